//! Lessons over invented cables, and what the maps they give then hear.

use super::*;
use crate::hw::handbox::keymap::Lead;
use crate::hw::handbox::{Decoder, Heard};
use crate::numerics::streams::Stream;

fn ms(ms: u64) -> Duration {
    Duration::from_millis(ms)
}

fn event(at: u64, bytes: &[u8]) -> Event {
    Event { at: ms(at), bytes: bytes.to_vec(), note: String::new() }
}

/// Five presses, each of these bursts 100 ms apart.
fn five(bursts: &[&[u8]]) -> Vec<Vec<Event>> {
    (0..5).map(|_| bursts.iter().enumerate().map(|(n, burst)| event(100 * n as u64, burst)).collect()).collect()
}

/// The keys that a map hears in bursts 200 ms apart.
fn keys(map: &KeyMap, bursts: &[&[u8]]) -> Vec<String> {
    let mut decoder = Decoder::new(map.clone());
    let mut heard = Vec::new();
    for (n, burst) in bursts.iter().enumerate() {
        heard.extend(decoder.feed(burst, ms(1000 + 200 * n as u64)));
        heard.extend(decoder.tick(ms(1100 + 200 * n as u64)));
    }
    heard.into_iter().filter_map(|h| if let Heard::Pressed(p) = h { Some(p.key) } else { None }).collect()
}

#[test]
fn a_press_and_its_release_in_bit_7_are_learned() {
    let mut lesson = Lesson::new(&[]);
    let key = lesson.learn("?", &five(&[&[0x3F], &[0xBF]])).unwrap();
    assert_eq!((key.press.to_string(), key.release.unwrap().to_string()), ("3F".into(), "BF".into()));
    lesson.learn("MODE", &five(&[&[0x09], &[0x89]])).unwrap();
    let map = lesson.map("mine", Line::default()).unwrap();
    assert_eq!(map.framing().mode, Mode::Bit7);
    assert_eq!(keys(&map, &[&[0x3F], &[0xBF], &[0x09], &[0x89], &[0x55]]), ["?", "MODE"]);
}

#[test]
fn keys_that_bounce_are_learned_all_the_same() {
    let mut takes = five(&[&[0x3F], &[0xBF]]);
    takes[1] = vec![event(0, &[0x3F, 0xBF, 0x3F]), event(100, &[0xBF])];
    takes[3] = vec![event(0, &[0x3F]), event(100, &[0xBF, 0x3F, 0xBF])];
    let mut lesson = Lesson::new(&[]);
    let key = lesson.learn("?", &takes).unwrap();
    assert_eq!((key.press.to_string(), key.release.unwrap().to_string()), ("3F".into(), "BF".into()));
}

#[test]
fn idle_traffic_is_cut_out_of_the_presses_and_ignored_by_the_map() {
    let idle: Vec<Event> = (0..20).map(|n| event(50 * n, &[0xA5, 0x00])).collect();
    let mut lesson = Lesson::new(&idle);
    assert_eq!(lesson.idle(), ["A5 00"]);
    // The key's byte comes right after the traffic, before it, or alone.
    let takes: Vec<Vec<Event>> = (0..5)
        .map(|n| match n % 3 {
            0 => vec![event(0, &[0xA5, 0x00, 0x21]), event(50, &[0xA5, 0x00])],
            1 => vec![event(0, &[0x21, 0xA5, 0x00])],
            _ => vec![event(0, &[0xA5, 0x00]), event(60, &[0x21])],
        })
        .collect();
    assert_eq!(lesson.learn("?", &takes).unwrap().press.to_string(), "21");
    let map = lesson.map("mine", Line::default()).unwrap();
    assert_eq!(keys(&map, &[&[0xA5, 0x00], &[0x21, 0xA5, 0x00], &[0xA5, 0x00]]), ["?"]);
}

