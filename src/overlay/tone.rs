//! How bright pictures and captions are drawn: in cd/m2 at the eye, toned for it by one operator, relative to the object's own
//! light.
//!
//! ```text
//! object, sky, eyepiece -> its own luminance and the eye's adaptation -> operator -> luminance to show -> share of full drive
//! ```

use serde::{Deserialize, Serialize};

use super::style::{Eye, Style};
use crate::eye::tone::{self, Adapted, Method};
use crate::sky::catalogue::{Kind, Object};
use crate::sky::optics::Instrument;
use crate::units::SurfaceBrightness;

/// A power as a table, and a picture's light brought along it.
pub mod curve;

/// Full white at the eye where nothing was measured, cd/m2: a medium filter before the thesis' module.
pub const ASSUMED_FULL_CD_M2: f64 = 0.3;
/// Full white over black where nothing was measured: the thesis' module down to 0.3 cd/m2 (section 8.5).
pub const ASSUMED_CONTRAST: f64 = 500.0;
/// Share of white's luminance that the red primary has: captions are red alone.
pub const RED_SHARE: f64 = 0.2126;
/// A picture or caption is asked to be so many magnitudes brighter than the object's own light at most, or less than none.
pub const MOST_MAG: f64 = 15.0;

/// What the projector gives at the eye, behind beam splitter and filters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Display {
    /// Luminance of a white pixel, cd/m2.
    pub full_cd_m2: f64,
    /// Luminance of a black pixel while the light is on, cd/m2: the veil over everything.
    pub black_cd_m2: f64,
    /// Whether somebody measured it; else it is what the settings (or the defaults) claim.
    pub measured: bool,
}

impl Default for Display {
    fn default() -> Display {
        Display::assumed(ASSUMED_FULL_CD_M2)
    }
}

impl Display {
    /// A projector that nobody measured: the contrast is that of the thesis' module.
    #[must_use]
    pub fn assumed(full_cd_m2: f64) -> Display {
        Display { full_cd_m2, black_cd_m2: full_cd_m2 / ASSUMED_CONTRAST, measured: false }
    }

    /// The same with its white dimmed to a share; its black stays, so that no dimming looks better than it may be.
    #[must_use]
    pub fn dimmed(self, share: f64) -> Display {
        Display { full_cd_m2: self.full_cd_m2 * share, ..self }
    }
}

/// What the observer wants of the light.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Toning {
    /// The operator for pictures and captions alike.
    pub method: Method,
    /// White of a picture, in magnitudes brighter than the object's own surface; left out: a fixed share of the projector's light.
    pub picture_over_object_mag: Option<f64>,
    /// The same of captions.
    pub captions_over_object_mag: Option<f64>,
}

impl Toning {
    /// Holds the numbers against what can be asked.
    ///
    /// # Errors
    /// Which number is out of range, in words.
    pub fn checked(&self) -> Result<(), String> {
        let asked = [
            ("picture_over_object_mag", self.picture_over_object_mag),
            ("captions_over_object_mag", self.captions_over_object_mag),
        ];
        for (key, mag) in asked {
            if let Some(mag) = mag.filter(|mag| !(-MOST_MAG..=MOST_MAG).contains(mag)) {
                return Err(format!(
                    "tone.{key} = {mag} is out of range: give -{MOST_MAG} (far dimmer than the object) to {MOST_MAG}"
                ));
            }
        }
        Ok(())
    }
}

/// How bright what is drawn is, as shares of full drive, and what that means at the eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lights {
    /// The operator.
    pub method: Method,
    /// The adaptations that it was asked with, before it raised them to where it holds.
    pub adapted: Adapted,
    /// Whether it raised one: the dark is beyond the operator.
    pub clamped: bool,
    /// The projector.
    pub display: Display,
    /// The light that pictures and captions are told relative to, at the eye, cd/m2.
    pub own_cd_m2: f64,
    /// Whether that is the object's own; else nothing is known of its surface (or it has none) and it is the sky's.
    pub of_object: bool,
    /// White of pictures. **No caption is brighter.**
    pub picture: f32,
    /// Text and the target's marks.
    pub text: f32,
    /// Other marks and names.
    pub marks: f32,
    /// A pixel of a share s of the picture's white is shown with s^exponent of it.
    pub exponent: f32,
}

