//! Whether the machine slept between two looks at its clocks. Then nothing that was believed is still known, and the
//! projector must be dark.

use std::time::Duration;

/// Three clocks read together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clocks {
    /// Time since 1970, as set by people and network: it may jump.
    pub wall: Duration,
    /// Runs evenly while the machine is awake (`CLOCK_MONOTONIC`).
    pub awake: Duration,
    /// Runs evenly, asleep or awake (`CLOCK_BOOTTIME`), where the system has it.
    pub always: Option<Duration>,
}

/// What happened between two looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Gap {
    /// Time went on as it should.
    Nothing,
    /// The machine was asleep so long. Everything believed of the mount is unknown from here on.
    Suspended {
        /// How long it slept.
        slept: Duration,
    },
    /// Somebody set the wall clock; the machine was awake. Seconds, positive forward.
    ClockSet {
        /// How far it was set.
        by_s: f64,
    },
}

/// Shorter differences are the time between reading one clock and the next, or a clock being slewed by the network.
const NOTICED: Duration = Duration::from_secs(1);

/// Compares two looks, `before` and `now`.
///
/// With `CLOCK_BOOTTIME` a sleep is its gain over `CLOCK_MONOTONIC`, and any other jump of the wall clock is a clock set.
/// Without it a forward jump of the wall clock cannot be told from a sleep and is taken for one: forgetting too much is safe.
#[must_use]
pub fn between(before: &Clocks, now: &Clocks) -> Gap {
    let awake = now.awake.saturating_sub(before.awake);
    let wall_gain_s = now.wall.as_secs_f64() - before.wall.as_secs_f64() - awake.as_secs_f64();
    match (before.always, now.always) {
        (Some(earlier), Some(later)) => {
            let slept = later.saturating_sub(earlier).saturating_sub(awake);
            let by_s = wall_gain_s - slept.as_secs_f64();
            if slept >= NOTICED {
                Gap::Suspended { slept }
            } else if by_s.abs() >= NOTICED.as_secs_f64() {
                Gap::ClockSet { by_s }
            } else {
                Gap::Nothing
            }
        }
        _ if wall_gain_s >= NOTICED.as_secs_f64() => Gap::Suspended { slept: Duration::from_secs_f64(wall_gain_s) },
        _ if wall_gain_s <= -NOTICED.as_secs_f64() => Gap::ClockSet { by_s: wall_gain_s },
        _ => Gap::Nothing,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clocks(wall: f64, awake: f64, always: Option<f64>) -> Clocks {
        let s = Duration::from_secs_f64;
        Clocks { wall: s(wall), awake: s(awake), always: always.map(s) }
    }

    #[test]
    fn an_ordinary_second_is_nothing() {
        assert_eq!(between(&clocks(1e9, 5.0, Some(7.0)), &clocks(1e9 + 1.0, 6.0, Some(8.0))), Gap::Nothing);
    }

    #[test]
    fn a_closed_lid_is_a_sleep_of_its_length() {
        let gap = between(&clocks(1e9, 5.0, Some(7.0)), &clocks(1e9 + 601.0, 6.0, Some(608.0)));
        assert_eq!(gap, Gap::Suspended { slept: Duration::from_secs(600) });
    }

    #[test]
    fn a_wall_clock_that_jumps_while_awake_is_no_sleep() {
        let forward = between(&clocks(1e9, 5.0, Some(7.0)), &clocks(1e9 + 3601.0, 6.0, Some(8.0)));
        assert_eq!(forward, Gap::ClockSet { by_s: 3600.0 });
        let back = between(&clocks(1e9, 5.0, Some(7.0)), &clocks(1e9 - 3599.0, 6.0, Some(8.0)));
        assert_eq!(back, Gap::ClockSet { by_s: -3600.0 });
    }

    #[test]
    fn a_sleep_and_a_set_clock_together_are_a_sleep() {
        let gap = between(&clocks(1e9, 5.0, Some(7.0)), &clocks(1e9 - 100.0, 6.0, Some(108.0)));
        assert_eq!(gap, Gap::Suspended { slept: Duration::from_secs(100) });
    }

    #[test]
    fn without_a_boot_clock_a_forward_jump_is_taken_for_a_sleep() {
        let gap = between(&clocks(1e9, 5.0, None), &clocks(1e9 + 61.0, 6.0, None));
        assert_eq!(gap, Gap::Suspended { slept: Duration::from_secs(60) });
    }
}
