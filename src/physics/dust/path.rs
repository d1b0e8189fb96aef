//! The way of an eye through a scene: key frames with a smooth curve between them, or an orbit.

use std::f64::consts::TAU;

use glam::DVec3;

/// Most key frames of a path.
pub const MOST_KEYS: usize = 10_000;

/// Where an eye is at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stand {
    /// Its place.
    pub eye: DVec3,
    /// What is in the middle of its picture.
    pub look_at: DVec3,
    /// What is up in its picture, as near as can be.
    pub up: DVec3,
    /// Width of its view: the full angle in radians, or a length for an orthographic one.
    pub field: f64,
}

/// A key frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Key {
    /// When, in any unit.
    pub time: f64,
    /// Where.
    pub stand: Stand,
}

/// The line between key frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Curve {
    /// Through every key without a jerk: cubic, and the speed at a key is that of the parabola through it and its neighbours.
    #[default]
    Smooth,
    /// Straight from key to key.
    Straight,
}

/// A circle around a place, seen from outside: around the y axis, anticlockwise seen from +y, beginning on the +z side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orbit {
    /// What is looked at.
    pub centre: DVec3,
    /// Distance from it.
    pub radius: f64,
    /// Height of the eye over the plane of x and z, radians.
    pub elevation: f64,
    /// Where it begins, radians from +z towards +x.
    pub from: f64,
    /// How many turns; negative for the other way round.
    pub turns: f64,
    /// Width of the view, as of a [`Stand`].
    pub field: f64,
}

/// A path that leads nowhere.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PathError {
    /// None, or too many.
    #[error("{0} key frames: a path has 1 to 10000")]
    Keys(usize),
    /// Not later than the one before.
    #[error(
        "key {number} is at time {time}, which is not after the one before: give the keys in order, each with a later time"
    )]
    Time {
        /// Counted from 1.
        number: usize,
        /// Its time.
        time: f64,
    },
    /// Not a number, or the eye is where it looks to, or no view.
    #[error("key {number}: {what}")]
    Stand {
        /// Counted from 1.
        number: usize,
        /// What is wrong, and what to do.
        what: &'static str,
    },
    /// An orbit that is none.
    #[error("the orbit's {what} is {value}: {wanted}")]
    Orbit {
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it may be.
        wanted: &'static str,
    },
}

/// A path.
#[derive(Debug, Clone, PartialEq)]
pub enum Path {
    /// Key frames.
    Keys(Vec<Key>, Curve),
    /// A circle.
    Orbit(Orbit),
}

impl Path {
    /// A path through key frames.
    ///
    /// # Errors
    /// No keys, times that do not grow, or a stand that cannot be, with its number.
    pub fn through(keys: Vec<Key>, curve: Curve) -> Result<Path, PathError> {
        if !(1..=MOST_KEYS).contains(&keys.len()) {
            return Err(PathError::Keys(keys.len()));
        }
        let mut before = f64::NEG_INFINITY;
        for (Key { time, stand }, number) in keys.iter().zip(1..) {
            if !(time.is_finite() && *time > before) {
                return Err(PathError::Time { number, time: *time });
            }
            before = *time;
            let what = if !(stand.eye.is_finite() && stand.look_at.is_finite()) {
                "eye and look_at are three numbers each"
            } else if stand.eye == stand.look_at {
                "the eye is where it looks to: move one of them"
            } else if !(stand.up.is_finite() && stand.up != DVec3::ZERO) {
                "up is a direction: three numbers, not all 0"
            } else if !(stand.field.is_finite() && stand.field > 0.0) {
                "the view's width is a number above 0"
            } else {
                continue;
            };
            return Err(PathError::Stand { number, what });
        }
        Ok(Path::Keys(keys, curve))
    }

    /// A circle.
    ///
    /// # Errors
    /// A radius or an angle that is none.
    pub fn around(orbit: Orbit) -> Result<Path, PathError> {
        let wrong = |what, value, wanted| Err(PathError::Orbit { what, value, wanted });
        let quarter = TAU / 4.0;
        if !orbit.centre.is_finite() {
            wrong("centre", f64::NAN, "give three numbers")
        } else if !(orbit.radius.is_finite() && orbit.radius > 0.0) {
            wrong("radius", orbit.radius, "give a length above 0")
        } else if !(-quarter..=quarter).contains(&orbit.elevation) {
            wrong("elevation", orbit.elevation.to_degrees(), "give -90 to 90 degrees")
        } else if !(orbit.from.is_finite() && orbit.turns.is_finite()) {
            wrong("turn", orbit.turns, "give a number")
        } else if !(orbit.field.is_finite() && orbit.field > 0.0) {
            wrong("view", orbit.field, "give a width above 0")
        } else {
            Ok(Path::Orbit(orbit))
        }
    }

