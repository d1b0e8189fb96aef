//! The screens as a person sees them: text snapshots, and the promise that every cell is red on black.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::sync::Arc;
use std::time::Duration;

use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::Buffer;
use ratatui::style::Modifier;
use scotopic::app::key::Key;
use scotopic::app::log::Weight;
use scotopic::app::model::Opening;
use scotopic::app::{Event, Model, Screen, update};
use scotopic::hw::mount::advice::Disagreement;
use scotopic::hw::mount::belief::{
    Aligned, Alignment, Belief, Clock, Counters, Decision, Display, Known, LinkState, Mounting, Precision, Source,
    Tracking,
};
use scotopic::hw::mount::estimate::Estimate;
use scotopic::hw::mount::order::Report;
use scotopic::picture::Picture;
use scotopic::safety::suspend::Clocks;
use scotopic::safety::{Rules, TurnCounter};
use scotopic::sky::astrometry::Astrometry;
use scotopic::sky::catalogue::{Band, Kind, Object};
use scotopic::sky::coords::{Equatorial, OfDate};
use scotopic::sky::optics::Instrument;
use scotopic::sky::pointing::Motion;
use scotopic::sky::site::Site;
use scotopic::sky::time::Utc;
use scotopic::tui::draw;
use scotopic::tui::theme::{Depth, STEPS, is_red};
use scotopic::units::{Angle, Magnitude, SurfaceBrightness};

const DEPTHS: [Depth; 3] = [Depth::True, Depth::Indexed, Depth::Sixteen];

fn now() -> Duration {
    Duration::from_secs(100)
}

fn clocks(awake: Duration) -> Clocks {
    let start = Utc::from_rfc3339("2026-11-22T23:30:00Z").unwrap();
    Clocks { wall: Duration::from_secs_f64(start.0) + awake, awake, always: Some(awake) }
}

fn andromeda() -> Equatorial<OfDate> {
    Equatorial::new(Angle::degrees(11.05), Angle::degrees(41.42))
}

fn m31() -> Object {
    Object {
        name: "M31".into(),
        names: vec!["M31".into(), "NGC 224".into(), "Andromeda Galaxy".into()],
        kind: Kind::Galaxy,
        hubble: Some("Sb"),
        astrometry: Astrometry::fixed(Equatorial::new(Angle::degrees(10.6847), Angle::degrees(41.269))),
        magnitude: Some(Magnitude(3.44)),
        band: Band::V,
        colour_bv: Some(0.92),
        axes_arcmin: Some((177.83, 69.66)),
        position_angle: Some(Angle::degrees(35.0)),
        surface_brightness: Some(SurfaceBrightness(22.16)),

        distance: None,
        hand_controllers_place: false,
        constellation: "And",
    }
}

fn tracking() -> Belief {
    let at = now() - Duration::from_millis(300);
    let known = |value| Known::Confirmed { value, at };
    Belief {
        link: LinkState::Ready,
        product: Known::Confirmed { value: "LX2001".into(), at: Duration::from_secs(1) },
        firmware: Known::Confirmed { value: "4.2l".into(), at: Duration::from_secs(1) },
        precision: Known::Assumed { value: Precision::Long, at: Duration::from_secs(2) },
        alignment: Known::Confirmed {
            value: Alignment { mounting: Mounting::AltAz, tracking: Tracking::On, aligned: Aligned::Stars(2) },
            at: Duration::from_secs(2),
        },
        position: known(andromeda()),
        motion: Known::Confirmed { value: Motion::Tracking, at },
        estimate: Some(Estimate::new(andromeda(), Motion::Tracking, Angle::arcminutes(2.0), at)),
        clock: Known::Confirmed {
            value: Clock { utc: Utc::from_rfc3339("2026-11-22T22:31:37Z").unwrap(), offset_hours: 1.0 },
            at: Duration::from_secs(3),
        },
        sidereal: Known::Confirmed { value: Angle::hours(4.2), at: Duration::from_secs(3) },
        decision: Some(Decision {
            clock: Source::Ours,
            clock_ahead_s: 0.0,
            site_from: Source::Ours,
            site: Some(Site::new(49.26, 7.04, 230.0).unwrap()),
            disagreements: vec![Disagreement::Zone { hours: -1.0 }],
        }),
        counters: Counters { polls: 190, slews: 1, ..Counters::default() },
        ..Belief::default()
    }
}

fn session() -> Model {
    Model::new(Opening {
        instrument: Instrument::default(),
        site: Some(Site::new(49.26, 7.04, 230.0).unwrap()),
        simulated: true,
        time_stated: true,
        rules: Rules::default(),
        turns: TurnCounter::unwound(),
        nudge: Default::default(),
        mount: "sim".into(),
        projector: "none".into(),
        bindings: Default::default(),
        animations: Vec::new(),
        observer: Default::default(),
    })
}

