//! The tube on its fork: two axes, azimuth and altitude, that take time to speed up and to stop. Degrees and seconds inside.

mod axis;

use std::time::Duration;

use self::axis::Axis;
use super::earth::{SIDEREAL_DEG_PER_S, SiderealClock, equatorial, horizontal, signed};
use super::settings::Settings;
use crate::sky::time::Utc;

/// One step of the axes while they move.
const STEP: Duration = Duration::from_millis(10);
/// The longest stretch of motion that is computed step by step; nothing moves for longer without an order.
const LONGEST: Duration = Duration::from_secs(3600);
/// A go-to has arrived when both axes are this near, degrees.
const ARRIVED_DEG: f64 = 0.3 / 3600.0;
/// The altitude axis meets its stops here.
const ALTITUDE_STOPS: (f64, f64) = (-10.0, 90.0);
/// Tracking rates are given as the frequency of a synchronous motor; this one is sidereal.
pub(super) const SIDEREAL_HZ: f64 = 60.164_274;

/// Directions of the arrow keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Arrow {
    North,
    South,
    East,
    West,
}

impl Arrow {
    /// From the letter of `:Mn#`.
    pub(super) fn of(letter: u8) -> Option<Arrow> {
        match letter {
            b'n' => Some(Arrow::North),
            b's' => Some(Arrow::South),
            b'e' => Some(Arrow::East),
            b'w' => Some(Arrow::West),
            _ => None,
        }
    }
}

/// Where a go-to goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Goal {
    /// Right ascension and declination, degrees.
    Sky(f64, f64),
    /// Azimuth and altitude, degrees.
    Ground(f64, f64),
}

#[derive(Debug, Clone, Copy)]
struct Held {
    speed: f64,
    until: Option<Duration>,
}

/// The tube. What it believes of the sky rests on its alignment: a sidereal clock and a latitude of its own, which setting
/// date, time or site afterwards does not touch.
#[derive(Debug)]
pub(super) struct Tube {
    azimuth: Axis,
    altitude: Axis,
    /// What a sync adds to the axes.
    sync: (f64, f64),
    tracking: bool,
    rate_hz: f64,
    /// What is followed while nothing moves: right ascension and declination in degrees.
    followed: Option<(f64, f64)>,
    held: [Option<Held>; 4],
    goal: Option<Goal>,
    /// The goal is the park position: tracking ends there.
    parking: bool,
    /// The goal is only to catch up with the sky.
    catching_up: bool,
    /// The axes move otherwise than with the sky.
    moving: bool,
    at: Duration,
    sidereal: SiderealClock,
    start: Utc,
    longitude_deg: f64,
    latitude_deg: f64,
    /// Added to sidereal time by `:SS`.
    pub(super) sidereal_shift_deg: f64,
    pub(super) fastest_deg_s: f64,
    acceleration: f64,
}

/// The next step after a time.
fn grid_after(at: Duration) -> Duration {
    let steps = at.as_nanos() / STEP.as_nanos() + 1;
    Duration::from_nanos(u64::try_from(steps * STEP.as_nanos()).unwrap_or(u64::MAX))
}

impl Tube {
    pub(super) fn new(settings: &Settings) -> Tube {
        let latitude_deg = settings.site.latitude.to_degrees();
        // Half up, on the side of the sky where the Sun never is.
        let azimuth = if latitude_deg >= 0.0 { 30.0 } else { 150.0 };
        let mut tube = Tube {
            azimuth: Axis::at(azimuth),
            altitude: Axis::at(45.0),
            sync: (0.0, 0.0),
            tracking: !settings.faults.not_tracking,
            rate_hz: SIDEREAL_HZ,
            followed: None,
            held: [None; 4],
            goal: None,
            parking: false,
            catching_up: false,
            moving: false,
            at: Duration::ZERO,
            sidereal: SiderealClock::at(settings.start),
            start: settings.start,
            longitude_deg: settings.site.longitude.to_degrees(),
            latitude_deg,
            sidereal_shift_deg: 0.0,
            fastest_deg_s: 8.0,
            acceleration: settings.acceleration_deg_s2,
        };
        tube.rest();
        tube
    }

    /// Sidereal time of the alignment, degrees.
    pub(super) fn sidereal_deg(&self, now: Duration) -> f64 {
        let utc = self.start.plus_seconds(now.as_secs_f64());
        self.sidereal.local_deg(utc, self.longitude_deg) + self.sidereal_shift_deg
    }

