//! A USB or Bluetooth presenter, a gamepad or a small keyboard instead of a tapped cable: the same keys, debounced the same way.

/// What each button stands for.
pub mod names;

use std::os::fd::AsFd;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use evdev::Device;
use rustix::event::{PollFd, PollFlags, Timespec, poll};

use super::Heard;
use super::presses::Presses;
use super::tap::TapSaid;
use crate::hw::port::PortError;

/// The pause before a lost device is opened again.
const PAUSE: Duration = Duration::from_secs(1);
/// How often the listener shows that it is alive.
const LOOK: Duration = Duration::from_millis(100);

/// Kinds of events: buttons, and the axes of a gamepad's pad.
const BUTTON: u16 = 1;
const AXIS: u16 = 3;
/// The two axes of the pad (ABS_HAT0X, ABS_HAT0Y).
const PAD: [u16; 2] = [16, 17];

/// Button events -> keys. Pure.
#[derive(Debug, Clone, Default)]
pub struct Buttons {
    presses: Presses,
    /// What each axis of the pad holds down.
    pad: [Option<&'static str>; 2],
}

impl Buttons {
    /// Exactly these keys have a long press that means something.
    #[must_use]
    pub fn with_long(keys: impl IntoIterator<Item = String>) -> Buttons {
        Buttons { presses: Presses::with_long(keys), pad: [None; 2] }
    }

    /// Takes an event as the system words it: kind, code, and value (1 down, 0 up, 2 repeats by itself).
    pub fn event(&mut self, kind: u16, code: u16, value: i32, at: Duration) -> Vec<Heard> {
        let mut heard = self.tick(at);
        match (kind, value) {
            (BUTTON, 0 | 1) => match names::of_button(code) {
                Some(key) if value == 1 => self.presses.press(key, true, at, &mut heard),
                Some(key) => self.presses.release(key, at, &mut heard),
                None if value == 1 => heard.push(Heard::Unknown { hex: format!("{code:04X}"), at }),
                None => {}
            },
            (AXIS, _) => {
                if let Some(held) = PAD.iter().position(|axis| *axis == code).and_then(|axis| self.pad.get_mut(axis)) {
                    let now = names::of_pad(value);
                    let before = std::mem::replace(held, now);
                    if before != now {
                        before.into_iter().for_each(|key| self.presses.release(key, at, &mut heard));
                        now.into_iter().for_each(|key| self.presses.press(key, true, at, &mut heard));
                    }
                }
            }
            _ => {}
        }
        heard
    }

    /// What only the passing of time decides.
    pub fn tick(&mut self, now: Duration) -> Vec<Heard> {
        let mut heard = Vec::new();
        self.presses.tick(now, &mut heard);
        heard
    }

    /// When [`Buttons::tick`] has something to do.
    #[must_use]
    pub fn wake_at(&self) -> Option<Duration> {
        self.presses.wake_at()
    }

    /// Forgets what is held.
    pub fn reset(&mut self) {
        self.presses.reset();
        self.pad = [None; 2];
    }
}

/// Listens to the device at `path` until `stop` is set or `told` answers `false`, opening it again for as long as it takes. The
/// device is grabbed: its keys reach no other program. Times are counted from `start`. Made for a thread of its own.
pub fn run(path: &str, mut buttons: Buttons, start: Instant, stop: &AtomicBool, mut told: impl FnMut(TapSaid) -> bool) {
    while !stop.load(Ordering::Relaxed) {
        let why = match open(path) {
            Ok(device) => {
                buttons.reset();
                if !told(TapSaid::Opened) {
                    return;
                }
                listen(path, device, &mut buttons, start, stop, &mut told)
            }
            Err(why) => Some(why),
        };
        let Some(why) = why else { return };
        if !told(TapSaid::Lost { why }) {
            return;
        }
        let again = Instant::now() + PAUSE;
        while Instant::now() < again && !stop.load(Ordering::Relaxed) {
            thread::sleep(LOOK);
            if !told(TapSaid::Alive) {
                return;
            }
        }
    }
}

/// Opens and grabs a device.
///
/// # Errors
/// It is not there, not ours to open, held by another program, or no input device.
pub fn open(path: &str) -> Result<Device, PortError> {
    let name = || path.to_owned();
    let mut device = Device::open(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => PortError::NotThere { name: name() },
        std::io::ErrorKind::PermissionDenied => PortError::Unusable {
            name: name(),
            why: "this user may not read it: join the group input (sudo adduser $USER input) and log in again".into(),
        },
        _ => PortError::Unusable { name: name(), why: format!("{error}; is it an input device?") },
    })?;
    device.grab().map_err(|_in_use| PortError::Held { name: name() })?;
    device.set_nonblocking(true).map_err(|error| PortError::Unusable { name: name(), why: error.to_string() })?;
    Ok(device)
}