/// A disc with a slope and some stars: shape and shades can be told in the snapshot.
fn picture() -> Arc<Picture> {
    let mut picture = Picture::black(1024, 768);
    for y in 0..768usize {
        for x in 0..1024usize {
            let (dx, dy) = (x as f32 - 512.0, y as f32 - 384.0);
            let light = (1.0 - dx.hypot(dy) / 300.0).max(0.0);
            picture.row_mut(y)[x] = [light, light * 0.5, light];
        }
    }
    Arc::new(picture)
}

/// A session that looks at M31.
fn looking() -> Model {
    let mut model = session();
    let _ = update(&mut model, Event::Clocks(clocks(now())));
    model.target = Some(m31());
    let _ = update(&mut model, Event::Mount(Box::new(tracking()), vec![Report::Position]));
    let _ = update(&mut model, Event::Shown(picture()));
    model
}

fn drawn(model: &Model, depth: Depth, width: u16, height: u16) -> Buffer {
    let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
    terminal.draw(|frame| draw(model, depth, frame)).unwrap();
    terminal.backend().buffer().clone()
}

fn text(buffer: &Buffer) -> String {
    let width = usize::from(buffer.area.width);
    let rows = buffer.content.chunks(width).map(|row| row.iter().map(|cell| cell.symbol()).collect::<String>());
    rows.map(|row| format!("{}\n", row.trim_end())).collect()
}

/// Every screen, in the states that look different.
fn states() -> Vec<(String, Model)> {
    let mut states = vec![("opening".to_owned(), session())];
    for screen in Screen::ALL {
        let mut model = looking();
        model.view.screen = screen;
        if screen == Screen::Log {
            for report in [Report::SlewStarted, Report::Arrived { off_by: Angle::arcminutes(0.2) }] {
                let _ = update(&mut model, Event::Mount(Box::new(tracking()), vec![report]));
            }
            let long = "a line that is longer than the screen is wide and has to be continued on the one that follows";
            let _ = update(&mut model, Event::Notice(long.into()));
            model.banner = None;
        }
        if screen == Screen::Mount {
            model.belief.display = Known::Confirmed {
                value: Display {
                    top: " M31 EX GAL".into(),
                    bottom: "MAG 3.5".into(),
                    cursor_shown: false,
                    row: 0,
                    column: 0,
                },
                at: now(),
            };
        }
        states.push((screen.title().to_owned(), model));
    }
    let mut alarm = looking();
    let report = Report::StopNotObeyed { after: Duration::from_secs(4), answers: true };
    let _ = update(&mut alarm, Event::Mount(Box::new(tracking()), vec![report]));
    states.push(("alarm".to_owned(), alarm));

    let mut slewing = looking();
    let moving = Belief {
        slewing_to: Some(andromeda()),
        motion: Known::Confirmed { value: Motion::Slewing, at: now() },
        ..tracking()
    };
    let _ = update(&mut slewing, Event::Mount(Box::new(moving), vec![Report::SlewStarted]));
    states.push(("slewing".to_owned(), slewing));
    states
}

#[test]
fn the_screens_look_like_this_at_80_by_24() {
    for (name, model) in states() {
        insta::assert_snapshot!(format!("{name}_80x24"), text(&drawn(&model, Depth::True, 80, 24)));
    }
}

#[test]
fn the_screens_look_like_this_at_120_by_40() {
    for (name, model) in states() {
        insta::assert_snapshot!(format!("{name}_120x40"), text(&drawn(&model, Depth::Sixteen, 120, 40)));
    }
}

