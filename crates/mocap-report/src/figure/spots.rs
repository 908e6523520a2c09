use std::{ops::Range, path::Path};

use mocap_core::{Mask, Take};

use super::{
    FigureFormat, PlotInput,
    cell::{FILLED_PEN, MEASURED_PEN, shorten},
    curve::{Curve, MM_PER_M},
    page::{CELL_HEIGHT, COLUMNS, FOOT_HEIGHT, HEADER_HEIGHT, MARGIN, WIDTH, draw_grid},
};
use crate::{
    ReportError,
    draw::{Align, Backend, Canvas, Drawing, colour, to_png, to_svg},
};

/// Spots that one figure can hold.
pub const MAX_SPOTS: usize = 36;
/// What is shown on either side of a spot, in seconds.
const CONTEXT_S: f64 = 0.25;
/// Longest window, in seconds.
const LONGEST_S: f64 = 4.0;

/// Frames of one marker to look at closely.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Spot {
    /// Marker index.
    pub marker: usize,
    /// Zero-based frames, end exclusive.
    pub frames: Range<usize>,
    /// A few words that stand beside it.
    pub note: String,
}

/// Draws the first [`MAX_SPOTS`] spots, each with a quarter of a second around it, in the format that the path's
/// extension names. Samples in `suspect`, `(T, M)`, are marked. Of a marker's coordinates the one is drawn
/// in which the spot stands out most.
///
/// # Errors
/// [`ReportError::Format`]; [`ReportError::Shape`] and [`ReportError::Core`] for a mask or a spot that does not
/// belong to the take.
pub fn plot_spots(
    title: &str,
    take: &Take,
    suspect: &Mask,
    spots: &[Spot],
    path: &Path,
) -> Result<Vec<u8>, ReportError> {
    let format = FigureFormat::from_path(path)?;
    let (bones, all) = (mocap_core::BoneSet::default(), spots.len());
    let input = PlotInput::take(title, take, &bones);
    input.check_size("the mask of suspect samples", suspect)?;
    let spots = &spots[..all.min(MAX_SPOTS)];
    for spot in spots {
        // Refuses a marker that is not there.
        take.select(&[spot.marker])?;
    }
    let curves = spots.iter().map(|spot| curve(&input, suspect, spot)).collect();
    let page = SpotPage { title, curves, all, rate_hz: take.rate_hz() };
    match format {
        FigureFormat::Svg => to_svg(&page),
        FigureFormat::Png => to_png(&page),
    }
}

fn curve(input: &PlotInput<'_>, suspect: &Mask, spot: &Spot) -> Curve {
    let (take, rate_hz) = (input.take, input.take.rate_hz());
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a moderate positive number
    let frames = |seconds: f64| (seconds * rate_hz).ceil().clamp(4.0, 1e7) as usize;
    let end = take.frames().min(spot.frames.end + frames(CONTEXT_S));
    let start = spot.frames.start.saturating_sub(frames(CONTEXT_S));
    let window = start..end.min(start + frames(LONGEST_S));
    let axis = outstanding(take, spot);
    let value = |t: usize| take.position(t, spot.marker).map(|p| MM_PER_M * p[axis]);
    let name = shorten(input.name(spot.marker), 12);
    Curve {
        heading: format!(
            "{name} {} (mm) from {:.2} s: {}",
            ["x", "y", "z"][axis],
            start as f64 / rate_hz,
            shorten(&spot.note, 30)
        ),
        values: window.clone().map(value).collect(),
        measured: window.clone().map(|t| !suspect.contains(t, spot.marker)).collect(),
        truth: window.map(|_| None).collect(),
        nominal: None,
        min_span: 20.0,
    }
}

/// The axis along which the spot's samples lie farthest from the straight line between the samples around it.
fn outstanding(take: &Take, spot: &Spot) -> usize {
    let at = |t: Option<usize>| {
        t.filter(|&t| t < take.frames()).and_then(|t| take.position(t, spot.marker))
    };
    let before = (0..spot.frames.start).rev().take(64).find_map(|t| at(Some(t)));
    let after = (spot.frames.end..take.frames()).take(64).find_map(|t| at(Some(t)));
    let (Some(from), Some(to)) = (before.or(after), after.or(before)) else { return 2 };
    let off = |axis: usize| {
        let line = |t: usize| {
            let share = (t + 1 - spot.frames.start) as f64 / (spot.frames.len() + 1) as f64;
            from[axis] + share * (to[axis] - from[axis])
        };
        let off = spot.frames.clone().filter_map(|t| Some((at(Some(t))?[axis] - line(t)).abs()));
        off.fold(0.0, f64::max)
    };
    (0..3).max_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(2)
}

/// A page of close-ups.
struct SpotPage<'a> {
    title: &'a str,
    curves: Vec<Curve>,
    /// How many spots there are, drawn or not.
    all: usize,
    rate_hz: f64,
}

impl Drawing for SpotPage<'_> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a few thousand
    fn size(&self) -> (u32, u32) {
        let rows = self.curves.len().div_ceil(COLUMNS) as f64;
        (WIDTH as u32, (HEADER_HEIGHT + rows * CELL_HEIGHT + FOOT_HEIGHT + MARGIN).ceil() as u32)
    }

    fn draw<DB: Backend>(&self, canvas: &mut Canvas<'_, DB>) -> Result<(), ReportError> {
        let (width, height) = self.size();
        canvas.bar((0.0, 0.0), (f64::from(width), f64::from(height)), plotters::style::WHITE)?;
        let title = shorten(self.title, 96);
        canvas.text(&title, (MARGIN, 38.0), 21.0, Align::Left, colour::INK)?;
        let count = match (self.all, self.curves.len()) {
            (0, _) => "no faults found".to_owned(),
            (all, shown) if shown < all => format!("the {shown} largest of {all} faults"),
            (all, _) => crate::summary::counted(all, "fault"),
        };
        canvas.text(&count, (MARGIN, 60.0), 13.0, Align::Left, colour::FAINT)?;
        let mut left = MARGIN;
        for (name, pen) in [("measured", MEASURED_PEN), ("suspect", FILLED_PEN)] {
            canvas.polyline(&[(left, 80.0), (left + 30.0, 80.0)], pen)?;
            canvas.text(name, (left + 37.0, 84.5), 12.5, Align::Left, colour::INK)?;
            left += 130.0;
        }
        draw_grid(canvas, &self.curves, HEADER_HEIGHT, self.rate_hz)
    }
}
