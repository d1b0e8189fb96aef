//! The simulator from outside: bytes in, bytes out.

use super::*;

fn simulator() -> Simulator {
    Simulator::new(Settings::default())
}

/// Sends and waits for so many milliseconds; what has come back by then.
fn ask(simulator: &mut Simulator, now: &mut Duration, command: &[u8], wait_ms: u64) -> Vec<u8> {
    simulator.feed(command, *now);
    *now += Duration::from_millis(wait_ms);
    simulator.drain(*now)
}

#[test]
fn it_starts_aligned_awake_tracking_and_above_the_horizon() {
    let (mut simulator, mut now) = (simulator(), Duration::ZERO);
    assert_eq!(ask(&mut simulator, &mut now, b":GW#", 100), b"AT2");
    assert_eq!(ask(&mut simulator, &mut now, b"\x06", 100), b"A");
    assert!(ask(&mut simulator, &mut now, b":GA#", 100).starts_with(b"+45\xDF00:0"));
}
