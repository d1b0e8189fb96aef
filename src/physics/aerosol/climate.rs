//! The air of a place: OPAC's ten climates, mixed of components, and how they thin out with height.

use std::fmt;
use std::str::FromStr;

use super::components::{Component, ComponentError, Humidity};
use super::sizes::{Average, CrossSections, SizesError};
use crate::physics::refraction::ray::Absorber;

/// A place's air. Source of the mixtures: Hess, Koepke & Schult (1998), Bull. Am. Meteorol. Soc. 79, 831, table 3.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Climate {
    /// Remote continents, hardly any soot.
    ContinentalClean,
    /// Continents with some people.
    ContinentalAverage,
    /// Densely settled continents.
    ContinentalPolluted,
    /// Cities.
    Urban,
    /// Deserts.
    Desert,
    /// Oceans far from people.
    MaritimeClean,
    /// Oceans downwind of people.
    MaritimePolluted,
    /// Tropical oceans with little wind.
    MaritimeTropical,
    /// North of 70 degrees, with the soot that winter brings.
    Arctic,
    /// The Antarctic plateau.
    Antarctic,
}

/// A component and how many of its particles are in a cubic centimetre.
pub type Constituent = (Component, f64);

/// Free troposphere above the mixed layer: number per cubic centimetre, referred to the ground. Hess et al. (1998), section 2d.
const FREE_TROPOSPHERE: &[Constituent] =
    &[(Component::Waso, 438.0), (Component::Inso, 0.0013), (Component::Soot, 294.0)];
/// Scale height of the free troposphere's particles, kilometres.
pub(super) const FREE_SCALE_KM: f64 = 8.0;
/// Where the free troposphere ends, kilometres.
pub(super) const TROPOPAUSE_KM: f64 = 12.0;
/// Stratosphere up to [`TOP_KM`]: number per cubic centimetre, the same everywhere.
const STRATOSPHERE: &[Constituent] = &[(Component::Suso, 3.0)];
/// Above this height, kilometres, the air has no particles.
pub(super) const TOP_KM: f64 = 35.0;

/// A climate that is not there.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("no climate '{asked}': there are {}", Climate::ALL.map(Climate::name).join(", "))]
pub struct UnknownClimate {
    /// What was asked for.
    pub asked: String,
}

/// Why a climate is not computed.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum AerosolError {
    /// The tables do not reach so far.
    #[error(transparent)]
    Component(#[from] ComponentError),
    /// The average over sizes failed.
    #[error(transparent)]
    Sizes(#[from] SizesError),
    /// The tolerance is none.
    #[error("tolerance {0}: give a fraction of the extinction between 1e-4 and 0.1")]
    Tolerance(f64),
    /// The tolerance is not reached with the most intervals that are allowed.
    #[error(
        "{intervals} size intervals leave an error of {reached:.1e} of the extinction: ask for a tolerance above it"
    )]
    NotConverged {
        /// Intervals tried last.
        intervals: usize,
        /// Error reached, relative to the extinction.
        reached: f64,
    },
}

/// What a volume of air does to light by its particles.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bulk {
    /// Extinction, scattering plus absorption, per kilometre.
    pub extinction_per_km: f64,
    /// Scattering, per kilometre.
    pub scattering_per_km: f64,
    /// Absorption, per kilometre.
    pub absorption_per_km: f64,
    /// Mean cosine of the scattering angle.
    pub asymmetry: f64,
    /// Believed error of the extinction, the scattering and the absorption, per kilometre.
    pub error_per_km: f64,
    /// Spheres computed for it.
    pub spheres: usize,
}

impl Bulk {
    /// Scattering over extinction; 1 where there is neither.
    #[must_use]
    pub fn single_scattering_albedo(&self) -> f64 {
        if self.extinction_per_km > 0.0 { self.scattering_per_km / self.extinction_per_km } else { 1.0 }
    }

