//! A solved motion: the skeleton at some moments with the markers round it, and how far they miss.

use mocap_core::{CoreError, Motion, Take, UpAxis};

use super::axes::{Axes, Interval};
use crate::{
    ReportError,
    draw::{Align, Backend, Canvas, Drawing, Pen, Point, colour},
};

/// A motion with the markers that it was solved from.
#[derive(Debug, Clone, Copy)]
pub struct MotionPlot<'a> {
    /// Heading of the figure.
    pub title: &'a str,
    /// The solved motion.
    pub motion: &'a Motion,
    /// The markers in the same axes, of as many frames.
    pub take: &'a Take,
    /// Root mean square distance of the markers from where the motion has them, in metres, `(T,)`.
    pub residual_m: &'a [f64],
    /// The vertical axis.
    pub up: UpAxis,
}

const WIDTH: f64 = 1200.0;
const HEIGHT: f64 = 600.0;
const MARGIN: f64 = 60.0;
const FLOOR: f64 = 400.0;
const HEAD: f64 = 90.0;
/// Figures beside each other.
const STILLS: usize = 6;

pub(super) const BONE_PEN: Pen = Pen::solid(colour::INK, 2.5);
const FLOOR_PEN: Pen = Pen::solid(colour::GRID, 1.5);
const CURVE_PEN: Pen = Pen::solid(colour::FILLED, 1.2);

/// What is seen of a motion from one side: metres to the right and up.
pub(super) struct View<'a> {
    pub(super) plot: &'a MotionPlot<'a>,
    right: [f64; 3],
    up: [f64; 3],
    /// Places of the joints in each frame, in metres.
    pub(super) joints: Vec<Vec<[f64; 3]>>,
    /// Height of the lowest and the highest point.
    pub(super) heights: Interval,
}

impl<'a> View<'a> {
    /// Looks from the side on a body that walks, and from the front on one that stays.
    pub(super) fn new(plot: &'a MotionPlot<'a>) -> Result<Self, ReportError> {
        let frames = plot.motion.poses().len();
        if plot.take.frames() != frames || plot.residual_m.len() != frames {
            let (markers, found_markers) = (plot.take.marker_count(), plot.take.marker_count());
            let found_frames = plot.take.frames();
            let what = "the solved motion";
            return Err(ReportError::Shape {
                what,
                frames: found_frames,
                markers,
                found_frames: frames,
                found_markers,
            });
        }
        let skeleton = plot.motion.skeleton();
        let joints = plot.motion.poses().iter().map(|pose| skeleton.positions(pose));
        let joints = joints.collect::<Result<Vec<_>, CoreError>>()?;
        let (x, y, z) = match plot.up {
            UpAxis::Z => (0, 1, 2),
            UpAxis::Y => (2, 0, 1),
        };
        let mut up = [0.0; 3];
        up[z] = 1.0;
        let mut right = [0.0; 3];
        let angle = heading(&joints, x, y);
        (right[x], right[y]) = (angle.cos(), angle.sin());
        let mut view = Self { plot, right, up, joints, heights: Interval { low: 0.0, high: 1.0 } };
        let markers = plot.take.observed().iter().filter_map(|(t, m)| plot.take.position(t, m));
        let heights = view.joints.iter().flatten().copied().chain(markers).map(|p| view.flat(p).1);
        view.heights = Interval::around(heights, 0.1);
        Ok(view)
    }

    /// Metres to the right and up.
    pub(super) fn flat(&self, p: [f64; 3]) -> Point {
        let dot = |q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
        (dot(self.right), dot(self.up))
    }

    /// Pairs of joints that a bone joins.
    pub(super) fn bones(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let joints = self.plot.motion.skeleton().joints();
        joints.iter().enumerate().filter_map(|(j, joint)| Some((joint.parent?, j)))
    }

    pub(super) fn markers(&self, frame: usize) -> impl Iterator<Item = [f64; 3]> + '_ {
        let take = self.plot.take;
        (0..take.marker_count()).filter_map(move |m| take.position(frame, m))
    }
}

