//! Joining paths that were found apart.

use std::ops::Range;

use mocap_core::geometry::{add, scale, sub};

/// Spreads the steps between adjoining `runs` of `places` over the frames next to them, up to `blend`
/// frames on either side, so that the path goes on there as fast as it came.
///
/// A run of one frame stays where it is: a single frame has no room to fade, and an observed border
/// must not move.
pub fn join(places: &mut [Option<[f64; 3]>], runs: &[Range<usize>], blend: f64) {
    let joints = runs.windows(2).filter(|pair| pair[0].end == pair[1].start);
    let shifts: Vec<(Range<usize>, Range<usize>, [f64; 3])> = joints
        .filter_map(|pair| {
            let excess = excess(places, &pair[0], &pair[1])?;
            Some((pair[0].clone(), pair[1].clone(), excess))
        })
        .collect();
    let mut shift = |i: usize, by: [f64; 3]| places[i] = places[i].map(|p| add(p, by));
    for (before, after, excess) in shifts {
        let shares = match (before.len() > 1, after.len() > 1) {
            (true, true) => [0.5, 0.5],
            (false, true) => [0.0, 1.0],
            (true, false) => [1.0, 0.0],
            (false, false) => [0.0, 0.0],
        };
        let joint = after.start;
        for i in before.clone() {
            let fade = fade(joint - 1 - i, before.len() - 1, blend);
            shift(i, scale(shares[0] * fade, excess));
        }
        for i in after.clone() {
            let fade = fade(i - joint, after.len() - 1, blend);
            shift(i, scale(-shares[1] * fade, excess));
        }
    }
}

/// The step at a joint beyond what the path moves in one frame, judged by its speed on either
/// side: by the cubic through two speeds before and two after, or by their mean.
fn excess(
    places: &[Option<[f64; 3]>],
    before: &Range<usize>,
    after: &Range<usize>,
) -> Option<[f64; 3]> {
    let change = |i: usize| Some(sub(places[i + 1]?, places[i]?));
    let joint = after.start;
    let near = [
        (before.len() > 1).then(|| change(joint - 2)).flatten(),
        (after.len() > 1).then(|| change(joint)).flatten(),
    ];
    let far = [
        (before.len() > 2).then(|| change(joint - 3)).flatten(),
        (after.len() > 2).then(|| change(joint + 1)).flatten(),
    ];
    let mean = |speeds: [Option<[f64; 3]>; 2]| {
        let known = speeds.iter().flatten().count().max(1) as f64;
        speeds.iter().flatten().fold([0.0; 3], |sum, &v| add(sum, scale(1.0 / known, v)))
    };
    let speed = if far.iter().all(Option::is_some) {
        add(scale(4.0 / 3.0, mean(near)), scale(-1.0 / 3.0, mean(far)))
    } else {
        mean(near)
    };
    Some(sub(change(joint - 1)?, speed))
}

/// 1 at the joint, 0 from `blend` frames on and at the far end of the segment; flat at both ends, so
/// that the path has no kink there.
fn fade(distance: usize, farthest: usize, blend: f64) -> f64 {
    if distance == 0 {
        return 1.0;
    }
    let rest = (1.0 - distance as f64 / blend.min(farthest as f64)).max(0.0);
    rest * rest * (3.0 - 2.0 * rest)
}
