//! Our driver against our simulated mount, over a cable inside the test and in virtual time.
//!
//! Both ends were written from one reading of the protocol: these tests prove that they agree, and what each does with a bad
//! line; they prove nothing about the instrument. The proof from outside is `tests/indi.rs` (INDI's own drivers) and the
//! captured bytes of a real LX200GPS in the unit tests of both ends.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "conversation/cases.rs"]
mod cases;
#[path = "conversation/table.rs"]
mod table;

use std::time::Duration;

use proptest::prelude::*;
use scotopic::hw::mount::belief::{Aligned, LinkState, Mounting, Precision, Tracking};
use scotopic::hw::mount::order::{Direction, Key, Order, Rate, Report};
use scotopic::hw::mount::sim::fault::TABLE;
use scotopic::hw::mount::sim::settings::Settings;
use scotopic::sky::coords::{Equatorial, OfDate};
use scotopic::sky::site::Site;
use scotopic::units::Angle;

use table::Table;

#[test]
fn it_connects_and_reads_everything_as_the_mount_has_it() {
    let mut table = Table::new(Settings::default());
    table.run(6.0);
    let belief = table.belief();
    assert_eq!(belief.link, LinkState::Ready);
    assert_eq!(belief.product.confirmed().map(String::as_str), Some("LX2001"));
    assert_eq!(belief.firmware.confirmed().map(String::as_str), Some("4.2l"));
    assert_eq!(belief.precision.confirmed(), Some(&Precision::Long));
    let alignment = belief.alignment.confirmed().unwrap();
    assert_eq!((alignment.mounting, alignment.tracking), (Mounting::AltAz, Tracking::On));
    assert_eq!(alignment.aligned, Aligned::Stars(2));
    let site = belief.site.confirmed().unwrap();
    assert!((site.latitude.to_degrees() - 49.26).abs() < 1e-3 && (site.longitude.to_degrees() - 7.04).abs() < 1e-3);
    let clock = belief.clock.confirmed().unwrap();
    assert_eq!(clock.offset_hours, 1.0);
    assert!((clock.utc.0 - Settings::default().start.0).abs() < 8.0);
    assert!(belief.sidereal.confirmed().is_some());
    assert!(table.off_by_arcsec() < 16.0, "one step of right ascension is 15 arcseconds");
    assert!(!table.said(|report| matches!(report, Report::Fault(_) | Report::Disagreement(_))), "{:?}", table.reports);
}

#[test]
fn a_goto_arrives_where_it_was_sent() {
    let mut table = Table::ready(Settings::default());
    let target = table.above(60.0, 20.0);
    table.order(Order::Goto(target));
    table.run(40.0);
    assert!(table.said(|report| matches!(report, Report::SlewStarted)));
    assert!(table.said(|report| matches!(report, Report::Arrived { off_by } if off_by.to_arcseconds() < 20.0)));
    assert!(table.reported().separation(&target).to_arcseconds() < 16.0);
    assert!(!table.said(|report| matches!(report, Report::Fault(_))), "{:?}", table.reports);
}

#[test]
fn below_the_horizon_the_mounts_own_words_come_back() {
    let mut table = Table::ready(Settings::default());
    let before = table.reported();
    table.order(Order::Goto(Equatorial::new(Angle::hours(14.6), Angle::degrees(-60.8))));
    table.run(5.0);
    assert!(table.said(|report| matches!(report, Report::GotoRefused { reason } if reason.contains("Below Horizon"))));
    assert!(table.reported().separation(&before).to_arcseconds() < 2.0);
    assert!(!table.said(|report| matches!(report, Report::Fault(_))), "{:?}", table.reports);
}

#[test]
fn a_stop_overtakes_a_slew_and_is_seen_to_be_obeyed() {
    let mut table = Table::ready(Settings::default());
    let target = table.above(150.0, 10.0);
    table.order(Order::Goto(target));
    table.run(2.5);
    assert!(table.fastest_axis() > 5.0);
    table.order(Order::Stop);
    table.run(2.6);
    assert!(table.fastest_axis() < 0.1, "{} degrees a second", table.fastest_axis());
    table.run(5.0);
    assert!(table.said(|report| matches!(report, Report::Stopped)));
    assert!(!table.said(|report| matches!(report, Report::Arrived { .. })));
    assert!(table.reported().separation(&target).to_degrees() > 2.0);
    assert!(table.off_by_arcsec() < 16.0);
}

#[test]
fn a_sync_is_believed_by_both() {
    let mut table = Table::ready(Settings::default());
    let here = table.reported();
    let star = Equatorial::new(here.ra() + Angle::arcminutes(30.0), here.dec() - Angle::arcminutes(6.0));
    table.order(Order::Sync(star));
    table.run(4.0);
    assert!(table.said(|report| matches!(report, Report::Synced { reply } if reply.contains("M31"))));
    assert!(table.reported().separation(&star).to_arcseconds() < 10.0);
    assert!(table.off_by_arcsec() < 16.0);
}

#[test]
fn a_site_is_set_and_read_back() {
    let mut table = Table::ready(Settings::default());
    table.order(Order::SetSite(Site::new(-24.6, -70.4, 2635.0).unwrap()));
    table.run(10.0);
    assert!(table.said(|report| matches!(report, Report::SiteSet)), "{:?}", table.reports);
    let site = *table.belief().site.confirmed().unwrap();
    assert!((site.latitude.to_degrees() + 24.6).abs() < 0.02 && (site.longitude.to_degrees() + 70.4).abs() < 0.02);
}

