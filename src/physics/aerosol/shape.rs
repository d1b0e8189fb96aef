//! How particles lie over a place, whatever the wavelength: three parts, each with one extinction.

use super::climate::{Climate, FREE_SCALE_KM, MixedLayer, TOP_KM, TROPOPAUSE_KM};
use crate::physics::refraction::ray::Absorber;

/// The mixed layer, the free troposphere and the stratosphere of a climate, each as if it took 1/m (the first two: referred to
/// the ground). A depth along a ray is then a length in metres; times a part's extinction it is that part's depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    layer: MixedLayer,
    steps_m: [f64; 3],
}

impl Shape {
    /// The shape of a climate.
    #[must_use]
    pub fn of(climate: Climate) -> Shape {
        let layer = climate.mixed_layer();
        Shape { layer, steps_m: [layer.top_km, TROPOPAUSE_KM, TOP_KM].map(|km| 1e3 * km) }
    }

    /// In which part a height lies: 0, 1 or 2, or 3 above them all.
    #[must_use]
    pub fn part(&self, height_m: f64) -> usize {
        self.steps_m.partition_point(|step| *step <= height_m)
    }
}

impl Absorber for Shape {
    fn per_m(&self, height_m: f64) -> f64 {
        match self.part(height_m) {
            0 => self.layer.thinning(1e-3 * height_m.max(0.0)),
            1 => (-1e-3 * height_m / FREE_SCALE_KM).exp(),
            2 => 1.0,
            _ => 0.0,
        }
    }

    fn knots_m(&self) -> &[f64] {
        &self.steps_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::aerosol::components::Humidity;

    #[test]
    fn parts_times_their_extinctions_are_the_column() {
        for climate in Climate::ALL {
            let column = climate.column(Humidity::HALF, 550.0, 0.1).unwrap();
            let (shape, parts) = (Shape::of(climate), column.parts_per_m());
            for height_m in [0.0, 900.0, 1999.0, 2000.0, 7000.0, 11_999.0, 12_000.0, 34_000.0, 36_000.0] {
                let part = shape.part(height_m);
                let ours = parts.get(part).map_or(0.0, |per_m| per_m * shape.per_m(height_m));
                assert!((ours - column.per_m(height_m)).abs() < 1e-12 * parts[0], "{climate} {height_m}");
            }
        }
    }

    /// The thesis' law, its eq. 4.3'.
    #[test]
    fn without_what_is_scattered_forward_each_part_takes_1_less_g_of_its_extinction() {
        let column = Climate::Urban.column(Humidity::HALF, 550.0, 0.1).unwrap();
        let less = column.less_forward();
        let expected = column.ground.extinction_per_km * (1.0 - column.ground.asymmetry);
        assert!((less.ground.extinction_per_km - expected).abs() < 1e-15);
        assert!(
            (1.0 - less.stratosphere.extinction_per_km / column.stratosphere.extinction_per_km
                - column.stratosphere.asymmetry)
                .abs()
                < 1e-12
        );
    }
}