/// Listens until the device is lost (then why), or nobody wants to hear more (`None`).
fn listen(
    path: &str,
    mut device: Device,
    buttons: &mut Buttons,
    start: Instant,
    stop: &AtomicBool,
    told: &mut impl FnMut(TapSaid) -> bool,
) -> Option<PortError> {
    let gone = |why: String| Some(PortError::Unplugged { name: path.to_owned(), why });
    while !stop.load(Ordering::Relaxed) {
        let due = buttons.wake_at().map_or(LOOK, |at| at.saturating_sub(start.elapsed()).min(LOOK));
        let mut files = [PollFd::from_borrowed_fd(device.as_fd(), PollFlags::IN)];
        let timeout = Timespec { tv_sec: 0, tv_nsec: due.subsec_nanos().into() };
        let ready = match poll(&mut files, Some(&timeout)) {
            Ok(ready) => ready > 0,
            Err(rustix::io::Errno::INTR) => false,
            Err(error) => return gone(error.to_string()),
        };
        let at = start.elapsed();
        let mut heard = buttons.tick(at);
        if ready {
            match device.fetch_events() {
                Ok(events) => heard.extend(events.flat_map(|event| {
                    let (kind, code, value) = (event.event_type().0, event.code(), event.value());
                    buttons.event(kind, code, value, at)
                })),
                Err(error) if error.kind() == std::io::ErrorKind::WouldBlock => {}
                Err(error) => return gone(error.to_string()),
            }
        }
        if heard.is_empty() && !told(TapSaid::Alive) {
            return None;
        }
        if !heard.into_iter().all(|heard| told(TapSaid::Heard(heard))) {
            return None;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys(heard: &[Heard]) -> Vec<(&str, bool)> {
        heard
            .iter()
            .filter_map(|h| if let Heard::Pressed(p) = h { Some((p.key.as_str(), p.long)) } else { None })
            .collect()
    }

    #[test]
    fn a_presenter_and_the_pad_of_a_gamepad_give_the_keys_of_a_hand_controller() {
        let mut buttons = Buttons::with_long(["?".to_owned()]);
        let ms = Duration::from_millis;
        assert_eq!(keys(&buttons.event(BUTTON, 109, 1, ms(0))), [("DOWN", false)]);
        assert_eq!(keys(&buttons.event(BUTTON, 109, 2, ms(300))), [], "what the system repeats is no press");
        buttons.event(BUTTON, 109, 0, ms(400));
        assert_eq!(keys(&buttons.event(AXIS, 17, -1, ms(500))), [("UP", false)]);
        assert_eq!(keys(&buttons.event(AXIS, 17, 0, ms(600))), []);
        assert_eq!(keys(&buttons.event(AXIS, 0, 12345, ms(650))), [], "a stick is not read");
        assert_eq!(keys(&buttons.event(BUTTON, 48, 1, ms(1000))), []);
        assert_eq!(buttons.wake_at(), Some(ms(1800)));
        assert_eq!(keys(&buttons.tick(ms(1800))), [("?", true)]);
    }

    #[test]
    fn what_is_no_input_device_is_refused_with_a_sentence() {
        assert!(matches!(open("/dev/input/no-such-event"), Err(PortError::NotThere { .. })));
        assert!(matches!(open("/dev/null"), Err(PortError::Unusable { .. })));
    }
}