    /// Right ascension and declination of an azimuth and an altitude, degrees.
    pub(super) fn sky_of(&self, (azimuth, altitude): (f64, f64), now: Duration) -> (f64, f64) {
        let (hour_angle, dec) = equatorial(azimuth, altitude, self.latitude_deg);
        ((self.sidereal_deg(now) - hour_angle).rem_euclid(360.0), dec)
    }

    /// Azimuth and altitude of a right ascension and a declination, degrees.
    pub(super) fn ground_of(&self, (ra, dec): (f64, f64), now: Duration) -> (f64, f64) {
        horizontal(self.sidereal_deg(now) - ra, dec, self.latitude_deg)
    }

    /// Azimuth and altitude of the axes.
    pub(super) fn encoders(&self) -> (f64, f64) {
        (self.azimuth.position, self.altitude.position)
    }

    /// Right ascension and declination that the mount believes, degrees.
    pub(super) fn believed(&self, now: Duration) -> (f64, f64) {
        let (azimuth, altitude) = self.encoders();
        self.sky_of((azimuth + self.sync.0, altitude + self.sync.1), if self.moving { self.at } else { now })
    }

    pub(super) fn speeds(&self) -> (f64, f64) {
        (self.azimuth.speed, self.altitude.speed)
    }

    pub(super) fn slewing(&self) -> bool {
        self.goal.is_some() && !self.catching_up
    }

    /// Whether anything moves otherwise than with the sky.
    pub(super) fn moving(&self) -> bool {
        self.moving
    }

    pub(super) fn tracking(&self) -> bool {
        self.tracking
    }

    /// Tracking on or off; what moves goes on moving.
    pub(super) fn set_tracking(&mut self, on: bool) {
        self.tracking = on;
        if !self.moving {
            self.rest();
        }
    }

    /// Goes to the park position and stands there.
    pub(super) fn park(&mut self) {
        self.set_tracking(false);
        self.go(Goal::Ground(0.0, 0.0));
        self.parking = true;
    }

    pub(super) fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    pub(super) fn set_rate_hz(&mut self, hertz: f64) {
        self.rate_hz = hertz;
    }

    pub(super) fn go(&mut self, goal: Goal) {
        self.held = [None; 4];
        self.goal = Some(goal);
        self.parking = false;
        self.catching_up = false;
        self.moving = true;
    }

    /// Presses an arrow; it stays pressed until it is let go, or for a time. A go-to ends by it.
    pub(super) fn press(&mut self, arrow: Arrow, speed: f64, until: Option<Duration>) {
        self.goal = None;
        self.held[arrow as usize] = Some(Held { speed: speed.min(self.fastest_deg_s), until });
        self.moving = true;
    }

    /// Lets an arrow go; a go-to ends by it too.
    pub(super) fn let_go(&mut self, arrow: Arrow) {
        self.goal = None;
        self.held[arrow as usize] = None;
    }

    /// Everything that moves slows down and stops.
    pub(super) fn stop(&mut self) {
        self.held = [None; 4];
        self.goal = None;
    }

    /// From here on the mount believes that it points at this.
    pub(super) fn sync(&mut self, ra: f64, dec: f64) {
        let (azimuth, altitude) = self.ground_of((ra, dec), self.at);
        self.sync = (signed(azimuth - self.azimuth.position), altitude - self.altitude.position);
        if !self.moving {
            self.rest();
        }
    }

    /// Brings the axes up to `now`. While they move, that is the last step before it: steps stand on a grid of their own, so
    /// that a run does not depend on how often it is looked at.
    pub(super) fn advance(&mut self, now: Duration) {
        self.at = self.at.max(now.saturating_sub(LONGEST));
        while self.at < now {
            if self.moving {
                let next = grid_after(self.at);
                if next > now {
                    return;
                }
                let step = next - self.at;
                self.at = next;
                self.step(step.as_secs_f64());
            } else {
                let passed = now - self.at;
                self.at = now;
                self.follow(passed.as_secs_f64());
            }
        }
    }

