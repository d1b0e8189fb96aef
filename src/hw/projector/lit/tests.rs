use std::sync::{Arc, Mutex};
use std::time::Duration;

use super::*;
use crate::hw::i2c::pace::Made;
use crate::hw::light::calibration::{Calibration, Filter, Meter, Optics, Row, Sheet};
use crate::hw::light::fake::{FakeBus, FakeModule, Faults};
use crate::hw::light::{Controller, Module};

/// A projector that writes down what it is told, and whether the LEDs were on then. It can be lost.
#[derive(Clone)]
struct Watched {
    bus: FakeBus,
    heard: Arc<Mutex<Vec<(&'static str, bool)>>>,
    lost: Arc<Mutex<bool>>,
}

impl Watched {
    fn hear(&self, what: &'static str) -> Result<(), ProjectorError> {
        self.heard.lock().unwrap().push((what, self.bus.look().lit));
        if *self.lost.lock().unwrap() {
            return Err(ProjectorError::Lost { path: "watched".into(), why: "unplugged".into() });
        }
        Ok(())
    }
}

impl Projector for Watched {
    fn present(&mut self, _: &Picture) -> Result<(), ProjectorError> {
        self.hear("picture")
    }

    fn dark(&mut self) -> Result<(), ProjectorError> {
        self.hear("dark")
    }

    fn describe(&self) -> String {
        "watched".into()
    }
}

struct Bench {
    bus: FakeBus,
    clock: Made,
    watched: Watched,
    lit: Lit,
}

fn calibration() -> Calibration {
    let rows = [(12, 0.06), (775, 1.8)].map(|(code, cd_m2)| Row { code, cd_m2, black_cd_m2: None });
    Calibration::checked(Sheet {
        module: Module::Dlpc34xx,
        id: 6,
        note: String::new(),
        leds: 7,
        balance: [1.0; 3],
        inverted: false,
        ceiling_cd_m2: 1.8,
        optics: Optics { meter: Meter::Eyepiece, fixed_nd: 1e-4, beam_splitter: 0.1, filter_at_the_meter: 1.0 },
        filters: vec![Filter { name: "10 %".into(), transmission: 0.1 }],
        rows: rows.to_vec(),
    })
    .unwrap()
}

fn bench(faults: Faults) -> Bench {
    let bus = FakeBus::new(FakeModule::new(Module::Dlpc34xx, faults));
    let controller = Controller::new(Module::Dlpc34xx, Box::new(bus.clone()));
    let clock = Made::default();
    let lamp = Lamp::ready(controller, calibration(), None, 0.6, Box::new(clock.clone())).unwrap();
    let watched = Watched { bus: bus.clone(), heard: Arc::default(), lost: Arc::default() };
    let lit = Lit::new(Box::new(watched.clone()), lamp, None);
    Bench { bus, clock, watched, lit }
}

fn picture() -> Picture {
    let mut picture = Picture::black(8, 4);
    picture.row_mut(0)[0] = [0.5; 3];
    picture
}

#[test]
fn the_leds_come_after_the_picture_and_go_before_it() {
    let Bench { bus, watched, mut lit, .. } = bench(Faults::default());
    lit.present(&picture()).unwrap();
    assert!(bus.look().lit);
    lit.present(&picture()).unwrap();
    lit.present(&Picture::black(8, 4)).unwrap();
    assert!(!bus.look().lit, "black is LEDs off");
    lit.present(&picture()).unwrap();
    lit.dark().unwrap();
    assert!(!bus.look().lit);
    let heard = watched.heard.lock().unwrap().clone();
    let wanted = [("picture", false), ("picture", true), ("dark", false), ("picture", false), ("dark", false)];
    assert_eq!(heard, wanted);
    drop(lit);
}

#[test]
fn dropped_or_panicking_it_is_dark_for_good() {
    let Bench { bus, mut lit, .. } = bench(Faults::default());
    lit.present(&picture()).unwrap();
    let panicked = std::thread::spawn(move || {
        let _lit = lit;
        panic!("in the projector's thread");
    });
    assert!(panicked.join().is_err());
    let now = bus.look();
    assert_eq!((now.lit, now.led_current, now.curtain), (false, [0; 3], true));
}

#[test]
fn a_lost_projector_and_a_failing_lamp_leave_no_light() {
    let Bench { bus, watched, mut lit, .. } = bench(Faults::default());
    lit.present(&picture()).unwrap();
    *watched.lost.lock().unwrap() = true;
    assert!(matches!(lit.present(&picture()), Err(ProjectorError::Lost { .. })));
    assert!(!bus.look().lit);

    let Bench { bus, watched, mut lit, .. } = bench(Faults { clamp: Some(20), ..Faults::default() });
    let error = lit.present(&picture()).unwrap_err();
    assert!(error.to_string().contains("read back 20, 20, 20"), "{error}");
    assert!(!bus.look().lit);
    assert_eq!(watched.heard.lock().unwrap().last().unwrap().0, "dark");
}

#[test]
fn a_module_that_resets_itself_is_lit_again_within_a_second() {
    let Bench { bus, clock, mut lit, .. } = bench(Faults::default());
    lit.present(&picture()).unwrap();
    bus.change(FakeModule::reset);
    assert!(!bus.look().lit);
    clock.pass(Duration::from_secs(1));
    lit.present(&picture()).unwrap();
    assert!(bus.look().lit);
    assert_eq!(lit.lamp().relit(), 1);
}

#[test]
fn dimming_goes_with_the_leds_and_the_pixels_take_the_rest() {
    let Bench { bus, mut lit, .. } = bench(Faults::default());
    lit.present(&picture()).unwrap();
    let full = bus.look().led_current[0];
    // Half of 0.6 cd/m2: (0.3 - 0.06) / 1.74 of the codes from 12 to 775 is 117.2, so 118 and a little less in the pixels.
    let half = lit.dim(0.5).unwrap();
    assert_eq!(bus.look().led_current, [118; 3]);
    assert!(half.gain > 0.98 && half.gain < 1.0 && full > 200, "{half:?}");
    // 0.006 cd/m2 is a tenth of what the dimmest code gives, and wants a filter.
    let dim = lit.dim(0.01).unwrap();
    assert_eq!(bus.look().led_current, [12; 3]);
    assert!((dim.gain - 0.1).abs() < 1e-6);
    assert!(dim.advice.unwrap().contains("insert the filter 10 %"));
    assert_eq!(lit.dim(f32::NAN).unwrap().gain, 0.0);
}

#[test]
fn the_calibration_of_another_module_lights_nothing() {
    let bus = FakeBus::new(FakeModule::new(Module::Dlpc34xx, Faults { id: Some(1), ..Faults::default() }));
    let controller = Controller::new(Module::Dlpc34xx, Box::new(bus.clone()));
    let error = Lamp::ready(controller, calibration(), None, 0.6, Box::new(Made::default())).err().unwrap();
    assert!(error.to_string().contains("made with DLPC3436, and a DLPC3433 answers"), "{error}");
    assert!(bus.look().writes.is_empty());
}
