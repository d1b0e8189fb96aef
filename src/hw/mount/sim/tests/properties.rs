//! What must hold for any bytes, any faults and any orders.

use proptest::prelude::*;

use super::super::fault::{Faults, TABLE};
use super::*;

/// Bytes as clients send them, and as nobody does.
fn bytes() -> impl Strategy<Value = Vec<u8>> {
    let command = prop::sample::select(vec![
        &b":GR#"[..],
        b":GD#",
        b":MS#",
        b":Q#",
        b":Mn#",
        b":Me#",
        b":Qe#",
        b":U#",
        b":CM#",
        b":D#",
        b":ED#",
        b":EK13#",
        b":EK68#",
        b":EK24#",
        b":EK63#",
        b":SC11/22/26#",
        b":Sr05:00:00#",
        b":Sd+10*00:00#",
        b":Sw2#",
        b":RS#",
        b":hP#",
        b":hN#",
        b":hW#",
        b":I#",
        b"\x06",
        b":SS01:02:03#",
        b":Mgn9999#",
        b":AL#",
        b":AA#",
        b":TL#",
        b":hF#",
        b":W2#",
    ])
    .prop_map(<[u8]>::to_vec);
    prop_oneof![8 => command, 1 => prop::collection::vec(any::<u8>(), 0..200)]
}

/// Some of the faults, with their examples.
fn faults() -> impl Strategy<Value = Faults> {
    prop::collection::vec(prop::sample::select(TABLE.iter().collect::<Vec<_>>()), 0..4).prop_map(|entries| {
        let mut faults = Faults::default();
        for entry in entries {
            faults.switch(&format!("{}={}", entry.name, entry.example)).unwrap();
        }
        faults
    })
}

proptest! {
    #[test]
    fn no_bytes_and_no_faults_make_it_panic_or_speak_faster_than_its_line(
        seed in any::<u64>(), faults in faults(), sent in prop::collection::vec((bytes(), 0u64..3000), 1..40)
    ) {
        let mut bench = Bench::with(Settings { seed, faults, ..Settings::default() });
        for (bytes, wait_ms) in sent {
            bench.mount.feed(&bytes, bench.now);
            let wait = Duration::from_millis(wait_ms);
            let heard = bench.wait(wait);
            // What piled up before may come at once; the line itself carries 960 bytes a second.
            prop_assert!(heard.len() as f64 <= 960.0 * wait.as_secs_f64() + 20_000.0);
            prop_assert!(bench.mount.room() <= 4096);
        }
    }

    #[test]
    fn a_deaf_client_and_a_flood_of_commands_take_bounded_memory(seed in any::<u64>()) {
        let mut bench = Bench::with(Settings { seed, ..Settings::default() });
        for _ in 0..200 {
            bench.mount.feed(&b":ED#".repeat(2000), bench.now);
            bench.now += Duration::from_millis(700);
            bench.mount.tick(bench.now);
        }
        prop_assert!(bench.mount.drain(bench.now).len() <= 16_384);
    }

    #[test]
    fn the_axes_never_jump_and_never_outrun_their_motors(
        seed in any::<u64>(),
        orders in prop::collection::vec((0usize..6, -170.0f64..170.0, -35.0f64..40.0, 0.1f64..12.0), 1..8)
    ) {
        let mut bench = Bench::with(Settings { seed, ..Settings::default() });
        for (order, azimuth, altitude, seconds) in orders {
            match order {
                0 | 1 => drop(bench.go_by(azimuth, altitude)),
                2 => drop(bench.ask(b":RS#:Mn#")),
                3 => drop(bench.ask(b":R8#:Mw#")),
                4 => drop(bench.ask(b":Q#")),
                _ => drop(bench.ask(b":Qn#:Qw#")),
            }
            let mut before = (bench.mount.controller.encoders(), bench.mount.axis_speeds_deg_s(bench.now));
            let end = bench.now + Duration::from_secs_f64(seconds);
            while bench.now < end {
                bench.now += Duration::from_millis(20);
                bench.mount.tick(bench.now);
                let after = (bench.mount.controller.encoders(), bench.mount.axis_speeds_deg_s(bench.now));
                for (moved, change) in [
                    (after.0.0 - before.0.0, after.1.0 - before.1.0),
                    (after.0.1 - before.0.1, after.1.1 - before.1.1),
                ] {
                    // Positions stand on a grid of 10 ms: between two looks lie one to three steps.
                    prop_assert!(moved.abs() <= 8.0 * 0.031, "{moved} degrees in 20 ms");
                    let at_a_stop = !(-9.99..89.99).contains(&after.0.1);
                    prop_assert!(change.abs() <= 4.0 * 0.031 + 0.02 || at_a_stop, "{change} degrees a second in 20 ms");
                }
                before = after;
            }
        }
    }

    #[test]
    fn one_seed_gives_one_conversation_however_often_it_is_looked_at(
        seed in any::<u64>(), faults in faults(), sent in prop::collection::vec((bytes(), 1u64..2000), 1..20)
    ) {
        let settings = Settings { seed, faults, ..Settings::default() };
        let mut once = Simulator::new(settings.clone());
        let mut often = Simulator::new(settings);
        let mut now = Duration::ZERO;
        let (mut said_once, mut said_often) = (Vec::new(), Vec::new());
        for (bytes, wait_ms) in sent {
            // Not up to the zenith: there the axes fall behind the sky, and when that is noticed depends on who looks.
            let bytes = if bytes == b":Mn#" { b":Ms#".to_vec() } else { bytes };
            once.feed(&bytes, now);
            often.feed(&bytes, now);
            for _ in 0..wait_ms.div_ceil(7) {
                now += Duration::from_millis(7);
                said_often.extend(often.drain(now));
            }
            said_once.extend(once.drain(now));
        }
        prop_assert_eq!(said_once, said_often);
    }
}
