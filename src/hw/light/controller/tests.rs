use std::sync::{Arc, Mutex};

use super::*;
use crate::hw::i2c::pace::{Made, Pace};
use crate::hw::light::fake::{FakeBus, FakeModule, Faults};

const TIME: Duration = Duration::from_secs(3);
const DRIVE: Drive = Drive { leds: 7, codes: [0x00C, 0x12C, 0x307] };
const BOTH: [Module; 2] = [Module::Dlpc2607, Module::Dlpc34xx];

fn bench(module: Module, faults: Faults) -> (FakeBus, Controller, Made) {
    let bus = FakeBus::new(FakeModule::new(module, faults));
    (bus.clone(), Controller::new(module, Box::new(bus)), Made::default())
}

/// A bus that writes down what passes: `w` bytes written, `r` bytes read.
struct Overheard(FakeBus, Arc<Mutex<Vec<String>>>);

fn hex(sign: char, bytes: &[u8]) -> String {
    bytes.iter().fold(sign.to_string(), |line, byte| format!("{line} {byte:02x}"))
}

impl I2cBus for Overheard {
    fn write(&mut self, address: u8, bytes: &[u8]) -> Result<(), I2cError> {
        assert_eq!(address, 0x1B);
        self.1.lock().unwrap().push(hex('w', bytes));
        self.0.write(address, bytes)
    }

    fn read(&mut self, address: u8, buffer: &mut [u8]) -> Result<(), I2cError> {
        self.0.read(address, buffer)?;
        self.1.lock().unwrap().push(hex('r', buffer));
        Ok(())
    }

    fn describe(&self) -> String {
        self.0.describe()
    }
}

