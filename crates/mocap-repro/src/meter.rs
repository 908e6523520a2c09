//! How far a run is, and how long it will take.

use std::{
    io::IsTerminal,
    sync::{Mutex, PoisonError},
    time::{Duration, Instant},
};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use mocap_repro::Progress;

/// A bar on a terminal; elsewhere a line now and then, for whoever reads a log.
pub(crate) struct Meter {
    bar: ProgressBar,
    start: Instant,
    /// When the last line was printed; `None` on a terminal.
    line: Option<Mutex<Instant>>,
}

/// Time between two lines of a log.
const PAUSE: Duration = Duration::from_secs(20);

impl Meter {
    pub(crate) fn new() -> Self {
        let start = Instant::now();
        if !std::io::stderr().is_terminal() {
            return Self { bar: ProgressBar::hidden(), start, line: Some(Mutex::new(start)) };
        }
        let style =
            ProgressStyle::with_template("{bar:40} {percent} %  {elapsed} gone, {eta} to go")
                .unwrap_or_else(|_| ProgressStyle::default_bar());
        Self { bar: ProgressBar::new(0).with_style(style), start, line: None }
    }

    pub(crate) fn show(&self, progress: Progress) {
        self.bar.set_length(progress.total as u64);
        self.bar.set_position(progress.done as u64);
        let Some(line) = &self.line else { return };
        let mut last = line.lock().unwrap_or_else(PoisonError::into_inner);
        if last.elapsed() >= PAUSE {
            *last = Instant::now();
            eprintln!("{}", report(progress, self.start.elapsed()));
        }
    }

    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// Done in percent, time gone, and time to go if the rest goes as fast.
fn report(progress: Progress, gone: Duration) -> String {
    let share = progress.done as f64 / progress.total.max(1) as f64;
    let left = gone.mul_f64(((1.0 - share) / share.max(1e-6)).clamp(0.0, 1e6));
    let (gone, left) = (HumanDuration(gone), HumanDuration(left));
    format!("{:.0} % done, {gone} gone, {left} to go", 100.0 * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_goes_as_fast_as_what_was_done() {
        let line = report(Progress { done: 25, total: 100 }, Duration::from_secs(10));
        assert_eq!(line, "25 % done, 10 seconds gone, 30 seconds to go");
        assert!(report(Progress { done: 0, total: 0 }, Duration::ZERO).starts_with("0 %"));
    }
}
