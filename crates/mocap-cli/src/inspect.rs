use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use mocap_core::{MarkerKnowledge, UpAxis};
use mocap_io::{Format, MarkerFile, MotionFile};
use mocap_report::TakeSummary;
use serde_json::json;

use crate::files::ReadArgs;
use crate::say::say;

/// Tell what a recording holds: markers, rate, units, storage, and where its gaps are
///
/// A damaged file is refused with the place of the damage; --salvage reads what is there of it.
#[derive(Debug, Args)]
pub(crate) struct Inspect {
    /// Recording
    input: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// List every gap, not the first 20 alone
    #[arg(long)]
    gaps: bool,
    #[command(flatten)]
    read: ReadArgs,
}

/// Gaps that the text lists unless it is asked for all.
const SHOWN_GAPS: usize = 20;

impl Inspect {
    pub(crate) fn run(self) -> Result<()> {
        match Format::of(&self.input) {
            Some(format) if !format.holds_markers() => self.motion(),
            _ => self.markers(&self.read.read(&self.input)?),
        }
    }

    fn markers(&self, file: &MarkerFile) -> Result<()> {
        let (take, info) = (file.take(), file.info());
        let summary = TakeSummary::new(take, info.first_frame);
        let up =
            UpAxis::guess(take, &MarkerKnowledge::for_markers(take.markers())).map(|up| match up {
                UpAxis::Y => "Y",
                UpAxis::Z => "Z",
            });
        if self.json {
            let mut object = serde_json::to_value(&summary)?;
            let missing = json!({
                "negative_residual": info.missing.negative_residual,
                "not_a_number": info.missing.not_a_number,
                "exact_zero": info.missing.exact_zero,
                "blank": info.missing.blank,
            });
            let other: Vec<_> = info
                .other_points
                .iter()
                .map(|(name, kind)| json!({"name": name, "kind": kind}))
                .collect();
            for (key, value) in [
                ("format", json!(info.format.extension())),
                ("storage", json!(info.storage)),
                ("unit", json!(info.unit.symbol())),
                ("unit_declared", json!(info.unit_declared)),
                ("rate_declared", json!(info.rate_declared)),
                ("up_axis", json!(up)),
                ("missing_marks", missing),
                ("other_points", json!(other)),
                ("notes", json!(info.notes)),
            ] {
                object[key] = value;
            }
            say!("{object}");
            return Ok(());
        }
        say!("{}", self.input.display());
        say!("  format    {}, {}", info.format.extension().to_uppercase(), info.storage);
        let assumed = if info.unit_declared { "" } else { " (assumed)" };
        say!("  unit      {}{assumed}, up axis {}", info.unit.symbol(), up.unwrap_or("unknown"));
        let marks = info.missing;
        for (count, how) in [
            (marks.negative_residual, "a negative residual"),
            (marks.not_a_number, "NaN"),
            (marks.exact_zero, "exact zeros"),
            (marks.blank, "blank fields"),
        ] {
            if count > 0 {
                say!("  missing   {count} samples by {how}");
            }
        }
        if !info.other_points.is_empty() {
            say!("  other     {} points that are no markers", info.other_points.len());
        }
        info.notes.iter().for_each(|note| say!("  note      {note}"));
        say!("\n{}", summary.to_text());
        say!("{}", summary.gaps_text(if self.gaps { usize::MAX } else { SHOWN_GAPS }));
        Ok(())
    }

    fn motion(&self) -> Result<()> {
        let file = MotionFile::read(&self.input, None, &self.read.options())?;
        let motion = file.motion();
        let joints: Vec<&str> =
            motion.skeleton().joints().iter().map(|j| j.name.as_str()).collect();
        let (frames, rate) = (motion.poses().len(), motion.rate_hz());
        if self.json {
            let object = json!({"joints": joints, "frames": frames, "rate_hz": rate});
            say!("{object}");
        } else {
            say!("{}", self.input.display());
            say!("  {} joints, {frames} frames at {rate} Hz", joints.len());
            say!("  {}", joints.join(" "));
        }
        Ok(())
    }
}