    /// Where the eye is at a share of the whole time, 0 to 1.
    #[must_use]
    pub fn at(&self, share: f64) -> Stand {
        let share = share.clamp(0.0, 1.0);
        match self {
            Path::Orbit(orbit) => orbit.at(share),
            Path::Keys(keys, curve) => between(keys, *curve, share),
        }
    }

    /// Where the eye is in each of so many frames, evenly in time. An orbit's last frame is one step before its first, so that it can
    /// be shown over and over; a path's last frame is its last key.
    #[must_use]
    pub fn frame(&self, number: usize, frames: usize) -> Stand {
        let steps = match self {
            Path::Orbit(_) => frames.max(1),
            Path::Keys(..) => (frames.max(2)) - 1,
        };
        self.at(number as f64 / steps as f64)
    }
}

impl Orbit {
    fn at(&self, share: f64) -> Stand {
        let (sine, cosine) = (self.from + share * self.turns * TAU).sin_cos();
        let (height, level) = self.elevation.sin_cos();
        let eye = self.centre + DVec3::new(level * sine, height, level * cosine) * self.radius;
        Stand { eye, look_at: self.centre, up: DVec3::Y, field: self.field }
    }
}

/// The numbers of a stand, that are interpolated one by one.
fn flat(stand: &Stand) -> [f64; 10] {
    let Stand { eye, look_at, up, field } = stand;
    [eye.x, eye.y, eye.z, look_at.x, look_at.y, look_at.z, up.x, up.y, up.z, *field]
}

/// Between key frames: Hermite's cubic.
///
/// ```text
/// v(s) = (2s^3 - 3s^2 + 1) v0 + (s^3 - 2s^2 + s) h m0 + (3s^2 - 2s^3) v1 + (s^3 - s^2) h m1
/// ```
///
/// with h the time between the keys and m the speeds at them.
fn between(keys: &[Key], curve: Curve, share: f64) -> Stand {
    let (first, last) = (keys[0], keys[keys.len() - 1]);
    let time = first.time + (last.time - first.time) * share;
    let after = keys.partition_point(|key| key.time <= time);
    if after == 0 || after == keys.len() {
        return if after == 0 { first.stand } else { last.stand };
    }
    let [a, b] = [after - 1, after];
    let (start, end) = (keys[a], keys[b]);
    let h = end.time - start.time;
    let s = (time - start.time) / h;
    let (v0, v1) = (flat(&start.stand), flat(&end.stand));
    let mut v = [0.0; 10];
    match curve {
        Curve::Straight => v.iter_mut().zip(v0).zip(v1).for_each(|((v, v0), v1)| *v = v0 + s * (v1 - v0)),
        Curve::Smooth => {
            let (m0, m1) = (speed(keys, a), speed(keys, b));
            let (s2, s3) = (s * s, s * s * s);
            for (i, v) in v.iter_mut().enumerate() {
                *v = (2.0 * s3 - 3.0 * s2 + 1.0) * v0[i]
                    + (s3 - 2.0 * s2 + s) * h * m0[i]
                    + (3.0 * s2 - 2.0 * s3) * v1[i]
                    + (s3 - s2) * h * m1[i];
            }
        }
    }
    let [x, y, z, lx, ly, lz, ux, uy, uz, field] = v;
    // A cubic may overshoot below 0: a view never does.
    let narrowest = start.stand.field.min(end.stand.field);
    Stand {
        eye: DVec3::new(x, y, z),
        look_at: DVec3::new(lx, ly, lz),
        up: DVec3::new(ux, uy, uz),
        field: field.clamp(narrowest, start.stand.field.max(end.stand.field)),
    }
}

