//! Where the canvas lies on the module: any number that a person may write, on modules of any shape.

use scotopic::cli::settings::Settings;
use scotopic::picture::Picture;

use super::assert_harmless;

/// Checks one input: two bytes for the module's size, then the lines of the settings' table `[placement]`.
///
/// # Panics
/// Something does not hold.
pub fn check(data: &[u8]) {
    let [width, height, text @ ..] = data else { return };
    let Ok(text) = str::from_utf8(text) else { return };
    let placement = match Settings::from_toml(&format!("[placement]\n{text}")) {
        Ok(settings) => settings.placement,
        Err(wrong) => return assert_harmless(&wrong.what),
    };
    let (canvas, module) = (canvas(), (usize::from(*width), usize::from(*height)));
    if module.0 == 0 || module.1 == 0 {
        return;
    }
    let placed = placement.apply(&canvas, module).into_owned();
    assert_eq!((placed.width(), placed.height()), module);
    let pixels = (0..module.1).flat_map(|row| placed.row(row)).flatten();
    let mut brightest = 0.0_f32;
    for light in pixels {
        assert!(light.is_finite() && (0.0..=1.0001).contains(light), "{light} from {placement:?}");
        brightest = brightest.max(*light);
    }
    match placement.seen((canvas.width(), canvas.height()), module) {
        Ok(_) => {}
        Err(error) => {
            assert_harmless(&error.to_string());
            assert_eq!(brightest, 0.0, "{error}, and yet something is seen");
        }
    }
}

/// A canvas with a frame of light, so that something is seen wherever a piece of it lies.
fn canvas() -> Picture {
    let mut canvas = Picture::black(16, 12);
    for row in 0..12 {
        for (column, pixel) in canvas.row_mut(row).iter_mut().enumerate() {
            *pixel = if row == 0 || row == 11 || column == 0 || column == 15 { [1.0; 3] } else { [0.25, 0.5, 0.0] };
        }
    }
    canvas
}
