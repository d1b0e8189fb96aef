//! From the luminances of a scene to those of a display, so that the eye sees alike in both: four operators.
//!
//! All luminances in cd/m2 at the eye. None of them changes a colour: "without blue shift".

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Tumblin and Rushmeier's operator of 1993.
mod tr93;
/// Its revision of 1999.
mod tr99;

/// Which operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Tumblin and Rushmeier (1993): equal brightness by Stevens' law. The thesis' own.
    #[default]
    Tr93,
    /// Its revision (Tumblin, Hodgins and Guenter 1999), which holds in the dark too.
    Tr99,
    /// Ward (1994): just noticeable differences stay so.
    Ward,
    /// The ratio to the adaptation kept: nothing is done for the eye.
    Linear,
}

impl Method {
    /// All of them.
    pub const ALL: [Method; 4] = [Method::Tr93, Method::Tr99, Method::Ward, Method::Linear];

    /// The next one, round and round: what one key does.
    #[must_use]
    pub fn next(self) -> Method {
        let place = Method::ALL.iter().position(|method| *method == self).unwrap_or(0);
        Method::ALL[(place + 1) % Method::ALL.len()]
    }

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Method::Tr93 => "tr93",
            Method::Tr99 => "tr99",
            Method::Ward => "ward",
            Method::Linear => "linear",
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Method {
    type Err = String;

    fn from_str(text: &str) -> Result<Method, String> {
        let named = Method::ALL.into_iter().find(|method| method.name() == text);
        named.ok_or_else(|| String::from("a method is tr93, tr99, ward or linear"))
    }
}

/// To what the eye is adapted in front of the scene and in front of the display, and what the display can do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adapted {
    /// In front of the scene: its mean logarithm.
    pub world_cd_m2: f64,
    /// In front of the display.
    pub display_cd_m2: f64,
    /// The display's brightest over its darkest: 60 for a projector of 0.03 to 1.8 cd/m2. Only the 1999 form asks for it.
    pub contrast: f64,
}

/// The contrast of the thesis' projector: 1.8 over 0.03 cd/m2.
pub const PROJECTOR_CONTRAST: f64 = 60.0;

/// What comes out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Toned {
    /// Luminance that the display should show.
    pub display_cd_m2: f64,
    /// Whether an adaptation was raised to where the operator holds, or a result lowered to [`BRIGHTEST_CD_M2`].
    pub clamped: bool,
}

/// Results are held here: no display is brighter, and an exponent can ask for anything.
pub const BRIGHTEST_CD_M2: f64 = 1e6;

/// The adaptation below which a method is not used: its formula is undefined there, or explodes.
#[must_use]
pub fn least_adaptation_cd_m2(method: Method) -> f64 {
    match method {
        // alpha is 0 at 1.6e-4 cd/m2 and negative below; at 0.01 it is 0.72.
        Method::Tr93 => 0.01,
        // One of its gammas is 0 at 2.3e-5 cd/m2; here it is 0.26.
        Method::Tr99 => 1e-4,
        Method::Ward => 0.0,
        // The eye's own light.
        Method::Linear => 1e-6,
    }
}

/// The luminance to display for a luminance of the scene.
///
/// ```text
/// Ward:   m = ((1.219 + L_da^0.4) / (1.219 + L_wa^0.4))^2.5,  L_d = m L        L_da his half of the display's brightest
/// linear: L_d = L L_da / L_wa
/// ```
///
/// Ward (1994), Graphics Gems IV, 415.
#[must_use]
pub fn display_luminance(method: Method, adapted: &Adapted, luminance_cd_m2: f64) -> Toned {
    let least = least_adaptation_cd_m2(method);
    let (world, display) = (adapted.world_cd_m2.max(least), adapted.display_cd_m2.max(least));
    let raised = world != adapted.world_cd_m2 || display != adapted.display_cd_m2;
    let luminance = luminance_cd_m2.max(0.0);
    let shown = match method {
        Method::Tr93 => tr93::display(world, display, luminance),
        Method::Tr99 => tr99::display(world, display, adapted.contrast, luminance),
        Method::Ward => ((1.219 + display.powf(0.4)) / (1.219 + world.powf(0.4))).powf(2.5) * luminance,
        Method::Linear => luminance / world * display,
    };
    let held = shown.min(BRIGHTEST_CD_M2);
    Toned { display_cd_m2: held, clamped: raised || held != shown }
}

