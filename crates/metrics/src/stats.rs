/// The `p`-quantile of values in ascending order, linear between order statistics; `None` without values.
///
/// With `n` values `x[0] ≤ … ≤ x[n−1]`, `h = (n − 1) p` and `k = ⌊h⌋`, it is
/// `x[k] + (h − k)(x[k+1] − x[k])`: type 7 of the usual numbering, the default of R and `numpy`. `p` is
/// clamped to 0…1.
///
/// ```
/// assert_eq!(metrics::quantile(&[1.0, 2.0, 4.0, 8.0], 0.5), Some(3.0));
/// assert_eq!(metrics::quantile(&[], 0.5), None);
/// ```
#[must_use]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 0 ≤ h ≤ n − 1
pub fn quantile(ascending: &[f64], p: f64) -> Option<f64> {
    let last = ascending.len().checked_sub(1)?;
    let h = last as f64 * p.clamp(0.0, 1.0);
    let k = (h.floor() as usize).min(last);
    let (low, high) = (ascending[k], ascending[(k + 1).min(last)]);
    Some(low + (h - k as f64) * (high - low))
}

/// Mean, root mean square and maximum of non-negative values; NaN without values.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moments {
    pub count: usize,
    pub mean: f64,
    pub rms: f64,
    pub max: f64,
}

impl Moments {
    pub(crate) fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let (mut count, mut sum, mut squares, mut max) = (0_usize, 0.0, 0.0, f64::NAN);
        for value in values {
            count += 1;
            sum += value;
            squares += value * value;
            max = value.max(max);
        }
        let n = count as f64;
        Self { count, mean: sum / n, rms: (squares / n).sqrt(), max }
    }
}
