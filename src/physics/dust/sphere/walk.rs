//! One photon's way through a sphere of even dust, lengths in mean free paths (thesis, appendix A).

use glam::DVec3;

use super::{Source, Sphere};
use crate::numerics::streams::Stream;

/// What became of a photon of weight 1: `escaped + absorbed + unfinished` is 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Fate {
    /// How often it met a grain.
    pub scatterings: u64,
    /// Weight that left the sphere.
    pub escaped: f64,
    /// Weight that the dust took, or that was too little to be followed.
    pub absorbed: f64,
    /// Weight that was still under way after the most scatterings allowed.
    pub unfinished: f64,
    /// Cosine between the first direction and the last.
    pub cosine: f64,
}

/// How photons are followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rules {
    /// Weight at which a photon is given up and counts as absorbed.
    pub threshold: f64,
    /// Scatterings after which a photon is given up and counts as unfinished.
    pub most_scatterings: u64,
}

/// A point of the unit circle, by rejection: no sine, no cosine.
#[inline]
pub(crate) fn azimuth(stream: &mut Stream) -> (f64, f64) {
    loop {
        let (x, y) = (2.0 * stream.uniform() - 1.0, 2.0 * stream.uniform() - 1.0);
        let square = x * x + y * y;
        if square <= 1.0 && square > 1e-12 {
            // The angle doubled: as even as the angle itself, and without a root.
            let over = 1.0 / square;
            return ((x * x - y * y) * over, 2.0 * x * y * over);
        }
    }
}

/// A direction turned aside by an angle of this cosine and sine, about an azimuth.
///
/// The thesis' two cases (along z or not) leave a gap of digits between them; the basis of Duff et al. (2017) has none.
#[inline]
pub(crate) fn turned(d: DVec3, (cosine, sine): (f64, f64), (x, y): (f64, f64)) -> DVec3 {
    let sign = 1f64.copysign(d.z);
    let a = -1.0 / (sign + d.z);
    let b = d.x * d.y * a;
    let right = DVec3::new(1.0 + sign * d.x * d.x * a, sign * b, -sign * d.x);
    let up = DVec3::new(b, sign + d.y * d.y * a, -d.y);
    right * (sine * x) + up * (sine * y) + d * cosine
}

/// Where a photon begins, and its direction, in a sphere of this radius.
#[inline]
pub(crate) fn launched(source: Source, radius: f64, stream: &mut Stream) -> (DVec3, DVec3) {
    match source {
        Source::Pencil => (DVec3::new(0.0, 0.0, -radius), DVec3::Z),
        Source::Beam => {
            // Over the disc b^2 is even; about the axis all azimuths are alike.
            let square = stream.uniform();
            (DVec3::new(square.sqrt(), 0.0, -(1.0 - square).sqrt()) * radius, DVec3::Z)
        }
        Source::Centre => (DVec3::ZERO, DVec3::Z),
        Source::Uniform => {
            // Directions are alike, so that the first may be z, and the azimuth of the place about it anything.
            let (r, cosine) = (radius * stream.uniform().cbrt(), 2.0 * stream.uniform() - 1.0);
            (DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine) * r, DVec3::Z)
        }
    }
}

/// Follows one photon.
#[inline]
pub(crate) fn follow(sphere: &Sphere, rules: &Rules, stream: &mut Stream) -> Fate {
    let square = sphere.depth * sphere.depth;
    let (mut place, mut direction) = launched(sphere.source, sphere.depth, stream);
    let first = direction;
    let mut fate = Fate::default();
    let mut weight = 1.0;
    loop {
        place += direction * -(1.0 - stream.uniform()).ln();
        if place.length_squared() > square {
            fate.escaped = weight;
            fate.cosine = first.dot(direction).clamp(-1.0, 1.0);
            return fate;
        }
        fate.scatterings += 1;
        fate.absorbed += weight * (1.0 - sphere.albedo);
        weight *= sphere.albedo;
        if weight < rules.threshold {
            fate.absorbed += weight;
            return fate;
        }
        if fate.scatterings >= rules.most_scatterings {
            fate.unfinished = weight;
            return fate;
        }
        direction = turned(direction, sphere.phase.turn(stream.uniform()), azimuth(stream));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_is_turned_by_the_angle_it_is_told_wherever_it_points() {
        let mut stream = Stream::seeded(3);
        for i in 0..2000 {
            let z = if i % 10 == 0 {
                DVec3::Z
            } else if i % 10 == 1 {
                -DVec3::Z
            } else {
                DVec3::Y
            };
            let before = turned(z, (0.3, (1f64 - 0.09).sqrt()), azimuth(&mut stream));
            let cosine = 2.0 * stream.uniform() - 1.0;
            let after = turned(before, (cosine, (1.0 - cosine * cosine).sqrt()), azimuth(&mut stream));
            assert!((after.length() - 1.0).abs() < 1e-14);
            assert!((after.dot(before) - cosine).abs() < 1e-14);
        }
    }

    #[test]
    fn every_photon_is_accounted_for() {
        let mut stream = Stream::seeded(9);
        let rules = Rules { threshold: 1e-10, most_scatterings: 10_000 };
        for (depth, albedo, g) in [(1e-6, 0.6, 0.6), (2.0, 1.0, -0.999_999), (10.0, 0.0, 0.0), (300.0, 0.99, 0.9)] {
            let sphere = Sphere::new(depth, albedo, g, Source::Uniform).unwrap();
            for _ in 0..500 {
                let fate = follow(&sphere, &rules, &mut stream);
                assert!((fate.escaped + fate.absorbed + fate.unfinished - 1.0).abs() < 1e-13, "{fate:?}");
            }
        }
    }
}
