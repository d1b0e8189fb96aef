//! Given an event, then this state and these effects.

use std::sync::Arc;
use std::time::Duration;

use proptest::prelude::*;

use super::*;
use crate::app::bindings::Bindings;
use crate::app::commands::Action;
use crate::app::key::{Arrow, Key};
use crate::app::log::Weight;
use crate::app::menu::Page;
use crate::app::model::{Opening, Projector, Screen};
use crate::app::scene::Scene;
use crate::hw::mount::belief::{Belief, Known, LinkState};
use crate::hw::mount::estimate::Estimate;
use crate::hw::mount::order::{Order, Report};
use crate::overlay::animation::Playable;
use crate::picture::Picture;
use crate::safety::suspend::Clocks;
use crate::safety::{Rules, TurnCounter};
use crate::sky::astrometry::{Astrometry, apparent};
use crate::sky::catalogue::{Band, Kind, Object};
use crate::sky::coords::{Equatorial, J2000, OfDate};
use crate::sky::ephemeris::{Body, Ephemeris};
use crate::sky::optics::Instrument;
use crate::sky::pointing::Motion;
use crate::sky::site::Site;
use crate::sky::sun;
use crate::sky::time::{Moment, Utc};
use crate::units::{Angle, Magnitude};

/// An evening in November, M31 high up.
const EVENING: &str = "2026-11-22T20:00:00Z";

fn opening() -> Opening {
    Opening {
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
    }
}

fn clocks(begin: &str, seconds: f64) -> Event {
    let begin = Duration::from_secs_f64(Utc::from_rfc3339(begin).unwrap().0);
    let awake = Duration::from_secs_f64(seconds);
    Event::Clocks(Clocks { wall: begin + awake, awake, always: Some(awake) })
}

fn here() -> Equatorial<OfDate> {
    Equatorial::new(Angle::degrees(11.0), Angle::degrees(41.4))
}

fn object(name: &str, position: Equatorial<J2000>) -> Object {
    Object {
        name: name.into(),
        names: vec![name.into()],
        kind: Kind::Galaxy,
        hubble: None,
        astrometry: Astrometry::fixed(position),
        magnitude: Some(Magnitude(3.4)),
        band: Band::V,
        colour_bv: None,
        axes_arcmin: None,
        position_angle: None,
        surface_brightness: None,

        distance: None,
        hand_controllers_place: false,
        constellation: "And",
    }
}

fn m31() -> Object {
    object("M31", Equatorial::new(Angle::degrees(10.6847), Angle::degrees(41.269)))
}

fn believed(position: Equatorial<OfDate>, motion: Motion, seconds: f64) -> Belief {
    let at = Duration::from_secs_f64(seconds);
    Belief {
        link: LinkState::Ready,
        position: Known::Confirmed { value: position, at },
        motion: Known::Confirmed { value: motion, at },
        estimate: Some(Estimate::new(position, motion, Angle::arcminutes(2.0), at)),
        ..Belief::default()
    }
}

fn told(belief: Belief) -> Event {
    Event::Mount(Box::new(belief), vec![Report::Position])
}

fn press(model: &mut Model, keys: &str) -> Vec<Effect> {
    keys.chars().flat_map(|c| update(model, Event::Key(if c == '\n' { Key::Enter } else { Key::Char(c) }))).collect()
}

/// A session that tracks M31 in the evening, its picture shown.
fn tracking() -> Model {
    let mut model = Model::new(opening());
    let _ = update(&mut model, clocks(EVENING, 1.0));
    let effects = update(&mut model, told(believed(here(), Motion::Tracking, 1.0)));
    assert!(matches!(effects[..], [Effect::Draw(_)]), "{effects:?}");
    let _ = update(&mut model, Event::Shown(Arc::new(Picture::black(4, 3))));
    model.target = Some(m31());
    let effects = update(&mut model, clocks(EVENING, 1.1));
    assert!(matches!(effects[..], [Effect::Draw(_)]), "the target is marked: {effects:?}");
    let _ = update(&mut model, Event::Shown(Arc::new(Picture::black(4, 3))));
    model
}

fn orders(effects: &[Effect]) -> Vec<&Order> {
    effects.iter().filter_map(|effect| if let Effect::Order(order) = effect { Some(order) } else { None }).collect()
}

