//! One short night by its seed: what goes wrong with the cable and the mount, what the observer orders, when he stops it.

use std::time::Duration;

use scotopic::hw::fault_line::{Cable, Mischief, Side, Spell, When};
use scotopic::hw::mount::command::Question;
use scotopic::hw::mount::order::{Direction, Key, Order, Rate};
use scotopic::hw::mount::sim::settings::Settings;
use scotopic::numerics::streams::Stream;
use scotopic::sky::coords::Equatorial;
use scotopic::units::Angle;

use super::bench::Bench;

/// All is calm again by then.
const CALM: f64 = 9.0;
/// A night in which the mount has not been brought back so long after all is calm has failed.
const DEADLINE: Duration = Duration::from_secs(30);

/// What happens in a night.
#[derive(Debug, Clone)]
pub(crate) struct Night {
    pub(crate) seed: u64,
    pub(crate) spells: Vec<Spell>,
    /// What the mount itself does wrong, as `scotopic simulate mount --fault` takes it.
    pub(crate) mount: Vec<String>,
    orders: Vec<(Duration, Order)>,
    /// When the clock leaps, and by how much.
    leap: Option<(Duration, Duration)>,
}

/// What a night is drawn with.
struct Dice(Stream);

impl Dice {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.uniform()
    }

    fn time(&mut self, low_s: f64, high_s: f64) -> Duration {
        Duration::from_secs_f64(self.between(low_s, high_s))
    }

    fn below(&mut self, count: usize) -> usize {
        ((self.0.uniform() * count as f64) as usize).min(count - 1)
    }

    fn one<T: Clone>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())].clone()
    }

    fn mischief(&mut self) -> Mischief {
        let chance = self.between(0.005, 0.15);
        match self.below(22) {
            0 => Mischief::Drop(chance),
            1 => Mischief::Duplicate(chance),
            2 => Mischief::Flip(chance / 3.0),
            3 => Mischief::Insert(chance),
            4 => Mischief::Truncate(self.below(10)),
            5 => Mischief::Stall(self.below(10), self.time(0.01, 3.0)),
            6 => Mischief::Delay(self.one(&[0, 50, 500, 6000].map(Duration::from_millis))),
            7 => Mischief::Swap(chance * 3.0),
            8 => Mischief::Glue(chance * 3.0),
            9 => Mischief::Unasked(chance * 3.0),
            10 => Mischief::Flood(1_000_000),
            11 => Mischief::WrongBaud,
            12 => Mischief::Echo,
            13 => Mischief::Break,
            14 => Mischief::Unplug,
            15 => Mischief::Rename,
            16 => Mischief::Forbid,
            17 => Mischief::Hold,
            18 => Mischief::Reset,
            19 => Mischief::Slow(self.one(&[0, 5, 50, 300])),
            20 => Mischief::MidPacket(self.below(20)),
            _ => Mischief::Crosstalk(chance),
        }
    }

    fn spell(&mut self) -> Spell {
        let mischief = self.mischief();
        let (from, lasts) = (self.time(0.0, 5.0), self.time(0.2, 4.0));
        let side = self.one(&[Side::Replies, Side::Replies, Side::Commands, Side::Both]);
        let when = if mischief.takes_the_port() {
            match self.below(6) {
                0 => When::Sent(from, b":GR".to_vec()),
                1 => When::Sent(from, b":MS".to_vec()),
                2 => When::Sent(from, b"#:Q".to_vec()),
                3 => When::Read(from, 1 + self.below(8)),
                _ => When::At(from),
            }
        } else {
            When::At(from)
        };
        Spell { when, lasts, mischief, side }
    }

    /// What the mount does wrong by itself.
    fn mount(&mut self) -> String {
        let at = self.between(1.0, 6.0);
        match self.below(12) {
            0 => "ignore-stop=3".into(),
            1 => format!("frozen={at:.1}"),
            2 => format!("format-switch={at:.1}"),
            3 => format!("clock-jump={at:.1},{:.0}", self.between(-4000.0, 4000.0)),
            4 => format!("keypad={at:.1},{},1", self.one(&['n', 's', 'e', 'w'])),
            5 => format!("push={at:.1},3,-2"),
            6 => "late-bar=3".into(),
            7 => "nak=0.2".into(),
            8 => "short=on".into(),
            9 => "degree=star".into(),
            10 => "jump=0.05".into(),
            _ => "stale=on".into(),
        }
    }

    fn order(&mut self) -> Order {
        let place = Equatorial::new(Angle::hours(self.between(0.0, 24.0)), Angle::degrees(self.between(55.0, 85.0)));
        match self.below(9) {
            0..=3 => Order::Goto(place),
            4 => Order::Move(self.one(&Direction::ALL), self.one(&[Rate::Guide, Rate::Centre, Rate::Find, Rate::Slew])),
            5 => Order::Sync(place),
            6 => Order::Compare,
            7 => self.one(&[Order::ReadDisplay, Order::PressKey(Key::Help)]),
            _ => Order::Ask(Question::new("GT").unwrap()),
        }
    }
}