#[test]
fn a_wrong_clock_is_set_right_and_agrees_afterwards() {
    let mut settings = Settings::default();
    settings.faults.switch("clock-error=5000").unwrap();
    let start = settings.start;
    let mut table = Table::ready(settings);
    assert!(!table.belief().decision.as_ref().unwrap().disagreements.is_empty());
    table.order(Order::SetClock(start.plus_seconds(table.now.as_secs_f64()), 2.0));
    table.run(30.0);
    assert!(table.said(|report| matches!(report, Report::ClockSet)), "{:?}", table.reports);
    assert_eq!(table.belief().clock.confirmed().unwrap().offset_hours, 2.0);
    assert!(table.belief().decision.as_ref().unwrap().disagreements.is_empty());
}

#[test]
fn a_move_by_hand_ends_with_its_key_or_by_itself() {
    let mut table = Table::ready(Settings::default());
    table.order(Order::Move(Direction::North, Rate::Find));
    table.run(0.6);
    assert!(table.fastest_axis() > 0.5);
    table.order(Order::MoveEnd(Direction::North));
    table.run(2.0);
    assert!(table.fastest_axis() < 0.1);
    table.order(Order::Move(Direction::North, Rate::Find));
    table.run(5.0);
    assert!(table.fastest_axis() < 0.1, "nobody renewed it");
    assert!(table.said(|report| matches!(report, Report::MoveBounded(Direction::North))));
}

#[test]
fn the_hand_controller_is_read_and_its_keys_are_pressed() {
    let mut table = Table::ready(Settings::default());
    table.order(Order::ReadDisplay);
    table.run(2.0);
    assert_eq!(table.belief().display.confirmed().unwrap().bottom.trim(), "Object");
    table.order(Order::PressKey(Key::Down));
    table.order(Order::ReadDisplay);
    table.run(2.0);
    assert_eq!(table.belief().display.confirmed().unwrap().bottom.trim(), "Event");
    table.order(Order::PressKey(Key::Help));
    table.order(Order::ReadDisplay);
    table.run(3.0);
    assert!(table.belief().display.confirmed().unwrap().bottom.len() > 200, "help is one long line");
}

#[test]
fn every_fault_has_its_expected_outcome() {
    let tried: Vec<&str> = cases::CASES.iter().map(|case| case.fault.split('=').next().unwrap()).collect();
    let untried: Vec<&str> = TABLE.iter().map(|entry| entry.name).filter(|name| !tried.contains(name)).collect();
    assert!(untried.is_empty(), "faults without an expected outcome: {untried:?}");
    let wrong: Vec<String> = cases::CASES.iter().filter_map(cases::Case::try_it).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_slew_is_taken_up_again_after_the_line_was_lost() {
    let mut settings = Settings::default();
    settings.faults.switch("unplug-at=:MS").unwrap();
    let mut table = Table::ready(settings);
    table.order(Order::Goto(table.above(150.0, 10.0)));
    table.run(30.0);
    assert!(table.said(|report| matches!(report, Report::Lost(_))));
    assert_eq!(table.belief().link, LinkState::Ready);
    assert!(!table.belief().slewing_by_order());
    assert!(table.belief().counters.slews <= 1);
}

/// Orders that a session might give.
fn orders() -> impl Strategy<Value = Order> {
    let place = (0.0..24.0f64, -90.0..90.0f64)
        .prop_map(|(ra, dec)| Equatorial::<OfDate>::new(Angle::hours(ra), Angle::degrees(dec)));
    prop_oneof![
        3 => place.clone().prop_map(Order::Goto),
        3 => Just(Order::Stop),
        1 => place.prop_map(Order::Sync),
        1 => prop::sample::select(Direction::ALL.to_vec()).prop_map(|way| Order::Move(way, Rate::Slew)),
        1 => prop::sample::select(Direction::ALL.to_vec()).prop_map(Order::MoveEnd),
        1 => Just(Order::ReadDisplay),
        1 => Just(Order::PressKey(Key::Help)),
        1 => Just(Order::Compare),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Whatever is ordered over whatever line: nothing panics or hangs, a stale position is never shown as live, and a stop at
    /// the end is obeyed once the line is good again.
    #[test]
    fn any_orders_over_any_bad_line_end_with_a_stop_that_is_obeyed(
        seed in any::<u64>(),
        rate in prop::sample::select(vec!["drop", "insert", "flip", "duplicate", "half", "nak", "glue", "swap", "unsolicited"]),
        chance in 0.0..0.3f64,
        given in prop::collection::vec((orders(), 0.1..6.0f64), 1..8)
    ) {
        let mut settings = Settings { seed, ..Settings::default() };
        settings.faults.switch(&format!("{rate}={chance}")).unwrap();
        let mut table = Table::new(settings);
        table.run(3.0);
        for (order, seconds) in given {
            table.order(order);
            table.run(seconds);
        }
        table.order(Order::Stop);
        table.run(15.0);
        // On the sky, not by the axes: a tube that was moved to the zenith tracks there with a fast azimuth.
        let before = table.reported();
        table.run(1.0);
        let moved = before.separation(&table.reported()).to_degrees();
        prop_assert!(moved < 0.5, "{} degrees a second, axes {}", moved, table.fastest_axis());
    }
}

/// Ten minutes of polling lose nothing and grow nothing.
#[test]
fn ten_minutes_of_polling_are_quiet() {
    let mut table = Table::ready(Settings::default());
    table.run(600.0);
    let counters = table.belief().counters;
    assert!(counters.polls > 1000, "2 Hz: {}", counters.polls);
    assert_eq!((counters.retries, counters.resyncs, counters.reconnects, counters.faults), (0, 0, 0, 0));
    assert!(table.off_by_arcsec() < 16.0);
    assert!(table.belief().position.age(table.now).unwrap() < Duration::from_secs(1));
}