impl Lights {
    /// The lights for an object (or for the bare sky) in an instrument.
    ///
    /// ```text
    /// L_own  object's mean surface behind instrument and splitter; the sky's where it has none
    /// lg L_wa = (1 - c) lg B + c lg(B + L_own)        B the sky, c the object's share of the field: the scene's log mean
    /// L_da = max(W / sqrt(C), L_wa)                   W the projector's white, C its contrast
    /// shown(m) = operator(10^(0.4 m) L_own) / W
    /// ```
    ///
    /// W / sqrt(C) is Tumblin and Rushmeier's own estimate; but the eye has sky and projector before it at once, so that it is
    /// adapted to no less than the sky's light. Captions are red: a drive d of theirs has 0.2126 d of the white's luminance.
    #[must_use]
    pub fn of(target: Option<&Object>, instrument: &Instrument, eye: &Eye, style: &Style) -> Lights {
        let viewing = instrument.viewing(eye.pupil_mm);
        let sky = viewing.background_cd_m2(eye.sky);
        let surface = target.and_then(surface_brightness).map(|own| own.to_candela_per_m2() * viewing.dimming());
        let surface = surface.filter(|own| own.is_finite() && *own > 0.0);
        let own_cd_m2 = surface.unwrap_or(sky);

        let display = style.display;
        let contrast = (display.full_cd_m2 / display.black_cd_m2).clamp(1.0, 1e6);
        let cover = match (target.and_then(|target| target.axes_arcmin), surface) {
            (Some((major, minor)), Some(_)) => {
                (major * minor / instrument.true_field().to_arcminutes().powi(2)).clamp(0.0, 1.0)
            }
            _ => 0.0,
        };
        let world_cd_m2 = ((1.0 - cover) * sky.ln() + cover * (sky + own_cd_m2).ln()).exp();
        let display_cd_m2 = (display.full_cd_m2 / contrast.sqrt()).max(world_cd_m2);
        let adapted = Adapted { world_cd_m2, display_cd_m2, contrast };

        let method = style.tone.method;
        let least = tone::least_adaptation_cd_m2(method);
        let shown = |mag: f64| {
            let asked = 10f64.powf(0.4 * mag) * own_cd_m2;
            tone::display_luminance(method, &adapted, asked).display_cd_m2 / display.full_cd_m2.max(1e-12)
        };
        let most = f64::from(style.ceiling.clamp(0.0, 1.0));
        let picture =
            style.tone.picture_over_object_mag.map_or(f64::from(style.photograph), shown).clamp(0.0, most) as f32;
        let text = style.tone.captions_over_object_mag.map_or(f64::from(style.text), |mag| shown(mag) / RED_SHARE);
        let text = (text.clamp(0.0, most) as f32).min(picture);
        let marks = text * (style.marks / style.text.max(1e-6)).min(1.0);
        Lights {
            method,
            adapted,
            clamped: world_cd_m2 < least || display_cd_m2 < least,
            display,
            own_cd_m2,
            of_object: surface.is_some(),
            picture,
            text,
            marks,
            exponent: tone::exponent(method, &adapted) as f32,
        }
    }

    /// Luminance of a picture's white at the eye, cd/m2.
    #[must_use]
    pub fn picture_cd_m2(&self) -> f64 {
        f64::from(self.picture) * self.display.full_cd_m2
    }

    /// Luminance of captions at the eye, cd/m2.
    #[must_use]
    pub fn captions_cd_m2(&self) -> f64 {
        RED_SHARE * f64::from(self.text) * self.display.full_cd_m2
    }

    /// How many magnitudes brighter than the object's own light a luminance is.
    #[must_use]
    pub fn over_own_mag(&self, cd_m2: f64) -> f64 {
        2.5 * (cd_m2.max(1e-12) / self.own_cd_m2.max(1e-12)).log10()
    }