    /// The same particles, `factor` times as many.
    #[must_use]
    pub fn times(&self, factor: f64) -> Bulk {
        Bulk {
            extinction_per_km: self.extinction_per_km * factor,
            scattering_per_km: self.scattering_per_km * factor,
            absorption_per_km: self.absorption_per_km * factor,
            error_per_km: self.error_per_km * factor,
            ..*self
        }
    }
}

/// How the particles of the mixed layer thin out with height. Hess et al. (1998), table 5.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MixedLayer {
    /// Its top, kilometres above the ground.
    pub top_km: f64,
    /// Height over which their number falls by e, kilometres; none where it is constant.
    pub scale_height_km: Option<f64>,
}

impl MixedLayer {
    /// Number of particles at a height, relative to the ground.
    pub(super) fn thinning(&self, height_km: f64) -> f64 {
        self.scale_height_km.map_or(1.0, |scale| (-height_km / scale).exp())
    }

    /// The same as a height: the layer's particles, were they as many everywhere as at the ground.
    fn depth_km(&self) -> f64 {
        self.scale_height_km.map_or(self.top_km, |scale| scale * -(-self.top_km / scale).exp_m1())
    }
}

impl Climate {
    /// All of them.
    pub const ALL: [Climate; 10] = [
        Climate::ContinentalClean,
        Climate::ContinentalAverage,
        Climate::ContinentalPolluted,
        Climate::Urban,
        Climate::Desert,
        Climate::MaritimeClean,
        Climate::MaritimePolluted,
        Climate::MaritimeTropical,
        Climate::Arctic,
        Climate::Antarctic,
    ];

