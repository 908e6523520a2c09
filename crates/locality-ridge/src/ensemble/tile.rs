//! Inner products of many rows with many others, four by four: what all costly steps are made of.
#![allow(clippy::inline_always, reason = "a kernel must take on the vectors of its caller")]

use std::ops::Range;

use pulp::Simd;

/// Rows are padded to whole tiles of so many, and to vectors of as many numbers.
pub(super) const TILE: usize = 4;

/// A matrix whose rows and columns are padded with zeros to whole tiles.
#[derive(Debug, Clone)]
pub(super) struct Panel {
    rows: usize,
    stride: usize,
    data: Vec<f64>,
}

impl Panel {
    pub fn zeros(rows: usize, columns: usize) -> Self {
        let (padded, stride) = (rows.next_multiple_of(TILE), columns.next_multiple_of(TILE));
        Self { rows, stride, data: vec![0.0; padded * stride] }
    }

    /// The square part with these rows and columns.
    pub fn part(&self, range: &Range<usize>) -> Self {
        let mut part = Self::zeros(range.len(), range.len());
        for (to, from) in range.clone().enumerate() {
            part.row_mut(to)[..range.len()].copy_from_slice(&self.row(from)[range.clone()]);
        }
        part
    }

    /// Rows without the padding.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Rows with the padding.
    #[inline(always)]
    pub fn padded(&self) -> usize {
        self.rows.next_multiple_of(TILE)
    }

    /// Length of a row with the padding.
    #[inline(always)]
    pub fn stride(&self) -> usize {
        self.stride
    }

    #[inline(always)]
    pub fn row(&self, i: usize) -> &[f64] {
        &self.data[i * self.stride..(i + 1) * self.stride]
    }

    #[inline(always)]
    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.data[i * self.stride..(i + 1) * self.stride]
    }

    /// The rows before `i`, and the tile of rows that begins there.
    #[inline(always)]
    pub fn split(&mut self, i: usize) -> (&[f64], &mut [f64]) {
        let (above, rest) = self.data.split_at_mut(i * self.stride);
        (above, &mut rest[..TILE * self.stride])
    }

    /// The same columns of four rows that begin at `i`.
    #[inline(always)]
    fn four(&self, i: usize) -> [&[f64]; TILE] {
        [self.row(i), self.row(i + 1), self.row(i + 2), self.row(i + 3)]
    }

    /// Inner products of all rows with all rows of `other`, `(rows, other.rows)`; of the rows with
    /// themselves, where `lower`, the tiles on and below the diagonal.
    ///
    /// # Cost
    /// Two operations for each product of numbers.
    pub fn products(&self, other: &Self, lower: bool) -> Self {
        pulp::Arch::new().dispatch(Products { left: self, right: other, lower })
    }
}

struct Products<'a> {
    left: &'a Panel,
    right: &'a Panel,
    lower: bool,
}

impl pulp::WithSimd for Products<'_> {
    type Output = Panel;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Panel {
        let Self { left, right, lower } = self;
        let mut out = Panel::zeros(left.rows, right.rows);
        for i in (0..left.padded()).step_by(TILE) {
            let until = if lower { i + 1 } else { right.padded() };
            for j in (0..until).step_by(TILE) {
                let sums = tile(simd, left.four(i), right.four(j));
                for (r, sums) in sums.iter().enumerate() {
                    out.row_mut(i + r)[j..j + TILE].copy_from_slice(sums);
                }
            }
        }
        out
    }
}

/// Inner products of four slices with four others, all of one length.
#[inline(always)]
pub(super) fn tile<S: Simd>(simd: S, a: [&[f64]; TILE], b: [&[f64]; TILE]) -> [[f64; TILE]; TILE] {
    let left = half(simd, a, [b[0], b[1]]);
    let right = half(simd, a, [b[2], b[3]]);
    let mut out = [[0.0; TILE]; TILE];
    for ((out, left), right) in out.iter_mut().zip(left).zip(right) {
        *out = [left[0], left[1], right[0], right[1]];
    }
    out
}

/// Four by two: eight running sums and the six vectors of a step fit into sixteen registers.
#[inline(always)]
fn half<S: Simd>(simd: S, a: [&[f64]; TILE], b: [&[f64]; 2]) -> [[f64; 2]; TILE] {
    let n = a[0].len();
    let (a0, a1, a2, a3) = (
        S::as_simd_f64s(&a[0][..n]).0,
        S::as_simd_f64s(&a[1][..n]).0,
        S::as_simd_f64s(&a[2][..n]).0,
        S::as_simd_f64s(&a[3][..n]).0,
    );
    let (b0, b1) = (S::as_simd_f64s(&b[0][..n]).0, S::as_simd_f64s(&b[1][..n]).0);
    let mut sums = [[simd.splat_f64s(0.0); 2]; TILE];
    let vectors = a0.len();
    for k in 0..vectors {
        let (x, y) = (b0[k], b1[k]);
        for (sums, a) in sums.iter_mut().zip([a0[k], a1[k], a2[k], a3[k]]) {
            sums[0] = simd.mul_add_e_f64s(a, x, sums[0]);
            sums[1] = simd.mul_add_e_f64s(a, y, sums[1]);
        }
    }
    let whole = vectors * S::F64_LANES;
    let mut out = [[0.0; 2]; TILE];
    // Loops, not closures: these would not take on the vectors of the caller.
    for r in 0..TILE {
        for c in 0..2 {
            let mut sum = simd.reduce_sum_f64s(sums[r][c]);
            for (x, y) in a[r][whole..n].iter().zip(&b[c][whole..n]) {
                sum += x * y;
            }
            out[r][c] = sum;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_sums_of_products() {
        let panel = |rows: usize, columns: usize, seed: usize| {
            let mut panel = Panel::zeros(rows, columns);
            for i in 0..rows {
                for j in 0..columns {
                    panel.row_mut(i)[j] = ((i * 31 + j * 17 + seed) % 13) as f64 - 6.0;
                }
            }
            panel
        };
        for (n, m, d) in [(1, 1, 1), (7, 9, 10), (8, 4, 33), (5, 5, 0)] {
            let (a, b) = (panel(n, d, 1), panel(m, d, 5));
            let out = a.products(&b, false);
            for i in 0..n {
                for j in 0..m {
                    let sum: f64 = (0..d).map(|k| a.row(i)[k] * b.row(j)[k]).sum();
                    // Sums of small whole numbers are exact.
                    assert!((out.row(i)[j] - sum).abs() < 1e-12);
                }
            }
        }
    }
}
