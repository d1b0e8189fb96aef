//! The projector's thread: the latest picture wins, dark overtakes, failures come back, and it dies dark.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use super::*;
use crate::hw::projector::Memory;

/// What the device was told, and a gate that its presents wait at.
struct Gated {
    memory: Memory,
    did: Sender<&'static str>,
    gate: Option<Receiver<()>>,
    refuses: u32,
    breaks: bool,
}

impl Projector for Gated {
    fn present(&mut self, picture: &Picture) -> Result<(), ProjectorError> {
        if self.breaks {
            panic!("the device's part breaks");
        }
        let _ = self.did.send("begins");
        if let Some(gate) = &self.gate {
            let _ = gate.recv();
        }
        self.memory.present(picture)?;
        let _ = self.did.send("shows");
        Ok(())
    }

    fn dark(&mut self) -> Result<(), ProjectorError> {
        if self.refuses > 0 {
            self.refuses -= 1;
            return Err(ProjectorError::Lost { path: "gated".into(), why: "it refuses".into() });
        }
        let _ = self.did.send("dark");
        self.memory.dark()
    }

    fn describe(&self) -> String {
        "gated".into()
    }
}

struct Bench {
    memory: Memory,
    did: Receiver<&'static str>,
    open: Sender<()>,
    told: Receiver<Told>,
    clock: Arc<AtomicU64>,
    output: Output,
}

/// A device whose presents wait for the gate (if `gated`), and a clock of our own.
fn bench(gated: bool, refuses: u32, breaks: bool) -> Bench {
    let memory = Memory::default();
    let (did, doing) = channel();
    let (open, gate) = channel();
    let device = Gated { memory: memory.clone(), did, gate: gated.then_some(gate), refuses, breaks };
    let (tell, told) = channel();
    let clock = Arc::new(AtomicU64::new(0));
    let read = Arc::clone(&clock);
    let now: Now = Arc::new(move || Duration::from_millis(read.load(Ordering::SeqCst)));
    let output = Output::start(Box::new(device), now, move |said| drop(tell.send(said))).unwrap();
    Bench { memory, did: doing, open, told, clock, output }
}

fn grey(light: f32) -> Arc<Picture> {
    let mut picture = Picture::black(2, 2);
    picture.pixels_mut().fill([light; 3]);
    Arc::new(picture)
}

const LONG: Duration = Duration::from_secs(20);

#[test]
fn of_pictures_that_wait_only_the_latest_is_shown_with_its_instants() {
    let Bench { memory, did, open, told, clock, output } = bench(true, 0, false);
    output.show(grey(0.1), Duration::from_millis(1));
    assert_eq!(did.recv_timeout(LONG), Ok("begins"));
    clock.store(40, Ordering::SeqCst);
    output.show(grey(0.2), Duration::from_millis(35));
    output.show(grey(0.3), Duration::from_millis(38));
    clock.store(57, Ordering::SeqCst);
    open.send(()).unwrap();
    open.send(()).unwrap();
    let stamps: Vec<Told> = (0..2).map(|_| told.recv_timeout(LONG).unwrap()).collect();
    let ms = Duration::from_millis;
    assert_eq!(stamps[0], Told::Shown(Stamp { predicted_for: ms(1), asked: ms(0), presented: ms(57) }));
    let last = Stamp { predicted_for: ms(38), asked: ms(40), presented: ms(57) };
    assert_eq!((&stamps[1], last.age()), (&Told::Shown(last), ms(19)));
    assert_eq!((memory.shown().presented, output.overtaken()), (2, 1));
    assert_eq!(memory.shown().picture, Some((*grey(0.3)).clone()));
}

#[test]
fn dark_overtakes_every_picture_that_waits() {
    let Bench { memory, did, open, told, output, .. } = bench(true, 0, false);
    output.show(grey(0.1), Duration::ZERO);
    assert_eq!(did.recv_timeout(LONG), Ok("begins"));
    output.show(grey(0.2), Duration::ZERO);
    output.dark();
    open.send(()).unwrap();
    assert_eq!([did.recv_timeout(LONG), did.recv_timeout(LONG)], [Ok("shows"), Ok("dark")]);
    assert!(matches!(told.recv_timeout(LONG), Ok(Told::Shown(_))));
    assert!(matches!(told.recv_timeout(LONG), Ok(Told::Dark(_))));
    assert!(memory.is_dark());
    assert_eq!(memory.shown().presented, 1);
}

#[test]
fn a_device_that_hangs_is_not_alive_and_does_not_hold_up_the_caller() {
    let Bench { did, open, clock, output, told, .. } = bench(true, 0, false);
    output.show(grey(0.1), Duration::ZERO);
    assert_eq!(did.recv_timeout(LONG), Ok("begins"));
    clock.store(4999, Ordering::SeqCst);
    assert!(output.alive());
    clock.store(5000, Ordering::SeqCst);
    (0..1000).for_each(|_| output.show(grey(0.2), Duration::ZERO));
    assert!(!output.alive());
    drop(open);
    assert!(matches!(told.recv_timeout(LONG), Ok(Told::Shown(_))));
    assert!(matches!(told.recv_timeout(LONG), Ok(Told::Shown(_))));
    assert!(output.alive());
}

#[test]
fn a_device_that_does_not_go_dark_is_told_again_until_it_does_and_the_failure_comes_back_once() {
    let Bench { did, told, output, .. } = bench(false, 3, false);
    output.dark();
    assert_eq!(did.recv_timeout(LONG), Ok("dark"));
    assert!(matches!(told.recv_timeout(LONG), Ok(Told::Failed(ProjectorError::Lost { .. }))));
    assert!(matches!(told.recv_timeout(LONG), Ok(Told::Dark(_))));
    drop(output);
    assert!(told.try_recv().is_err());
}

#[test]
fn it_is_dark_when_it_is_dropped_and_when_its_own_part_breaks() {
    let Bench { memory, told, output, .. } = bench(false, 0, false);
    output.show(grey(0.5), Duration::ZERO);
    assert!(matches!(told.recv_timeout(LONG), Ok(Told::Shown(_))));
    assert!(!memory.is_dark());
    drop(output);
    assert!(memory.is_dark());

    let Bench { did, told, output, .. } = bench(false, 0, true);
    output.show(grey(0.5), Duration::ZERO);
    assert_eq!(did.recv_timeout(LONG), Ok("dark"));
    assert!(matches!(told.recv_timeout(LONG), Ok(Told::Failed(_))));
    drop(told);
    drop(output);
}

#[test]
fn without_a_lamp_dimming_is_left_to_the_pixels() {
    let Bench { told, output, .. } = bench(false, 0, false);
    for (share, gain) in [(0.25, 0.25), (7.0, 1.0), (-1.0, 0.0), (f32::NAN, 0.0)] {
        output.dim(share);
        assert_eq!(told.recv_timeout(LONG), Ok(Told::Dimmed(Dimmed { gain, advice: None })));
    }
}