#[test]
fn frames_of_one_length_are_learned_whole_with_wildcards_for_what_varies() {
    let mut stream = Stream::seeded(5);
    let mut takes = |code: u8| -> Vec<Vec<Event>> {
        (0..5)
            .map(|_| {
                let (a, b) = (stream.byte(), stream.byte());
                vec![event(0, &[0x02, a, code, 0x03]), event(120, &[0x02, b, code | 0x80, 0x03])]
            })
            .collect()
    };
    let mut lesson = Lesson::new(&[]);
    lesson.learn("?", &takes(0x3F)).unwrap();
    lesson.learn("MODE", &takes(0x09)).unwrap();
    let map = lesson.map("mine", Line::default()).unwrap();
    assert_eq!(map.keys()[0].press.to_string(), "02 ?? 3F 03");
    assert_eq!(map.keys()[0].release.as_ref().unwrap().to_string(), "02 ?? BF 03");
    assert_eq!((map.framing().mode, map.framing().length, map.framing().lead), (Mode::Fixed, Some(4), Some(Lead(2))));
    // The listener begins in the middle of a frame; another key passes; two frames come in one go.
    let bursts: [&[u8]; 3] = [&[0x3F, 0x03], &[0x02, 1, 0x41, 0x03], &[0x02, 9, 0x09, 3, 2, 9, 0x89, 3]];
    assert_eq!(keys(&map, &bursts), ["MODE"]);
}

#[test]
fn a_release_that_only_differs_in_its_first_byte_is_not_taken_for_the_press() {
    let mut lesson = Lesson::new(&[]);
    lesson.learn("?", &five(&[&[0xE0, 0x3F], &[0xF0, 0x3F]])).unwrap();
    lesson.learn("MODE", &five(&[&[0xE0, 0x09], &[0xF0, 0x09]])).unwrap();
    let map = lesson.map("mine", Line::default()).unwrap();
    assert_eq!(keys(&map, &[&[0xE0, 0x3F], &[0xF0, 0x3F], &[0xE0, 0x09], &[0xF0, 0x09]]), ["?", "MODE"]);
}

#[test]
fn frames_of_several_lengths_end_with_silence() {
    let mut lesson = Lesson::new(&[]);
    lesson.learn("?", &five(&[&[0x10, 0x20, 0x30]])).unwrap();
    lesson.learn("MODE", &five(&[&[0x10, 0x21, 0x31, 0x41, 0x51]])).unwrap();
    let map = lesson.map("mine", Line::default()).unwrap();
    assert_eq!(map.framing().mode, Mode::Gap);
    assert_eq!(keys(&map, &[&[0x10, 0x20, 0x30], &[0x10, 0x99], &[0x10, 0x21, 0x31, 0x41, 0x51]]), ["?", "MODE"]);
}

#[test]
fn text_for_the_display_on_the_same_wire_is_left_out() {
    let text = [b"\x1B1Select Item:    ".as_slice(), b"\x1B2 Object         "].concat();
    let mut takes = five(&[&[0x4D], &[0xCD]]);
    takes.iter_mut().for_each(|take| take.insert(1, event(40, &text)));
    let mut lesson = Lesson::new(&[event(0, &text)]);
    lesson.learn("MODE", &takes).unwrap();
    let map = lesson.map("mine", Line::default()).unwrap();
    assert_eq!(map.framing().mode, Mode::Escape);
    assert_eq!(keys(&map, &[&[0x4D], &text, &[0xCD]]), ["MODE"]);
}

#[test]
fn a_long_press_that_sends_something_else_is_learned_under_its_key() {
    let mut lesson = Lesson::new(&[]);
    lesson.learn("MODE", &five(&[&[0x09], &[0x89]])).unwrap();
    let key = lesson.learn("MODE~", &five(&[&[0x09], &[0x0B], &[0x89]])).unwrap();
    assert_eq!(key.long.unwrap().to_string(), "0B");
    assert_eq!(lesson.learn("ENTER~", &five(&[&[0x0A]])), Err(LearnError::NoSuchKey("ENTER".into())));
}

#[test]
fn what_cannot_be_learned_is_said_and_not_kept() {
    let mut lesson = Lesson::new(&[event(0, &[0xAA])]);
    assert_eq!(lesson.learn("?", &five(&[&[0xAA]])), Err(LearnError::Silent("?".into())));
    let differ: Vec<Vec<Event>> = (0..5).map(|n| vec![event(0, &[n])]).collect();
    assert!(matches!(lesson.learn("?", &differ), Err(LearnError::Disagree { .. })));
    lesson.learn("?", &five(&[&[0x3F], &[0xBF]])).unwrap();
    let same = lesson.learn("MODE", &five(&[&[0x3F], &[0xBF]]));
    assert_eq!(same, Err(LearnError::Same { key: "MODE".into(), other: "?".into() }));
    assert_eq!(lesson.map("mine", Line::default()).unwrap().keys().len(), 1);
}