/// How much steeper than the scene the display is: all four operators are powers, L_d ~ L^exponent.
#[must_use]
pub fn exponent(method: Method, adapted: &Adapted) -> f64 {
    let least = least_adaptation_cd_m2(method);
    let (world, display) = (adapted.world_cd_m2.max(least), adapted.display_cd_m2.max(least));
    match method {
        Method::Tr93 => tr93::alpha(world) / tr93::alpha(display),
        Method::Tr99 => tr99::gamma(world) / tr99::gamma(display),
        Method::Ward | Method::Linear => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn adapted(world_cd_m2: f64, display_cd_m2: f64) -> Adapted {
        Adapted { world_cd_m2, display_cd_m2, contrast: PROJECTOR_CONTRAST }
    }

    #[test]
    fn the_1993_form_gives_the_published_grid_where_it_holds_and_says_where_it_does_not() {
        let text = include_str!("../../fixtures/reference/eye/tumblin_rushmeier_check.csv");
        let (mut compared, mut clamped) = (0, 0);
        for row in text.lines().skip(1) {
            let cells: Vec<&str> = row.split(',').collect();
            let n = |i: usize| cells[i].parse::<f64>().unwrap();
            let toned = display_luminance(Method::Tr93, &adapted(n(0), n(1)), n(2));
            if n(0) < 0.01 || n(1) < 0.01 {
                assert!(toned.clamped && toned.display_cd_m2.is_finite(), "{row}: {toned:?}");
                clamped += 1;
            } else {
                assert!((toned.display_cd_m2 / n(7) - 1.0).abs() < 1e-6 && !toned.clamped, "{row}: {toned:?}");
                compared += 1;
            }
        }
        assert!(compared > 30 && clamped > 30, "{compared} {clamped}");
    }

    #[test]
    fn a_scene_seen_in_its_own_light_is_shown_as_it_is() {
        for method in Method::ALL {
            for level in [0.01, 0.3, 50.0] {
                let same = Adapted { contrast: 1.0, ..adapted(level, level) };
                let toned = display_luminance(method, &same, level / 3.0);
                let ratio = toned.display_cd_m2 / (level / 3.0);
                // The 1999 form's two gammas differ by its 2.3e-5 cd/m2.
                assert!((ratio - 1.0).abs() < 1e-3, "{method} {level}: {ratio}");
            }
        }
    }

    #[test]
    fn no_adaptation_makes_anything_but_a_number() {
        for method in Method::ALL {
            for world in [0.0, 1e-300, 1e-8, 1e-4, 1.0, 1e4] {
                for display in [0.0, 1e-8, 1e-4, 1.0, 1e4] {
                    let mut before = -1.0;
                    for luminance in [0.0, 1e-300, 1e-8, 1e-3, 1.0, 1e4, 1e10] {
                        let shown = display_luminance(method, &adapted(world, display), luminance).display_cd_m2;
                        assert!(
                            shown.is_finite() && shown >= before,
                            "{method} {world} {display} {luminance}: {shown}"
                        );
                        before = shown;
                    }
                }
            }
        }
    }

    #[test]
    fn each_operator_is_a_power_of_the_luminance_with_the_exponent_told() {
        for method in Method::ALL {
            for (world, display) in [(1e-8, 0.3), (0.01, 0.03), (3.0, 0.1), (1e4, 1.0)] {
                let adapted = adapted(world, display);
                let shown = |luminance| display_luminance(method, &adapted, luminance).display_cd_m2;
                let slope = (shown(2e-3) / shown(1e-3)).log2();
                assert!((slope - exponent(method, &adapted)).abs() < 1e-9, "{method} {world} {display}: {slope}");
            }
        }
    }

    #[test]
    fn wards_factor_halves_where_he_says() {
        // A display of 100 cd/m2 and a world of 0: m = ((1.219 + 50^0.4) / 1.219)^2.5 = 27.95 by hand.
        let toned = display_luminance(Method::Ward, &adapted(0.0, 50.0), 1.0);
        let by_hand: f64 = ((1.219 + 4.781_763) / 1.219f64).powf(2.5);
        assert!((toned.display_cd_m2 / by_hand - 1.0).abs() < 1e-6 && !toned.clamped);
    }
}
