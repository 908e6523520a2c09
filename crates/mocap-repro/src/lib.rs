#![doc = include_str!("../README.md")]

mod bolero;
mod cell;
mod error;
mod figure;
mod leaderboard;
mod matrix;
mod method;
mod motions;
mod page;
mod reference;
mod report;
mod store;
mod summary;
mod table;
mod trial;

pub use bolero::{bolero_report, bolero_trials};
pub use cell::{Coordinates, Knowledge, Outcome};
pub use error::ReproError;
pub use leaderboard::{Protocol, leaderboard_report, leaderboard_trials};
pub use matrix::{Finished, Matrix, Progress, run};
pub use method::Variant;
pub use motions::{Motion, Motions};
pub use reference::{Compared, Reference, compare};
pub use report::Report;
pub use store::Store;
pub use summary::{Duel, Row, Stats, duels, summarise};
pub use table::{Entry, Table};
pub use trial::{Hide, Trial, fixture_trials, read_trials};

/// What tells the results of two builds apart: the version of this crate, and a fingerprint of the
/// sources of every method and metric.
pub const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "+", env!("MOCAP_REPRO_FINGERPRINT"));