/// Angle of the page's rightward direction between two horizontal axes: along the way, a little from the front, or along the
/// widest spread of the joints.
fn heading(joints: &[Vec<[f64; 3]>], x: usize, y: usize) -> f64 {
    /// A body that gets this far walks, in metres.
    const WALK_M: f64 = 0.7;
    const FROM_THE_FRONT: f64 = 0.4;
    let (Some(first), Some(last)) = (joints.first(), joints.last()) else { return 0.0 };
    let (dx, dy) = (last[0][x] - first[0][x], last[0][y] - first[0][y]);
    if dx.hypot(dy) > WALK_M {
        return dy.atan2(dx) + FROM_THE_FRONT;
    }
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for frame in joints {
        for p in frame {
            let (a, b) = (p[x] - frame[0][x], p[y] - frame[0][y]);
            xx += a * a;
            xy += a * b;
            yy += b * b;
        }
    }
    // Direction of the larger principal axis.
    0.5 * (2.0 * xy).atan2(xx - yy)
}

impl Drawing for View<'_> {
    fn size(&self) -> (u32, u32) {
        (1200, 600)
    }

    fn draw<DB: Backend>(&self, canvas: &mut Canvas<'_, DB>) -> Result<(), ReportError> {
        canvas.text(self.plot.title, (MARGIN, 40.0), 18.0, Align::Left, colour::INK)?;
        let frames = self.joints.len();
        let text = format!(
            "{} joints, {frames} frames at {} Hz; dots are measured markers",
            self.plot.motion.skeleton().joints().len(),
            self.plot.motion.rate_hz()
        );
        canvas.text(&text, (MARGIN, 62.0), 12.0, Align::Left, colour::FAINT)?;
        canvas.polyline(&[(MARGIN, FLOOR), (WIDTH - MARGIN, FLOOR)], FLOOR_PEN)?;
        let count = STILLS.min(frames);
        let scale = (FLOOR - HEAD) / (self.heights.high - self.heights.low);
        for still in 0..count {
            let frame = if count < 2 { 0 } else { still * (frames - 1) / (count - 1) };
            let slot = (WIDTH - 2.0 * MARGIN) / count as f64;
            let centre = MARGIN + slot * (still as f64 + 0.5);
            self.draw_still(canvas, frame, centre, scale)?;
            let time = format!("{:.2} s", frame as f64 / self.plot.motion.rate_hz());
            canvas.text(&time, (centre, FLOOR + 18.0), 11.0, Align::Centre, colour::FAINT)?;
        }
        self.draw_residual(canvas)
    }
}

impl View<'_> {
    fn draw_still<DB: Backend>(
        &self,
        canvas: &mut Canvas<'_, DB>,
        frame: usize,
        centre: f64,
        scale: f64,
    ) -> Result<(), ReportError> {
        let joints = &self.joints[frame];
        let root = self.flat(joints[0]).0;
        let at = |p: [f64; 3]| {
            let (x, y) = self.flat(p);
            (centre + scale * (x - root), FLOOR - scale * (y - self.heights.low))
        };
        for (parent, joint) in self.bones() {
            canvas.polyline(&[at(joints[parent]), at(joints[joint])], BONE_PEN)?;
        }
        for marker in self.markers(frame) {
            canvas.dot(at(marker), 2.2, colour::MISSING)?;
        }
        Ok(())
    }

    fn draw_residual<DB: Backend>(&self, canvas: &mut Canvas<'_, DB>) -> Result<(), ReportError> {
        let seconds = |frame: usize| frame as f64 / self.plot.motion.rate_hz();
        let millimetres: Vec<f64> = self.plot.residual_m.iter().map(|m| 1e3 * m).collect();
        let highest = millimetres.iter().copied().filter(|v| v.is_finite()).fold(1.0, f64::max);
        let axes = Axes {
            left: MARGIN,
            top: 460.0,
            right: WIDTH - MARGIN,
            bottom: HEIGHT - 40.0,
            x: Interval { low: 0.0, high: seconds(self.joints.len().max(2) - 1) },
            y: Interval { low: 0.0, high: 1.1 * highest },
        };
        axes.draw_x(canvas, 8)?;
        axes.draw_y(canvas, 3)?;
        let text = "how far markers are from where the skeleton has them: RMS in mm over time in s";
        canvas.text(text, (MARGIN, 452.0), 12.0, Align::Left, colour::INK)?;
        // A frame without markers breaks the curve.
        for run in millimetres.iter().enumerate().collect::<Vec<_>>().split(|(_, v)| !v.is_finite())
        {
            let points: Vec<Point> = run.iter().map(|&(t, &v)| axes.at(seconds(t), v)).collect();
            canvas.polyline(&points, CURVE_PEN)?;
        }
        axes.draw_frame(canvas)
    }
}
