//! INDI's own LX200 drivers against our simulated mount: somebody else's reading of the protocol, which is what makes this a
//! proof. What INDI says is asserted, on TCP and on a pty.
//!
//! Debian's `indi-bin` brings the drivers. Without it these tests pass and say that they skipped; with
//! `SCOTOPIC_DEMAND_INDI=1` they fail. `SCOTOPIC_KEEP_TRACES=1` keeps their recordings in `fixtures/traces/`.

#![expect(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

#[path = "indi/client.rs"]
mod client;
#[path = "indi/rig.rs"]
mod rig;

use std::time::Duration;

use client::Client;

/// Where the mount points at 2026-11-22T20:00:00Z from 49.26 N 7.04 E at azimuth 30, altitude 45 degrees: hours and degrees of
/// date, by ERFA (gst06a and ae2hd of pyerfa 2.0). The mount tracks, so it stays.
const START: (f64, f64) = (6.617_701, 69.294_646);
/// One step of right ascension in hours, and of declination in degrees, as the line carries them.
const STEP: (f64, f64) = (1.0 / 3600.0, 1.0 / 3600.0);

#[test]
fn indi_lx200gps_over_tcp() {
    session("indi_lx200gps", "tcp:127.0.0.1:0");
}

#[test]
fn indi_lx200gps_over_a_pty() {
    session("indi_lx200gps", "pty");
}

#[test]
fn indi_lx200classic_over_tcp() {
    session("indi_lx200classic", "tcp:127.0.0.1:0");
}

#[test]
fn indi_lx200classic_over_a_pty() {
    session("indi_lx200classic", "pty");
}

/// One evening: connect, look, go, stop, sync, set time and site.
fn session(driver: &str, listen: &str) {
    if !rig::installed("indiserver") || !rig::installed(driver) {
        assert!(std::env::var_os("SCOTOPIC_DEMAND_INDI").is_none(), "{driver} is not installed: apt install indi-bin");
        eprintln!("SKIPPED: {driver} is not installed (apt install indi-bin)");
        return;
    }
    let name = format!("{driver}-{}", listen.split(':').next().unwrap());
    let folder = rig::folder(&name);
    let trace = folder.join(format!("{name}.jsonl"));
    let (simulator, endpoint) = rig::simulator(listen, &trace);
    let (server, port) = rig::indiserver(driver, &folder.join("home"));
    let mut indi = Client::connect(port);

    connect(&mut indi, &endpoint);
    reads_the_start(&mut indi);
    goes_to(&mut indi, 2.0, 41.5);
    if listen == "pty" {
        is_refused_below_the_horizon(&mut indi);
    }
    aborts(&mut indi);
    syncs(&mut indi);
    sets_the_site(&mut indi);
    sets_the_time(&mut indi);
    indi.switch("CONNECTION", "DISCONNECT");
    indi.wait("the disconnection", |indi| indi.is_on("CONNECTION", "DISCONNECT"));
    drop(indi);
    drop(server);
    the_mount_took_them(driver, &endpoint);
    assert_eq!(simulator.end(), Some(0), "the simulator ends cleanly when it is told to");
    keep(&trace, driver, listen);
}

fn connect(indi: &mut Client, endpoint: &str) {
    match endpoint.strip_prefix("tcp:127.0.0.1:") {
        Some(port) => {
            indi.switch("CONNECTION_MODE", "CONNECTION_TCP");
            indi.wait("the choice of TCP", |indi| indi.state("DEVICE_ADDRESS") != "not defined");
            indi.texts("DEVICE_ADDRESS", &[("ADDRESS", "127.0.0.1"), ("PORT", port)]);
            indi.wait("the address", |indi| indi.state("DEVICE_ADDRESS") == "Ok");
        }
        None => {
            indi.switch("CONNECTION_MODE", "CONNECTION_SERIAL");
            indi.wait("the choice of a serial port", |indi| indi.state("DEVICE_AUTO_SEARCH") != "not defined");
            // It is to open this port and to try no other.
            indi.switch("DEVICE_AUTO_SEARCH", "INDI_DISABLED");
            indi.texts("DEVICE_PORT", &[("PORT", endpoint)]);
            indi.wait("the port", |indi| {
                indi.text("DEVICE_PORT", "PORT") == Some(endpoint) && indi.state("DEVICE_PORT") == "Ok"
            });
        }
    }
    indi.switch("CONNECTION", "CONNECT");
    indi.wait("the connection", |indi| indi.state("CONNECTION") == "Ok" && indi.is_on("CONNECTION", "CONNECT"));
}

