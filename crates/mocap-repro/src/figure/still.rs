use mocap_report::{
    ReportError,
    draw::{Align, Backend, Canvas, Pen, Point, colour},
};

use super::panels::{HEADING, Place};

/// A body in one frame, as markers and the bones between them, in metres to the right and up.
#[derive(Debug)]
pub(crate) struct Still {
    pub heading: String,
    pub bones: Vec<[Point; 2]>,
    /// Bones of interest.
    pub bold: Vec<([Point; 2], colour::RGBColor)>,
    pub markers: Vec<Point>,
    /// Markers that were hidden.
    pub hidden: Vec<Point>,
    /// Left, right, bottom and top of what is shown.
    pub window: [f64; 4],
}

impl Still {
    pub(super) fn draw<DB: Backend>(
        &self,
        canvas: &mut Canvas<'_, DB>,
        place: Place,
    ) -> Result<(), ReportError> {
        let [left, right, bottom, top] = self.window;
        let head = (place.left + 58.0, place.top + 15.0);
        canvas.text(&self.heading, head, 13.0, Align::Left, colour::INK)?;
        let (width, height) = (place.width - 20.0, place.height - HEADING - 14.0);
        let scale = (width / (right - left).max(1e-3)).min(height / (top - bottom).max(1e-3));
        let origin = (place.left + 0.5 * place.width, place.top + HEADING + 0.5 * height);
        let middle = (f64::midpoint(left, right), f64::midpoint(bottom, top));
        // What a bad fill throws far away ends at the edge of the panel.
        let at = |(x, y): Point| {
            let x = (scale * (x - middle.0)).clamp(-0.5 * width, 0.5 * width);
            let y = (scale * (y - middle.1)).clamp(-0.5 * height, 0.5 * height);
            (origin.0 + x, origin.1 - y)
        };
        for bone in &self.bones {
            canvas.polyline(&bone.map(at), Pen::solid(colour::MEASURED, 1.0))?;
        }
        for marker in &self.markers {
            canvas.dot(at(*marker), 1.8, colour::FAINT)?;
        }
        for (bone, colour) in &self.bold {
            canvas.polyline(&bone.map(at), Pen::solid(*colour, 3.2))?;
        }
        self.hidden.iter().try_for_each(|marker| canvas.dot(at(*marker), 4.2, colour::INK))
    }
}
