//! The tapped hand controller: keys through a bad cable under a virtual clock, and through a pty in real time.
//!
//! Wiring: the tapping adapter's receiver (RX, with a series resistor or opto-isolator) on the hand controller's data wire, its
//! ground on the cable's ground, its transmitter on nothing. On the loopback rig a pty stands for the cable.

use std::fs::File;
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use scotopic::cli::rig::Rig;
use scotopic::hw::fault_line::{Cable, Mischief, Spell};
use scotopic::hw::handbox::sim::{Faults, Handset};
use scotopic::hw::handbox::tap::{Tap, TapSaid, refuse_mounts_port};
use scotopic::hw::handbox::{Decoder, Heard, KeyMap};
use scotopic::hw::mount::address::MountAddress;
use scotopic::hw::port::{Port, PortError};
use scotopic::numerics::streams::Stream;

use super::report::{Outcome, Report, histogram, record};

const SECTION: &str = "tap";
const NIGHTS: u64 = 2000;
const MAPS: [&str; 3] = ["lx200-classic", "autostar2-guess", "ascii"];

/// The hand controller's end of the cable. Nothing may ever be sent into it.
#[derive(Clone)]
struct HandsetPort(Arc<Mutex<(Handset, Duration, u64)>>);

impl Port for HandsetPort {
    fn receive(&mut self, buffer: &mut [u8]) -> Result<usize, PortError> {
        let (handset, now, _) = &mut *self.0.lock().unwrap();
        let bytes = handset.drain(*now);
        let count = bytes.len().min(buffer.len());
        buffer[..count].copy_from_slice(&bytes[..count]);
        Ok(count)
    }

