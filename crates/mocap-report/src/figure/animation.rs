//! A solved motion as an animated SVG, which any browser plays.

use std::fmt::Write;

use super::stills::{MotionPlot, View};
use crate::ReportError;

/// Size of the picture in pixels.
const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 480.0;
const MARGIN: f64 = 30.0;
/// Pictures a second, and at most in all: longer motions are shown at wider steps.
const RATE_HZ: f64 = 20.0;
const MOST: usize = 400;

/// Draws a solved motion as an animated SVG that plays in real time, over and over: bones as lines, measured markers as dots.
/// The picture moves along with the body. Motions beyond twenty seconds play in wider steps.
///
/// # Errors
/// [`ReportError::Shape`] for markers of another length than the motion.
pub fn animate_motion(plot: &MotionPlot<'_>) -> Result<Vec<u8>, ReportError> {
    let view = View::new(plot)?;
    let frames = view.joints.len();
    let rate_hz = plot.motion.rate_hz();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a rate over another"
    )]
    let step = ((rate_hz / RATE_HZ).round() as usize).max(1).max(frames.div_ceil(MOST));
    let shown: Vec<usize> = (0..frames).step_by(step).collect();
    let seconds = frames as f64 / rate_hz;
    let scale = (HEIGHT - 2.0 * MARGIN) / (view.heights.high - view.heights.low);
    let mut bones = String::new();
    let mut markers = String::new();
    for (index, &frame) in shown.iter().enumerate() {
        let joints = &view.joints[frame];
        let root = view.flat(joints[0]).0;
        let at = |p: [f64; 3]| {
            let (x, y) = view.flat(p);
            (0.5 * WIDTH + scale * (x - root), HEIGHT - MARGIN - scale * (y - view.heights.low))
        };
        let end = if index + 1 == shown.len() { "" } else { ";" };
        for (parent, joint) in view.bones() {
            let ((a, b), (c, d)) = (at(joints[parent]), at(joints[joint]));
            let _ = write!(bones, "M{a:.1} {b:.1}L{c:.1} {d:.1}");
        }
        for marker in view.markers(frame) {
            let (x, y) = at(marker);
            // A line of no length with round ends is a dot.
            let _ = write!(markers, "M{x:.1} {y:.1}h0");
        }
        if view.markers(frame).next().is_none() {
            markers.push_str("M0 0h0");
        }
        bones.push_str(end);
        markers.push_str(end);
    }
    let title = crate::escape(&crate::draw::printable(plot.title));
    let floor = HEIGHT - MARGIN;
    let animate = |values: &str| {
        format!(
            "<animate attributeName=\"d\" dur=\"{seconds:.3}s\" calcMode=\"discrete\" repeatCount=\"indefinite\" values=\"{values}\"/>"
        )
    };
    let first = |values: &str| values.split(';').next().unwrap_or_default().to_owned();
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" height=\"{HEIGHT}\">\n\
         <title>{title}</title>\n<rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#ffffff\"/>\n\
         <path d=\"M0 {floor}H{WIDTH}\" stroke=\"#e2e2e2\" stroke-width=\"2\"/>\n\
         <path d=\"{}\" fill=\"none\" stroke=\"#222222\" stroke-width=\"3\" stroke-linecap=\"round\">{}</path>\n\
         <path d=\"{}\" fill=\"none\" stroke=\"#d55e00\" stroke-width=\"5\" stroke-linecap=\"round\">{}</path>\n</svg>\n",
        first(&bones),
        animate(&bones),
        first(&markers),
        animate(&markers)
    )
    .into_bytes())
}