#[test]
fn enter_goes_to_the_target_at_its_place_of_date() {
    let mut model = tracking();
    let effects = press(&mut model, "\n");
    let [Order::Goto(place)] = orders(&effects)[..] else { panic!("{effects:?}") };
    let moment = Moment::at(Utc::from_rfc3339(EVENING).unwrap());
    assert!(place.separation(&apparent(&m31().astrometry, &moment)).to_arcseconds() < 0.01);
}

#[test]
fn without_a_site_or_with_a_dead_clock_nothing_goes_anywhere() {
    let mut nowhere = Model::new(Opening { site: None, ..opening() });
    let mut long_ago = Model::new(Opening { time_stated: false, ..opening() });
    for (model, begin) in [(&mut nowhere, EVENING), (&mut long_ago, "2003-01-01T00:00:00Z")] {
        let _ = update(model, clocks(begin, 1.0));
        let _ = update(model, told(believed(here(), Motion::Tracking, 1.0)));
        model.target = Some(m31());
        let effects = press(model, "\n");
        assert!(orders(&effects).is_empty(), "{effects:?}");
        assert_eq!(model.counts.refused, 1);
        let banner = model.banner.clone().unwrap();
        assert!(banner.text.contains("Sun may be anywhere") && !banner.advice.is_empty(), "{banner:?}");
    }
}

#[test]
fn the_sun_is_not_gone_to() {
    let noon = "2026-11-22T11:30:00Z";
    let moment = Moment::at(Utc::from_rfc3339(noon).unwrap());
    let mut model = Model::new(opening());
    let _ = update(&mut model, clocks(noon, 1.0));
    let _ = update(&mut model, told(believed(here(), Motion::Tracking, 1.0)));
    let place = sun::apparent(&moment);
    model.target = Some(object("beside the Sun", Equatorial::new(place.ra(), place.dec() + Angle::degrees(20.0))));
    let effects = press(&mut model, "\n");
    assert!(orders(&effects).is_empty(), "{effects:?}");
    assert!(model.banner.unwrap().text.contains("from the Sun"));
}

#[test]
fn every_stop_key_stops_from_every_screen_and_asks_nothing() {
    for screen in Screen::ALL {
        for key in [Key::Esc, Key::Ctrl('x'), Key::Char(' ')] {
            let mut model = tracking();
            model.show(screen);
            let effects = update(&mut model, Event::Key(key));
            if screen == Screen::Search && key == Key::Char(' ') {
                assert_eq!(model.search.text, " ", "a space is typed");
                continue;
            }
            assert_eq!(orders(&effects), [&Order::Stop], "{key} on {}", screen.title());
        }
    }
}

#[test]
fn while_it_slews_the_projector_is_dark_and_it_lights_up_on_arrival() {
    let mut model = tracking();
    let slewing = Belief { slewing_to: Some(here()), ..believed(here(), Motion::Slewing, 2.0) };
    let _ = update(&mut model, clocks(EVENING, 2.0));
    assert_eq!(update(&mut model, told(slewing)), [Effect::Dark]);
    assert_eq!((&model.projector, &model.picture), (&Projector::Dark("the telescope moves"), &None));
    let arrived = Equatorial::new(Angle::degrees(80.0), Angle::degrees(10.0));
    let _ = update(&mut model, clocks(EVENING, 9.0 - 5.0));
    let effects = update(&mut model, told(believed(arrived, Motion::Tracking, 4.0)));
    assert!(matches!(effects[..], [.., Effect::Draw(_)]), "{effects:?}");
}

#[test]
fn a_stale_position_is_not_drawn_from() {
    let mut model = tracking();
    let mut effects = Vec::new();
    for quarter in 5..=20 {
        effects.extend(update(&mut model, clocks(EVENING, f64::from(quarter) / 4.0)));
    }
    assert_eq!(effects.last(), Some(&Effect::Dark));
    assert_eq!(model.projector, Projector::Dark("the position is too old"));
}

#[test]
fn after_a_suspend_nothing_is_believed_and_the_projector_is_dark() {
    let mut model = tracking();
    let begin = Duration::from_secs_f64(Utc::from_rfc3339(EVENING).unwrap().0);
    let (awake, slept) = (Duration::from_secs(2), Duration::from_secs(600));
    let woken = Clocks { wall: begin + awake + slept, awake, always: Some(awake + slept) };
    assert_eq!(update(&mut model, Event::Clocks(woken)), [Effect::Dark, Effect::Forget]);
    assert_eq!(model.belief.position, Known::Unknown);
    assert!(model.here.is_none() && model.picture.is_none() && model.field.is_empty());
    assert!(model.banner.unwrap().text.contains("slept for 600 s"));
}

