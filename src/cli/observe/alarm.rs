//! A thread that breaks ends the session: nothing may move, or shine, with nobody listening to it.

use std::sync::mpsc::Sender;
use std::time::Duration;

/// Kept by what a thread runs: says so when that thread panics.
pub(super) struct Alarm<W>(Option<(Sender<W>, W)>);

impl<W> Alarm<W> {
    /// An alarm that sends this.
    pub(super) fn new(to: &Sender<W>, what: W) -> Alarm<W> {
        Alarm(Some((to.clone(), what)))
    }
}

impl<W> Drop for Alarm<W> {
    fn drop(&mut self) {
        if std::thread::panicking()
            && let Some((to, what)) = self.0.take()
        {
            // Nobody listens any more: the session is ending.
            let _ = to.send(what);
        }
    }
}

/// Panics in a thread on order, to show that every end of a session is dark: `SCOTOPIC_TEST_PANIC=SECONDS@THREAD`.
pub(super) fn rehearse(thread: &str, now: Duration) {
    let Some(asked) = std::env::var_os("SCOTOPIC_TEST_PANIC") else { return };
    let due = asked
        .to_str()
        .and_then(|text| text.split_once('@'))
        .is_some_and(|(after, name)| name == thread && after.parse().is_ok_and(|after: f64| now.as_secs_f64() > after));
    if due {
        #[expect(clippy::panic, reason = "asked for, to show that everything is given back")]
        {
            panic!("SCOTOPIC_TEST_PANIC asked for it in the thread '{thread}'");
        }
    }
}