    /// In a line of 42 characters at most: `picture +5.7, words +3.9 mag, tr93 held`. Held is an operator that does not reach so dark.
    #[must_use]
    pub fn words(&self) -> String {
        let over = |cd_m2| format!("{:+.1}", self.over_own_mag(cd_m2)).replace('-', "−");
        format!(
            "picture {}, words {} mag, {}{}",
            over(self.picture_cd_m2()),
            over(self.captions_cd_m2()),
            self.method,
            if self.clamped { " held" } else { "" }
        )
    }

    /// What a person should know of it: where the operator was held, and whether the projector was measured.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let least = tone::least_adaptation_cd_m2(self.method);
        let clamped = format!(
            "tone: {} does not hold for an eye adapted to less than {least} cd/m2 (here {:.1e} before the sky, {:.1e} before the \
             projector): it is taken as adapted to that",
            self.method, self.adapted.world_cd_m2, self.adapted.display_cd_m2
        );
        let assumed = format!(
            "tone: nobody measured the projector: its white is taken as {:.3} cd/m2 at the eye and its black as {:.1e}; \
             docs/hardware/light.md tells how to measure it",
            self.display.full_cd_m2, self.display.black_cd_m2
        );
        let told = [(self.clamped, clamped), (!self.display.measured, assumed)];
        told.into_iter().filter_map(|(so, text)| so.then_some(text)).collect()
    }
}