#[test]
fn a_program_that_stood_still_believes_nothing_either() {
    let mut model = tracking();
    assert_eq!(update(&mut model, clocks(EVENING, 20.0)), [Effect::Dark, Effect::Forget]);
}

#[test]
fn a_nudge_moves_the_picture_stays_with_the_sky_and_ends_with_a_sync() {
    let mut model = tracking();
    let effects = update(&mut model, Event::Key(Key::Arrow(Arrow::Left)));
    let [.., Effect::Draw(scene)] = &effects[..] else { panic!("{effects:?}") };
    let pushed_px = scene.pointing.position.separation(&here()) / model.instrument.pixel_scale();
    assert!((pushed_px - 8.0).abs() < 0.1, "{pushed_px}");
    let nudge = model.nudge;
    let _ = update(&mut model, told(believed(here(), Motion::Tracking, 2.0)));
    assert_eq!(model.nudge, nudge, "a new position keeps it");
    let _ = press(&mut model, "S");
    let synced = Event::Mount(
        Box::new(believed(here(), Motion::Tracking, 3.0)),
        vec![Report::Synced { reply: "M31 EX GAL".into() }],
    );
    let _ = update(&mut model, synced);
    assert!(!model.nudged());
}

#[test]
fn opposite_nudges_cancel() {
    let mut model = tracking();
    for arrow in [Arrow::Left, Arrow::Up, Arrow::Right, Arrow::Down] {
        let _ = update(&mut model, Event::Key(Key::Shifted(arrow)));
    }
    assert!(model.nudge.east.to_arcseconds().hypot(model.nudge.north.to_arcseconds()) < 1e-3, "{:?}", model.nudge);
}

#[test]
fn a_movement_of_less_than_half_a_pixel_is_not_drawn() {
    for (pixels, drawn) in [(0.4, false), (0.6, true)] {
        let mut model = tracking();
        let step = model.instrument.pixel_scale() * pixels;
        let _ = update(&mut model, clocks(EVENING, 1.2));
        let moved = Equatorial::new(here().ra(), here().dec() + step);
        let effects = update(&mut model, told(believed(moved, Motion::Tracking, 1.2)));
        assert_eq!(!effects.is_empty(), drawn, "{pixels} px: {effects:?}");
    }
}

#[test]
fn a_lost_and_found_line_resumes_no_slew() {
    let mut model = tracking();
    let mut effects = press(&mut model, "\n");
    assert_eq!(orders(&effects).len(), 1);
    effects = update(&mut model, Event::Mount(Box::default(), vec![Report::Resynchronised]));
    let back = Report::Connected { product: "LX2001".into(), firmware: None };
    let belief = believed(here(), Motion::Tracking, 2.0);
    effects.extend(update(&mut model, Event::Mount(Box::new(belief), vec![back, Report::Position])));
    assert!(orders(&effects).is_empty(), "{effects:?}");
}

#[test]
fn the_hand_controller_driving_into_the_sun_is_stopped_with_an_alarm() {
    let noon = "2026-11-22T11:30:00Z";
    let sun = sun::apparent(&Moment::at(Utc::from_rfc3339(noon).unwrap()));
    let mut model = Model::new(opening());
    let mut effects = Vec::new();
    for step in 0..12 {
        let seconds = 1.0 + f64::from(step) * 0.25;
        let position = Equatorial::new(sun.ra(), sun.dec() + Angle::degrees(50.0 - 2.0 * f64::from(step)));
        let _ = update(&mut model, clocks(noon, seconds));
        effects.extend(update(&mut model, told(believed(position, Motion::Slewing, seconds))));
    }
    assert!(orders(&effects).contains(&&Order::Stop), "{effects:?}");
    assert_eq!(model.banner.unwrap().weight, Weight::Alarm);
}

#[test]
fn quitting_in_a_slew_stops_it_first() {
    let mut model = tracking();
    model.belief.slewing_to = Some(here());
    let effects = press(&mut model, "q");
    assert!(
        matches!(effects[..], [Effect::Dark, Effect::Order(Order::Stop), Effect::Keep(..), Effect::Quit, ..]),
        "{effects:?}"
    );
}

