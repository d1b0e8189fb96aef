use proptest::prelude::*;

use super::*;
use crate::hw::light::calibration::{Meter, Optics, Row, Sheet};
use crate::hw::light::module::Module;

const SET: [(&str, f64); 7] =
    [("70 %", 0.7), ("50 %", 0.5), ("25 %", 0.25), ("10 %", 0.1), ("3 %", 0.03), ("1 %", 0.01), ("0.3 %", 0.003)];

fn sheet(rows: &[(u16, f64)]) -> Sheet {
    Sheet {
        module: Module::Dlpc2607,
        id: 0x8A,
        note: String::new(),
        leds: 7,
        balance: [1.0; 3],
        inverted: false,
        ceiling_cd_m2: 1.8,
        optics: Optics { meter: Meter::Eyepiece, fixed_nd: 1e-4, beam_splitter: 0.1, filter_at_the_meter: 1.0 },
        filters: SET.map(|(name, transmission)| Filter { name: name.into(), transmission }).to_vec(),
        rows: rows.iter().map(|(code, cd_m2)| Row { code: *code, cd_m2: *cd_m2, black_cd_m2: None }).collect(),
    }
}

/// Light in proportion to the code, as far as TI's DLPA2000 reaches: 25 mA at 12 to 750 mA at 775.
fn straight() -> Calibration {
    Calibration::checked(sheet(&[(12, 0.06), (775, 1.8)])).unwrap()
}

fn inserted(plan: &Plan) -> Option<&str> {
    plan.insert.as_ref().map(|filter| filter.name.as_str())
}

#[test]
fn the_densest_filter_behind_which_the_module_reaches_is_preferred_to_dimming() {
    let calibration = straight();
    // By hand: asked / transmission must not exceed 1.8.
    for (asked, filter, runs_at) in [
        (1.8, None, 1.8),
        (1.2, Some("70 %"), 1.714),
        (0.8, Some("50 %"), 1.6),
        (0.3, Some("25 %"), 1.2),
        (0.05, Some("3 %"), 1.667),
        (0.03, Some("3 %"), 1.0),
    ] {
        let dimmed = plan(asked, &calibration, None).unwrap();
        assert_eq!(inserted(&dimmed), filter, "{asked}");
        if let Some(fitted) = &dimmed.insert {
            let with = plan(asked, &calibration, Some(fitted)).unwrap();
            assert!((with.module_cd_m2 - runs_at).abs() < 2e-3, "{asked}: {}", with.module_cd_m2);
            assert_eq!(with.insert, None);
            // The thesis: 500:1 from 1.8 down to 0.3, less below. The filter gives it back.
            assert!(
                with.contrast > 490.0 && with.contrast >= dimmed.contrast - 10.0,
                "{asked}: {} {}",
                with.contrast,
                dimmed.contrast
            );
        }
    }
    let dim = plan(0.03, &calibration, None).unwrap();
    assert!(!dim.keeps_contrast() && dim.contrast < 51.0, "{}", dim.contrast);
    assert!(dim.advice().unwrap().contains("insert the filter 3 %"), "{:?}", dim.advice());
}

#[test]
fn each_piece_of_glass_is_counted_once() {
    // A 25,000 cd/m2 engine behind ND 3.14 and a 10 % beam splitter is 1.8 cd/m2 at the eyepiece, wherever the meter stood.
    for (meter, reading, filter_at_the_meter) in [
        (Meter::Module, 25_000.0, 1.0),
        (Meter::FixedNd, 25_000.0 * 7.2e-4, 1.0),
        (Meter::Eyepiece, 25_000.0 * 7.2e-5, 1.0),
        (Meter::Eyepiece, 25_000.0 * 7.2e-5 * 0.5, 0.5),
    ] {
        let mut sheet = sheet(&[(12, reading / 30.0), (775, reading)]);
        sheet.optics = Optics { meter, fixed_nd: 7.2e-4, beam_splitter: 0.1, filter_at_the_meter };
        let plan = plan(1.8, &Calibration::checked(sheet).unwrap(), None).unwrap();
        assert_eq!((plan.drive.codes, plan.predicted_cd_m2), ([775; 3], 1.8), "{meter:?}");
    }
}

