//! `scotopic simulate handbox`: a hand controller on a pseudo terminal, whose keys are pressed by lines on standard input.

use std::io::BufRead;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use clap::Args;

use super::say_endpoint;
use crate::cli::Failure;
use crate::cli::handbox::map;
use crate::hw::handbox::keymap::Line;
use crate::hw::handbox::sim::serve::Server;
use crate::hw::handbox::sim::{Faults, Handset};

/// A tap.
const SHORT: Duration = Duration::from_millis(100);
/// A press that is meant to be long.
const LONG: Duration = Duration::from_millis(1200);
/// Between the release of a key and the next press.
const PAUSE: Duration = Duration::from_millis(300);
/// The longest time between two looks at the input.
const LOOK: Duration = Duration::from_millis(5);

/// The simulated hand controller.
#[derive(Debug, Args)]
#[command(after_help = "Lines on standard input:\n  \
    ?          a tap of key ?\n  \
    ?~         a long press\n  \
    ? 300      held for 300 ms\n  \
    stick ? 2000    stuck for 2 s\n  \
    wait 500   half a second of nothing\n  \
    send 02 3F bytes of any kind\n\n\
    Example:\n  \
    printf '?\\nwait 1000\\nMODE\\n' | scotopic simulate handbox --map autostar2-guess")]
pub struct Handbox {
    /// Its keys and its line: a built-in key map, or a file
    #[arg(long, value_name = "NAME|FILE", default_value = "lx200-classic")]
    map: String,
    /// Another speed of its line
    #[arg(long, value_name = "BAUD", value_parser = clap::value_parser!(u32).range(300..=1_000_000))]
    baud: Option<u32>,
    /// Share of presses and releases that bounce, 0 to 1
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = share)]
    bounce: f64,
    /// Share of presses with a byte of noise before them
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = share)]
    noise: f64,
    /// Share of presses and releases that are missing
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = share)]
    missing: f64,
    /// Text for the display passes on the same wire
    #[arg(long)]
    display: bool,
    /// Send the start-up sequence first
    #[arg(long)]
    switch_on: bool,
    /// Seed of everything random
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

fn share(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|share| (0.0..=1.0).contains(share)).ok_or_else(|| "give a number from 0 to 1".into())
}

/// Runs until it is told to end.
///
/// # Errors
/// It was asked wrongly, or there is no pseudo terminal.
pub(super) fn run(arguments: &Handbox) -> Result<(), Failure> {
    let mut keys = map::load(Some(&arguments.map))?;
    if let Some(baud) = arguments.baud {
        let line = Line { baud, ..keys.line() };
        keys = keys.over(line);
    }
    let Handbox { bounce, noise, missing, display, seed, .. } = *arguments;
    let handset = Handset::new(keys, Faults { bounce, noise, missing, display }, seed);
    let mut server = Server::open(handset, seed).map_err(Failure::failed)?;
    let ended = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGTERM, signal_hook::consts::SIGINT, signal_hook::consts::SIGHUP] {
        signal_hook::flag::register(signal, Arc::clone(&ended)).map_err(Failure::failed)?;
    }
    say_endpoint(server.endpoint())?;
    let lines = lines()?;
    // Keys are pressed one after the other, however fast their lines come.
    let mut free = Duration::ZERO;
    if arguments.switch_on {
        server.handset().switch_on(Duration::ZERO);
    }
    while !ended.load(Ordering::Relaxed) {
        while let Ok(line) = lines.try_recv() {
            let at = free.max(server.now());
            match act(server.handset(), &line, at) {
                Ok(done) => free = done,
                Err(why) => eprintln!("{why}"),
            }
        }
        server.step(LOOK).map_err(|error| Failure::Failed(format!("the pseudo terminal is lost: {error}")))?;
    }
    Ok(())
}

/// Lines of standard input, from a thread of their own; its end is no end of the hand controller.
fn lines() -> Result<Receiver<String>, Failure> {
    let (sender, receiver) = channel();
    std::thread::Builder::new()
        .name("input".into())
        .spawn(move || {
            let _ = std::io::stdin().lock().lines().map_while(Result::ok).try_for_each(|line| sender.send(line));
        })
        .map_err(Failure::failed)?;
    Ok(receiver)
}

/// Does what a line says, from `at` on; gives the time at which the next may begin.
fn act(handset: &mut Handset, line: &str, at: Duration) -> Result<Duration, String> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let ms = |text: &str| match text.parse::<u64>() {
        Ok(ms @ 0..=3_600_000) => Ok(Duration::from_millis(ms)),
        _ => Err(format!("'{text}' is no number of milliseconds")),
    };
    match words.as_slice() {
        [] => Ok(at),
        ["wait", time] => Ok(at + ms(time)?),
        ["stick", key, time] => {
            let lasting = ms(time)?;
            handset.stick(key, at, lasting).map_err(|error| error.to_string())?;
            Ok(at + lasting + PAUSE)
        }
        ["send", bytes @ ..] => {
            let read = |byte: &&str| u8::from_str_radix(byte, 16).map_err(|_no_hex| format!("'{byte}' is no byte"));
            handset.send(at, bytes.iter().map(read).collect::<Result<_, _>>()?);
            Ok(at + PAUSE)
        }
        [key, time] => press(handset, key, at, ms(time)?),
        [key] => match key.strip_suffix('~') {
            Some(key) => press(handset, key, at, LONG),
            None => press(handset, key, at, SHORT),
        },
        _ => Err(format!("'{line}' is not understood: write a key, or see --help")),
    }
}

fn press(handset: &mut Handset, key: &str, at: Duration, held: Duration) -> Result<Duration, String> {
    handset.press(key, at, held).map_err(|error| error.to_string())?;
    Ok(at + held + PAUSE)
}