#[test]
fn a_far_away_sync_is_refused_as_a_mistake() {
    let mut model = tracking();
    model.target = Some(object("far", Equatorial::new(Angle::degrees(11.0), Angle::degrees(70.0))));
    assert!(orders(&press(&mut model, "S")).is_empty());
    model.target = Some(m31());
    assert!(matches!(orders(&press(&mut model, "S"))[..], [Order::Sync(_)]));
}

fn any_key() -> impl Strategy<Value = Key> {
    let arrow = prop_oneof![Just(Arrow::Up), Just(Arrow::Down), Just(Arrow::Left), Just(Arrow::Right)];
    prop_oneof![
        any::<char>().prop_map(Key::Char),
        prop::char::range(' ', '~').prop_map(Key::Char),
        prop::char::range('a', 'z').prop_map(Key::Ctrl),
        arrow.clone().prop_map(Key::Arrow),
        arrow.prop_map(Key::Shifted),
        prop_oneof![Just(Key::Enter), Just(Key::Esc), Just(Key::Backspace), Just(Key::Tab), Just(Key::PageDown)],
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever is typed: without a site there is no go-to, a stop key stops, and nothing panics.
    #[test]
    fn no_keys_in_any_order_move_a_telescope_of_unknown_place(keys in prop::collection::vec(any_key(), 0..60)) {
        let mut model = Model::new(Opening { site: None, ..opening() });
        let _ = update(&mut model, clocks(EVENING, 1.0));
        let _ = update(&mut model, told(believed(here(), Motion::Tracking, 1.0)));
        model.target = Some(m31());
        for key in keys {
            let effects = update(&mut model, Event::Key(key));
            prop_assert!(!orders(&effects).iter().any(|order| matches!(order, Order::Goto(_))), "{:?}", effects);
        }
        let effects = update(&mut model, Event::Key(Key::Ctrl('x')));
        prop_assert_eq!(orders(&effects), [&Order::Stop]);
    }
}

#[test]
fn a_weaker_sun_rule_holds_only_after_the_words_were_typed_where_names_are_typed() {
    let rules = Rules { sun_cone_deg: 5.0, ..Rules::default() };
    let mut model = Model::new(Opening { rules, ..opening() });
    let _ = update(&mut model, clocks(EVENING, 1.0));
    let _ = press(&mut model, "/certified solar filter\n");
    assert_eq!(model.acknowledged, None);
    let effects = press(&mut model, " fitted\n");
    assert!(model.acknowledged.is_some() && orders(&effects).is_empty());
    assert_eq!(model.view.screen, Screen::Sky);
    assert!(model.banner.as_ref().is_some_and(|banner| banner.text.contains("5° from the Sun")), "{:?}", model.banner);
}

/// A press of the hand controller's keys: `?`, or `?~` for the long one.
fn tapped(model: &mut Model, presses: &str) -> Vec<Effect> {
    let mut effects = Vec::new();
    for press in presses.split_whitespace() {
        let press = crate::app::bindings::Press::named(press);
        let at = model.time.now;
        let pressed = crate::hw::handbox::Pressed { key: press.key, long: press.long, at };
        effects.extend(update(model, Event::Handbox(pressed)));
    }
    effects
}

/// A session that tracks M31, with the keys of a profile.
fn with_keys(profile: &str) -> Model {
    let mut model = tracking();
    model.opening.bindings = Bindings::of_profile(profile);
    model
}

fn drawn(effects: &[Effect]) -> Option<&Scene> {
    effects.iter().rev().find_map(|effect| if let Effect::Draw(scene) = effect { Some(&**scene) } else { None })
}

#[test]
fn the_question_mark_steps_through_the_eyepieces_round_and_round_and_shows_the_list() {
    let mut model = with_keys("autostar2-guess");
    let count = model.instrument.eyepieces.len();
    for step in 1..=count {
        let effects = tapped(&mut model, "?");
        assert_eq!(model.instrument.eyepiece_index(), step % count);
        let menu = drawn(&effects).and_then(|scene| scene.menu.clone()).unwrap();
        assert_eq!((menu.title.as_str(), menu.bar), ("eyepiece", Some(step % count)));
        assert!(menu.lines[step % count].chosen);
    }
    assert_eq!(model.counts.presses, count as u64);
}

#[test]
fn with_one_key_alone_every_line_of_the_menu_can_be_reached_and_chosen() {
    for (line, action) in crate::app::menu::LINES.iter().enumerate() {
        let mut model = with_keys("a-cable-of-ones-own");
        let before = model.overlay;
        let _ = tapped(&mut model, "?~");
        assert_eq!(model.menu.as_ref().map(|menu| menu.page.clone()), Some(Page::Commands));
        let _ = tapped(&mut model, &"? ".repeat(line));
        assert_eq!(model.menu.as_ref().map(|menu| menu.bar), Some(line));
        let next = model.next_in_field().map(str::to_owned);
        let lights = model.lights();
        let _ = tapped(&mut model, "?~");
        let page = model.menu.as_ref().map(|menu| menu.page.clone());
        match action {
            Action::NextEyepiece => assert_eq!(page, Some(Page::Eyepieces)),
            Action::OverlayMode => assert_eq!(model.overlay.mode, before.mode.next()),
            Action::Photographs => assert!(!model.overlay.photographs),
            Action::Facts => assert!(!model.overlay.facts),
            Action::Animation => {
                assert!(matches!(page, Some(Page::Says(text)) if text.contains("no animation of M31")));
            }
            Action::OverlayBrighter => assert_eq!(model.overlay.brightness, before.brightness + 1),
            Action::OverlayDimmer => assert_eq!(model.overlay.brightness, before.brightness - 1),
            Action::PictureBrighter => assert!(model.lights().picture > lights.picture && page == Some(Page::Commands)),
            Action::PictureDimmer => assert!(model.lights().picture < lights.picture),
            Action::WordsBrighter => {
                // They are as bright as the picture already.
                assert_eq!(model.lights(), lights);
                assert!(matches!(page, Some(Page::Says(text)) if text.contains("never brighter than the picture")));
            }
            Action::WordsDimmer => assert!(model.lights().text < lights.text),
            Action::NextObject => assert_eq!(model.target.map(|target| target.name), next),
            Action::EyepieceHelp => assert_eq!(page, Some(Page::Help)),
            _ => assert_eq!(page, None),
        }
    }
}

#[test]
fn picture_and_words_go_up_and_down_by_half_magnitudes_beside_the_object_and_back_to_themselves() {
    let mut model = tracking();
    let plain = model.lights();
    let over = |lights: &crate::overlay::tone::Lights| lights.over_own_mag(lights.captions_cd_m2());
    let _ = press(&mut model, "[[[{");
    let dimmed = model.lights();
    assert!(dimmed.picture < 0.4 * plain.picture && dimmed.text <= dimmed.picture);
    let asked = model.overlay.tone.picture_over_object_mag.unwrap();
    assert!((asked * 2.0).fract() == 0.0, "{asked} is no half magnitude");
    let effects = press(&mut model, "}");
    assert!(over(&model.lights()) >= over(&dimmed));
    assert!(drawn(&effects).is_none_or(|scene| scene.tone == model.overlay.tone));
    let effects = press(&mut model, "]");
    assert_eq!(drawn(&effects).map(|scene| scene.tone), Some(model.overlay.tone), "the picture is drawn anew");
    let _ = press(&mut model, &"]".repeat(40));
    assert!(model.lights().picture <= 1.0 && model.overlay.tone.picture_over_object_mag.unwrap() < 15.0);
    let _ = press(&mut model, "nttt");
    assert_eq!(model.lights().method, crate::eye::tone::Method::Linear);
    let _ = press(&mut model, "t");
    assert_eq!(model.lights(), plain);
}

#[test]
fn the_menu_goes_away_by_itself_and_the_next_press_is_an_eyepiece_again() {
    let mut model = with_keys("autostar2-guess");
    let _ = tapped(&mut model, "?~ ?");
    let until = model.menu.as_ref().map(|menu| menu.until).unwrap();
    assert_eq!(model.wake_at(), Some(until), "the loop must wake for it");
    let _ = update(&mut model, told(believed(here(), Motion::Tracking, 11.0)));
    for quarter in 5..=45 {
        let seconds = f64::from(quarter) / 4.0;
        let _ = update(&mut model, told(believed(here(), Motion::Tracking, seconds)));
        let effects = update(&mut model, clocks(EVENING, seconds));
        assert_eq!(model.menu.is_some(), Duration::from_secs_f64(seconds) < until, "{seconds}");
        if model.menu.is_none() {
            assert_eq!(drawn(&effects).map(|scene| scene.menu.is_none()), Some(true), "drawn anew without it");
            break;
        }
    }
    assert!(model.menu.is_none());
    let index = model.instrument.eyepiece_index();
    let _ = tapped(&mut model, "?");
    assert_eq!(model.instrument.eyepiece_index(), index + 1);
}

#[test]
fn switched_off_the_picture_is_dark_but_the_menu_is_still_drawn_and_never_in_a_slew() {
    let mut model = with_keys("ascii");
    assert_eq!(tapped(&mut model, "1 1"), Vec::from_iter(drawn_then_dark(&model)), "over, beside, off");
    let effects = tapped(&mut model, "MODE");
    let scene = drawn(&effects).unwrap();
    assert!(scene.mode == crate::overlay::Mode::Off && scene.menu.is_some());
    assert_eq!(tapped(&mut model, "0"), [Effect::Dark], "closed: dark again");

    let _ = tapped(&mut model, "MODE");
    let slewing = Belief { slewing_to: Some(here()), ..believed(here(), Motion::Slewing, 2.0) };
    let _ = update(&mut model, clocks(EVENING, 2.0));
    assert_eq!(update(&mut model, told(slewing)), [Effect::Dark]);
    assert_eq!(tapped(&mut model, "DOWN ENTER ?"), [], "nothing is drawn while it moves");
}

/// What two presses of the overlay's key give: a picture beside, then dark.
fn drawn_then_dark(model: &Model) -> [Effect; 2] {
    let mut other = with_keys("ascii");
    other.time = model.time;
    let effects = tapped(&mut other, "1");
    assert_eq!(drawn(&effects).map(|scene| scene.mode), Some(crate::overlay::Mode::Beside));
    [effects.into_iter().next_back().unwrap(), Effect::Dark]
}

#[test]
fn keys_with_commands_of_their_own_do_them_at_once() {
    let mut model = with_keys("ascii");
    let effects = tapped(&mut model, "2");
    assert!(!drawn(&effects).unwrap().photographs);
    let effects = tapped(&mut model, "3");
    assert!(!drawn(&effects).unwrap().facts);
    let brighter = drawn(&tapped(&mut model, "6")).unwrap().brightness;
    assert!(brighter > drawn(&tapped(&mut model, "5")).unwrap().brightness);
    let effects = tapped(&mut model, "8");
    let page = |effects: &[Effect]| drawn(effects).and_then(|scene| scene.menu.clone()).unwrap();
    let (first, second, third) = (page(&effects), page(&tapped(&mut model, "?")), page(&tapped(&mut model, "?")));
    assert_eq!([&first, &second, &third].map(|menu| menu.title.as_str()), ["keys", "keys", "menu"]);
    let mut lines = first.lines.iter().chain(&second.lines);
    assert!(lines.any(|line| line.label == "?" && line.value == "eyepiece"), "{first:?} {second:?}");
}

#[test]
fn an_animation_plays_for_its_object_stands_in_a_slew_and_is_missed_aloud() {
    let mut model = with_keys("ascii");
    let playable = Playable { object: "M31".into(), frames: 4, frames_per_second: 2.0 };
    model.opening.animations = vec![Playable { object: "M57".into(), ..playable.clone() }, playable];
    let effects = tapped(&mut model, "4");
    assert_eq!(drawn(&effects).unwrap().animation, Some((1, 0)));
    let due = model.wake_at().unwrap();
    assert!((due.as_secs_f64() - 1.6).abs() < 1e-6, "half a second after 1.1 s: {due:?}");
    let effects = update(&mut model, clocks(EVENING, 1.7));
    assert_eq!(drawn(&effects).unwrap().animation, Some((1, 1)));

    let slewing = Belief { slewing_to: Some(here()), ..believed(here(), Motion::Slewing, 1.8) };
    let _ = update(&mut model, told(slewing));
    let _ = update(&mut model, clocks(EVENING, 3.8));
    let _ = update(&mut model, told(believed(here(), Motion::Tracking, 3.8)));
    assert_eq!(model.drawn.as_ref().unwrap().animation, Some((1, 1)), "it stood while the mount moved");

    assert_eq!(drawn(&tapped(&mut model, "4")).unwrap().animation, None);
    model.target = Some(object("M33", here_j2000()));
    let effects = tapped(&mut model, "4");
    let said = drawn(&effects).and_then(|scene| scene.menu.clone()).unwrap();
    let words: Vec<&str> = said.lines.iter().map(|line| line.label.as_str()).collect();
    assert!(words.join(" ").contains("there is no animation of M33"), "{words:?}");
}

fn here_j2000() -> Equatorial<J2000> {
    Equatorial::new(Angle::degrees(11.0), Angle::degrees(41.4))
}

#[test]
fn planets_are_listed_with_their_moons_and_tab_takes_the_planet() {
    let mut model = Model::new(opening());
    let _ = update(&mut model, clocks(EVENING, 1.0));
    let moment = Moment::at(Utc::from_rfc3339(EVENING).unwrap());
    let saturn = Ephemeris::at(&moment).unwrap().place(Body::Saturn).apparent;
    let _ = update(&mut model, told(believed(saturn, Motion::Tracking, 1.0)));
    let listed = |name: &str| model.field.iter().find(|listed| listed.name == name);
    assert!(listed("Saturn").is_some_and(|saturn| saturn.what == "planet" && saturn.choosable), "{:?}", model.field);
    // Titan's orbit is 20 radii of Saturn.
    let titan = listed("Titan").unwrap();
    assert!(titan.what == "moon" && titan.separation.to_arcseconds() < 220.0 && !titan.choosable, "{titan:?}");
    let radius = model.instrument.true_field() / 2.0;
    assert!(model.field.iter().filter(|listed| listed.what.starts_with("moon")).all(|moon| moon.separation <= radius));
    let _ = update(&mut model, Event::Key(Key::Tab));
    assert_eq!(model.target.as_ref().map(|target| target.name.as_str()), Some("Saturn"));

    // From beside the planet a narrow field holds it and not those of its moons that are on the other side.
    let all = model.field.len();
    let _ = update(&mut model, Event::Key(Key::Char('w')));
    assert!(model.instrument.true_field() / 2.0 != radius && model.field.len() != all, "{:?}", model.field);
    let radius = model.instrument.true_field() / 2.0;
    assert!(model.field.iter().all(|listed| listed.choosable || listed.separation <= radius), "{:?}", model.field);
}

#[test]
fn while_the_menu_is_open_the_keyboards_enter_chooses_and_goes_nowhere() {
    let mut model = tracking();
    let _ = press(&mut model, "M");
    let _ = update(&mut model, Event::Key(Key::Arrow(Arrow::Down)));
    let effects = press(&mut model, "\n");
    assert!(orders(&effects).is_empty(), "{effects:?}");
    assert_eq!(model.overlay.mode, crate::overlay::Mode::Beside);
    let _ = update(&mut model, Event::Key(Key::Backspace));
    assert!(model.menu.is_none() && !model.nudged());
    assert_eq!(orders(&update(&mut model, Event::Key(Key::Esc))), [&Order::Stop], "stop is stop");
}

#[test]
fn an_alarm_is_not_put_away_by_the_hand_controller() {
    let mut model = with_keys("ascii");
    model.say(Weight::Alarm, "STOPPED: the Sun", "");
    let _ = tapped(&mut model, "4 ? 7");
    assert_eq!(model.banner.as_ref().map(|banner| banner.weight), Some(Weight::Alarm));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Whatever is pressed on a tapped hand controller, bound to whatever may be bound: nothing moves, and a stop stops.
    #[test]
    fn no_tapped_keys_in_any_order_move_a_telescope(presses in prop::collection::vec((0usize..60, any::<bool>()), 0..40)) {
        let mut model = tracking();
        let mut bindings = Bindings::default();
        for (index, command) in crate::app::commands::COMMANDS.iter().enumerate() {
            let (short, long) = (format!("{index}"), format!("{index}~"));
            bindings = bindings.clone().with([(short.as_str(), command.id), (long.as_str(), command.id)]).unwrap_or(bindings);
        }
        model.opening.bindings = bindings;
        for (index, long) in presses {
            let press = if long { format!("{index}~") } else { format!("{index}") };
            for order in orders(&tapped(&mut model, &press)) {
                prop_assert!(matches!(order, Order::Stop | Order::Compare | Order::ReadDisplay), "{:?}", order);
            }
        }
    }
}
