use super::number::roundest;
use crate::{ReadOptions, recording::ASSUMED_RATE_HZ};

/// What is known of a table's sampling rate.
#[derive(Default)]
pub(super) struct RateSources<'a> {
    /// In the header, in Hz.
    pub header: Option<f64>,
    /// The time column in seconds, one a frame, NaN where it has no number; empty without one.
    pub times: &'a [f64],
    /// Rounding error of one time, in seconds.
    pub time_error: f64,
}

/// A settled rate.
pub(super) struct Rate {
    pub hz: f64,
    pub is_declared: bool,
}

/// Settles the rate: the header's, else the time column's, else the caller's, else 120 Hz.
pub(super) fn settle(
    sources: &RateSources<'_>,
    options: &ReadOptions,
    notes: &mut Vec<String>,
) -> Rate {
    let by_time = from_times(sources.times, sources.time_error);
    if let Some(hz) = sources.header {
        if let Some(timed) = by_time.filter(|timed| disagree(*timed, hz)) {
            notes.push(format!(
                "the header says {hz} Hz, the time column runs at {timed} Hz; {hz} Hz is used"
            ));
        }
        note_given(hz, options, notes);
        return Rate { hz, is_declared: true };
    }
    if let Some(hz) = by_time {
        notes.push(format!("the sampling rate of {hz} Hz comes from the time column"));
        note_given(hz, options, notes);
        return Rate { hz, is_declared: true };
    }
    Rate { hz: undeclared(options, notes), is_declared: false }
}

/// The rate of a file that cannot state one.
pub(super) fn undeclared(options: &ReadOptions, notes: &mut Vec<String>) -> f64 {
    options.rate_hz.unwrap_or_else(|| {
        notes.push(format!(
            "the file states no sampling rate; {ASSUMED_RATE_HZ} Hz is assumed, as for CMU's \
             recordings; give the rate if it is another"
        ));
        ASSUMED_RATE_HZ
    })
}

fn note_given(hz: f64, options: &ReadOptions, notes: &mut Vec<String>) {
    if let Some(given) = options.rate_hz.filter(|given| disagree(*given, hz)) {
        notes.push(format!("the file's rate of {hz} Hz is used, not the given {given} Hz"));
    }
}

/// Rates closer than half a percent are one rate, written with few digits.
fn disagree(a: f64, b: f64) -> bool {
    (a - b).abs() > 0.005 * b.abs()
}

fn from_times(times: &[f64], error: f64) -> Option<f64> {
    let (first, last) = (times.first()?, times.last()?);
    let span = last - first;
    let rate = (times.len() - 1) as f64 / span;
    let is_rate = rate.is_finite() && rate > 0.0;
    is_rate.then(|| roundest(rate, 2.0 * error / span))
}
