//! What the rig is made of, and what it lacks.

use std::fs;
use std::path::Path;

use scotopic::cli::rig::Rig;
use serde_json::json;

use super::report::Report;

/// Writes down the machine, the versions, and every port with its adapter.
pub(crate) fn take(rig: &Rig, report: &mut Report) {
    report.inventory("rig", rig.name.clone());
    if !rig.note.is_empty() {
        report.inventory("note", rig.note.clone());
    }
    let built = if std::env::var_os("SCOTOPIC_RIG_PROGRAM").is_some() { "as named" } else { "built for tests" };
    let path = super::program::path();
    report.inventory("program", format!("scotopic {}, {built}: {}", env!("CARGO_PKG_VERSION"), path.display()));
    let kernel = fs::read_to_string("/proc/sys/kernel/osrelease").unwrap_or_default();
    report.inventory("kernel", format!("Linux {}", kernel.trim()));
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let load = fs::read_to_string("/proc/loadavg").unwrap_or_default();
    report.inventory("machine", format!("{} cores, load {}", cores, load.split(' ').next().unwrap_or_default()));
    let crates: Vec<String> =
        ["serialport", "rppal", "i2cdev", "drm", "evdev"].iter().filter_map(|name| version(name)).collect();
    report.inventory("crates", crates.join(", "));
    for (what, port) in rig.ports() {
        report.inventory(&format!("port of the {what}"), json!(adapter(port)));
    }
}

/// The version of a crate in Cargo.lock.
fn version(name: &str) -> Option<String> {
    let lock: toml::Table = fs::read_to_string("Cargo.lock").ok()?.parse().ok()?;
    let packages = lock.get("package")?.as_array()?;
    let package = packages.iter().find(|package| package.get("name").and_then(toml::Value::as_str) == Some(name))?;
    Some(format!("{name} {}", package.get("version")?.as_str()?))
}

/// A port's adapter as the kernel knows it: vendor, product, serial number, driver, latency timer.
fn adapter(port: &str) -> String {
    let Ok(device) = fs::canonicalize(port) else { return format!("{port}: not there") };
    let name = device.file_name().and_then(|name| name.to_str()).unwrap_or_default().to_owned();
    let class = Path::new("/sys/class/tty").join(&name).join("device");
    let driver = fs::canonicalize(class.join("driver")).ok();
    let driver = driver.as_deref().and_then(Path::file_name).and_then(|name| name.to_str()).unwrap_or("no driver");
    let read = |file: &str| {
        let mut folder = fs::canonicalize(&class).ok()?;
        for _ in 0..4 {
            if let Ok(text) = fs::read_to_string(folder.join(file)) {
                return Some(text.trim().to_owned());
            }
            folder = folder.parent()?.to_owned();
        }
        None
    };
    let told = |file: &str| read(file).unwrap_or_else(|| "?".into());
    format!(
        "{port} -> {} ({driver}, {}:{}:{}, latency timer {} ms)",
        device.display(),
        told("idVendor"),
        told("idProduct"),
        told("serial"),
        told("latency_timer")
    )
}

/// Names each check that this rig cannot make.
pub(crate) fn name_what_is_missing(rig: &Rig, report: &mut Report) {
    let why = |what: &str| format!("the rig '{}' has no {what}: name it in the rig file (hil/README.md)", rig.name);
    let slewing = "real mount, slew and stop with a person at the switch";
    if rig.mount.is_none() {
        report.not_run("mount", "real mount, motors off", &why("mount"));
        report.not_run("mount", slewing, &why("mount with motors"));
    } else {
        report.not_run("mount", slewing, "done by hand: hil/procedures/mount.md");
    }
    if rig.null_modem.is_none() {
        report.not_run("mount", "two adapters and a null-modem cable", &why("null modem"));
    } else {
        report.not_run("mount", "an adapter pulled and replugged", "done by hand: hil/procedures/null-modem.md");
    }
    if rig.tap.is_none() {
        report.not_run("tap", "real hand controller's cable", &why("tap"));
    }
    let light = "real light module over I2C, brightness read back";
    if rig.projector.is_none() {
        report.not_run("projector", light, &why("projector"));
    } else {
        report.not_run("projector", light, "done by hand with `scotopic projector status`: docs/hardware/light.md");
    }
    report.not_run(
        "projector",
        "KMS page flips on a real kernel (vkms)",
        "an optional job under QEMU: hil/procedures/vkms.md",
    );
}
