//! The stop: ahead of everything, again and again, until the position is still.

use std::time::Duration;

use super::{Peer, commands, place};
use crate::hw::mount::order::{Direction, Order, Rate, Report};
use crate::hw::port::PortError;

const STOP: [&[u8]; 6] = [b"#", b":Q#", b":Qn#", b":Qs#", b":Qe#", b":Qw#"];

#[test]
fn a_stop_is_the_next_thing_sent_whatever_is_under_way() {
    // Every millisecond of three seconds: between polls, within them, while a slew is being ordered, after a NAK.
    for ms in (0..3000).step_by(7) {
        let mut peer = Peer::connected();
        peer.reply(b":Sr00:40:00#", b"1");
        peer.reply(b":Sd+41*00:00#", b"\x15");
        peer.reply(b":MS#", b"0");
        peer.reply(b":D#", b"|#");
        peer.driver.order(Order::Goto(place(10.0, 41.0)), peer.now);
        peer.driver.order(Order::Move(Direction::North, Rate::Slew), peer.now);
        peer.run(Duration::from_millis(ms));
        peer.driver.order(Order::Stop, peer.now);
        let sent = commands(&peer.driver.drain());
        assert_eq!(sent, STOP, "after {ms} ms");
    }
}

#[test]
fn a_stop_does_not_wait_for_the_planets_to_be_computed() {
    let mut peer = Peer::connected();
    for (command, reply) in
        [(&b":SH0#"[..], &b"1"[..]), (b":SG-02#", b"1"), (b":SL20:05:00#", b"1"), (b":SC09/07/23#", b"1Upd")]
    {
        peer.reply(command, reply);
    }
    let utc = crate::sky::time::Utc::from_rfc3339("2023-09-07T18:05:00Z").unwrap();
    peer.driver.order(Order::SetClock(utc, 2.0), peer.now);
    peer.run_until(|peer| peer.count(b":SC09/07/23#") == 1);
    peer.run(Duration::from_millis(200));
    peer.driver.order(Order::Stop, peer.now);
    peer.run(Duration::from_millis(5));
    assert_eq!(peer.count(b":Q#"), 1);
    peer.run(Duration::from_secs(5));
    assert!(peer.reports.contains(&Report::Stopped), "{:?}", peer.reports);
}

#[test]
fn a_stop_is_repeated_until_the_position_is_still_and_then_no_more() {
    let mut peer = Peer::connected();
    peer.driver.order(Order::Stop, peer.now);
    for step in 0..6 {
        peer.reply(b":GD#", format!("+{:02}*17:16#", 40 + step).as_bytes());
        peer.run(Duration::from_millis(400));
        assert!(!peer.reports.contains(&Report::Stopped));
    }
    assert!(peer.count(b":Q#") >= 4);
    peer.run(Duration::from_secs(3));
    assert!(peer.reports.contains(&Report::Stopped));
    let sent = peer.count(b":Q#");
    peer.run(Duration::from_secs(5));
    assert_eq!(peer.count(b":Q#"), sent);
    assert!(!peer.reported(|r| matches!(r, Report::StopNotObeyed { .. })));
}

#[test]
fn a_mount_that_keeps_moving_raises_the_alarm_and_is_told_on() {
    let mut peer = Peer::connected();
    peer.driver.order(Order::Stop, peer.now);
    for step in 0..40 {
        peer.reply(b":GD#", format!("+{:02}*17:16#", 40 + step).as_bytes());
        peer.run(Duration::from_millis(300));
    }
    assert!(peer.reported(|r| matches!(r, Report::StopNotObeyed { answers: true, .. })));
    assert!(peer.count(b":Q#") >= 15);
    let failed = peer.reports.len();
    peer.driver.order(Order::Goto(place(1.0, 1.0)), peer.now);
    peer.run(Duration::from_millis(10));
    assert!(matches!(&peer.reports[failed..], [Report::OrderFailed { .. }, ..]));
}

#[test]
fn a_mount_that_falls_silent_at_the_stop_raises_the_alarm_too() {
    let mut peer = Peer::connected();
    for command in [&b":GR#"[..], b":GD#", b"\x06"] {
        peer.silent_to(command);
    }
    peer.driver.order(Order::Stop, peer.now);
    peer.run(Duration::from_secs(8));
    assert!(peer.reported(|r| matches!(r, Report::StopNotObeyed { answers: false, .. })), "{:?}", peer.reports);
}

#[test]
fn a_stop_without_a_line_is_an_alarm_at_once_and_is_sent_when_the_line_is_back() {
    let mut peer = Peer::connected();
    peer.driver.link_lost(PortError::Unplugged { name: "x".into(), why: "gone".into() }, peer.now);
    peer.driver.order(Order::Stop, peer.now);
    assert!(
        std::iter::from_fn(|| peer.driver.poll()).any(|r| matches!(r, Report::StopNotObeyed { answers: false, .. }))
    );
    peer.sent.clear();
    peer.driver.link_opened(peer.now);
    peer.run(Duration::from_millis(5));
    let first: Vec<_> = peer.sent.iter().map(|(_, command)| command.as_slice()).collect();
    assert_eq!(first, STOP);
    peer.run(Duration::from_secs(10));
    assert!(peer.reports.contains(&Report::Stopped));
}

#[test]
fn a_line_lost_in_the_middle_of_a_move_is_an_alarm_and_the_move_is_stopped_when_it_is_back() {
    let mut peer = Peer::connected();
    peer.driver.order(Order::Move(Direction::North, Rate::Slew), peer.now);
    peer.run(Duration::from_millis(300));
    peer.driver.link_lost(PortError::Unplugged { name: "x".into(), why: "gone".into() }, peer.now);
    peer.run(Duration::from_millis(1));
    assert!(peer.reported(|r| matches!(r, Report::StopNotObeyed { answers: false, .. })));
    peer.sent.clear();
    peer.driver.link_opened(peer.now);
    peer.run(Duration::from_millis(5));
    assert_eq!(peer.sent.first().map(|(_, c)| c.as_slice()), Some(&b"#"[..]));
}

#[test]
fn orders_that_wait_are_dropped_by_a_stop() {
    let mut peer = Peer::connected();
    peer.reply(b":Sr00:40:00#", b"1");
    peer.driver.order(Order::Goto(place(10.0, 41.0)), peer.now);
    peer.driver.order(Order::Stop, peer.now);
    peer.run(Duration::from_secs(5));
    assert_eq!(peer.count(b":MS#"), 0);
    assert!(peer.reports.contains(&Report::Stopped));
}
