use mocap_core::Take;

use super::number;
use crate::LengthUnit;

/// Appends one row a frame: what `lead` says, then the positions, blank where missing.
pub(super) fn push_rows(
    out: &mut Vec<u8>,
    take: &Take,
    unit: LengthUnit,
    delimiter: char,
    lead: impl Fn(usize) -> String,
) {
    for frame in 0..take.frames() {
        let mut row = lead(frame);
        for marker in 0..take.marker_count() {
            // A position beyond the largest number in this unit cannot be written: `inf` is none.
            let texts = take.position(frame, marker).and_then(|p| number::position(p, unit));
            for text in texts.unwrap_or_default() {
                if !row.is_empty() || marker > 0 {
                    row.push(delimiter);
                }
                row.push_str(&text);
            }
        }
        row.push('\n');
        out.extend_from_slice(row.as_bytes());
    }
}

/// A name that cannot break the lines and tab-separated fields of a table.
pub(super) fn plain_name(name: &str) -> String {
    name.trim().chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// Time of a frame in seconds, to the nanosecond. The zeros at its end tell how exact it is.
pub(super) fn time(take: &Take, frame: usize) -> String {
    format!("{:.9}", frame as f64 / take.rate_hz())
}
