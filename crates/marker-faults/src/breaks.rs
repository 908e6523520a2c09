//! Steps of a path.

use mocap_core::geometry::norm;

use crate::detector::Scene;

/// A path that does not go on from one trusted sample to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Break {
    /// The last frame before it.
    pub last: usize,
    /// The first frame after it.
    pub first: usize,
    /// Where the path goes on, less where it led to, in metres; the motion of the part is taken out.
    pub step: [f64; 3],
}

/// The breaks of a marker, in time order: the samples before do not lead to the first one after, nor
/// the samples after to the last one before.
pub(crate) fn breaks(scene: &Scene<'_>, marker: usize) -> Vec<Break> {
    let limit = scene.limit_m(scene.params.step_m);
    let pairs = scene.trusted[marker].windows(2).map(|pair| (pair[0], pair[1]));
    let found = pairs.filter_map(|(last, first)| {
        // Long before neighbours are asked, most samples are fine.
        let own = &scene.deviations[marker];
        let rough = norm(own.before[first]?).min(norm(own.after[last]?));
        if rough <= limit {
            return None;
        }
        let step = scene.local(marker, first, |d| &d.before)?;
        let back = scene.size(marker, last, |d| &d.after)?;
        let least = norm(step).min(back);
        let is_break = least > limit
            && least > scene.limit_around(marker, first, limit, |d| &d.before)
            && least > scene.limit_around(marker, last, limit, |d| &d.after);
        is_break.then_some(Break { last, first, step })
    });
    found.collect()
}
