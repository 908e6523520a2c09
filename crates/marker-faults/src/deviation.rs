//! How far a sample lies from where the samples around it lead.

use mocap_core::{
    Take,
    geometry::{norm, scale, sub},
};

use crate::neighbours::Neighbour;

/// Samples farther apart in time than this say nothing about each other, in seconds.
const REACH_S: f64 = 0.07;

/// Deviations of the samples of one marker, in metres; `None` where too few samples stand around.
#[derive(Debug, Clone)]
pub(crate) struct Deviations {
    /// From the cubic through the two samples on either side.
    pub within: Vec<Option<[f64; 3]>>,
    /// From the parabola through the three samples before.
    pub before: Vec<Option<[f64; 3]>>,
    /// From the parabola through the three samples after.
    pub after: Vec<Option<[f64; 3]>>,
}

impl Deviations {
    /// Of the samples at the frames `trusted`, in rising order. `allowance` is the share of the limit that the allowed
    /// acceleration uses up within a frame.
    pub fn of(take: &Take, marker: usize, trusted: &[usize], allowance: f64) -> Self {
        let nothing = vec![None; take.frames()];
        let mut found = Self { within: nothing.clone(), before: nothing.clone(), after: nothing };
        let reach = reach_frames(take.rate_hz());
        for (k, &t) in trusted.iter().enumerate() {
            let at = |k: usize| trusted.get(k).copied();
            let deviation = |base: &[usize]| {
                let near = base.iter().all(|&s| s.abs_diff(t) <= reach);
                near.then(|| deviation(take, marker, t, base, allowance)).flatten()
            };
            if let (true, Some(last)) = (k >= 2, at(k + 2)) {
                found.within[t] =
                    deviation(&[trusted[k - 2], trusted[k - 1], trusted[k + 1], last]);
            }
            if k >= 3 {
                found.before[t] = deviation(&[trusted[k - 3], trusted[k - 2], trusted[k - 1]]);
            }
            if let Some(last) = at(k + 3) {
                found.after[t] = deviation(&[trusted[k + 1], trusted[k + 2], last]);
            }
        }
        found
    }
}

/// The deviation of any sample from the cubic through the two trusted samples on either side of it.
pub(crate) fn from_either_side(
    take: &Take,
    marker: usize,
    t: usize,
    trusted: &[usize],
    allowance: f64,
) -> Option<[f64; 3]> {
    let after = trusted.partition_point(|&s| s <= t);
    let before = trusted.partition_point(|&s| s < t);
    let base = [
        *trusted.get(before.checked_sub(2)?)?,
        *trusted.get(before - 1)?,
        *trusted.get(after)?,
        *trusted.get(after + 1)?,
    ];
    let reach = reach_frames(take.rate_hz());
    let near = base.iter().all(|&s| s.abs_diff(t) <= reach);
    near.then(|| deviation(take, marker, t, &base, allowance)).flatten()
}

/// Frames that samples may lie apart: three at least, so that slow recordings are looked at, too.
pub(crate) fn reach_frames(rate_hz: f64) -> usize {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a small positive number
    let frames = (REACH_S * rate_hz).min(1e6) as usize;
    frames.max(3)
}

/// The sample less the polynomial through the samples at the frames `base`.
///
/// Over a wide base the same acceleration makes a larger deviation than over consecutive frames, as the square of the width.
/// Where that alone would reach the limit, the deviation is divided by it, so that one limit serves all.
fn deviation(
    take: &Take,
    marker: usize,
    t: usize,
    base: &[usize],
    allowance: f64,
) -> Option<[f64; 3]> {
    if let Some(weights) = consecutive(t, base) {
        return weighted(take, marker, t, base, weights);
    }
    let offset = |s: usize| s as f64 - t as f64;
    // Lagrange's weights at offset zero.
    let weight = |k: usize| {
        let others = base.iter().enumerate().filter(|(other, _)| *other != k);
        others.map(|(_, &r)| offset(r) / (offset(r) - offset(base[k]))).product::<f64>()
    };
    let weights: [f64; 4] = std::array::from_fn(|k| if k < base.len() { weight(k) } else { 0.0 });
    let product: f64 = base.iter().map(|&s| offset(s).abs()).product();
    // The product of the offsets of consecutive frames: 1 · 1 · 2 · 2, or 1 · 2 · 3.
    let squares =
        if base.len() == 4 { (product / 4.0).sqrt() } else { (product / 6.0).cbrt().powi(2) };
    let excess = (allowance * squares).max(1.0);
    Some(scale(1.0 / excess, weighted(take, marker, t, base, &weights)?))
}

/// Lagrange's weights where no frame is left out, which is nearly always.
fn consecutive(t: usize, base: &[usize]) -> Option<&'static [f64]> {
    match *base {
        [a, _, _, d] if a + 2 == t && d == t + 2 => {
            Some(&[-1.0 / 6.0, 4.0 / 6.0, 4.0 / 6.0, -1.0 / 6.0])
        }
        [a, _, c] if a + 3 == t && c + 1 == t => Some(&[1.0, -3.0, 3.0]),
        [a, _, c] if a == t + 1 && c == t + 3 => Some(&[3.0, -3.0, 1.0]),
        _ => None,
    }
}

/// The sample less the weighted sum of others.
fn weighted(
    take: &Take,
    marker: usize,
    t: usize,
    base: &[usize],
    weights: &[f64],
) -> Option<[f64; 3]> {
    let mut left = take.position(t, marker)?;
    for (&s, &weight) in base.iter().zip(weights) {
        left = sub(left, scale(weight, take.position(s, marker)?));
    }
    Some(left)
}

/// The deviation that is left when the motion of the part is taken out: less the middle deviation of the neighbours in
/// the same frame, axis by axis. Where that makes it larger, or fewer than three neighbours have one, as it is.
pub(crate) fn part_local(
    own: [f64; 3],
    neighbours: &[Neighbour],
    theirs: impl Fn(usize) -> Option<[f64; 3]>,
) -> [f64; 3] {
    let mut around = [[0.0; 3]; 6];
    let mut count = 0;
    for deviation in neighbours.iter().filter_map(|n| theirs(n.marker)).take(around.len()) {
        around[count] = deviation;
        count += 1;
    }
    if count < 3 {
        return own;
    }
    let common: [f64; 3] = std::array::from_fn(|axis| {
        let mut values = around.map(|p| p[axis]);
        let values = &mut values[..count];
        values.sort_by(f64::total_cmp);
        0.5 * (values[(count - 1) / 2] + values[count / 2])
    });
    let local = sub(own, common);
    if norm(local) < norm(own) { local } else { own }
}