    fn send(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        self.0.lock().unwrap().2 += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn set_now(&mut self, now: Duration) {
        self.0.lock().unwrap().1 = now;
    }
}

fn mischief(stream: &mut Stream) -> Mischief {
    let chance = stream.uniform() * 0.2;
    match (stream.uniform() * 11.0) as u32 {
        0 => Mischief::Drop(chance),
        1 => Mischief::Duplicate(chance),
        2 => Mischief::Flip(chance),
        3 => Mischief::Insert(chance),
        4 => Mischief::MidPacket(1 + (chance * 20.0) as usize),
        5 => Mischief::Crosstalk(chance * 4.0),
        6 => Mischief::WrongBaud,
        7 => Mischief::Flood(20_000),
        8 => Mischief::Break,
        9 => Mischief::Delay(Duration::from_millis(500)),
        _ => Mischief::Rename,
    }
}

/// One minute: keys all along, something wrong with the cable from second 5 to 10, and from second 12 on all is as pressed.
fn night(seed: u64, map: &KeyMap, late: &mut hdrhistogram::Histogram<u64>) -> Result<u64, String> {
    let mut stream = Stream::seeded(seed);
    let faults = Faults { display: map.name() == "lx200-classic", ..Faults::default() };
    let mut handset = Handset::new(map.clone(), faults, seed);
    handset.switch_on(Duration::from_millis(10));
    let names: Vec<String> = map.keys().iter().map(|key| key.name.clone()).collect();
    let mut pressed = Vec::new();
    for turn in 0..30u64 {
        let key = names[((stream.uniform() * names.len() as f64) as usize).min(names.len() - 1)].clone();
        let at = Duration::from_millis(1000 + 600 * turn + (stream.uniform() * 100.0) as u64);
        handset.press(&key, at, Duration::from_millis(120)).unwrap();
        pressed.push((at, key));
    }
    let far = HandsetPort(Arc::new(Mutex::new((handset, Duration::ZERO, 0))));
    let from = Duration::from_secs_f64(5.0 + stream.uniform());
    let lasts = Duration::from_secs_f64(0.5 + 3.5 * stream.uniform());
    let cable = Cable::new(seed, None, vec![Spell::at(from, lasts, mischief(&mut stream))]);
    let mut decoder = Decoder::new(map.clone());
    let (mut line, mut heard) = (None, Vec::new());
    for turn in 0..4400u64 {
        let now = Duration::from_millis(5 * turn);
        cable.set_now(now);
        if line.is_none() {
            line = cable.open(|_| Ok(far.clone())).ok();
            decoder.reset();
        }
        let mut buffer = [0; 512];
        match line.as_mut().map(|line| {
            line.set_now(now);
            line.receive(&mut buffer)
        }) {
            Some(Ok(count)) => heard.extend(decoder.feed(&buffer[..count], now)),
            Some(Err(_gone)) => line = None,
            None => far.clone().set_now(now),
        }
        heard.extend(decoder.tick(now));
        if heard.len() > 20_000 {
            return Err("more is heard than a line can carry".into());
        }
    }
    if far.0.lock().unwrap().2 > 0 {
        return Err("something was sent to the hand controller".into());
    }
    let keys: Vec<(Duration, &String)> = heard
        .iter()
        .filter_map(|heard| if let Heard::Pressed(pressed) = heard { Some((pressed.at, &pressed.key)) } else { None })
        .collect();
    for second in 0..22 {
        let range = Duration::from_secs(second)..Duration::from_secs(second + 1);
        for name in &names {
            let count = keys.iter().filter(|(at, key)| range.contains(at) && *key == name).count();
            if count > 10 {
                return Err(format!("{count} presses of {name} in second {second}"));
            }
        }
    }
    // Before anything was wrong, and two seconds after: what is heard is what was pressed.
    let calm =
        |at: Duration| at < from.saturating_sub(Duration::from_secs(1)) || at > from + lasts + Duration::from_secs(2);
    let told: Vec<&String> = keys.iter().filter(|(at, _)| calm(*at)).map(|(_, key)| *key).collect();
    let meant: Vec<(Duration, &String)> =
        pressed.iter().filter(|(at, _)| calm(*at)).map(|(at, key)| (*at, key)).collect();
    if told != meant.iter().map(|(_, key)| *key).collect::<Vec<_>>() {
        // A press at the very edge of the calm is heard on the other side of it.
        let edge = |at: Duration| {
            !calm(at + Duration::from_millis(200)) || !calm(at.saturating_sub(Duration::from_millis(200)))
        };
        if !pressed.iter().any(|(at, _)| edge(*at) && edge(*at + Duration::from_millis(130))) {
            return Err(format!("pressed {meant:?}, heard {told:?}"));
        }
        return Ok(0);
    }
    for ((at, _), (heard, _)) in meant.iter().zip(keys.iter().filter(|(at, _)| calm(*at))) {
        record(late, heard.saturating_sub(*at));
    }
    Ok(meant.len() as u64)
}

/// Keys through a bad cable.
pub(crate) fn nights(report: &mut Report) {
    let began = Instant::now();
    let (mut failures, mut keys, mut late) = (Vec::new(), 0, histogram());
    for number in 0..NIGHTS {
        let map = KeyMap::shipped(MAPS[(number % 3) as usize]).unwrap();
        match night(report.seed.wrapping_add(number), &map, &mut late) {
            Ok(count) => keys += count,
            Err(what) => failures.push(format!("seed {} ({}): {what}", report.seed.wrapping_add(number), map.name())),
        }
    }
    report
        .times("tap, virtual: key down to key heard (a short press of a key with a long one: when it comes up)", &late);
    report.count("tap: presses held against what was heard", keys);
    failures.truncate(10);
    let outcome = if failures.is_empty() { Outcome::Passed } else { Outcome::Failed(failures.join("\n")) };
    report.check(SECTION, format!("{NIGHTS} nights of keys through a bad cable"), outcome, began.elapsed());
}

/// A pty with a listener, keys alternating, every 70 ms; then the plug out and in.
pub(crate) fn pty(report: &mut Report) {
    let began = Instant::now();
    let map = KeyMap::shipped("lx200-classic").unwrap();
    let open = || {
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC).unwrap();
        grantpt(&master).unwrap();
        unlockpt(&master).unwrap();
        let name = ptsname(&master, Vec::new()).unwrap().to_string_lossy().into_owned();
        (File::from(master), name)
    };
    let folder = std::env::temp_dir().join(format!("scotopic-tap-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let link = folder.join("tap");
    let lead = |name: &str| {
        let _ = std::fs::remove_file(&link);
        std::os::unix::fs::symlink(name, &link).unwrap();
    };
    let (mut master, name) = open();
    lead(&name);
    let (stop, start) = (Arc::new(AtomicBool::new(false)), Instant::now());
    let (tell, told) = std::sync::mpsc::channel();
    let (ended, path, decoder) = (Arc::clone(&stop), link.to_string_lossy().into_owned(), Decoder::new(map.clone()));
    let thread = std::thread::spawn(move || {
        Tap::run(&path, decoder, start, &ended, |said| tell.send((Instant::now(), said)).is_ok());
    });
    let patience = Duration::from_secs(20);
    let wait = |wanted: &dyn Fn(&TapSaid) -> bool| {
        let deadline = Instant::now() + patience;
        loop {
            match told.recv_timeout(deadline.saturating_duration_since(Instant::now())) {
                Ok((at, said)) if wanted(&said) => return Some(at),
                Ok(_) => {}
                Err(_) => return None,
            }
        }
    };
    let (mut late, mut wrong) = (histogram(), Vec::new());
    let opened = |said: &TapSaid| matches!(said, TapSaid::Opened);
    if wait(&opened).is_none() {
        wrong.push("the tap was never opened".to_owned());
    }
    let mut press = |master: &mut File, turn: usize| {
        let key = &map.keys()[turn % map.keys().len()];
        let code = key.press.places()[0].unwrap();
        let at = Instant::now();
        master.write_all(&[code]).unwrap();
        let heard = wait(&|said| matches!(said, TapSaid::Heard(Heard::Pressed(pressed)) if pressed.key == key.name));
        master.write_all(&[code | 0x80]).unwrap();
        std::thread::sleep(Duration::from_millis(20));
        heard.map(|heard| record(&mut late, heard - at)).ok_or_else(|| format!("{} was not heard", key.name))
    };
    for turn in 0..60 {
        wrong.extend(press(&mut master, turn).err());
    }
    // A new name is there before the old one goes.
    let (mut again, name) = open();
    lead(&name);
    let out = Instant::now();
    drop(master);
    let back = wait(&opened);
    match back {
        Some(at) => {
            report.figure(
                "tap: reopened under a new name",
                "< 2 s",
                format!("{:.2} s", (at - out).as_secs_f64()),
                at - out < Duration::from_secs(2),
            );
            wrong.extend(press(&mut again, 3).err());
        }
        None => wrong.push("the tap was never opened again".into()),
    }
    stop.store(true, Ordering::Relaxed);
    thread.join().unwrap();
    let _ = std::fs::remove_dir_all(&folder);
    report.times("tap, pty: byte written to key heard", &late);
    wrong.truncate(10);
    let outcome = if wrong.is_empty() { Outcome::Passed } else { Outcome::Failed(wrong.join("\n")) };
    report.check(SECTION, "keys through a pty, unplugged and replugged under a new name", outcome, began.elapsed());
}

/// The rig's own tap: opened for reading only, listened to while nobody touches a key.
pub(crate) fn real(rig: &Rig, report: &mut Report) {
    let Some(tap) = &rig.tap else { return };
    let (began, name) = (Instant::now(), "real hand controller's cable: ten seconds of silence");
    let Some(map) =
        KeyMap::shipped(&tap.map).or_else(|| KeyMap::from_toml(&std::fs::read_to_string(&tap.map).ok()?).ok())
    else {
        let why = format!("there is no key map {}", tap.map);
        return report.check(SECTION, name, Outcome::Failed(why), began.elapsed());
    };
    let outcome = match Tap::open(&tap.port, &map.line()) {
        Err(error) => Outcome::Failed(error.to_string()),
        Ok(mut line) => {
            let (mut bytes, mut malformed) = (0, 0);
            while began.elapsed() < Duration::from_secs(10) {
                let Ok(received) = line.read(Duration::from_millis(100)) else { break };
                (bytes, malformed) = (bytes + received.bytes.len(), malformed + received.malformed);
            }
            report.count("tap: bytes of ten seconds without a key", bytes as u64);
            report.count("tap: of these not well formed", malformed as u64);
            Outcome::Passed
        }
    };
    report.check(SECTION, name, outcome, began.elapsed());
}

/// What must be refused, in a sentence.
pub(crate) fn refusals(report: &mut Report) {
    let began = Instant::now();
    let mut wrong = Vec::new();
    let mut say = |what: &str, said: Option<String>, words: &[&str]| match said {
        None => wrong.push(format!("{what} was not refused")),
        Some(said) if !words.iter().all(|word| said.contains(word)) => wrong.push(format!("{what}: {said}")),
        Some(_) => {}
    };
    let mount = MountAddress::Serial { path: "/dev/tty".into(), baud: 9600 };
    say(
        "tapping the mount's port",
        refuse_mounts_port("/dev/tty", &mount).err().map(|e| e.to_string()),
        &["/dev/tty", "command port"],
    );
    let twice = "name = 'x'\n[line]\nbaud = 9600\n[framing]\nmode = 'single'\n[[key]]\nname = 'A'\npress = '3?'\n";
    say("a key map that is no key map", KeyMap::from_toml(twice).err().map(|e| e.to_string()), &[]);
    let overlap = "name = 'x'\n[line]\nbaud = 9600\n[framing]\nmode = 'single'\n[[key]]\nname = 'A'\npress = '31'\n[[key]]\nname = 'B'\npress = '31'\n";
    say("overlapping patterns", KeyMap::from_toml(overlap).err().map(|e| e.to_string()), &["A", "B"]);
    let same = "name = 'x'\n[mount]\nport = '/dev/serial/by-id/a'\n[tap]\nport = '/dev/serial/by-id/a'\nmap = 'ascii'";
    say("one port twice", Rig::from_toml(same).err().map(|e| e.to_string()), &["mount", "tap"]);
    let outcome = if wrong.is_empty() { Outcome::Passed } else { Outcome::Failed(wrong.join("\n")) };
    report.check(
        SECTION,
        "the mount's own port, overlapping patterns, one port twice: refused in a sentence",
        outcome,
        began.elapsed(),
    );
}
