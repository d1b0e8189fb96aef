//! Whether a window stands on the monitor that was named: some displays put windows where they like, and the observer's own
//! bright screen must not get the picture, nor the eyepiece the desktop. Pure.

/// A rectangle of the desktop, in its pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// Left edge.
    pub left: i32,
    /// Upper edge.
    pub top: i32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Place {
    fn contains(&self, x: i64, y: i64) -> bool {
        let (left, top) = (i64::from(self.left), i64::from(self.top));
        (left..left + i64::from(self.width)).contains(&x) && (top..top + i64::from(self.height)).contains(&y)
    }

    fn middle(&self) -> (i64, i64) {
        (i64::from(self.left) + i64::from(self.width / 2), i64::from(self.top) + i64::from(self.height / 2))
    }
}

/// Why a window must stay black.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Astray {
    /// It is on another monitor, or on none.
    #[error(
        "the window landed on {landed}, not on '{wanted}': move it there, or give the projector to scotopic alone with kms:CONNECTOR"
    )]
    Elsewhere {
        /// The monitor that was named.
        wanted: String,
        /// Where it is.
        landed: String,
    },
    /// Two monitors show the same part of the desktop.
    #[error(
        "'{wanted}' shows the same as '{other}': set the monitors side by side, or the observer's screen gets the picture"
    )]
    Mirrored {
        /// The monitor that was named.
        wanted: String,
        /// The one that shows the same.
        other: String,
    },
    /// It does not fill its monitor.
    #[error(
        "the window on '{wanted}' is {} x {} at {}, {} and does not fill the monitor: the desktop would be seen in the eyepiece",
        window.width, window.height, window.left, window.top
    )]
    Partly {
        /// The monitor that was named.
        wanted: String,
        /// The window.
        window: Place,
    },
}

/// Judges a window by its rectangle and those of all monitors.
///
/// # Errors
/// It is elsewhere, does not fill the monitor, or the monitor is mirrored.
pub fn judge(monitors: &[(String, Place)], window: Place, wanted: &str) -> Result<(), Astray> {
    let (x, y) = window.middle();
    let under: Vec<&(String, Place)> = monitors.iter().filter(|(_, place)| place.contains(x, y)).collect();
    let Some((_, own)) = under.iter().find(|(name, _)| name == wanted) else {
        let names: Vec<String> = under.iter().map(|(name, _)| format!("'{name}'")).collect();
        let landed = if names.is_empty() { "no monitor".into() } else { names.join(" and ") };
        return Err(Astray::Elsewhere { wanted: wanted.into(), landed });
    };
    if let Some((other, _)) = under.iter().find(|(name, _)| name != wanted) {
        return Err(Astray::Mirrored { wanted: wanted.into(), other: other.clone() });
    }
    let (right, bottom) = (i64::from(own.left) + i64::from(own.width), i64::from(own.top) + i64::from(own.height));
    let fills = window.left <= own.left
        && window.top <= own.top
        && i64::from(window.left) + i64::from(window.width) >= right
        && i64::from(window.top) + i64::from(window.height) >= bottom;
    if fills { Ok(()) } else { Err(Astray::Partly { wanted: wanted.into(), window }) }
}

/// Judges a window by the name of the monitor that the display says it is on, where rectangles are kept secret (Wayland).
///
/// # Errors
/// It is elsewhere.
pub fn judge_by_name(landed: Option<&str>, wanted: &str) -> Result<(), Astray> {
    if landed == Some(wanted) {
        return Ok(());
    }
    let landed = landed.map_or_else(|| "no monitor that the display would name".into(), |name| format!("'{name}'"));
    Err(Astray::Elsewhere { wanted: wanted.into(), landed })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(left: i32, top: i32, width: u32, height: u32) -> Place {
        Place { left, top, width, height }
    }

    /// A laptop of 1920 x 1200 with a projector of 1280 x 720 on its right.
    fn desk() -> Vec<(String, Place)> {
        vec![("eDP-1".into(), place(0, 0, 1920, 1200)), ("HDMI-1".into(), place(1920, 100, 1280, 720))]
    }

    #[test]
    fn a_window_that_fills_the_named_monitor_is_right() {
        assert_eq!(judge(&desk(), place(1920, 100, 1280, 720), "HDMI-1"), Ok(()));
        assert_eq!(judge(&desk(), place(0, 0, 1920, 1200), "eDP-1"), Ok(()));
        assert_eq!(judge_by_name(Some("HDMI-1"), "HDMI-1"), Ok(()));
    }

    #[test]
    fn a_window_on_the_observers_screen_is_refused_and_says_where_it_landed() {
        for (window, words) in [
            (place(0, 0, 1920, 1200), "landed on 'eDP-1', not on 'HDMI-1'"),
            (place(-4000, 0, 10, 10), "landed on no monitor"),
            (place(i32::MIN, i32::MIN, u32::MAX, u32::MAX), "HDMI-1"),
            (place(1920, 100, 1024, 720), "is 1024 x 720 at 1920, 100 and does not fill"),
            (place(1930, 100, 1280, 720), "does not fill"),
        ] {
            let said = judge(&desk(), window, "HDMI-1").unwrap_err().to_string();
            assert!(said.contains(words), "{said}");
        }
        assert!(
            judge_by_name(None, "HDMI-1").unwrap_err().to_string().contains("no monitor that the display would name")
        );
    }

    #[test]
    fn a_mirrored_monitor_is_refused() {
        let mirrored = vec![("eDP-1".into(), place(0, 0, 1280, 720)), ("HDMI-1".into(), place(0, 0, 1280, 720))];
        let said = judge(&mirrored, place(0, 0, 1280, 720), "HDMI-1").unwrap_err().to_string();
        assert!(said.contains("shows the same as 'eDP-1'"), "{said}");
    }
}