    /// The name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Climate::ContinentalClean => "continental-clean",
            Climate::ContinentalAverage => "continental-average",
            Climate::ContinentalPolluted => "continental-polluted",
            Climate::Urban => "urban",
            Climate::Desert => "desert",
            Climate::MaritimeClean => "maritime-clean",
            Climate::MaritimePolluted => "maritime-polluted",
            Climate::MaritimeTropical => "maritime-tropical",
            Climate::Arctic => "arctic",
            Climate::Antarctic => "antarctic",
        }
    }

    /// Particles at the ground, number per cubic centimetre, the same at every humidity. Hess et al. (1998), table 3.
    #[must_use]
    pub const fn constituents(self) -> &'static [Constituent] {
        use Component::{Inso, Miam, Micm, Minm, Mitr, Soot, Ssam, Sscm, Suso, Waso};
        match self {
            Climate::ContinentalClean => &[(Waso, 2600.0), (Inso, 0.15)],
            Climate::ContinentalAverage => &[(Waso, 7000.0), (Inso, 0.4), (Soot, 8300.0)],
            Climate::ContinentalPolluted => &[(Waso, 15700.0), (Inso, 0.6), (Soot, 34300.0)],
            Climate::Urban => &[(Waso, 28000.0), (Inso, 1.5), (Soot, 130_000.0)],
            Climate::Desert => &[(Waso, 2000.0), (Minm, 269.5), (Miam, 30.5), (Micm, 0.142)],
            Climate::MaritimeClean => &[(Waso, 1500.0), (Ssam, 20.0), (Sscm, 0.0032)],
            Climate::MaritimePolluted => &[(Waso, 3800.0), (Ssam, 20.0), (Sscm, 0.0032), (Soot, 5180.0)],
            Climate::MaritimeTropical => &[(Waso, 590.0), (Ssam, 10.0), (Sscm, 0.0013)],
            Climate::Arctic => &[(Waso, 1300.0), (Inso, 0.01), (Ssam, 1.9), (Soot, 5300.0)],
            Climate::Antarctic => &[(Suso, 42.9), (Ssam, 0.047), (Mitr, 0.0053)],
        }
    }

    /// How its particles thin out with height.
    #[must_use]
    pub const fn mixed_layer(self) -> MixedLayer {
        match self {
            Climate::ContinentalClean | Climate::ContinentalAverage | Climate::ContinentalPolluted | Climate::Urban => {
                MixedLayer { top_km: 2.0, scale_height_km: Some(8.0) }
            }
            Climate::Desert => MixedLayer { top_km: 6.0, scale_height_km: Some(2.0) },
            Climate::MaritimeClean | Climate::MaritimePolluted | Climate::MaritimeTropical => {
                MixedLayer { top_km: 2.0, scale_height_km: Some(1.0) }
            }
            Climate::Arctic => MixedLayer { top_km: 2.0, scale_height_km: None },
            Climate::Antarctic => MixedLayer { top_km: 10.0, scale_height_km: Some(8.0) },
        }
    }

    /// What the air at the ground does to light of a wavelength, to a tolerance that is a fraction of the extinction.
    ///
    /// # Errors
    /// The wavelength is outside 300 to 1000 nm; the tolerance is outside 1e-4 to 0.1 or not reached.
    pub fn at_ground(self, humidity: Humidity, wavelength_nm: f64, tolerance: f64) -> Result<Bulk, AerosolError> {
        mixture(self.constituents(), humidity, wavelength_nm, tolerance)
    }

    /// The same over all sizes with a number of intervals for each component, and no plan: the first power of two times
    /// [`FEWEST_INTERVALS`] that is not below `intervals`.
    ///
    /// # Errors
    /// The wavelength is outside 300 to 1000 nm.
    pub fn at_ground_with_intervals(
        self,
        humidity: Humidity,
        wavelength_nm: f64,
        intervals: usize,
    ) -> Result<Bulk, AerosolError> {
        let mut rules = first_rules(self.constituents(), humidity, wavelength_nm, FEWEST_INTERVALS)?;
        for (_, rule) in &mut rules {
            while rule.intervals() < intervals.min(MOST_INTERVALS) {
                *rule = rule.halved()?;
            }
        }
        Ok(sum(&rules))
    }

    /// The whole column above a place of this climate: the mixed layer in air of this humidity, the free troposphere at
    /// 50 %, the stratosphere dry.
    ///
    /// # Errors
    /// The wavelength is outside 300 to 1000 nm; the tolerance is outside 1e-4 to 0.1 or not reached.
    pub fn column(self, humidity: Humidity, wavelength_nm: f64, tolerance: f64) -> Result<Column, AerosolError> {
        let layer = self.mixed_layer();
        Ok(Column {
            layer,
            steps_m: [layer.top_km, TROPOPAUSE_KM, TOP_KM].map(|km| 1e3 * km),
            ground: self.at_ground(humidity, wavelength_nm, tolerance)?,
            free_troposphere: mixture(FREE_TROPOSPHERE, Humidity::HALF, wavelength_nm, tolerance)?,
            stratosphere: mixture(STRATOSPHERE, Humidity::DRY, wavelength_nm, tolerance)?,
        })
    }
}

impl fmt::Display for Climate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Climate {
    type Err = UnknownClimate;

    fn from_str(text: &str) -> Result<Climate, UnknownClimate> {
        let found = Climate::ALL.into_iter().find(|climate| climate.name() == text);
        found.ok_or_else(|| UnknownClimate { asked: text.to_owned() })
    }
}

/// The particles over a place, at one wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    /// How the mixed layer thins out.
    pub layer: MixedLayer,
    /// The mixed layer's air at the ground.
    pub ground: Bulk,
    /// The free troposphere's air, referred to the ground.
    pub free_troposphere: Bulk,
    /// The stratosphere's air.
    pub stratosphere: Bulk,
    /// Where the number of particles jumps, metres.
    steps_m: [f64; 3],
}

impl Column {
    /// The air at a height above the ground; nothing above 35 km. Below the ground the mixed layer goes on as at it.
    #[must_use]
    pub fn at(&self, height_km: f64) -> Bulk {
        if height_km < self.layer.top_km {
            self.ground.times(self.layer.thinning(height_km.max(0.0)))
        } else if height_km < TROPOPAUSE_KM {
            self.free_troposphere.times((-height_km / FREE_SCALE_KM).exp())
        } else if height_km < TOP_KM {
            self.stratosphere
        } else {
            Bulk::default()
        }
    }

