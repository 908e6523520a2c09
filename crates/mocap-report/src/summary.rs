mod fill;
mod take;

pub use fill::{BrokenBones, FillSummary, GapFill, Share};
pub use take::{GapSummary, MarkerSummary, TakeSummary};

/// Number that a file gives to a frame.
fn file_frame(first_frame: i64, frame: usize) -> i64 {
    first_frame.saturating_add(i64::try_from(frame).unwrap_or(i64::MAX))
}

/// `1 gap`, `2 gaps`.
pub(crate) fn counted(count: usize, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}
