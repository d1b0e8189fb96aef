//! One axis: an angle, a speed, and what its motor can do.

/// One axis, degrees and degrees a second.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axis {
    pub(super) position: f64,
    pub(super) speed: f64,
}

/// What the motor can do.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    pub(super) fastest: f64,
    pub(super) acceleration: f64,
}

impl Axis {
    pub(super) fn at(position: f64) -> Axis {
        Axis { position, speed: 0.0 }
    }

    /// Turns towards a wanted speed.
    pub(super) fn turn(&mut self, wanted: f64, limits: Limits, dt: f64) {
        let wanted = wanted.clamp(-limits.fastest, limits.fastest);
        let change = limits.acceleration * dt;
        let before = self.speed;
        self.speed += (wanted - self.speed).clamp(-change, change);
        self.position += (before + self.speed) / 2.0 * dt;
    }

    /// Turns towards a place that is `off` degrees away and itself moves at `carried`: as fast as it can still brake.
    ///
    /// ```text
    /// v = sqrt(2 a |off|), and in the last step off / dt
    /// ```
    pub(super) fn approach(&mut self, off: f64, carried: f64, limits: Limits, dt: f64) {
        let braking = (1.8 * limits.acceleration * off.abs()).sqrt();
        let last = off.abs() / dt.max(1e-3) / 2.0;
        self.turn(carried + off.signum() * braking.min(last), limits, dt);
    }

    /// A mechanical stop takes all speed.
    pub(super) fn stop_at(&mut self, (low, high): (f64, f64)) {
        if self.position < low || self.position > high {
            self.position = self.position.clamp(low, high);
            self.speed = 0.0;
        }
    }
}