fn ra(indi: &Client) -> f64 {
    indi.number("EQUATORIAL_EOD_COORD", "RA")
}

fn dec(indi: &Client) -> f64 {
    indi.number("EQUATORIAL_EOD_COORD", "DEC")
}

/// Whether INDI says that the telescope points there, to one step of the line.
fn points_at(indi: &Client, (hours, degrees): (f64, f64)) -> bool {
    (ra(indi) - hours).abs() < 1.01 * STEP.0 && (dec(indi) - degrees).abs() < 1.01 * STEP.1
}

fn reads_the_start(indi: &mut Client) {
    indi.wait("the coordinates that ERFA gives", |indi| points_at(indi, START));
    indi.wait("the site", |indi| (indi.number("GEOGRAPHIC_COORD", "LAT") - 49.26).abs() < 1e-4);
    // INDI 1.9.9 negates the mount's 0 to 360 degrees west: -352.96 is 7.04 east.
    let east = indi.number("GEOGRAPHIC_COORD", "LONG").rem_euclid(360.0);
    assert!((east - 7.04).abs() < 1e-4, "INDI says longitude {east}");
    indi.wait("the clock", |indi| indi.text("TIME_UTC", "UTC").is_some_and(|utc| utc.starts_with("2026-11-22T20:0")));
    assert_eq!(indi.number("TIME_UTC", "OFFSET"), 0.0);
}

/// Orders a go-to.
fn go(indi: &mut Client, hours: f64, degrees: f64) {
    indi.switch("ON_COORD_SET", "TRACK");
    indi.wait("the choice of tracking", |indi| indi.is_on("ON_COORD_SET", "TRACK"));
    indi.numbers("EQUATORIAL_EOD_COORD", &[("RA", hours), ("DEC", degrees)]);
}

fn goes_to(indi: &mut Client, hours: f64, degrees: f64) {
    go(indi, hours, degrees);
    indi.wait("the slew", |indi| indi.state("EQUATORIAL_EOD_COORD") == "Busy");
    assert!(!points_at(indi, (hours, degrees)), "it takes time to get there");
    indi.wait("the arrival", |indi| indi.state("EQUATORIAL_EOD_COORD") == "Ok");
    indi.wait("the target's coordinates", |indi| points_at(indi, (hours, degrees)));
}

/// Only on a pty. INDI 1.9.9 reads one character of the answer `1Object Below Horizon#` and flushes the rest with `tcflush`,
/// which does nothing on a TCP socket: there it takes the rest for the next coordinates, and from then on right ascension for
/// declination (the swap of indilib/indi issue 999). The text belongs to the answer, so the simulator keeps sending it.
fn is_refused_below_the_horizon(indi: &mut Client) {
    let before = (ra(indi), dec(indi));
    go(indi, 14.6, -60.8);
    indi.wait("the refusal", |indi| indi.state("EQUATORIAL_EOD_COORD") == "Alert");
    indi.listen(Duration::from_secs(2));
    assert!(points_at(indi, before), "it stays at {before:?}: {} {}", ra(indi), dec(indi));
}

