//! What is installed is what the unit, the rules and the documents speak of: everything is put into a folder by the real
//! `install.sh`, and held against the program's own `--help`.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::os::unix::net::UnixDatagram;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use rustix::process::{Pid, Signal, kill_process};

const PROGRAM: &str = env!("CARGO_BIN_EXE_scotopic");
const MOUNT: &str = "0403:6001:A50285BI";
const HANDBOX: &str = "067b:2303:HC-17";

/// A folder that does not outlive its test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("scotopic-packaging-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    fn read(&self, file: &str) -> String {
        fs::read_to_string(self.0.join(file.trim_start_matches('/'))).unwrap()
    }

    fn files(&self) -> BTreeSet<String> {
        let (mut found, mut folders) = (BTreeSet::new(), vec![self.0.clone()]);
        while let Some(folder) = folders.pop() {
            for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
                if path.is_dir() {
                    folders.push(path);
                } else {
                    found.insert(format!("/{}", path.strip_prefix(&self.0).unwrap().display()));
                }
            }
        }
        found
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // A folder that stays is in the way of nobody.
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn install(folder: &Folder, options: &[&str]) -> Output {
    Command::new("packaging/install.sh").args(options).env("DESTDIR", &folder.0).env_remove("PREFIX").output().unwrap()
}

fn installed(name: &str, options: &[&str]) -> (Folder, String) {
    let folder = Folder::new(name);
    let output = install(&folder, &[&["--program", PROGRAM], options].concat());
    assert!(output.status.success(), "{output:?}");
    (folder, String::from_utf8(output.stdout).unwrap())
}

const UNIT: &str = "/etc/systemd/system/scotopic.service";
const RULES: &str = "/etc/udev/rules.d/70-scotopic.rules";
const SETTINGS: &str = "/etc/scotopic/settings.toml";

/// The values of a key of the unit.
fn values<'a>(unit: &'a str, key: &str) -> Vec<&'a str> {
    unit.lines().filter_map(|line| line.strip_prefix(key)?.strip_prefix('=')).collect()
}

#[test]
fn every_file_is_where_it_is_looked_for_and_says_what_is_left_to_do() {
    let (folder, said) = installed("files", &[]);
    let expected = [
        "/etc/scotopic/settings.toml",
        "/etc/systemd/system/scotopic.service",
        "/etc/sysusers.d/scotopic.conf",
        "/etc/udev/rules.d/70-scotopic.rules",
        "/usr/local/bin/scotopic",
        "/usr/local/share/doc/scotopic/installing.md",
        "/usr/local/share/doc/scotopic/settings.example.toml",
    ];
    assert_eq!(folder.files(), expected.map(str::to_owned).into());
    assert!(expected.iter().all(|file| said.contains(file)), "{said}");
    assert!(said.contains("Left to you:") && said.contains("handbox learn"), "{said}");
    for file in folder.files() {
        let mode = fs::metadata(folder.0.join(&file[1..])).unwrap().permissions().mode() & 0o7777;
        assert_eq!(mode, if file.contains("/bin/") { 0o755 } else { 0o644 }, "{file}");
    }
}

#[test]
fn every_option_in_the_unit_is_one_that_the_program_has() {
    let (folder, _) = installed("options", &[]);
    let unit = folder.read(UNIT);
    let commands: Vec<&str> = ["ExecStart", "ExecStopPost"].iter().flat_map(|key| values(&unit, key)).collect();
    assert_eq!(commands.len(), 3, "{commands:?}");
    for command in commands {
        let mut words = command.trim_start_matches('-').split(' ');
        let program = words.next().unwrap();
        assert!(folder.files().contains(program), "{program}");
        let words: Vec<&str> = words.collect();
        // The subcommands are the words that are neither options nor what follows one with a value.
        let mut asked = Command::new(PROGRAM);
        let mut value = false;
        for word in &words {
            match word.strip_prefix("--") {
                Some(_) => value = true,
                None if !value => drop(asked.arg(word)),
                None => value = false,
            }
        }
        let help = asked.arg("--help").output().unwrap();
        let help = String::from_utf8(help.stdout).unwrap();
        for option in words.iter().filter(|word| word.starts_with("--")) {
            assert!(help.contains(option), "{option} of '{command}' is not in the program's help:\n{help}");
        }
    }
}