/// An object's mean surface brightness: the catalogue's, or of a disc of the solar system from its magnitude and size.
#[must_use]
pub fn surface_brightness(object: &Object) -> Option<SurfaceBrightness> {
    let of_disc = || {
        let (major, minor) = object.axes_arcmin.filter(|_| object.kind == Kind::SolarSystem)?;
        let square_arcsec = std::f64::consts::FRAC_PI_4 * major * minor * 3600.0;
        Some(SurfaceBrightness(object.magnitude?.0 + 2.5 * square_arcsec.log10()))
    };
    object.surface_brightness.or_else(of_disc)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::catalogue::Catalogue;
    use crate::units::Magnitude;
    use proptest::prelude::*;

    fn lights(name: &str, sky: f64, style: &Style) -> Lights {
        let object = Catalogue::embedded().search(name).unwrap();
        let eye = Eye { sky: SurfaceBrightness(sky), ..Eye::default() };
        Lights::of(Some(&object), &Instrument::default().with_eyepiece(24.0), &eye, style)
    }

    fn toned(method: Method, picture: Option<f64>, captions: Option<f64>) -> Style {
        Style {
            tone: Toning { method, picture_over_object_mag: picture, captions_over_object_mag: captions },
            ..Style::default()
        }
    }

    /// The reference text: 24.1 mag/arcsec2 is the sky at 104 times under 21.5; the Ring (17.8) stands 3.7 magnitudes above it.
    #[test]
    fn the_ring_nebulas_own_light_is_its_surface_behind_the_eyepiece() {
        let ring = lights("M57", 21.5, &Style::default());
        assert!(ring.of_object);
        let viewing = Instrument::default().with_eyepiece(24.0).viewing(7.0);
        let sky = viewing.background_cd_m2(SurfaceBrightness(21.5));
        let object = Catalogue::embedded().search("M57").unwrap();
        let by_hand = sky * 10f64.powf(0.4 * (21.5 - object.surface_brightness.unwrap().0));
        assert!((ring.own_cd_m2 / by_hand - 1.0).abs() < 1e-9, "{ring:?}");
        assert!(
            ring.adapted.world_cd_m2 > sky && ring.adapted.world_cd_m2 < 1.1 * sky,
            "the Ring is small in the field"
        );
    }

    /// sky.md's check values: adapted to 0.01 and 0.03, 0.001 cd/m2 is shown as 3.241e-3.
    #[test]
    fn a_dark_sky_is_clamped_told_and_brought_to_the_display_as_published() {
        // White 0.67 with a contrast of 500 adapts the eye to 0.03 cd/m2.
        let full = 0.03 * ASSUMED_CONTRAST.sqrt();
        let own = lights("M57", 21.5, &Style::default()).own_cd_m2;
        let mag = 2.5 * (1e-3 / own).log10();
        let style = Style { display: Display::assumed(full), ..toned(Method::Tr93, Some(mag), None) };
        let ring = lights("M57", 21.5, &style);
        assert!(ring.clamped && (ring.adapted.display_cd_m2 - 0.03).abs() < 1e-9);
        assert!((ring.picture_cd_m2() / 3.241e-3 - 1.0).abs() < 1e-3, "{}", ring.picture_cd_m2());
        assert!(ring.notes().iter().any(|note| note.contains("taken as adapted")), "{:?}", ring.notes());
        assert!(ring.words().ends_with("mag, tr93 held"));
    }

    #[test]
    fn a_picture_as_bright_as_the_object_is_just_that_with_the_linear_operator_where_the_eye_has_one_adaptation() {
        // A projector so dim that the sky adapts the eye: then the linear operator changes nothing.
        let display = Display { full_cd_m2: 1e-3, black_cd_m2: 1e-3, measured: true };
        for mag in [-1.0, 0.0, 0.5] {
            let style = Style { display, ..toned(Method::Linear, Some(mag), Some(mag)) };
            let moon = lights("M57", 16.0, &style);
            assert!((moon.over_own_mag(moon.picture_cd_m2()) - mag).abs() < 1e-3 || moon.picture == 1.0, "{moon:?}");
        }
    }

    #[test]
    fn a_planet_has_the_surface_of_its_magnitude_over_its_disc() {
        let mut jupiter = Catalogue::embedded().search("M57").unwrap();
        jupiter.kind = Kind::SolarSystem;
        (jupiter.surface_brightness, jupiter.magnitude) = (None, Some(Magnitude(-2.5)));
        jupiter.axes_arcmin = Some((45.0 / 60.0, 42.0 / 60.0));
        // pi/4 45 42 = 1484 square arcseconds: -2.5 + 7.93.
        assert!((surface_brightness(&jupiter).unwrap().0 - 5.43).abs() < 0.01);
        assert!(surface_brightness(&Object { kind: Kind::Star, ..jupiter }).is_none());
    }

    #[test]
    fn numbers_that_nobody_means_are_refused_with_the_key() {
        let wrong = Toning { captions_over_object_mag: Some(99.0), ..Toning::default() }.checked().unwrap_err();
        assert!(wrong.contains("tone.captions_over_object_mag = 99"), "{wrong}");
        assert!(Toning { picture_over_object_mag: Some(f64::NAN), ..Toning::default() }.checked().is_err());
    }

    proptest! {
        /// Section 8.6 of the thesis: brighter captions would lift the threshold for the object.
        #[test]
        fn captions_are_never_brighter_than_the_pictures_limit(
            method in 0usize..4, picture in proptest::option::of(-15.0..15.0f64), captions in proptest::option::of(-15.0..15.0f64),
            sky in 16.0..22.2f64, full in -4.0..1.0f64, contrast in 0.0..4.0f64, text in 0.0..1.0f32, photograph in 0.0..1.0f32,
            name in 0usize..4,
        ) {
            let full_cd_m2 = 10f64.powf(full);
            let display = Display { full_cd_m2, black_cd_m2: full_cd_m2 / 10f64.powf(contrast), measured: true };
            let style = Style { display, text, photograph, ..toned(Method::ALL[method], picture, captions) };
            let lights = lights(["M57", "M31", "M45", "Vega"][name], sky, &style);
            for light in [lights.picture, lights.text, lights.marks] {
                prop_assert!((0.0..=1.0).contains(&light), "{:?}", lights);
            }
            prop_assert!(lights.text <= lights.picture && lights.marks <= lights.text, "{:?}", lights);
            prop_assert!(lights.exponent.is_finite() && lights.exponent > 0.0);
        }
    }
}