fn aborts(indi: &mut Client) {
    go(indi, START.0, START.1);
    indi.wait("the slew", |indi| indi.state("EQUATORIAL_EOD_COORD") == "Busy" && !points_at(indi, (2.0, 41.5)));
    indi.switch("TELESCOPE_ABORT_MOTION", "ABORT");
    indi.wait("the abort", |indi| indi.state("TELESCOPE_ABORT_MOTION") == "Ok");
    indi.listen(Duration::from_secs(4));
    let stopped = (ra(indi), dec(indi));
    assert_ne!(indi.state("EQUATORIAL_EOD_COORD"), "Busy");
    assert!(!points_at(indi, START), "it was stopped on the way");
    indi.listen(Duration::from_secs(3));
    assert!(points_at(indi, stopped), "it tracks where it was stopped: {stopped:?}, {} {}", ra(indi), dec(indi));
}

fn syncs(indi: &mut Client) {
    let target = ((ra(indi) * 3600.0).round() / 3600.0 + 20.0 / 3600.0, (dec(indi) * 3600.0).round() / 3600.0 - 0.05);
    indi.switch("ON_COORD_SET", "SYNC");
    indi.wait("the choice of syncing", |indi| indi.is_on("ON_COORD_SET", "SYNC"));
    indi.numbers("EQUATORIAL_EOD_COORD", &[("RA", target.0), ("DEC", target.1)]);
    indi.wait("the sync", |indi| indi.state("EQUATORIAL_EOD_COORD") == "Ok");
    indi.listen(Duration::from_secs(2));
    assert!(points_at(indi, target), "it believes the sync {target:?}: {} {}", ra(indi), dec(indi));
}

fn sets_the_site(indi: &mut Client) {
    indi.numbers("GEOGRAPHIC_COORD", &[("LAT", -24.6), ("LONG", 289.6), ("ELEV", 2635.0)]);
    indi.wait("the site", |indi| indi.state("GEOGRAPHIC_COORD") == "Ok");
    assert!((indi.number("GEOGRAPHIC_COORD", "LAT") + 24.6).abs() < 1e-4);
    assert!((indi.number("GEOGRAPHIC_COORD", "LONG") - 289.6).abs() < 1e-4);
}

fn sets_the_time(indi: &mut Client) {
    indi.texts("TIME_UTC", &[("UTC", "2027-03-04T01:30:00"), ("OFFSET", "-3")]);
    indi.wait("the time", |indi| indi.state("TIME_UTC") == "Ok");
    assert_eq!(indi.text("TIME_UTC", "UTC"), Some("2027-03-04T01:30:00"));
    assert_eq!(indi.number("TIME_UTC", "OFFSET"), -3.0);
}

/// What the mount itself says after INDI has set it: 24.6 degrees south, 70.4 west, 22:30 in the evening, three hours to add.
///
/// The date is the disputed one: in that local evening it is already tomorrow in UTC. INDI's `lx200gps` sends the date of UTC
/// with the time of the place, its `lx200classic` both of the place.
fn the_mount_took_them(driver: &str, endpoint: &str) {
    assert_eq!(rig::ask(endpoint, b":Gt#:Gg#:GG#"), "-24\u{FFFD}36:00#070\u{FFFD}24:00#+03#");
    let date = if driver == "indi_lx200gps" { "03/04/27#" } else { "03/03/27#" };
    assert_eq!(rig::ask(endpoint, b":GC#"), date);
    let time = rig::ask(endpoint, b":GL#");
    assert!(time.starts_with("22:30:"), "the mount says {time}");
}

/// Keeps the recording as a fixture when that is asked for, its header saying who spoke.
fn keep(trace: &std::path::Path, driver: &str, listen: &str) {
    if std::env::var_os("SCOTOPIC_KEEP_TRACES").is_none() {
        return;
    }
    let text = std::fs::read_to_string(trace).unwrap();
    let who = format!("{driver} of INDI 1.9.9 over {}", listen.split(':').next().unwrap());
    let text = text.replacen("a client", &who, 1);
    let kept = std::path::Path::new("fixtures/traces").join(trace.file_name().unwrap());
    std::fs::create_dir_all("fixtures/traces").unwrap();
    std::fs::write(kept, text).unwrap();
}
