//! No frame is ever torn, whatever writing costs and whenever it begins; and a driver that writes where it should not is caught.

use std::time::Duration;

use proptest::prelude::*;

use super::*;

const SMALL: (u32, u32) = (8, 6);

fn display(row_us: u64, begin_us: u64) -> SimulatedDisplay {
    let beat = Beat::Made { now: Duration::from_micros(begin_us), row: Duration::from_micros(row_us) };
    SimulatedDisplay::new(SMALL.0, SMALL.1, 60.0, beat).unwrap()
}

fn solid(light: f32) -> Picture {
    let mut picture = Picture::black(8, 6);
    picture.pixels_mut().fill([light; 3]);
    picture
}

/// Rows of one light as the display takes them.
fn rows(display: &SimulatedDisplay, light: f32) -> Vec<(usize, Vec<u8>)> {
    let mut bytes = vec![0; display.geometry().row_bytes()];
    display.geometry().encode_row(0, &[[light; 3]; 8], &mut bytes);
    (0..6).map(|y| (y, bytes.clone())).collect()
}

#[test]
fn a_driver_that_draws_on_the_buffer_that_is_shown_tears_and_is_seen_to() {
    // A row costs a quarter of a frame: the beam overtakes the pen.
    let mut display = display(4000, 0);
    let watch = display.watch();
    let white = rows(&display, 1.0);
    display.write(0, &white).unwrap();
    display.flip(0).unwrap();
    assert!(watch.record().torn >= 1, "{:?}", watch.record());
}

#[test]
fn a_driver_that_waits_for_its_flip_never_tears_and_each_flip_is_at_the_start_of_a_frame() {
    let display = display(900, 5000);
    let watch = display.watch();
    let mut projector = Flipping::new(display, Placement::default()).unwrap();
    for light in [1.0, 0.2, 0.7, 0.0, 1.0] {
        projector.present(&solid(light)).unwrap();
    }
    let record = watch.record();
    assert_eq!((record.torn, record.flips), (0, 6));
    let period = Duration::from_secs_f64(1.0 / 60.0);
    for (one, next) in record.latest.iter().zip(record.latest.iter().skip(1)) {
        let frames = (next.shown - one.shown).as_secs_f64() / period.as_secs_f64();
        assert!((frames - frames.round()).abs() < 1e-6 && frames >= 1.0, "{frames}");
        assert!(one.asked <= one.shown && one.buffer != next.buffer);
    }
    drop(projector);
    let end = watch.record();
    assert!(end.dark && end.torn == 0, "{end:?}");
}

#[test]
fn frames_that_a_slow_pen_lets_go_by_are_missed_and_counted() {
    // Six rows at 10 ms are 60 ms: shown with the fourth frame, three more than needed.
    let display = display(10_000, 0);
    let watch = display.watch();
    let mut projector = Flipping::new(display, Placement::default()).unwrap();
    let before = watch.record().missed;
    projector.present(&solid(1.0)).unwrap();
    let missed = watch.record().missed - before;
    assert!((3..=4).contains(&missed), "{missed}");
    // The same picture again: after the first both buffers hold other rows, then nothing is left to write.
    projector.present(&solid(1.0)).unwrap();
    let before = watch.record().missed;
    projector.present(&solid(1.0)).unwrap();
    assert_eq!(watch.record().missed, before);
}

#[test]
fn six_hours_of_one_picture_are_six_hours_of_frames() {
    let mut display = display(0, 0);
    let watch = display.watch();
    display.scan(Duration::from_secs(6 * 3600));
    let frames = watch.record().frames;
    assert!(frames.abs_diff(6 * 3600 * 60) <= 2, "{frames}");
}

/// Buffers that refuse to flip.
struct Stuck {
    display: SimulatedDisplay,
    black: [Vec<bool>; 2],
    refuses: bool,
}

impl Buffers for Stuck {
    fn geometry(&self) -> &Geometry {
        self.display.geometry()
    }

    fn write(&mut self, buffer: usize, rows: &[(usize, Vec<u8>)]) -> Result<(), String> {
        rows.iter().for_each(|(y, bytes)| self.black[buffer][*y] = bytes.iter().all(|byte| *byte == 0));
        Ok(())
    }

    fn flip(&mut self, _buffer: usize) -> Result<(), String> {
        if self.refuses { Err("permission denied".into()) } else { Ok(()) }
    }

    fn describe(&self) -> String {
        "stuck".into()
    }
}

#[test]
fn when_flips_fail_dark_still_blackens_both_buffers_and_says_that_it_failed() {
    let stuck = Stuck { display: display(0, 0), black: [vec![false; 6], vec![false; 6]], refuses: false };
    let mut projector = Flipping::new(stuck, Placement::default()).unwrap();
    projector.present(&solid(1.0)).unwrap();
    projector.present(&solid(0.5)).unwrap();
    assert!(projector.buffers.black.iter().flatten().all(|black| !black));
    projector.buffers.refuses = true;
    assert!(projector.dark().unwrap_err().to_string().contains("permission denied"));
    assert!(projector.buffers.black.iter().flatten().all(|black| *black));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn whatever_writing_costs_and_whenever_it_begins_no_frame_is_torn(
        row_us in 0..9000u64, begin_us in 0..40_000u64, lights in prop::collection::vec(0f32..=1.0, 1..12),
        dark_after in 0..12usize,
    ) {
        let display = display(row_us, begin_us);
        let watch = display.watch();
        let mut projector = Flipping::new(display, Placement::default()).unwrap();
        for (count, light) in lights.into_iter().enumerate() {
            projector.present(&solid(light)).unwrap();
            if count == dark_after {
                projector.dark().unwrap();
            }
        }
        drop(projector);
        let record = watch.record();
        prop_assert_eq!(record.torn, 0);
        prop_assert!(record.dark && record.flips >= 2);
    }
}