#[test]
fn every_cell_is_red_on_black_on_every_terminal_at_every_brightness_and_size() {
    for (name, mut model) in states() {
        for depth in DEPTHS {
            for brightness in 1..=STEPS {
                model.view.brightness = brightness;
                for (width, height) in [(80, 24), (133, 43), (30, 8), (3, 2)] {
                    let buffer = drawn(&model, depth, width, height);
                    for cell in &buffer.content {
                        assert!(is_red(cell.fg) && is_red(cell.bg), "{name}, {depth:?}: {cell:?}");
                        assert_eq!(cell.modifier, Modifier::empty(), "{name}: bold could be another colour: {cell:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn simulated_stands_on_every_screen_while_it_is_and_on_none_when_it_is_not() {
    for (name, mut model) in states() {
        for (width, height) in [(80, 24), (200, 60)] {
            assert!(text(&drawn(&model, Depth::True, width, height)).contains("SIMULATED"), "{name}");
        }
        model.opening.simulated = false;
        assert!(!text(&drawn(&model, Depth::True, 80, 24)).contains("SIMULATED"), "{name}");
    }
}

#[test]
fn names_from_outside_cannot_carry_escapes_to_the_screen() {
    let hostile = "\x1b[41mM\u{9b}2J\x0731\u{202e}\x1b]0;owned\x07";
    let mut model = looking();
    let mut target = m31();
    target.name = hostile.into();
    target.names = vec![hostile.into(), format!("{hostile}2")];
    model.search.text = hostile.into();
    model.search.offered = vec![hostile.into()];
    model.search.meant = Some(target.clone());
    model.target = Some(target);
    model.opening.mount = hostile.into();
    model.opening.projector = hostile.into();
    model.instrument.telescope.name = hostile.into();
    let mut belief = tracking();
    belief.product = Known::Confirmed { value: hostile.into(), at: now() };
    belief.firmware = Known::Confirmed { value: hostile.into(), at: now() };
    let display = Display { top: hostile.into(), bottom: hostile.into(), cursor_shown: true, row: 0, column: 0 };
    belief.display = Known::Confirmed { value: display, at: now() };
    if let Some(decision) = &mut belief.decision {
        decision.disagreements.push(Disagreement::Clone { product: hostile.into() });
    }
    let refused = Report::GotoRefused { reason: hostile.into() };
    let _ = update(&mut model, Event::Mount(Box::new(belief), vec![refused]));
    let _ = update(&mut model, Event::ProjectorFailed(hostile.into()));
    for screen in Screen::ALL {
        model.view.screen = screen;
        for cell in &drawn(&model, Depth::True, 120, 40).content {
            let bad = cell.symbol().chars().find(|c| c.is_control() || *c == '\u{202e}');
            assert_eq!(bad, None, "on {}: {:?}", screen.title(), cell.symbol());
        }
    }
}

#[test]
fn the_stop_is_hinted_on_every_screen_and_the_help_tells_every_key() {
    let mut model = looking();
    for screen in Screen::ALL {
        model.view.screen = screen;
        let text = text(&drawn(&model, Depth::True, 80, 24));
        assert!(text.lines().last().unwrap().starts_with(" Esc stop"), "{text}");
    }
    model.view.screen = Screen::Help;
    let help = text(&drawn(&model, Depth::True, 100, 80));
    for command in scotopic::app::commands::COMMANDS {
        assert!(help.contains(&command.keys_in_words()), "{} is not in the help:\n{help}", command.name);
    }
}

#[test]
fn a_message_is_seen_with_what_to_do_and_an_alarm_is_not_covered() {
    let mut model = session();
    let _ = update(&mut model, Event::Clocks(clocks(now())));
    let _ = update(&mut model, Event::Key(Key::Enter));
    let report = Report::StopNotObeyed { after: Duration::from_secs(4), answers: true };
    let _ = update(&mut model, Event::Mount(Box::new(tracking()), vec![report]));
    let _ = update(&mut model, Event::ProjectorFailed("the projector is unplugged".into()));
    let Some(banner) = &model.banner else { panic!("an alarm stays") };
    assert_eq!(banner.weight, Weight::Alarm);
    let seen = text(&drawn(&model, Depth::True, 80, 24));
    let words: Vec<&str> = seen.split_whitespace().collect();
    assert!(words.join(" ").contains("Cut the mount's power"), "{seen}");
}

/// Bytes on their way to a terminal, kept where the test can read them.
#[derive(Clone, Default)]
struct Wire(Arc<std::sync::Mutex<Vec<u8>>>);

impl std::io::Write for Wire {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn what_a_terminal_shows_after_each_change_is_what_was_drawn() {
    let wire = Wire::default();
    let backend = scotopic::tui::backend::RedBackend::new(wire.clone(), || Ok((80, 24)));
    let mut terminal = Terminal::new(backend).unwrap();
    let (rows, columns) = (std::num::NonZero::new(24).unwrap(), std::num::NonZero::new(80).unwrap());
    let mut parser = vt100::Parser::new(rows, columns, 0);
    let mut states = states();
    let again: Vec<_> = states.iter().rev().cloned().collect();
    states.extend(again);
    for (name, model) in states {
        terminal.draw(|frame| draw(&model, Depth::Indexed, frame)).unwrap();
        parser.process(&std::mem::take(&mut *wire.0.lock().unwrap()));
        let shown: Vec<String> = parser.screen().rows(0, 80).map(|row| row.trim_end().to_owned()).collect();
        let drawn = text(&drawn(&model, Depth::Indexed, 80, 24));
        assert_eq!(shown.join("\n") + "\n", drawn, "{name}");
    }
}