    /// Nothing moves but with the sky.
    fn rest(&mut self) {
        self.moving = false;
        self.followed = self.tracking.then(|| self.believed(self.at));
        let (azimuth, altitude) = self.sky_speeds();
        (self.azimuth.speed, self.altitude.speed) = (azimuth, altitude);
    }

    /// Follows the sky; where the axes cannot (through the zenith), they catch up at their best.
    fn follow(&mut self, passed_s: f64) {
        let Some((ra, dec)) = self.followed else {
            return;
        };
        let ra = (ra + self.rate_drift_deg_s() * passed_s).rem_euclid(360.0);
        self.followed = Some((ra, dec));
        let (azimuth, altitude) = self.ground_of((ra, dec), self.at);
        let off =
            (signed(azimuth - self.sync.0 - self.azimuth.position), altitude - self.sync.1 - self.altitude.position);
        let reach = self.fastest_deg_s * passed_s;
        if off.0.abs() > reach || off.1.abs() > reach {
            self.goal = Some(Goal::Sky(ra, dec));
            self.catching_up = true;
            self.moving = true;
            return;
        }
        self.azimuth.position += off.0;
        self.altitude.position += off.1;
        (self.azimuth.speed, self.altitude.speed) = self.sky_speeds();
    }

    /// How fast right ascension grows because the rate is not sidereal.
    fn rate_drift_deg_s(&self) -> f64 {
        SIDEREAL_DEG_PER_S * (1.0 - self.rate_hz / SIDEREAL_HZ)
    }

    /// Speeds of the axes that follow the sky here; nothing when tracking is off.
    fn sky_speeds(&self) -> (f64, f64) {
        if !self.tracking {
            return (0.0, 0.0);
        }
        let second = Duration::from_secs(1);
        let sky = self.believed(self.at);
        let (here, there) = (self.ground_of(sky, self.at), self.ground_of(sky, self.at + second));
        let held = |speed: f64| speed.clamp(-self.fastest_deg_s, self.fastest_deg_s);
        (held(signed(there.0 - here.0)), held(there.1 - here.1))
    }

    /// Degrees a second that the arrows ask of azimuth and altitude. East is where the Sun rises for somebody who faces the
    /// meridian: azimuth shrinks in the northern hemisphere and grows in the southern.
    fn arrow_speeds(&mut self) -> (f64, f64) {
        for held in &mut self.held {
            if held.is_some_and(|held| held.until.is_some_and(|until| until <= self.at)) {
                *held = None;
            }
        }
        let speed = |arrow: Arrow| self.held[arrow as usize].map_or(0.0, |held| held.speed);
        let east = speed(Arrow::East) - speed(Arrow::West);
        let azimuth = if self.latitude_deg >= 0.0 { -east } else { east };
        (azimuth, speed(Arrow::North) - speed(Arrow::South))
    }

    fn step(&mut self, dt: f64) {
        let sky = self.sky_speeds();
        let arrows = self.arrow_speeds();
        let limits = axis::Limits { fastest: self.fastest_deg_s, acceleration: self.acceleration };
        let near = match self.goal {
            Some(goal) => {
                let (azimuth, altitude) = match goal {
                    Goal::Sky(ra, dec) => self.ground_of((ra, dec), self.at),
                    Goal::Ground(azimuth, altitude) => (azimuth, altitude),
                };
                let off_az = signed(azimuth - self.sync.0 - self.azimuth.position);
                let off_alt = altitude - self.sync.1 - self.altitude.position;
                self.azimuth.approach(off_az, sky.0, limits, dt);
                self.altitude.approach(off_alt, sky.1, limits, dt);
                off_az.abs() < ARRIVED_DEG && off_alt.abs() < ARRIVED_DEG
            }
            None => {
                self.azimuth.turn(sky.0 + arrows.0, limits, dt);
                self.altitude.turn(sky.1 + arrows.1, limits, dt);
                arrows == (0.0, 0.0) && self.held.iter().all(Option::is_none)
            }
        };
        let (low, high) = ALTITUDE_STOPS;
        self.altitude.stop_at((low - self.sync.1, high - self.sync.1));
        let still = |speed: f64, sky: f64| (speed - sky).abs() <= limits.acceleration * dt.max(0.001);
        if near && still(self.azimuth.speed, sky.0) && still(self.altitude.speed, sky.1) {
            if self.goal.take().is_some() && self.parking {
                self.tracking = false;
            }
            self.rest();
        }
    }
}