/// The speed at a key: of the parabola through it and its neighbours; at the ends that of the straight line.
fn speed(keys: &[Key], at: usize) -> [f64; 10] {
    let slope = |a: usize| {
        let (start, end) = (flat(&keys[a].stand), flat(&keys[a + 1].stand));
        let h = keys[a + 1].time - keys[a].time;
        (std::array::from_fn::<f64, 10, _>(|i| (end[i] - start[i]) / h), h)
    };
    if at == 0 {
        return slope(0).0;
    }
    if at + 1 == keys.len() {
        return slope(at - 1).0;
    }
    let ((before, h0), (after, h1)) = (slope(at - 1), slope(at));
    std::array::from_fn(|i| (before[i] * h1 + after[i] * h0) / (h0 + h1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(time: f64, eye: DVec3) -> Key {
        Key { time, stand: Stand { eye, look_at: DVec3::new(0.0, 0.0, -9.0), up: DVec3::Y, field: 1.0 } }
    }

    #[test]
    fn a_path_passes_its_keys_and_ends_at_its_last() {
        let places = [DVec3::ZERO, DVec3::X, DVec3::new(2.0, 3.0, 0.0), DVec3::new(0.0, 0.0, 5.0)];
        let keys: Vec<_> = [0.0, 1.0, 4.0, 5.0].into_iter().zip(places).map(|(time, eye)| key(time, eye)).collect();
        for curve in [Curve::Smooth, Curve::Straight] {
            let path = Path::through(keys.clone(), curve).unwrap();
            for (share, place) in [0.0, 0.2, 0.8, 1.0].into_iter().zip(places) {
                assert!(path.at(share).eye.distance(place) < 1e-12, "{share}");
            }
            assert_eq!((path.frame(0, 6).eye, path.frame(5, 6).eye), (places[0], places[3]));
        }
    }

    #[test]
    fn evenly_spaced_keys_on_a_line_are_passed_at_one_speed_and_a_parabola_is_followed() {
        let line = (0..5u8).map(|i| key(f64::from(i), DVec3::X * f64::from(i))).collect();
        let line = Path::through(line, Curve::Smooth).unwrap();
        let parabola = (0..5u8).map(|i| key(f64::from(i), DVec3::Y * f64::from(i).powi(2))).collect();
        let parabola = Path::through(parabola, Curve::Smooth).unwrap();
        for step in 0..=40u8 {
            let share = f64::from(step) / 40.0;
            assert!((line.at(share).eye.x - 4.0 * share).abs() < 1e-12);
            if (0.25..=0.75).contains(&share) {
                assert!((parabola.at(share).eye.y - (4.0 * share).powi(2)).abs() < 1e-12, "{share}");
            }
        }
    }

    #[test]
    fn a_smooth_path_has_no_jerk_at_a_key_and_a_straight_one_has() {
        let keys = vec![key(0.0, DVec3::ZERO), key(1.0, DVec3::X), key(3.0, DVec3::new(1.0, 1.0, 0.0))];
        let turn = |curve| {
            let path = Path::through(keys.clone(), curve).unwrap();
            let e = 1e-5;
            let [a, b, c] = [1.0 / 3.0 - e, 1.0 / 3.0, 1.0 / 3.0 + e].map(|share| path.at(share).eye);
            (((c - b) - (b - a)) / e).length()
        };
        assert!(turn(Curve::Smooth) < 1e-3 && turn(Curve::Straight) > 1.0);
    }

    #[test]
    fn an_orbit_keeps_its_distance_and_closes() {
        let orbit = Orbit { centre: DVec3::X, radius: 3.0, elevation: 0.3, from: 0.0, turns: 1.0, field: 0.7 };
        let path = Path::around(orbit).unwrap();
        for number in 0..12 {
            assert!((path.frame(number, 12).eye.distance(DVec3::X) - 3.0).abs() < 1e-12);
        }
        let first = path.frame(0, 12).eye;
        assert!((first - DVec3::new(1.0, 3.0 * 0.3f64.sin(), 3.0 * 0.3f64.cos())).length() < 1e-12);
        assert!(path.frame(12, 12).eye.distance(first) < 1e-12 && path.frame(3, 12).eye.x > 3.8);
    }

    #[test]
    fn what_leads_nowhere_is_told_with_the_key_s_number() {
        let told = |keys| Path::through(keys, Curve::Smooth).unwrap_err().to_string();
        assert!(told(vec![]).contains("0 key frames"));
        assert!(told(vec![key(0.0, DVec3::ZERO), key(0.0, DVec3::X)]).contains("key 2 is at time 0"));
        assert!(told(vec![key(0.0, DVec3::new(0.0, 0.0, -9.0))]).contains("key 1: the eye is where it looks to"));
        assert!(told(vec![key(f64::NAN, DVec3::ZERO)]).contains("key 1"));
        let orbit = Orbit { centre: DVec3::ZERO, radius: 0.0, elevation: 0.0, from: 0.0, turns: 1.0, field: 1.0 };
        assert!(Path::around(orbit).unwrap_err().to_string().contains("radius is 0"));
    }
}