#[test]
fn the_densest_filter_takes_the_dimmest_light_to_9e_6() {
    // 0.03 cd/m2 at the screen through a 10 % beam splitter and a 0.3 % filter is 9e-6 cd/m2 at the eye.
    let mut sheet = sheet(&[(12, 0.03), (775, 1.8)]);
    sheet.optics = Optics { meter: Meter::FixedNd, fixed_nd: 1.0, beam_splitter: 0.1, filter_at_the_meter: 1.0 };
    let calibration = Calibration::checked(sheet).unwrap();
    let densest = calibration.filter("0.3%").unwrap().clone();
    let plan = dimmed(9e-6, &calibration, Some(&densest)).unwrap();
    assert_eq!(plan.drive.codes, [12; 3]);
    assert!((plan.pixel_gain - 1.0).abs() < 1e-9);
}

#[test]
fn what_cannot_be_given_is_refused_with_what_to_do() {
    let low = straight().under(0.5);
    let (calibration, dense) = (straight(), straight().filter("3 %").unwrap().clone());
    let short = Calibration::checked(sheet(&[(12, 0.06), (400, 0.9)])).unwrap();
    let bright = Calibration::checked(sheet(&[(12, 2.0), (400, 9.0)])).unwrap();
    for (asked, calibration, fitted, words) in [
        (0.029, &calibration, None, "give 0.03 to 1.8 cd/m2; with the filter 70 % in the tray"),
        (0.001, &calibration, None, "insert it and add --filter '3 %'"),
        (1.81, &calibration, None, "cannot be asked"),
        (0.0, &calibration, None, "cannot be asked"),
        (-1.0, &calibration, None, "cannot be asked"),
        (f64::NAN, &calibration, None, "cannot be asked"),
        (f64::INFINITY, &calibration, None, "cannot be asked"),
        (0.6, &low, None, "above the ceiling of 0.5"),
        (0.3, &calibration, Some(&dense), "take it out"),
        (1.0, &short, None, "measure a step nearer to the ceiling"),
        (1.0, &bright, None, "insert a denser filter"),
    ] {
        let error = plan(asked, calibration, fitted).unwrap_err().to_string();
        assert!(error.contains(words), "{asked}: {error}");
    }
    // Behind the filter the lower end sinks by its transmission.
    assert!(plan(0.001, &calibration, Some(&dense)).is_ok());
}

#[test]
fn a_controller_that_counts_backwards_is_driven_backwards() {
    let mut sheet = sheet(&[(0, 1.8), (500, 0.9), (1000, 0.03)]);
    sheet.inverted = true;
    let plan = plan(0.9, &Calibration::checked(sheet).unwrap(), None).unwrap();
    assert_eq!(plan.drive.codes, [500; 3]);
}

#[test]
fn the_leds_are_balanced_by_their_shares_of_the_code() {
    let mut sheet = sheet(&[(10, 0.06), (1000, 1.8)]);
    (sheet.leds, sheet.balance) = (1, [1.0, 0.5, 0.25]);
    let plan = plan(1.8, &Calibration::checked(sheet).unwrap(), None).unwrap();
    assert_eq!(plan.drive, Drive { leds: 1, codes: [1000, 500, 250] });
}

#[test]
fn black_is_what_was_measured_where_it_was() {
    let mut sheet = sheet(&[(12, 0.06), (775, 1.8)]);
    sheet.rows[0].black_cd_m2 = Some(6e-5);
    sheet.rows[1].black_cd_m2 = Some(1.8e-3);
    let calibration = Calibration::checked(sheet).unwrap();
    let plan = plan(0.06, &calibration, None).unwrap();
    assert_eq!((plan.black_cd_m2, plan.source), (6e-5, Source::Measured));
    assert!((plan.contrast - 1000.0).abs() < 1e-6);
    assert_eq!(super::plan(0.06, &straight(), None).unwrap().source, Source::Thesis);
}

/// A lamp as LEDs are: light goes with a power of the current a little below 1, from some code on.
fn lamp() -> impl Strategy<Value = (f64, f64, Vec<u16>)> {
    let codes = proptest::collection::btree_set(12u16..=2000, 6..20);
    (0.02f64..0.06, 0.8f64..1.1, codes).prop_map(|(dimmest, power, codes)| {
        // Measured closely enough that a straight line between two steps is good to two percent.
        let mut all: Vec<u16> = vec![12];
        while all[all.len() - 1] < 2000 {
            all.push(all[all.len() - 1] * 3 / 2 + 1);
        }
        all.retain(|code| *code <= 2047);
        all.extend(codes);
        all.sort_unstable();
        all.dedup();
        (dimmest, power, all)
    })
}

