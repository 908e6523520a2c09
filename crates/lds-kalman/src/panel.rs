//! Products of tall matrices with narrow ones: `(T, m)` with `(m, n)` and their like, where `n` is
//! the hidden dimension.
//!
//! They are most of the arithmetic of an EM iteration. A general library splits such a product for
//! caches that it fits anyway; here a few rows of sums stay in registers, and the tall matrix is read once.
#![allow(clippy::inline_always, reason = "a kernel must take on the vectors of its caller")]

use crate::kernel::{self, Job, add_scaled};

/// Columns computed together.
const BLOCK: usize = 16;

/// Rows computed together.
const ROWS: usize = 2;

/// Frames whose rows stay in the first-level cache while all columns pass over them.
const FRAMES: usize = 64;

/// `out = X · B` for `x` of `(frames, m)`, `b` of `(m, n)` and `out` of `(frames, n)`.
pub(crate) fn project(x: &[f64], m: usize, b: &[f64], n: usize, out: &mut [f64]) {
    kernel::fast(n, Project { x, m, b, out });
}

/// `out = Xᵀ · Z` for `x` of `(frames, m)`, `z` of `(frames, n)` and `out` of `(m, n)`.
pub(crate) fn correlate(x: &[f64], m: usize, z: &[f64], n: usize, out: &mut [f64]) {
    kernel::fast(n, Correlate { x, m, z, out });
}

struct Project<'a> {
    x: &'a [f64],
    m: usize,
    b: &'a [f64],
    out: &'a mut [f64],
}

impl Job for Project<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self, n: usize) {
        let Self { x, m, b, out } = self;
        let blocked = n - n % BLOCK;
        let (pairs, lone) = x.split_at(x.len() - x.len() % (ROWS * m));
        let (out_pairs, out_lone) = out.split_at_mut(pairs.len() / m * n);
        for start in (0..blocked).step_by(BLOCK) {
            let rows = pairs.chunks_exact(ROWS * m).zip(out_pairs.chunks_exact_mut(ROWS * n));
            for (x, out) in rows {
                project_rows::<ROWS>(x, m, b, n, start, out);
            }
            for (x, out) in lone.chunks_exact(m).zip(out_lone.chunks_exact_mut(n)) {
                project_rows::<1>(x, m, b, n, start, out);
            }
        }
        if blocked == n {
            return;
        }
        for (x, out) in x.chunks_exact(m).zip(out.chunks_exact_mut(n)) {
            let rest = &mut out[blocked..];
            rest.fill(0.0);
            for (factor, row) in x.iter().zip(b.chunks_exact(n)) {
                add_scaled(rest, *factor, &row[blocked..]);
            }
        }
    }
}

/// `R` rows of a product, in the columns of one block.
#[inline(always)]
fn project_rows<const R: usize>(
    x: &[f64],
    m: usize,
    b: &[f64],
    n: usize,
    start: usize,
    out: &mut [f64],
) {
    let x: [&[f64]; R] = std::array::from_fn(|r| &x[r * m..][..m]);
    let mut sums = [[0.0; BLOCK]; R];
    for (k, row) in b.chunks_exact(n).take(m).enumerate() {
        let row = &row[start..][..BLOCK];
        for r in 0..R {
            let factor = x[r][k];
            for c in 0..BLOCK {
                sums[r][c] += factor * row[c];
            }
        }
    }
    for (r, sum) in sums.iter().enumerate() {
        out[r * n + start..][..BLOCK].copy_from_slice(sum);
    }
}

struct Correlate<'a> {
    x: &'a [f64],
    m: usize,
    z: &'a [f64],
    out: &'a mut [f64],
}

impl Job for Correlate<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self, n: usize) {
        let Self { x, m, z, out } = self;
        out[..m * n].fill(0.0);
        let blocked = n - n % BLOCK;
        let paired = m - m % ROWS;
        for (x, z) in x.chunks(FRAMES * m).zip(z.chunks(FRAMES * n)) {
            for start in (0..blocked).step_by(BLOCK) {
                for j in (0..paired).step_by(ROWS) {
                    correlate_columns::<ROWS>(x, m, j, z, n, start, out);
                }
                for j in paired..m {
                    correlate_columns::<1>(x, m, j, z, n, start, out);
                }
            }
            if blocked < n {
                for (x, z) in x.chunks_exact(m).zip(z.chunks_exact(n)) {
                    for (factor, out) in x.iter().zip(out.chunks_exact_mut(n)) {
                        add_scaled(&mut out[blocked..], *factor, &z[blocked..]);
                    }
                }
            }
        }
    }
}

/// Adds the sums over the frames for `R` columns of `x`, in the columns of one block of `z`.
#[inline(always)]
fn correlate_columns<const R: usize>(
    x: &[f64],
    m: usize,
    first: usize,
    z: &[f64],
    n: usize,
    start: usize,
    out: &mut [f64],
) {
    // Sums that begin at zero and arrays of fixed length: with either missing they leave the registers.
    let mut sums = [[0.0; BLOCK]; R];
    for (x, z) in x.chunks_exact(m).zip(z.chunks_exact(n)) {
        let factors: &[f64; R] = x[first..][..R].try_into().expect("a slice of this length");
        let row: &[f64; BLOCK] = z[start..][..BLOCK].try_into().expect("a slice of this length");
        for r in 0..R {
            for c in 0..BLOCK {
                sums[r][c] += factors[r] * row[c];
            }
        }
    }
    for (r, sum) in sums.iter().enumerate() {
        add_scaled(&mut out[(first + r) * n + start..][..BLOCK], 1.0, sum);
    }
}

#[cfg(test)]
mod tests {
    use ndarray::Array2;

    use super::*;

    fn example(rows: usize, columns: usize, seed: usize) -> Array2<f64> {
        Array2::from_shape_fn((rows, columns), |(i, j)| {
            ((i * 7919 + j * 104_729 + seed * 31) % 997) as f64 / 997.0 - 0.4
        })
    }

    #[test]
    fn both_products_agree_with_ndarray_for_sizes_around_the_blocks() {
        for (frames, m, n) in [(1, 1, 1), (7, 5, 3), (65, 123, 16), (130, 6, 17), (64, 33, 35)] {
            let (x, b, z) = (example(frames, m, 1), example(m, n, 2), example(frames, n, 3));
            let flat = |a: &Array2<f64>| a.iter().copied().collect::<Vec<_>>();
            let mut out = vec![f64::NAN; frames * n];
            project(&flat(&x), m, &flat(&b), n, &mut out);
            let apart = |out: Vec<f64>, expected: Array2<f64>| {
                let out = Array2::from_shape_vec(expected.dim(), out).unwrap();
                (out - expected).iter().fold(0.0_f64, |a, x| a.max(x.abs()))
            };
            // 1e-12: sums of at most 130 products below one.
            assert!(apart(out, x.dot(&b)) < 1e-12, "{frames} {m} {n}");
            let mut out = vec![f64::NAN; m * n];
            correlate(&flat(&x), m, &flat(&z), n, &mut out);
            assert!(apart(out, x.t().dot(&z)) < 1e-12, "{frames} {m} {n}");
        }
    }
}
