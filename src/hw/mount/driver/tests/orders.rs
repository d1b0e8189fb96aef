//! Orders: go-to, synchronise, clock and site, keys.

use std::time::Duration;

use super::{Peer, place};
use crate::hw::mount::command::Question;
use crate::hw::mount::order::{Direction, Fault, Key, Order, Rate, Report};
use crate::hw::port::PortError;
use crate::sky::pointing::Motion;
use crate::sky::site::Site;
use crate::sky::time::Utc;

/// M42, as in the papers.
fn orion() -> crate::sky::coords::Equatorial<crate::sky::coords::OfDate> {
    place((5.0 + 35.0 / 60.0 + 17.0 / 3600.0) * 15.0, -(5.0 + 23.0 / 60.0 + 28.0 / 3600.0))
}

fn taking_targets() -> Peer {
    let mut peer = Peer::connected();
    peer.reply(b":Sr05:35:17#", b"1");
    peer.reply(b":Sd-05*23:28#", b"1");
    peer.reply(b":MS#", b"0");
    peer
}

#[test]
fn a_go_to_is_watched_to_its_end() {
    let mut peer = taking_targets();
    peer.reply(b":D#", b"\x7F#");
    peer.driver.order(Order::Goto(orion()), peer.now);
    peer.run_until(|peer| peer.reports.contains(&Report::SlewStarted));
    assert_eq!(peer.driver.belief().slewing_to, Some(orion()));
    // Two degrees of declination a step, every 300 ms, down to the target.
    for step in 0..20 {
        let dec: i32 = (37 - 2 * step).max(-5);
        let sign = if dec < 0 { '-' } else { '+' };
        peer.reply(b":GD#", &[format!("{sign}{:02}", dec.abs()).as_bytes(), b"\xDF23:28#"].concat());
        peer.run(Duration::from_millis(300));
    }
    assert_eq!(peer.driver.belief().motion.value(), Some(&Motion::Slewing));
    assert!(!peer.driver.belief().pointing(peer.now).unwrap().may_draw());
    assert!(!peer.reported(|r| matches!(r, Report::Arrived { .. })));
    peer.reply(b":GR#", b"05:35:17#");
    peer.reply(b":GD#", b"-05\xDF23:28#");
    peer.run(Duration::from_secs(3));
    assert!(!peer.reported(|r| matches!(r, Report::Arrived { .. })), "the bar is still there");
    peer.reply(b":D#", b"#");
    peer.run(Duration::from_secs(2));
    assert!(peer.reported(|r| matches!(r, Report::Arrived { off_by } if off_by.to_arcseconds() < 1.0)));
    assert!(peer.driver.belief().pointing(peer.now).unwrap().may_draw());
    assert_eq!(peer.driver.belief().counters.slews, 1);
    // Faster while moving: at least four positions a second.
    let moving = peer.sent.iter().filter(|(_, command)| command == b":GD#").count();
    assert!(moving >= 4 * 9, "{moving}");
}

#[test]
fn a_refusal_is_told_in_the_mounts_words() {
    let mut peer = taking_targets();
    peer.reply(b":MS#", b"1Object Below Horizon#");
    peer.driver.order(Order::Goto(orion()), peer.now);
    peer.run(Duration::from_secs(1));
    assert!(peer.reported(|r| *r == Report::GotoRefused { reason: "Object Below Horizon".into() }));
    assert!(!peer.driver.belief().slewing_by_order());
}

#[test]
fn an_answer_to_ms_that_is_lost_is_never_asked_for_again() {
    let mut peer = taking_targets();
    peer.silent_to(b":MS#");
    peer.driver.order(Order::Goto(orion()), peer.now);
    peer.run(Duration::from_secs(30));
    assert_eq!(peer.count(b":MS#"), 1);
    assert!(peer.reported(|r| matches!(r, Report::GotoFailed { .. })));
    assert!(peer.reported(|r| matches!(r, Report::EndedShort { .. })));
}