fn light((dimmest, power): (f64, f64), code: u16) -> f64 {
    dimmest * (f64::from(code) / 12.0).powf(power)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn what_the_lamp_truly_gives_is_what_was_asked(
        (dimmest, power, codes) in lamp(), share in 0.0f64..=1.0, filter in 0usize..=SET.len(),
    ) {
        let lamp = (dimmest, power);
        let rows: Vec<(u16, f64)> = codes.iter().map(|code| (*code, light(lamp, *code))).collect();
        let calibration = Calibration::checked(sheet(&rows)).unwrap();
        let fitted = SET.get(filter).map(|(name, _)| calibration.filter(name).unwrap().clone());
        let transmission = fitted.as_ref().map_or(1.0, |fitted| fitted.transmission);
        // From the dimmest to the brightest step under the ceiling, evenly in the logarithm.
        let top = rows.iter().map(|(_, white)| *white).filter(|white| *white <= 1.8 / transmission).fold(0.0, f64::max);
        let top = (top * transmission).min(1.8);
        let asked = 0.03 * transmission * (top / (0.03 * transmission)).powf(share);
        let plan = plan(asked, &calibration, fitted.as_ref()).unwrap();
        let truly = light(lamp, plan.drive.codes[0]) * plan.pixel_gain * transmission;
        prop_assert!((plan.predicted_cd_m2 / asked - 1.0).abs() < 1e-9, "{} for {asked}", plan.predicted_cd_m2);
        prop_assert!((truly / asked - 1.0).abs() < TOLERANCE, "{truly} for {asked}");
        // A full white pixel too is under the ceiling.
        prop_assert!(light(lamp, plan.drive.codes[0]) * transmission <= 1.8 * (1.0 + 1e-6));
    }

    #[test]
    fn no_lamp_whatever_it_does_between_two_steps_is_driven_above_the_ceiling(
        steps in proptest::collection::vec((1u16..200, 0.001f64..2.0), 2..12),
        ceiling in 0.03f64..1.8, asked in 0.0f64..2.0, inverted: bool,
    ) {
        let mut rows: Vec<(u16, f64)> = Vec::new();
        for (code, light) in steps {
            let (before, dark) = rows.last().copied().unwrap_or((0, 0.0));
            rows.push((before + code, dark + light));
        }
        if inverted {
            let lights: Vec<f64> = rows.iter().rev().map(|row| row.1).collect();
            rows.iter_mut().zip(lights).for_each(|(row, light)| row.1 = light);
        }
        let mut sheet = sheet(&rows);
        (sheet.inverted, sheet.ceiling_cd_m2) = (inverted, ceiling);
        let calibration = Calibration::checked(sheet).unwrap();
        if let Ok(plan) = dimmed(asked, &calibration, None) {
            // The worst lamp: right above each step it is as bright as the next one.
            let code = plan.drive.codes[0];
            let worst = if inverted {
                rows.iter().rev().find(|row| row.0 <= code).unwrap().1
            } else {
                rows.iter().find(|row| row.0 >= code).unwrap().1
            };
            prop_assert!(worst <= ceiling * (1.0 + 1e-6), "code {code} may give {worst} under a ceiling of {ceiling}");
            prop_assert!(plan.predicted_cd_m2 <= ceiling * (1.0 + 1e-6));
            prop_assert!(plan.pixel_gain <= 1.0);
        }
    }

    #[test]
    fn more_asked_is_never_less_light(a in 0.03f64..1.8, b in 0.03f64..1.8) {
        let calibration = Calibration::checked(sheet(&[(12, 0.06), (50, 0.2), (60, 0.9), (775, 1.8)])).unwrap();
        let (low, high) = (a.min(b), a.max(b));
        let (low, high) = (plan(low, &calibration, None).unwrap(), plan(high, &calibration, None).unwrap());
        prop_assert!(low.predicted_cd_m2 <= high.predicted_cd_m2);
        prop_assert!(low.drive.codes[0] <= high.drive.codes[0]);
    }
}

#[test]
fn what_the_pixels_take_away_they_take_on_the_average_of_the_screen() {
    // The gain that the plan leaves to the pixels, dithered onto the 256 codes of a display.
    let calibration = straight();
    for asked in [0.03, 0.031, 0.047, 0.3] {
        let plan = plan(asked, &calibration, None).unwrap();
        let codes = crate::picture::dither::Codes::of(8);
        let mut light = 0.0;
        for (x, y) in (0..64).flat_map(|y| (0..64).map(move |x| (x, y))) {
            light += f64::from(codes.light(codes.dithered(plan.pixel_gain as f32, x, y)));
        }
        let shown = light / 4096.0 / plan.pixel_gain * plan.predicted_cd_m2;
        assert!((shown / asked - 1.0).abs() < 0.005, "{shown} for {asked}");
    }
}