impl Night {
    /// The night of a seed: one to three things wrong with the cable, perhaps one with the mount, one or two orders, a stop.
    pub(crate) fn of(seed: u64) -> Night {
        let mut dice = Dice(Stream::seeded(seed));
        let spells = (0..=dice.below(3)).map(|_| dice.spell()).collect();
        let mount = if dice.below(3) == 0 { vec![dice.mount()] } else { Vec::new() };
        let mut orders: Vec<(Duration, Order)> =
            (0..=dice.below(2)).map(|_| (dice.time(1.0, 5.0), dice.order())).collect();
        orders.push((dice.time(1.5, 8.0), Order::Stop));
        orders.sort_by_key(|(at, _)| *at);
        let leap = (dice.below(20) == 0).then(|| (dice.time(1.0, 7.0), dice.time(5.0, 3600.0)));
        Night { seed, spells, mount, orders, leap }
    }

    pub(crate) fn settings(&self) -> Settings {
        let mut settings = Settings { seed: self.seed, ..Settings::default() };
        for fault in &self.mount {
            settings.faults.switch(fault).unwrap();
        }
        settings
    }

    /// The same night for a clock that cannot leap.
    pub(crate) fn without_leap(self) -> Night {
        Night { leap: None, ..self }
    }

    pub(crate) fn cable(&self) -> Cable {
        Cable::new(self.seed, None, self.spells.clone())
    }

    /// Plays the night on a bench; `clock` says what time the next turn has, leaps of the clock left
    /// out. What broke, if anything.
    pub(crate) fn play(&self, bench: &mut Bench, mut clock: impl FnMut(&Bench) -> Duration) -> Vec<String> {
        let calm = Duration::from_secs_f64(CALM);
        let mut orders = self.orders.iter().peekable();
        let mut leap = self.leap;
        loop {
            let mut now = clock(bench) + bench.leapt;
            if let Some((at, by)) = leap
                && now >= at
            {
                (leap, now) = (None, now + by);
                bench.leap(by);
                bench.turn(now);
                bench.forget();
            }
            bench.turn(now);
            let (leapt, since) = (bench.leapt, now - bench.leapt);
            while let Some((at, order)) = orders.next_if(|(at, _)| *at <= since) {
                bench.order(order.clone(), *at + leapt);
            }
            if since < calm {
                continue;
            }
            bench.cable.relent();
            let over = bench.cable.calm_from().unwrap_or_default().max(calm + leapt);
            if bench.well() && now > over + Duration::from_millis(500) {
                break;
            }
            if now > over + DEADLINE && bench.switched_off() {
                // One flipped bit makes EOT of ACK, or another command that only the power switch undoes. It must be said.
                if bench.belief().pointing(now).is_some_and(|pointing| !pointing.stale) {
                    bench.truth.breaks(now, "a mount that answers nothing is shown as live");
                }
                bench.truth.switched_off = true;
                break;
            }
            if now > over + DEADLINE {
                let last: Vec<String> =
                    bench.reports.iter().rev().take(12).map(|(at, r)| format!("{:.2} {r}", at.as_secs_f64())).collect();
                let belief = bench.belief();
                let (link, stopping) = (belief.link, belief.stopping);
                let what = format!(
                    "not well again {} s after all was calm: {link:?}, stopping {stopping}; {last:#?}",
                    DEADLINE.as_secs()
                );
                bench.truth.breaks(now, what);
                break;
            }
        }
        bench.judge_stops();
        std::mem::take(&mut bench.truth.broken)
    }
}

/// A virtual clock: five milliseconds while something is on the line, twenty while nothing is.
pub(crate) fn virtual_clock(bench: &Bench) -> Duration {
    let now = bench.now;
    let far = bench.mount.look(|simulator| simulator.wake_at()).unwrap_or(Duration::MAX);
    let next = bench.pump.wake_at().min(far);
    now - bench.leapt + next.saturating_sub(now).clamp(Duration::from_millis(5), Duration::from_millis(20))
}