#[test]
fn the_service_dies_dark_starts_again_with_a_cap_and_has_no_rights() {
    let (folder, _) = installed("unit", &[]);
    let unit = folder.read(UNIT);
    for line in [
        "Type=notify",
        "Restart=on-failure",
        "RestartPreventExitStatus=2",
        "User=scotopic",
        "SupplementaryGroups=dialout i2c video input",
        "NoNewPrivileges=yes",
        "CapabilityBoundingSet=",
        "ProtectSystem=strict",
        "DevicePolicy=closed",
        "KillMode=mixed",
    ] {
        assert!(unit.lines().any(|l| l == line), "{line} is missing");
    }
    let number = |key: &str| values(&unit, key)[0].parse::<u32>().unwrap();
    assert!((1..=10).contains(&number("WatchdogSec")));
    assert!((1..=10).contains(&number("StartLimitBurst")), "restarts without a cap");
    assert!(number("StartLimitIntervalSec") > number("StartLimitBurst") * number("RestartSec"), "a cap never reached");
    let stops = values(&unit, "ExecStopPost");
    assert!(stops[0].contains(" projector ") && stops[0].ends_with(" off"), "first the light: {stops:?}");
    assert!(stops[1].contains(" mount stop "), "then the mount: {stops:?}");
    assert!(!unit.contains('@') || unit.contains("modprobe@") && !unit.contains("@PREFIX@"));
}

