//! What methods cost and what errors they make, measured: a study is cases with references and the methods that answer them.
//!
//! To register a method is to push one `Contender` on a study; to add a study is to make one `Study`.

use std::time::Duration;

/// What particles take from light.
pub mod aerosol;
/// The colour of the low Sun.
pub mod colour;
/// The picture of the disc.
pub mod disc;
/// The models of the eye, against tables of others.
pub mod eye;
/// Dust lit by a star, against pictures of another program.
pub mod nebula;
/// A study as a plot.
pub mod plot;
/// The refraction of single rays by every method.
pub mod refraction;
/// The Moon's calibration.
pub mod registration;
/// The thesis' figure of how a voxel scatters.
pub mod scattering_figure;
/// The scattering table of the thesis, and photons through spheres.
pub mod scattering_table;
/// The light of the sky, against photons followed one by one.
pub mod skylight;
/// Extreme air and extreme rays.
pub mod stability;

/// One question with a known answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// What it belongs to: the atmosphere.
    pub group: String,
    /// What is asked there: the direction.
    pub name: String,
    /// The answer, computed by others.
    pub reference: f64,
}

/// What a method answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// The value.
    pub value: f64,
    /// The error that the method believes it made.
    pub believed: f64,
    /// Its steps.
    pub steps: usize,
}

/// A method at one setting, made ready for every case.
pub struct Contender<'a> {
    /// The method.
    pub method: &'static str,
    /// The setting: tolerance, layers.
    pub setting: String,
    /// Answers the case of an index; `None` where it has no answer.
    pub answer: Box<dyn Fn(usize) -> Option<Answer> + 'a>,
}

/// Cases, and the methods that answer them.
pub struct Study<'a> {
    /// What is studied.
    pub title: &'static str,
    /// The unit of values and errors.
    pub unit: &'static str,
    /// The questions.
    pub cases: Vec<Case>,
    /// The methods, each setting one.
    pub contenders: Vec<Contender<'a>>,
}

/// What was measured of one method in one case.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Measurement {
    /// The group of the case.
    pub group: String,
    /// The case.
    pub case: String,
    /// The method.
    pub method: &'static str,
    /// Its setting.
    pub setting: String,
    /// The value less the reference; nothing where there was no answer.
    pub error: Option<f64>,
    /// The error believed.
    pub believed: Option<f64>,
    /// Its steps.
    pub steps: usize,
    /// What one answer took, microseconds.
    pub time_us: f64,
}

/// How long one contender is timed in one case.
const ENOUGH: Duration = Duration::from_millis(2);

/// Batches timed; the fastest counts, because others are slowed by whatever else the machine does.
const BATCHES: usize = 3;

/// Measures every contender in every case. The clock gives the time since some beginning.
#[must_use]
pub fn measure(study: &Study<'_>, clock: &dyn Fn() -> Duration) -> Vec<Measurement> {
    let mut measurements = Vec::new();
    for (index, case) in study.cases.iter().enumerate() {
        for contender in &study.contenders {
            let answer = (contender.answer)(index);
            measurements.push(Measurement {
                group: case.group.clone(),
                case: case.name.clone(),
                method: contender.method,
                setting: contender.setting.clone(),
                error: answer.map(|answer| answer.value - case.reference),
                believed: answer.map(|answer| answer.believed),
                steps: answer.map_or(0, |answer| answer.steps),
                time_us: (0..BATCHES)
                    .map(|_| {
                        seconds_each(clock, || {
                            std::hint::black_box((contender.answer)(index));
                        }) * 1e6
                    })
                    .fold(f64::INFINITY, f64::min),
            });
        }
    }
    measurements
}

/// Mean time of one call, seconds.
pub fn seconds_each(clock: &dyn Fn() -> Duration, mut call: impl FnMut()) -> f64 {
    let (begin, mut calls) = (clock(), 0u32);
    loop {
        call();
        calls += 1;
        let gone = clock().saturating_sub(begin);
        if gone >= ENOUGH {
            return gone.as_secs_f64() / f64::from(calls);
        }
    }
}

/// The measurements as a table for people, a block for each case.
#[must_use]
pub fn table(study: &Study<'_>, measurements: &[Measurement]) -> String {
    let mut text = format!("{}\n", study.title);
    let mut last = ("", "");
    for m in measurements {
        if last != (&m.group, &m.case) {
            text += &format!(
                "\n{}, {}\n  {:<12} {:<14} {:>12} {:>12} {:>8} {:>11}\n",
                m.group,
                m.case,
                "method",
                "setting",
                format!("error {}", study.unit),
                "believed",
                "steps",
                "time us"
            );
            last = (&m.group, &m.case);
        }
        let number = |value: Option<f64>| value.map_or_else(|| "none".to_owned(), |value| format!("{value:.2e}"));
        text += &format!(
            "  {:<12} {:<14} {:>12} {:>12} {:>8} {:>11.2}\n",
            m.method,
            m.setting,
            number(m.error),
            number(m.believed),
            m.steps,
            m.time_us
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    fn study() -> Study<'static> {
        let case = |name: &str, reference| Case { group: "g".to_owned(), name: name.to_owned(), reference };
        let answer = |index| (index == 0).then_some(Answer { value: 3.0, believed: 0.5, steps: 7 });
        Study {
            title: "a study",
            unit: "arcsec",
            cases: vec![case("one", 2.0), case("two", 1.0)],
            contenders: vec![Contender { method: "m", setting: "s".to_owned(), answer: Box::new(answer) }],
        }
    }

    #[test]
    fn errors_are_answers_less_references_and_times_are_those_of_the_clock_handed_in() {
        let ticks = Cell::new(0);
        let clock = || {
            ticks.set(ticks.get() + 1);
            Duration::from_millis(ticks.get())
        };
        let measured = measure(&study(), &clock);
        assert_eq!((measured[0].error, measured[0].believed, measured[0].steps), (Some(1.0), Some(0.5), 7));
        assert_eq!((measured[1].error, measured[1].steps), (None, 0));
        // Each call reads the clock once, so that each takes a millisecond.
        assert!((measured[0].time_us - 1000.0).abs() < 1e-6, "{}", measured[0].time_us);
        let text = table(&study(), &measured);
        assert!(text.contains("1.00e0") && text.contains("none"), "{text}");
    }
}
