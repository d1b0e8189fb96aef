//! What is to be drawn, and whether it differs from what was drawn: less than half a pixel is not drawn again.

use crate::overlay::menu::Menu;
use crate::overlay::style::Mode;
use crate::overlay::tone::Toning;
use crate::sky::catalogue::Object;
use crate::sky::optics::Instrument;
use crate::sky::pointing::Pointing;
use crate::sky::site::Site;
use crate::sky::time::Moment;
use crate::units::Angle;

/// A movement under this share of a pixel cannot be seen.
const SEEN_PX: f64 = 0.5;

/// From the canvas' middle to its corner, pixels.
const REACH_PX: f64 = 640.0;

/// All that one frame is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Where the telescope points, nudge included.
    pub pointing: Pointing,
    /// Through what it looks.
    pub instrument: Instrument,
    /// When.
    pub moment: Moment,
    /// From where.
    pub site: Option<Site>,
    /// How the field stands against the horizon: the parallactic angle.
    pub rotation: Angle,
    /// Over the object, beside it.
    pub mode: Mode,
    /// How bright the picture is, 0 to 1.
    pub brightness: f32,
    /// The operator, and how bright picture and words are beside the object's own light.
    pub tone: Toning,
    /// The object whose facts are told, if one was chosen.
    pub target: Option<Object>,
    /// Whether photographs are drawn.
    pub photographs: bool,
    /// Whether words are drawn.
    pub facts: bool,
    /// Which animation is played, and its frame.
    pub animation: Option<(usize, usize)>,
    /// The menu over it.
    pub menu: Option<Menu>,
}

impl Scene {
    /// Whether the eye could tell the two apart.
    #[must_use]
    pub fn differs(&self, drawn: &Scene) -> bool {
        let pixel = self.instrument.pixel_scale();
        let moved_px = self.pointing.position.separation(&drawn.pointing.position) / pixel;
        let surer_px = (self.pointing.uncertainty - drawn.pointing.uncertainty).abs() / pixel;
        let turned_px = (self.rotation - drawn.rotation).wrapped_signed().abs().to_radians() * REACH_PX;
        moved_px >= SEEN_PX
            || surer_px >= 2.0
            || turned_px >= SEEN_PX
            || (&self.instrument, self.mode, self.brightness, &self.target)
                != (&drawn.instrument, drawn.mode, drawn.brightness, &drawn.target)
            || (self.photographs, self.facts, self.animation, &self.menu)
                != (drawn.photographs, drawn.facts, drawn.animation, &drawn.menu)
            || (self.site, self.tone) != (drawn.site, drawn.tone)
    }
}