#[test]
fn the_rules_name_each_adapter_by_its_serial_number_and_open_it_to_no_stranger() {
    let (folder, _) = installed("rules", &["--mount", MOUNT, "--handbox", HANDBOX]);
    let rules = folder.read(RULES);
    let rules: Vec<&str> = rules.lines().filter(|line| !line.starts_with('#') && line.contains("idVendor")).collect();
    assert_eq!(rules.len(), 6);
    for rule in &rules {
        let one_of = |ids: [&str; 3]| {
            ["idVendor", "idProduct", "serial"].iter().zip(ids).all(|(key, id)| {
                rule.contains(&format!("ATTR{{{key}}}==\"{id}\""))
                    || rule.contains(&format!("ATTRS{{{key}}}==\"{id}\""))
            })
        };
        assert!(one_of(["0403", "6001", "A50285BI"]) != one_of(["067b", "2303", "HC-17"]), "{rule}");
    }
    let all = rules.join("\n");
    for what in [r#"SYMLINK+="scotopic-mount""#, r#"SYMLINK+="scotopic-handbox""#] {
        let rule = rules.iter().find(|rule| rule.contains(what)).unwrap();
        for part in [r#"GROUP="dialout""#, r#"MODE="0660""#, r#"TAG+="uaccess""#, r#"ENV{ID_MM_DEVICE_IGNORE}="1""#] {
            assert!(rule.contains(part), "{what} without {part}");
        }
    }
    assert_eq!(all.matches(r#"ATTR{latency_timer}="1""#).count(), 2);
    let text = folder.read(RULES);
    let modes: Vec<&str> = text.split("MODE=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert!(!modes.is_empty() && modes.iter().all(|mode| mode.ends_with('0')), "world may open: {modes:?}");
}

#[test]
fn rules_that_nobody_has_filled_in_match_no_device() {
    let (folder, said) = installed("unfilled", &[]);
    let text = folder.read(RULES);
    let rules = text.lines().filter(|line| !line.starts_with('#') && line.contains("idVendor"));
    // Serial numbers are in the rule as capital words with an underscore, which no adapter's vendor number is.
    assert!(rules.clone().count() == 6 && rules.clone().all(|rule| rule.contains("_VID\"")));
    assert!(said.contains("udevadm info"), "{said}");
}

#[test]
fn what_a_person_has_edited_is_never_overwritten() {
    let (folder, _) = installed("edited", &["--mount", MOUNT]);
    for file in [SETTINGS, RULES] {
        fs::write(folder.0.join(&file[1..]), "# mine\n").unwrap();
    }
    let again = install(&folder, &["--program", PROGRAM]);
    assert!(again.status.success(), "{again:?}");
    let said = String::from_utf8(again.stdout).unwrap();
    for file in [SETTINGS, RULES] {
        assert_eq!(folder.read(file), "# mine\n");
        assert!(said.contains(&format!("{file} is yours and stays")), "{said}");
    }
}

#[test]
fn uninstalling_leaves_the_settings_and_purging_leaves_nothing() {
    let (folder, _) = installed("uninstalled", &["--mount", MOUNT]);
    assert!(install(&folder, &["--uninstall"]).status.success());
    assert_eq!(folder.files(), [SETTINGS.to_owned()].into());
    assert!(install(&folder, &["--uninstall", "--purge"]).status.success());
    assert_eq!(folder.files(), BTreeSet::new());
}

#[test]
fn what_is_no_adapter_is_refused_and_nothing_is_installed() {
    let folder = Folder::new("refused");
    for options in [
        ["--mount", "0403:6001"],
        ["--mount", "ttyUSB0"],
        ["--handbox", "0403:6001:X\", MODE=\"0666"],
        ["--handbox", "0403:6001:a b"],
        ["--mount", "0403:6001:"],
        ["--frobnicate", "x"],
    ] {
        let output = install(&folder, &[&["--program", PROGRAM], &options[..]].concat());
        assert_eq!(output.status.code(), Some(2), "{options:?}: {output:?}");
        assert!(String::from_utf8_lossy(&output.stderr).starts_with("install.sh: "), "{output:?}");
    }
    let twice = install(&folder, &["--program", PROGRAM, "--mount", MOUNT, "--handbox", MOUNT]);
    assert!(String::from_utf8_lossy(&twice.stderr).contains("same adapter"), "{twice:?}");
    assert_eq!(folder.files(), BTreeSet::new());
}

#[test]
fn the_service_reads_its_settings() {
    let (folder, _) = installed("settings", &[]);
    let text = folder.read(SETTINGS);
    let all: String =
        text.lines().map(|line| line.strip_prefix("#! ").unwrap_or(line)).fold(String::new(), |all, l| all + l + "\n");
    for text in [&text, &all] {
        let settings = scotopic::cli::settings::Settings::from_toml(text).unwrap();
        assert_eq!(settings.mount.unwrap().to_string(), "serial:/dev/scotopic-mount");
    }
}

/// A process that does not outlive its test.
struct Ended(Child);

impl Drop for Ended {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn the_service_as_installed_waits_for_its_adapters_feeds_the_watchdog_and_ends_when_asked() {
    let (folder, _) = installed("service", &[]);
    let socket = folder.0.join("notify");
    let manager = UnixDatagram::bind(&socket).unwrap();
    manager.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
    let unit = folder.read(UNIT);
    let words = values(&unit, "ExecStart")[0].replace(SETTINGS, folder.0.join(&SETTINGS[1..]).to_str().unwrap());
    let home = folder.0.join("var");
    let child = Command::new(PROGRAM)
        .args(words.split(' ').skip(1))
        .env("NOTIFY_SOCKET", &socket)
        .env("WATCHDOG_USEC", "1000000")
        .envs(["HOME", "XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_DATA_DIRS"].map(|name| (name, &home)))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut child = Ended(child);
    let mut heard = Vec::new();
    let mut told = |what: &str, times: usize| {
        while heard.iter().filter(|line: &&String| line.as_str() == what).count() < times {
            let mut bytes = [0; 4096];
            let count = manager.recv(&mut bytes).unwrap_or_else(|error| panic!("no {what} ({error}): {heard:?}"));
            heard.extend(String::from_utf8_lossy(&bytes[..count]).lines().map(str::to_owned));
        }
    };
    told("READY=1", 1);
    told("WATCHDOG=1", 3);
    kill_process(Pid::from_child(&child.0), Signal::TERM).unwrap();
    // It ends by itself, and says that no mount was ever heard.
    assert_eq!(child.0.wait().unwrap().code(), Some(1));
}

/// Runs another project's checker, if this machine has it.
fn checker(program: &str, arguments: &[&str]) -> Option<Output> {
    let output = Command::new(program).args(arguments).output();
    if output.is_err() {
        eprintln!("not run: {program} is not on this machine");
    }
    output.ok()
}

#[test]
fn systemd_and_shellcheck_find_no_fault_where_they_are_installed() {
    let (folder, _) = installed("checked", &[]);
    // systemd wants the program where the unit says that it is.
    let unit = folder.0.join("scotopic.service");
    fs::write(&unit, folder.read(UNIT).replace("/usr/local/bin/scotopic", PROGRAM)).unwrap();
    let unit = unit.to_str().unwrap();
    if let Some(output) = checker("systemd-analyze", &["verify", "--man=no", unit]) {
        let said = String::from_utf8_lossy(&output.stderr);
        let ours: Vec<&str> = said.lines().filter(|line| line.contains("scotopic")).collect();
        assert!(ours.is_empty(), "{said}");
        let rated = checker("systemd-analyze", &["security", "--offline=true", "--threshold=30", unit]).unwrap();
        assert!(rated.status.success(), "{}", String::from_utf8_lossy(&rated.stdout));
    }
    let scripts = ["packaging/install.sh", "fuzz/run.sh", "fuzz/keep.sh"];
    assert!(scripts.iter().all(|script| Path::new(script).exists()));
    if let Some(output) = checker("shellcheck", &scripts) {
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
    }
}