#[test]
fn a_target_that_is_not_taken_is_not_gone_to() {
    let mut peer = taking_targets();
    peer.reply(b":Sd-05*23:28#", b"0");
    peer.driver.order(Order::Goto(orion()), peer.now);
    peer.run(Duration::from_secs(2));
    assert_eq!(peer.count(b":MS#"), 0);
    assert!(peer.reported(|r| matches!(r, Report::GotoRefused { .. })));
}

#[test]
fn no_slew_is_ordered_again_after_a_lost_line() {
    let mut peer = taking_targets();
    peer.reply(b":D#", b"|#");
    peer.driver.order(Order::Goto(orion()), peer.now);
    peer.driver.order(Order::Goto(orion()), peer.now);
    peer.run_until(|peer| peer.count(b":MS#") == 1);
    let why = PortError::Unplugged { name: "/dev/ttyUSB0".into(), why: "gone".into() };
    peer.driver.link_lost(why, peer.now);
    peer.run(Duration::from_secs(3));
    assert!(peer.driver.belief().pointing(peer.now + Duration::from_secs(3)).is_none_or(|p| p.stale));
    peer.driver.link_opened(peer.now);
    peer.run(Duration::from_secs(60));
    assert_eq!(peer.count(b":MS#"), 1);
}

#[test]
fn an_order_without_a_line_is_refused_and_not_kept() {
    let mut peer = taking_targets();
    let why = PortError::Unplugged { name: "x".into(), why: "gone".into() };
    peer.driver.link_lost(why, peer.now);
    peer.driver.order(Order::Goto(orion()), peer.now);
    peer.driver.link_opened(peer.now);
    peer.run(Duration::from_secs(10));
    assert_eq!(peer.count(b":MS#"), 0);
    assert!(peer.reported(|r| matches!(r, Report::OrderFailed { order: "the go-to", .. })));
}

#[test]
fn a_synchronisation_is_taken_late_when_another_byte_pushes_it_out() {
    let mut peer = taking_targets();
    peer.silent_to(b":CM#");
    peer.reply(b"\x06", b" M31 EX GAL MAG 3.5 SZ178.0'#A");
    peer.driver.order(Order::Sync(orion()), peer.now);
    peer.run(Duration::from_millis(1500));
    assert!(
        peer.reported(|r| *r == Report::Synced { reply: "M31 EX GAL MAG 3.5 SZ178.0'".into() }),
        "{:?}",
        peer.reports
    );
}

#[test]
fn the_position_may_jump_once_after_a_synchronisation() {
    let mut peer = taking_targets();
    peer.reply(b":CM#", b" M31 EX GAL MAG 3.5 SZ178.0'#");
    peer.driver.order(Order::Sync(orion()), peer.now);
    peer.run_until(|peer| peer.reported(|r| matches!(r, Report::Synced { .. })));
    peer.reply(b":GR#", b"05:35:17#");
    peer.reply(b":GD#", b"-05\xDF23:28#");
    peer.run(Duration::from_secs(2));
    assert!(!peer.reported(|r| matches!(r, Report::Fault(Fault::Jump { .. }))));
    assert!(peer.driver.belief().position.value().unwrap().separation(&orion()).to_arcseconds() < 1.0);
}

#[test]
fn clock_and_site_are_set_read_back_and_checked() {
    let mut peer = Peer::connected();
    peer.reply(b":SH0#", b"1");
    peer.reply(b":SG-02#", b"1");
    peer.reply(b":SL20:05:00#", b"1");
    peer.reply(b":SC09/07/23#", b"1Updating Planetary Data#                        #");
    peer.reply(b":GH#", b"0");
    peer.reply(b":GG#", b"-02#");
    peer.reply(b":GL#", b"20:01:31#");
    peer.reply(b":GS#", b"17:29:15#");
    let utc = Utc::from_rfc3339("2023-09-07T18:05:00Z").unwrap();
    peer.driver.order(Order::SetClock(utc, 2.0), peer.now);
    peer.run(Duration::from_secs(3));
    assert!(peer.reported(|r| *r == Report::ClockSet), "{:?}", peer.reports);

    peer.reply(b":St+52*11#", b"1");
    peer.reply(b":Sg354*37#", b"1");
    peer.driver.order(Order::SetSite(Site::new(52.1833, 5.385, 0.0).unwrap()), peer.now);
    peer.run(Duration::from_secs(3));
    assert!(peer.reported(|r| *r == Report::SiteSet), "{:?}", peer.reports);
}

