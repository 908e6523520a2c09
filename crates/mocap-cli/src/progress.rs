//! A progress bar on a terminal, and nothing elsewhere.

use std::{io::IsTerminal, ops::ControlFlow};

use indicatif::{ProgressBar, ProgressStyle};
use mocap_core::IterReport;

/// The bar of one iterative method.
pub(crate) struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// A bar that shows itself if standard error is a terminal and `quiet` is not set.
    pub(crate) fn new(method: &str, quiet: bool) -> Self {
        let bar = if quiet || !std::io::stderr().is_terminal() {
            ProgressBar::hidden()
        } else {
            ProgressBar::new(0)
        };
        let style = ProgressStyle::with_template("{prefix} {bar:30} {pos}/{len} {msg} {eta}")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        bar.set_style(style);
        bar.set_prefix(method.to_owned());
        Self { bar }
    }

    /// Shows an iteration; never stops the work.
    pub(crate) fn show(&self, report: &IterReport) -> ControlFlow<()> {
        self.bar.set_length(report.limit as u64);
        self.bar.set_position(report.iteration as u64);
        self.bar.set_message(format!("objective {:.6e}", report.objective));
        ControlFlow::Continue(())
    }

    /// Shows that so many of so many are done.
    pub(crate) fn count(&self, done: usize, of: usize) {
        self.bar.set_length(of as u64);
        self.bar.set_position(done as u64);
    }

    /// Takes the bar away.
    pub(crate) fn finish(self) {
        self.bar.finish_and_clear();
    }
}
