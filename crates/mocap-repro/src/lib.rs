#![doc = include_str!("../README.md")]

mod bolero;
mod calibration;
mod cell;
mod error;
mod figure;
mod leaderboard;
mod matrix;
mod method;
mod motions;
mod outcome;
mod protocol;
mod raw;
mod reference;
mod report;
mod section;
mod store;
mod summary;
mod sureness;
mod synth;
mod trial;

pub use bolero::{Evaluation, bolero_report};
pub use cell::{Coordinates, Knowledge};
pub use error::ReproError;
pub use leaderboard::leaderboard_report;
pub use matrix::{Finished, Matrix, Progress, run};
pub use method::Variant;
pub use motions::{Motion, Motions};
pub use outcome::{LengthOutcome, Outcome};
pub use protocol::{Protocol, protocol_trials};
pub use raw::{RawFill, raw_fills, raw_table};
pub use reference::{Compared, Reference, compare};
pub use report::Report;
pub use section::Section;
pub use store::Store;
pub use summary::{Duel, Row, Stats, duels, summarise};
pub use sureness::{LENGTH_EDGES_S, MULTIPLES, Sureness};
pub use synth::synth_report;
pub use trial::{Hide, Trial, fixture_trials, read_trials};

/// What tells the results of two builds apart: the version of this crate, and a fingerprint of the
/// sources of every method and metric.
pub const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "+", env!("MOCAP_REPRO_FINGERPRINT"));
