//! A simulated LX200GPS: bytes in, bytes out, a clock handed in. It has its own reading and writing of bytes and shares
//! nothing with the driver but the facts of the protocol.
//!
//! ```text
//! bytes -> wire (9600 baud) -> framing (`:`...`#`) -> controller (the firmware) -> reply -> wire, with its faults -> bytes
//!                                                      |
//!                                                      tube (two axes that take time to move) -> where it really points
//! ```
//!
//! It starts aligned, awake, tracking and above the horizon. What the sky sees (`Simulator::true_axis`) and what the mount
//! says (`Simulator::reported`) differ by the pointing error, the periodic error, the drift and a push of the tube:
//! these move the true axis and never the reported position.

mod angles;
mod answer;
mod controller;
mod earth;
/// The faults that can be switched on, by name.
pub mod fault;
mod framing;
mod handset;
mod pointing;
/// The simulator as a port inside the program.
pub mod port;
/// The simulator behind a real port.
pub mod serve;
/// What the simulator is to be: site, time, seed, errors, faults.
pub mod settings;
mod tube;
mod wire;

use std::collections::VecDeque;
use std::time::Duration;

use self::controller::Controller;
use self::framing::{Framing, Heard};
use self::pointing::PointingError;
use self::settings::Settings;
use self::wire::Wire;
use crate::sky::coords::{Equatorial, OfDate};

/// The simulated mount. `now` is the time since the program started; [`Settings::start`] is the UTC of `now` = 0.
#[derive(Debug)]
pub struct Simulator {
    wire: Wire,
    framing: Framing,
    controller: Controller,
    error: PointingError,
    told: VecDeque<Told>,
}

/// What the mount has said to a command, before any fault of the line: the truth that a driver is held against.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Told {
    /// When the command was heard.
    pub at: Duration,
    /// The letters between `:` and `#`.
    pub command: Vec<u8>,
    /// The reply, all its parts.
    pub reply: Vec<u8>,
}

/// So many replies are remembered.
const TOLD: usize = 256;

impl Simulator {
    /// A mount that stands as the settings say.
    #[must_use]
    pub fn new(settings: Settings) -> Simulator {
        Simulator {
            wire: Wire::new(&settings),
            framing: Framing::default(),
            error: PointingError::new(&settings),
            controller: Controller::new(settings),
            told: VecDeque::new(),
        }
    }

    /// How many more bytes [`Simulator::feed`] takes before it loses some: the rest should wait in the sender's buffer.
    #[must_use]
    pub fn room(&self) -> usize {
        self.wire.room()
    }

    /// Bytes from the computer, all handed over at `now`; the mount hears them one after the other at 9600 baud.
    pub fn feed(&mut self, bytes: &[u8], now: Duration) {
        self.wire.arrive(bytes, now);
    }

    /// Brings everything up to `now`: bytes are heard, commands obeyed, axes moved, each at its own time, so that it does not
    /// matter how often this is called.
    pub fn tick(&mut self, now: Duration) {
        while let Some(at) = self.next_event().filter(|at| *at <= now) {
            self.controller.advance(at);
            self.wire.happen(at);
            for answer in self.controller.unasked() {
                self.wire.reply(answer, at);
            }
            if let Some(byte) = self.wire.hear(at) {
                self.hear(byte, at);
            }
        }
        self.controller.advance(now);
    }

    /// The next time when something happens by itself, or a byte on its way has been heard.
    fn next_event(&self) -> Option<Duration> {
        [self.wire.heard_at(), self.wire.next_event(), self.controller.next_event()].into_iter().flatten().min()
    }

    /// One byte that the mount has heard.
    fn hear(&mut self, byte: u8, at: Duration) {
        let answer = match self.framing.push(byte) {
            Heard::Nothing => return,
            _ if self.wire.busy(at) => return,
            Heard::Control(byte) => self.controller.control(byte),
            Heard::Command(body) => {
                self.wire.command_heard(&body, at);
                let answer = self.controller.obey(&body, at);
                if self.told.len() == TOLD {
                    self.told.pop_front();
                }
                let reply = answer.parts.iter().flat_map(|(_, bytes)| bytes.clone()).collect();
                self.told.push_back(Told { at, command: body, reply });
                answer
            }
        };
        self.wire.reply(answer, at);
    }

    /// The bytes whose last bit has reached the computer by `now`.
    pub fn drain(&mut self, now: Duration) -> Vec<u8> {
        self.tick(now);
        self.wire.sent(now)
    }

    /// When something will happen next without new bytes; `None` if only new bytes can change anything on the line.
    #[must_use]
    pub fn wake_at(&self) -> Option<Duration> {
        [self.next_event(), self.wire.first_to_send()].into_iter().flatten().min()
    }

    /// A client has opened the port: what it finds waiting (nothing, unless the fault `stale` is on).
    pub fn client_came(&mut self, now: Duration) {
        self.tick(now);
        self.wire.client_came(now);
    }

    /// The client has closed the port: what was still to be sent to it is lost.
    pub fn client_left(&mut self, now: Duration) {
        self.tick(now);
        self.wire.client_left();
    }

    /// Whether the cable is in: `false` while the fault `unplug` has it out.
    #[must_use]
    pub fn plugged(&self, now: Duration) -> bool {
        self.wire.plugged(now)
    }

    /// Where the optical axis really points.
    pub fn true_axis(&mut self, now: Duration) -> Equatorial<OfDate> {
        self.tick(now);
        self.controller.sky_of(self.error.apply(self.controller.encoders(), now), now)
    }

    /// Where the mount believes it points, before it rounds to whole seconds for a reply.
    pub fn reported(&mut self, now: Duration) -> Equatorial<OfDate> {
        self.tick(now);
        self.controller.reported(now)
    }

    /// Whether it answers commands at all: it is neither asleep, nor starting, nor in its firmware loader.
    #[must_use]
    pub fn answers(&self) -> bool {
        self.controller.answers()
    }

    /// The last replies, oldest first.
    pub fn told(&self) -> impl DoubleEndedIterator<Item = &Told> + Clone {
        self.told.iter()
    }

    /// Speeds of the azimuth and the altitude axis in degrees a second.
    pub fn axis_speeds_deg_s(&mut self, now: Duration) -> (f64, f64) {
        self.tick(now);
        self.controller.axis_speeds()
    }
}

#[cfg(test)]
mod tests;