    /// The column for the thesis' law (its eq. 4.3'), by which all that is scattered forward counts as not scattered:
    /// everything that particles take is (1 - g) times as much.
    #[must_use]
    pub fn less_forward(self) -> Column {
        let less = |bulk: Bulk| bulk.times(1.0 - bulk.asymmetry);
        Column {
            ground: less(self.ground),
            free_troposphere: less(self.free_troposphere),
            stratosphere: less(self.stratosphere),
            ..self
        }
    }

    /// Extinction of the mixed layer and the free troposphere, each referred to the ground, and of the stratosphere, per
    /// metre: the parts of [`super::shape::Shape`].
    #[must_use]
    pub fn parts_per_m(&self) -> [f64; 3] {
        [self.ground, self.free_troposphere, self.stratosphere].map(|bulk| 1e-3 * bulk.extinction_per_km)
    }

    /// Optical depth of the whole column, straight up.
    #[must_use]
    pub fn optical_depth(&self) -> f64 {
        let free_km =
            FREE_SCALE_KM * ((-self.layer.top_km / FREE_SCALE_KM).exp() - (-TROPOPAUSE_KM / FREE_SCALE_KM).exp());
        self.ground.extinction_per_km * self.layer.depth_km()
            + self.free_troposphere.extinction_per_km * free_km
            + self.stratosphere.extinction_per_km * (TOP_KM - TROPOPAUSE_KM)
    }
}

impl Absorber for Column {
    fn per_m(&self, height_m: f64) -> f64 {
        1e-3 * self.at(1e-3 * height_m).extinction_per_km
    }

    fn knots_m(&self) -> &[f64] {
        &self.steps_m
    }
}

/// One square micrometre a particle and one particle a cubic centimetre, in 1/km.
const PER_KM: f64 = 1e-3;

/// Intervals of the rough sum that tells what each component contributes.
const FEWEST_INTERVALS: usize = 16;
/// A component that still errs too much with these is refused.
const MOST_INTERVALS: usize = 65_536;
/// The share of the tolerance that sizes left out may cost.
const LEFT_OUT: f64 = 0.05;

/// A component's number per cubic centimetre and its average over sizes.
type Rule = (f64, Average);

/// A mixture to a tolerance. A rough sum tells what each component contributes. Then sizes are left out that a bound says
/// are too few to matter, and the step is halved for whichever component errs most, until all together err little enough:
/// a component that hardly matters is hardly computed. Independent errors add as squares.
fn mixture(
    constituents: &[Constituent],
    humidity: Humidity,
    wavelength_nm: f64,
    tolerance: f64,
) -> Result<Bulk, AerosolError> {
    if !(1e-4..=0.1).contains(&tolerance) {
        return Err(AerosolError::Tolerance(tolerance));
    }
    let mut rules = first_rules(constituents, humidity, wavelength_nm, FEWEST_INTERVALS)?;
    let allowed_per_km = LEFT_OUT * tolerance * sum(&rules).extinction_per_km / constituents.len() as f64;
    for (number, rule) in &mut rules {
        *rule = rule.without(allowed_per_km / (PER_KM * *number))?.halved()?;
    }
    loop {
        let bulk = sum(&rules);
        let reached = bulk.error_per_km / bulk.extinction_per_km;
        if reached <= tolerance {
            return Ok(bulk);
        }
        let error = |(number, rule): &Rule| number * rule.result().error_um2;
        let Some((_, worst)) = rules.iter_mut().max_by(|a, b| error(a).total_cmp(&error(b))) else { return Ok(bulk) };
        if worst.intervals() >= MOST_INTERVALS {
            return Err(AerosolError::NotConverged { intervals: worst.intervals(), reached });
        }
        *worst = worst.halved()?;
    }
}

/// Each component's first rule.
fn first_rules(
    constituents: &[Constituent],
    humidity: Humidity,
    wavelength_nm: f64,
    intervals: usize,
) -> Result<Vec<Rule>, AerosolError> {
    let first = |&(component, number): &Constituent| {
        let wet = component.in_air(humidity);
        let m = wet.refractive_index(wavelength_nm)?;
        Ok((number, Average::new(wet.sizes, m, wavelength_nm / 1000.0, intervals)?))
    };
    constituents.iter().map(first).collect()
}