fn overheard(module: Module, what: impl Fn(&mut Controller, &mut Within<'_>)) -> Vec<String> {
    let heard = Arc::new(Mutex::new(Vec::new()));
    let bus = Overheard(FakeBus::new(FakeModule::new(module, Faults::default())), heard.clone());
    let mut controller = Controller::new(module, Box::new(bus));
    what(&mut controller, &mut Within::new(&mut Made::default(), TIME));
    heard.lock().unwrap().clone()
}

#[test]
fn a_dlpc2607_is_lit_and_made_dark_with_the_bytes_of_ti_s_library() {
    // dpp2607.py: write [reg, 32 bits big-endian]; read [0x15, reg] then 4 bytes; currents count after compound 0xD3.
    let lit = overheard(Module::Dlpc2607, |controller, within| controller.light(DRIVE, within).unwrap());
    let propagated = ["w 39 00 00 00 01", "w 3a 00 00 00 01", "w 38 00 00 00 d3", "w 15 3a", "r 00 00 00 00"];
    let mut wanted = vec![
        "w 15 03",
        "r 00 00 08 8a", // who it is: 0x8A, bit 11 initialised
        "w 16 00 00 00 00",
        "w 15 16",
        "r 00 00 00 00", // LEDs off first
        "w 12 00 00 00 0c",
        "w 15 12",
        "r 00 00 00 0c",
        "w 13 00 00 01 2c",
        "w 15 13",
        "r 00 00 01 2c",
        "w 14 00 00 03 07",
        "w 15 14",
        "r 00 00 03 07",
    ];
    wanted.extend(propagated.repeat(2));
    wanted.extend([
        "w 2d 00 00 00 00",
        "w 15 2d",
        "r 00 00 00 00", // mirrors out of their resting place
        "w a6 00 00 00 00",
        "w 15 a6",
        "r 00 00 00 00", // curtain open
        "w 16 00 00 00 07",
        "w 15 16",
        "r 00 00 00 07", // and the LEDs last
    ]);
    assert_eq!(lit, wanted);

    let dark = overheard(Module::Dlpc2607, |controller, within| controller.dark(within).unwrap());
    let writes: Vec<&str> = dark.iter().map(String::as_str).filter(|line| line.len() == 16).collect();
    let mut wanted = vec!["w 16 00 00 00 00", "w 12 00 00 00 00", "w 13 00 00 00 00", "w 14 00 00 00 00"];
    wanted.extend(["w 39 00 00 00 01", "w 3a 00 00 00 01", "w 38 00 00 00 d3"].repeat(2));
    wanted.extend(["w a6 00 00 00 01", "w 2d 00 00 00 01"]);
    assert_eq!(writes, wanted, "LED enable 0, current 0, curtain black, park");
}

#[test]
fn a_dlpc34xx_is_lit_and_made_dark_with_the_opcodes_of_ti_s_guide() {
    // DLPU078A: 0x50 method, 0x84 CAIC, 0x54 currents as three little-endian words, 0x16 curtain, 0x52 enable.
    let lit = overheard(Module::Dlpc34xx, |controller, within| controller.light(DRIVE, within).unwrap());
    assert_eq!(
        lit,
        [
            "w d4",
            "r 06",
            "w d0",
            "r 81", // a DLPC3436, initialised
            "w 52 00",
            "w 53",
            "r 00",
            "w 50 00",
            "w 51",
            "r 00", // currents by hand
            "w 85",
            "r 48 1e 3c",
            "w 84 00 1e 3c",
            "w 85",
            "r 00 1e 3c", // CAIC off
            "w 54 0c 00 2c 01 07 03",
            "w 55",
            "r 0c 00 2c 01 07 03",
            "w 16 00",
            "w 17",
            "r 00",
            "w 52 07",
            "w 53",
            "r 07",
        ]
    );
    let dark = overheard(Module::Dlpc34xx, |controller, within| controller.dark(within).unwrap());
    assert_eq!(
        dark[4..],
        ["w 52 00", "w 53", "r 00", "w 54 00 00 00 00 00 00", "w 55", "r 00 00 00 00 00 00", "w 16 01", "w 17", "r 01"]
    );
}

#[test]
fn a_module_that_needs_its_time_after_power_up_is_waited_for() {
    for module in BOTH {
        let (bus, mut controller, mut made) =
            bench(module, Faults { silent_at_start: 9, starting_reads: 9, ..Faults::default() });
        controller.light(DRIVE, &mut Within::new(&mut made, TIME)).unwrap();
        assert!(bus.look().lit);
    }
}

#[test]
fn patience_ends_when_it_was_said_to_end() {
    let for_ever = [
        Faults { silent_from: Some(1), ..Faults::default() },
        Faults { starting_reads: u32::MAX, ..Faults::default() },
        Faults { stuck_from: Some(20), ..Faults::default() },
        Faults { busy_for_ever: true, ..Faults::default() },
        Faults { silent_from: Some(30), ..Faults::default() },
    ];
    for faults in for_ever {
        let (_, mut controller, mut made) = bench(Module::Dlpc2607, faults.clone());
        let clock = made.clone();
        let error = controller.light(DRIVE, &mut Within::new(&mut made, TIME)).unwrap_err();
        assert!(clock.now() <= TIME, "{faults:?}: {:?}", clock.now());
        assert!(
            matches!(error, LightError::Bus { .. } | LightError::NotReady { .. } | LightError::Busy { .. }),
            "{error}"
        );
    }
}

#[test]
fn a_wrong_identity_is_told_and_nothing_is_written() {
    for (module, id, words) in [
        (Module::Dlpc2607, 0x82, "it is a DLPC2601"),
        (Module::Dlpc2607, 0x06, "no dlpc2607"),
        (Module::Dlpc34xx, 0x8A, "no dlpc34xx"),
        (Module::Dlpc34xx, 0xFF, "an open line"),
    ] {
        let (bus, mut controller, mut made) = bench(module, Faults { id: Some(id), ..Faults::default() });
        let error = controller.light(DRIVE, &mut Within::new(&mut made, TIME)).unwrap_err();
        assert!(error.to_string().contains(words), "{error}");
        assert!(controller.dark(&mut Within::new(&mut made, TIME)).is_err());
        assert!(bus.look().writes.is_empty(), "{:?}", bus.look().writes);
    }
}

#[test]
fn the_wrong_family_of_controller_is_not_written_to() {
    for (said, real) in [(Module::Dlpc2607, Module::Dlpc34xx), (Module::Dlpc34xx, Module::Dlpc2607)] {
        let bus = FakeBus::new(FakeModule::new(real, Faults::default()));
        let mut controller = Controller::new(said, Box::new(bus.clone()));
        let error = controller.light(DRIVE, &mut Within::new(&mut Made::default(), TIME)).unwrap_err();
        assert!(matches!(error, LightError::WrongId { .. }), "{error}");
        assert!(bus.look().writes.is_empty(), "{:?}", bus.look().writes);
    }
}

#[test]
fn currents_that_are_clamped_in_silence_are_told_with_asked_and_got() {
    for (module, asked, got) in [(Module::Dlpc2607, "300", "200"), (Module::Dlpc34xx, "12, 300, 775", "12, 200, 200")] {
        let (bus, mut controller, mut made) = bench(module, Faults { clamp: Some(200), ..Faults::default() });
        let error = controller.light(DRIVE, &mut Within::new(&mut made, TIME)).unwrap_err();
        assert_eq!(error, LightError::Mismatch { what: Doing::Current, asked: asked.into(), got: got.into() });
        assert!(!bus.look().lit);
    }
}

#[test]
fn an_led_switch_that_does_not_take_is_told() {
    let (_, mut controller, mut made) = bench(Module::Dlpc2607, Faults { enable_sticks: true, ..Faults::default() });
    let error = controller.light(DRIVE, &mut Within::new(&mut made, TIME)).unwrap_err();
    assert_eq!(error, LightError::Mismatch { what: Doing::Enable, asked: "7".into(), got: "0".into() });
}

#[test]
fn whichever_transaction_fails_the_light_is_as_asked_or_off() {
    // A step of every transaction's fault, one at a time, for both families: as SQLite fails every Nth operation.
    let faults: [fn(u64) -> Faults; 6] = [
        |n| Faults { silent: vec![n], ..Faults::default() },
        |n| Faults { short: vec![n], ..Faults::default() },
        |n| Faults { flipped: vec![n], ..Faults::default() },
        |n| Faults { lost: vec![n, n + 1], ..Faults::default() },
        |n| Faults { stuck_from: Some(n), stuck_for: Some(7), ..Faults::default() },
        |n| Faults { reset_at: Some(n), silent_at_start: 2, ..Faults::default() },
    ];
    let (mut lit, mut failed) = (0, 0);
    for module in BOTH {
        for (kind, fault) in faults.iter().enumerate() {
            for n in 1..70 {
                let (bus, mut controller, mut made) = bench(module, fault(n));
                let done = controller.light(DRIVE, &mut Within::new(&mut made, TIME));
                let now = bus.look();
                match done {
                    // A module that resets itself right after a check is found out by the next look.
                    Ok(()) if now.resets > 0 => {}
                    Ok(()) => {
                        lit += 1;
                        assert_eq!((now.led_enable, now.led_current), (7, DRIVE.codes), "{module} fault {kind} at {n}");
                    }
                    Err(error) => {
                        failed += 1;
                        assert!(!now.lit, "{module} fault {kind} at {n}: {error}");
                    }
                }
            }
        }
    }
    assert!(lit > 600 && failed < 40, "one passing fault is overcome: {lit} lit, {failed} failed");
}

#[test]
fn darkness_is_reached_whichever_transaction_fails_once() {
    for module in BOTH {
        for n in 1..60 {
            for faults in
                [Faults { silent: vec![n], ..Faults::default() }, Faults { flipped: vec![n], ..Faults::default() }]
            {
                let (bus, mut controller, mut made) = bench(module, Faults::default());
                controller.light(DRIVE, &mut Within::new(&mut made, TIME)).unwrap();
                bus.change(|fake| (fake.faults, fake.transactions) = (faults, 0));
                controller.dark(&mut Within::new(&mut made, TIME)).unwrap();
                let now = bus.look();
                assert!(!now.lit && now.curtain && now.led_current == [0; 3], "{module} at {n}: {now:?}");
            }
        }
    }
}

#[test]
fn status_tells_what_the_module_holds() {
    for module in BOTH {
        let (_, mut controller, mut made) = bench(module, Faults::default());
        let mut within = Within::new(&mut made, TIME);
        controller.light(DRIVE, &mut within).unwrap();
        let status = controller.status(&mut within).unwrap();
        assert_eq!((status.leds, status.codes, status.curtain), (7, DRIVE.codes, false));
        assert_eq!(status.complaints, Vec::<String>::new());
    }
    assert_eq!(wire::complaints_2607(1 << 12 | 0x88A), ["an LED timed out"]);
    assert_eq!(
        wire::complaints_34xx(0x83, [0, 0x08, 0, 0x20]),
        ["a command was not understood", "the red LED failed", "its watchdog barked"]
    );
}

#[test]
fn the_input_is_taken_behind_the_curtain_with_the_leds_off() {
    // tregota/rpi4-dlpdlcr2000evm: 0x0C = 0x1B, 0x0B = 0. TI's init_parallel_mode.py: source, size, actuator, format, sync.
    let writes = |module, longer: usize| {
        let heard = overheard(module, |controller, within| controller.take_parallel_input(within).unwrap());
        heard.into_iter().filter(|line| line.starts_with('w') && line.len() > longer).collect::<Vec<_>>()
    };
    assert_eq!(
        writes(Module::Dlpc2607, 8),
        ["w 16 00 00 00 00", "w a6 00 00 00 01", "w 0c 00 00 00 1b", "w 0b 00 00 00 00"]
    );
    assert_eq!(
        writes(Module::Dlpc34xx, 4),
        ["w 52 00", "w 16 01", "w 05 01 00", "w 60 80 07 38 04", "w ae 01", "w 6d 02", "w 6b 02"]
    );
    let (bus, mut controller, mut made) = bench(Module::Dlpc34xx, Faults { id: Some(1), ..Faults::default() });
    let error = controller.take_parallel_input(&mut Within::new(&mut made, TIME)).unwrap_err();
    assert!(error.to_string().contains("DLPC3433") && bus.look().writes.is_empty(), "{error}");
}
