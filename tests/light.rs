//! The projector's light from outside: the program on a made-up bus whose registers outlive it, however it dies.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};
use scotopic::hw::light::fake::stored::StoredBus;
use scotopic::hw::light::fake::{FakeModule, Faults};
use scotopic::hw::light::{Calibration, Module};

/// No step takes so long on the slowest machine that is meant.
const PATIENCE: Duration = Duration::from_secs(60);

/// A folder with a module's registers and a calibration.
struct Bench {
    folder: PathBuf,
}

impl Bench {
    fn new(name: &str) -> Bench {
        let folder = std::env::temp_dir().join(format!("scotopic-light-{}-{name}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("light.toml"), CALIBRATION).unwrap();
        Bench { folder }
    }

    fn with_faults(name: &str, faults: Faults) -> Bench {
        let bench = Bench::new(name);
        let module = FakeModule::new(Module::Dlpc2607, faults);
        fs::write(bench.state(), serde_json::to_vec(&module).unwrap()).unwrap();
        bench
    }

    fn state(&self) -> PathBuf {
        self.folder.join("state.json")
    }

    fn look(&self) -> FakeModule {
        StoredBus::look(&self.state()).unwrap()
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_scotopic"));
        command.args(["projector", "--module", "dlpc2607", "--bus"]).arg(format!("fake:{}", self.state().display()));
        command
            .args(arguments)
            .current_dir(&self.folder)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        for variable in ["HOME", "XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_DATA_HOME", "XDG_DATA_DIRS"] {
            command.env(variable, &self.folder);
        }
        command
    }

    fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Waits until the module is as it should be.
    fn until(&self, what: &str, is_so: impl Fn(&FakeModule) -> bool) -> FakeModule {
        let begun = Instant::now();
        loop {
            if let Ok(module) = StoredBus::look(&self.state())
                && is_so(&module)
            {
                return module;
            }
            assert!(begun.elapsed() < PATIENCE, "not {what}: {:?}", StoredBus::look(&self.state()));
            thread::sleep(Duration::from_millis(5));
        }
    }

    /// The program with its LEDs on.
    fn lit(&self) -> Child {
        let child = self.command(&["--calibration", "light.toml", "luminance", "0.3"]).spawn().unwrap();
        self.until("lit", |module| module.lit);
        child
    }
}

impl Drop for Bench {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// Codes and currents of TI's DLPA2000 (DLPS043): 25 mA at 12 to 750 mA at 775; light in proportion, 1.8 cd/m2 at the top.
const CALIBRATION: &str = r#"
module = "dlpc2607"
id = 0x8A

[optics]
meter = "eyepiece"
fixed_nd = 1e-4
beam_splitter = 0.1

[[filter]]
name = "25 %"
transmission = 0.25

[[filter]]
name = "10 %"
transmission = 0.1

[[row]]
code = 12
cd_m2 = 0.06

[[row]]
code = 775
cd_m2 = 1.8
"#;

fn said(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn json(output: &Output) -> serde_json::Value {
    assert!(output.status.success(), "{}", said(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn a_luminance_becomes_currents_that_are_read_back_and_all_is_dark_at_the_end() {
    let bench = Bench::new("luminance");
    let output = bench.run(&["--calibration", "light.toml", "--json", "luminance", "0.3", "--for", "0.2"]);
    assert!(output.status.success(), "{}", said(&output.stderr));
    let told = json(&output);
    // (0.3 - 0.06) / (1.8 - 0.06) of the way from code 12 to 775: 117.2.
    assert_eq!(told["codes"], serde_json::json!([118, 118, 118]));
    assert_eq!(told["read_back_codes"], told["codes"]);
    assert!((told["predicted_cd_m2"].as_f64().unwrap() - 0.3).abs() < 1e-6);
    // 0.3 / 0.25 = 1.2 cd/m2 is what the module can do; 0.3 / 0.1 = 3 is not.
    assert_eq!(told["insert_filter"], "25 %");
    let module = bench.look();
    assert!(module.writes.contains(&"16 00 00 00 07".into()), "it was lit: {:?}", module.writes);
    assert_eq!((module.lit, module.led_current, module.curtain, module.parked), (false, [0; 3], true, true));
}

#[test]
fn whatever_ends_the_program_the_leds_are_off() {
    for signal in [Signal::INT, Signal::TERM, Signal::HUP, Signal::KILL] {
        let bench = Bench::new(&format!("signal-{signal:?}"));
        let mut child = bench.lit();
        kill_process(Pid::from_child(&child), signal).unwrap();
        child.wait().unwrap();
        let module = bench.until("dark", |module| !module.lit && module.parked);
        assert_eq!(module.led_current, [0; 3]);
    }
}

#[test]
fn a_killed_program_is_made_dark_by_the_off_command_as_systemd_would_run_it() {
    let bench = Bench::new("off");
    let mut module = FakeModule::new(Module::Dlpc2607, Faults::default());
    module.write(0x1B, &[0x16, 0, 0, 0, 7]).unwrap();
    assert!(module.lit);
    fs::write(bench.state(), serde_json::to_vec(&module).unwrap()).unwrap();
    // A broken settings file must not keep the light on.
    fs::create_dir_all(bench.folder.join("scotopic")).unwrap();
    fs::write(bench.folder.join("scotopic/settings.toml"), "light = nonsense").unwrap();
    let output = bench.run(&["off"]);
    assert!(output.status.success(), "{}", said(&output.stderr));
    assert!(!bench.look().lit && bench.look().parked);

    // As in the unit: everything from a settings file, which is wrong elsewhere.
    let config = bench.folder.join("unit.toml");
    fs::write(bench.state(), serde_json::to_vec(&module).unwrap()).unwrap();
    let light = format!("[light]\nmodule = \"dlpc2607\"\nbus = \"fake:{}\"\n", bench.state().display());
    fs::write(&config, format!("muont = 3\n{light}")).unwrap();
    let off = |config: &Path| {
        Command::new(env!("CARGO_BIN_EXE_scotopic"))
            .args(["projector", "off", "--config"])
            .arg(config)
            .output()
            .unwrap()
    };
    let output = off(&config);
    assert!(output.status.success(), "{}", said(&output.stderr));
    assert!(!bench.look().lit && bench.look().parked);
    fs::write(&config, "mount = \"sim\"\n").unwrap();
    assert!(off(&config).status.success(), "settings without a light have nothing to switch off");
}

#[test]
fn without_a_calibration_or_with_a_bad_one_nothing_is_written_to_the_module() {
    let bench = Bench::new("calibration");
    let falling = CALIBRATION.replace("cd_m2 = 1.8", "cd_m2 = 0.05");
    fs::write(bench.folder.join("falling.toml"), falling).unwrap();
    fs::write(bench.folder.join("misspelt.toml"), CALIBRATION.replace("fixed_nd", "fixed_dn")).unwrap();
    fs::write(bench.folder.join("other.toml"), CALIBRATION.replace("0x8A", "0x82")).unwrap();
    for (arguments, words) in [
        (&["luminance", "0.3"][..], "scotopic projector measure"),
        (&["--calibration", "none.toml", "luminance", "0.3"], "none.toml is not there"),
        (&["--calibration", "falling.toml", "luminance", "0.3"], "row 2 of the calibration is not monotone"),
        (
            &["--calibration", "misspelt.toml", "luminance", "0.3"],
            "line 7: 'fixed_dn' is not a setting: did you mean 'fixed_nd'?",
        ),
        (&["--calibration", "other.toml", "luminance", "0.3"], "id = 130"),
        (&["--calibration", "light.toml", "luminance", "0.02"], "0.02 cd/m2 cannot be asked: give 0.03 to 1.8"),
        (&["--calibration", "light.toml", "luminance", "1.9"], "1.9 cd/m2 cannot be asked"),
        (&["--calibration", "light.toml", "luminance", "nan"], "cannot be asked"),
        (&["--calibration", "light.toml", "--filter", "3 %", "luminance", "0.3"], "it has 25 %, 10 %"),
    ] {
        let output = bench.run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", said(&output.stderr));
        assert!(said(&output.stderr).contains(words), "{arguments:?}: {}", said(&output.stderr));
        assert!(!bench.state().exists(), "{arguments:?} opened the bus");
    }
}

#[test]
fn a_controller_of_another_kind_is_told_and_left_alone() {
    for arguments in [&["--calibration", "light.toml", "luminance", "0.3"][..], &["status"], &["off"]] {
        let bench = Bench::with_faults("other", Faults { id: Some(0x82), ..Faults::default() });
        let output = bench.run(arguments);
        assert_eq!(output.status.code(), Some(1));
        assert!(
            said(&output.stderr).contains("0x82") && said(&output.stderr).contains("DLPC2601"),
            "{}",
            said(&output.stderr)
        );
        assert!(bench.look().writes.is_empty());
    }
}

#[test]
fn currents_that_the_module_limits_are_told_and_nothing_is_lit() {
    let bench = Bench::with_faults("clamp", Faults { clamp: Some(100), ..Faults::default() });
    let output = bench.run(&["--calibration", "light.toml", "luminance", "0.3"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(said(&output.stderr).contains("asked for 118, read back 100"), "{}", said(&output.stderr));
    assert!(!bench.look().lit && !bench.look().writes.contains(&"16 00 00 00 07".into()));
}

#[test]
fn status_says_who_answers_and_writes_nothing() {
    let bench = Bench::new("status");
    let told = json(&bench.run(&["--json", "status"]));
    assert_eq!((&told["chip"], &told["lit"]), (&"DLPC2607".into(), &false.into()));
    let output = bench.run(&["status"]);
    assert!(said(&output.stdout).contains("identity 0x8A") && said(&output.stdout).contains("LEDs       off"));
    assert!(bench.look().writes.is_empty());
}

#[test]
fn a_session_lights_its_pictures_and_is_dark_at_its_end_and_when_it_is_killed() {
    for killed in [false, true] {
        let bench = Bench::new(if killed { "session-killed" } else { "session" });
        let light = format!(
            "projector = \"png:frames\"\n[light]\nmodule = \"dlpc2607\"\nbus = \"fake:{}\"\ncalibration = \"light.toml\"\n",
            bench.state().display()
        );
        fs::write(bench.folder.join("settings.toml"), light).unwrap();
        let mut session = Command::new(env!("CARGO_BIN_EXE_scotopic"))
            .args(["observe", "--headless", "--for", if killed { "600" } else { "8" }, "--config", "settings.toml"])
            .current_dir(&bench.folder)
            .env("HOME", &bench.folder)
            .env("XDG_DATA_DIRS", &bench.folder)
            .env("XDG_STATE_HOME", &bench.folder)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let lit = bench.until("lit", |module| module.lit);
        assert!(lit.led_current[0] >= 12 && lit.led_current[0] <= 118, "{lit:?}");
        if killed {
            kill_process(Pid::from_child(&session), Signal::KILL).unwrap();
        }
        session.wait().unwrap();
        bench.until("dark", |module| !module.lit && module.parked);
    }
}

/// Measures with these answers and gives what was saved, if it was.
fn measured(bench: &Bench, extra: &[&str], answers: &str) -> (Output, Option<Calibration>) {
    let file: &Path = &bench.folder.join("measured.toml");
    let mut child =
        bench.command(&[&["measure", "measured.toml"], extra].concat()).stdin(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(answers.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(!bench.look().lit && bench.look().parked, "dark at the end");
    (output, fs::read_to_string(file).ok().map(|text| Calibration::from_toml(&text).unwrap()))
}

#[test]
fn a_builder_is_led_through_the_measurement_and_the_saved_calibration_lights_the_module() {
    let bench = Bench::new("measure");
    // The third answer is a slip of the pen: refused, asked again. Then the next code is aimed right under the ceiling.
    let (output, saved) =
        measured(&bench, &["--nd", "10 %=0.1", "--codes", "12,40,400,775"], "0.06\nx\n0.05\n0.2\n1.78\n");
    assert!(output.status.success(), "{}", said(&output.stderr));
    let asked = said(&output.stderr);
    assert!(asked.contains("0.05 cd/m2 is no more than the 0.06 cd/m2 at code 12"), "{asked}");
    let rows: Vec<(u16, f64)> = saved.unwrap().sheet().rows.iter().map(|row| (row.code, row.cd_m2)).collect();
    // 40 x 1.8 / 0.2 x 0.99 = 356.4.
    assert_eq!(rows, [(12, 0.06), (40, 0.2), (356, 1.78)]);
    let output = bench.run(&["--calibration", "measured.toml", "--json", "luminance", "1.78", "--for", "0.1"]);
    assert_eq!(json(&output)["read_back_codes"], serde_json::json!([356, 356, 356]));
}

#[test]
fn a_measurement_that_is_broken_off_saves_nothing_that_cannot_be_used() {
    let bench = Bench::new("broken-off");
    let (output, saved) = measured(&bench, &[], "0.06\nend\n");
    assert_eq!((output.status.code(), saved), (Some(1), None));
    assert!(said(&output.stderr).contains("has 1 measured steps"), "{}", said(&output.stderr));
    // Brighter than the ceiling: not kept, and nothing brighter follows.
    let (output, saved) = measured(&bench, &["--codes", "12,18,27"], "0.06\n0.09\n3\n");
    assert!(said(&output.stderr).contains("above the ceiling of 1.8"), "{}", said(&output.stderr));
    assert_eq!(saved.unwrap().sheet().rows.len(), 2);
}