/// All components together.
fn sum(rules: &[Rule]) -> Bulk {
    let mut bulk = Bulk::default();
    let (mut forward_per_km, mut squares) = (0.0, 0.0);
    for &(number, rule) in rules {
        let CrossSections { extinction_um2, scattering_um2, absorption_um2, forward_um2, error_um2, spheres } =
            rule.result();
        bulk.extinction_per_km += PER_KM * number * extinction_um2;
        bulk.scattering_per_km += PER_KM * number * scattering_um2;
        bulk.absorption_per_km += PER_KM * number * absorption_um2;
        forward_per_km += PER_KM * number * forward_um2;
        squares += (PER_KM * number * error_um2).powi(2);
        bulk.spheres += spheres;
    }
    bulk.asymmetry = forward_per_km / bulk.scattering_per_km;
    bulk.error_per_km = squares.sqrt();
    bulk
}

#[cfg(test)]
mod tests {
    use super::*;

    fn humidity(percent: f64) -> Humidity {
        Humidity::percent(percent).unwrap()
    }

    #[test]
    fn the_believed_error_covers_the_true_one() {
        for climate in [Climate::Urban, Climate::MaritimePolluted, Climate::Antarctic] {
            let fine = climate.at_ground(humidity(80.0), 550.0, 2e-4).unwrap();
            for tolerance in [0.1, 0.01] {
                let bulk = climate.at_ground(humidity(80.0), 550.0, tolerance).unwrap();
                assert!(bulk.error_per_km <= tolerance * bulk.extinction_per_km);
                assert!(bulk.spheres < fine.spheres);
                let error = (bulk.extinction_per_km - fine.extinction_per_km).abs();
                assert!(error <= bulk.error_per_km + fine.error_per_km, "{climate} to {tolerance}: {error}");
            }
        }
    }

    #[test]
    fn air_that_swells_grows_thicker_with_humidity() {
        for climate in Climate::ALL {
            let mut before = 0.0;
            for percent in [0.0, 30.0, 50.0, 60.0, 75.0, 85.0, 92.5, 97.0, 98.5, 99.0] {
                let bulk = climate.at_ground(humidity(percent), 550.0, 0.01).unwrap();
                assert!(bulk.extinction_per_km > before, "{climate} at {percent} %");
                assert!(bulk.asymmetry > 0.5 && bulk.asymmetry < 0.9);
                assert!((0.6..=1.0).contains(&bulk.single_scattering_albedo()));
                before = bulk.extinction_per_km;
            }
        }
    }

    #[test]
    fn optical_depth_is_what_the_heights_add_up_to() {
        for climate in [Climate::Desert, Climate::Arctic, Climate::MaritimeClean] {
            let column = climate.column(humidity(50.0), 550.0, 0.01).unwrap();
            let thin_km = 0.001;
            let sum: f64 =
                (0..36_000).map(|i| column.at((f64::from(i) + 0.5) * thin_km).extinction_per_km * thin_km).sum();
            assert!((sum / column.optical_depth() - 1.0).abs() < 1e-4, "{climate}: {sum}");
            assert_eq!(column.at(-0.1), column.at(0.0));
            assert_eq!(column.at(36.0), Bulk::default());
        }
    }

    #[test]
    fn what_is_not_known_is_refused() {
        let climate = Climate::MaritimePolluted;
        for nm in [299.9, 1001.0, f64::NAN] {
            assert!(climate.at_ground(humidity(80.0), nm, 0.01).is_err(), "{nm} nm");
        }
        for tolerance in [0.0, 1e-5, 0.2, f64::NAN] {
            assert!(climate.at_ground(humidity(80.0), 550.0, tolerance).is_err(), "{tolerance}");
        }
        assert!("atlantis".parse::<Climate>().unwrap_err().to_string().contains("maritime-polluted"));
        for climate in Climate::ALL {
            assert_eq!(climate.name().parse(), Ok(climate));
        }
    }
}