#[test]
fn a_clock_that_was_not_taken_is_said_so() {
    let mut peer = Peer::connected();
    peer.reply(b":SH0#", b"1");
    peer.reply(b":SG-02#", b"0");
    let utc = Utc::from_rfc3339("2023-09-07T18:05:00Z").unwrap();
    peer.driver.order(Order::SetClock(utc, 2.0), peer.now);
    peer.run(Duration::from_secs(2));
    assert!(peer.reported(|r| matches!(r, Report::OrderFailed { order: "setting the clock", .. })));
}

#[test]
fn enter_is_not_pressed_in_the_menu_of_the_firmware_loader() {
    let mut peer = Peer::connected();
    peer.reply(b":ED#", b"\x97Utilities:      >Download       #");
    peer.driver.order(Order::PressKey(Key::Enter), peer.now);
    peer.run(Duration::from_secs(1));
    assert_eq!(peer.count(b":EK13#"), 0);
    assert!(peer.reported(|r| matches!(r, Report::OrderFailed { order: "pressing a key", .. })));
    peer.driver.order(Order::PressKey(Key::Mode), peer.now);
    peer.run(Duration::from_secs(1));
    assert_eq!(peer.count(b":EK9#"), 1);
    assert!(peer.reports.contains(&Report::Display));
}

#[test]
fn other_questions_are_asked_by_the_table() {
    let mut peer = Peer::connected();
    peer.reply(b":GT#", b"+60.0#");
    peer.driver.order(Order::Ask(Question::new("GT").unwrap()), peer.now);
    peer.run(Duration::from_secs(1));
    assert!(peer.reported(|r| *r == Report::Answer { command: ":GT#".into(), text: "+60.0".into() }));
}

#[test]
fn a_move_by_hand_ends_by_itself_unless_it_is_renewed() {
    let mut peer = Peer::connected();
    for _press in 0..5 {
        peer.driver.order(Order::Move(Direction::North, Rate::Centre), peer.now);
        peer.run(Duration::from_millis(500));
    }
    assert_eq!((peer.count(b":RC#"), peer.count(b":Mn#"), peer.count(b":Qn#")), (1, 1, 0));
    peer.run(Duration::from_millis(700));
    assert_eq!(peer.count(b":Qn#"), 2);
    assert!(peer.reports.contains(&Report::MoveBounded(Direction::North)));
    assert!(!peer.driver.belief().moving_by_order);
}

#[test]
fn a_move_that_is_ended_is_ended_at_once_and_twice() {
    let mut peer = Peer::connected();
    peer.driver.order(Order::Move(Direction::East, Rate::Slew), peer.now);
    peer.run(Duration::from_millis(300));
    peer.driver.order(Order::MoveEnd(Direction::East), peer.now);
    let ordered = peer.now;
    peer.run(Duration::from_millis(300));
    let ends: Vec<Duration> = peer.sent.iter().filter(|(_, c)| c == b":Qe#").map(|(at, _)| *at - ordered).collect();
    assert_eq!(ends.len(), 2);
    assert!(ends[0] <= Duration::from_millis(1));
}

#[test]
fn a_wild_position_is_asked_again_before_it_is_believed() {
    let mut peer = Peer::connected();
    let before = *peer.driver.belief().position.value().unwrap();
    peer.reply(b":GR#", b"17:29:28#");
    peer.run_until(|peer| peer.count(b":GR#") == 1);
    peer.reply(b":GR#", b"05:29:28#");
    peer.run(Duration::from_secs(2));
    assert!(peer.reported(|r| matches!(r, Report::Fault(Fault::Jump { .. }))));
    assert_eq!(peer.driver.belief().position.value(), Some(&before));
    assert_eq!(peer.driver.belief().counters.jumps, 1);
}
