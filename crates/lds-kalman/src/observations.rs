//! Observations of which any entry may be missing.

use std::collections::HashMap;

use ndarray::{Array1, Array2, ArrayView2};

use crate::error::LdsError;

/// A matrix of observations, `(T, m)`, with a mask that says which entries were observed.
///
/// Any subset of a frame may be missing, the whole frame included. The values of missing entries
/// are never read; they may be NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct Observations {
    values: Array2<f64>,
    mask: Array2<bool>,
    patterns: Vec<Pattern>,
    pattern_of: Vec<usize>,
    gap_groups: Vec<GapGroup>,
    gap_frames: Vec<usize>,
    /// Sums of the squares of the observed values, `(m)`.
    squares: Array1<f64>,
    observed: usize,
}

/// The dimensions that are observed in all frames sharing one row of the mask.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pattern {
    pub(crate) observed: Vec<usize>,
    pub(crate) missing: Vec<usize>,
    pub(crate) complete: bool,
}

/// Dimensions that miss exactly the same frames.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct GapGroup {
    pub(crate) dimensions: Vec<usize>,
    pub(crate) frames: Vec<usize>,
}

impl Observations {
    /// Takes values `(T, m)` and a mask `(T, m)` that is `true` where a value was observed.
    ///
    /// # Errors
    ///
    /// When the shapes differ, there is no frame or no dimension, or an observed value is not
    /// finite.
    pub fn new(values: ArrayView2<'_, f64>, mask: ArrayView2<'_, bool>) -> Result<Self, LdsError> {
        let (frames, dimensions) = values.dim();
        if mask.dim() != (frames, dimensions) {
            return Err(LdsError::Shape {
                what: "mask",
                rows: frames,
                columns: dimensions,
                found_rows: mask.nrows(),
                found_columns: mask.ncols(),
            });
        }
        for (what, size) in
            [("the number of frames", frames), ("the observed dimension", dimensions)]
        {
            if size == 0 {
                return Err(LdsError::ZeroDimension { what });
            }
        }
        let mut clean = Array2::zeros((frames, dimensions));
        for ((at, value), &seen) in values.indexed_iter().zip(mask) {
            if seen && !value.is_finite() {
                return Err(LdsError::ObservedNotFinite { frame: at.0, dimension: at.1 });
            }
            if seen {
                clean[at] = *value;
            }
        }
        let (patterns, pattern_of) = patterns(mask);
        let gap_frames = (0..frames).filter(|&t| !patterns[pattern_of[t]].complete).collect();
        Ok(Self {
            squares: column_squares(&clean),
            values: clean,
            mask: mask.to_owned(),
            patterns,
            pattern_of,
            gap_groups: gap_groups(mask),
            gap_frames,
            observed: mask.iter().filter(|&&seen| seen).count(),
        })
    }

    /// Takes values `(T, m)` of which every finite one counts as observed.
    ///
    /// # Errors
    ///
    /// When there is no frame or no dimension.
    pub fn from_finite(values: ArrayView2<'_, f64>) -> Result<Self, LdsError> {
        Self::new(values, values.mapv(f64::is_finite).view())
    }

    /// Number of frames, `T`.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.values.nrows()
    }

    /// Number of dimensions, `m`.
    #[must_use]
    pub fn dimensions(&self) -> usize {
        self.values.ncols()
    }

    /// Number of observed entries.
    #[must_use]
    pub fn observed(&self) -> usize {
        self.observed
    }

    /// Number of entries observed in the frame that shows fewest.
    pub(crate) fn fewest_observed(&self) -> usize {
        self.patterns.iter().map(|pattern| pattern.observed.len()).min().unwrap_or(0)
    }

    /// The values, `(T, m)`, zero where missing.
    #[must_use]
    pub fn values(&self) -> ArrayView2<'_, f64> {
        self.values.view()
    }

    /// The mask, `(T, m)`, `true` where observed.
    #[must_use]
    pub fn mask(&self) -> ArrayView2<'_, bool> {
        self.mask.view()
    }

    /// Takes new values for the observed entries of some frames from a matrix `(T, m)`.
    pub(crate) fn set_values(&mut self, values: ArrayView2<'_, f64>, frames: &[usize]) {
        for &t in frames {
            for &j in &self.patterns[self.pattern_of[t]].observed {
                self.values[(t, j)] = values[(t, j)];
            }
        }
        self.squares = column_squares(&self.values);
    }

    /// Sums of the squares of the observed values, `(m)`.
    pub(crate) fn squares(&self) -> &Array1<f64> {
        &self.squares
    }

    /// Sums of the squares of a fill of all entries `(T, m)`, `(m)`.
    pub(crate) fn squares_with(&self, filled: ArrayView2<'_, f64>) -> Array1<f64> {
        let mut squares = self.squares.clone();
        for GapGroup { dimensions, frames } in &self.gap_groups {
            for &j in dimensions {
                squares[j] += frames.iter().map(|&t| filled[(t, j)].powi(2)).sum::<f64>();
            }
        }
        squares
    }

    /// The frames that miss an entry, in order.
    pub(crate) fn gap_frames(&self) -> &[usize] {
        &self.gap_frames
    }

    pub(crate) fn patterns(&self) -> &[Pattern] {
        &self.patterns
    }

    pub(crate) fn pattern_of(&self) -> &[usize] {
        &self.pattern_of
    }

    /// Dimensions that share their mask.
    pub(crate) fn columns_by_mask(&self) -> Vec<Vec<usize>> {
        let mut complete: Vec<usize> = (0..self.dimensions()).collect();
        let mut groups: Vec<Vec<usize>> =
            self.gap_groups.iter().map(|group| group.dimensions.clone()).collect();
        complete.retain(|j| !groups.iter().any(|group| group.contains(j)));
        if !complete.is_empty() {
            groups.push(complete);
        }
        groups
    }

    pub(crate) fn gap_groups(&self) -> &[GapGroup] {
        &self.gap_groups
    }

    /// The values with missing entries filled by a straight line in each dimension, the nearest
    /// value beyond the first and last observation, and zero where nothing was ever observed.
    #[must_use]
    pub fn interpolated(&self) -> Array2<f64> {
        let mut filled = self.values.clone();
        for GapGroup { dimensions, frames } in &self.gap_groups {
            let seen: Vec<usize> =
                (0..self.frames()).filter(|&t| self.mask[(t, dimensions[0])]).collect();
            for &t in frames {
                let next = seen.partition_point(|&s| s < t);
                let (before, after) = match (next.checked_sub(1), seen.get(next)) {
                    (Some(b), Some(&a)) => (seen[b], a),
                    (Some(b), None) => (seen[b], seen[b]),
                    (None, Some(&a)) => (a, a),
                    (None, None) => continue,
                };
                let span = after.saturating_sub(before).max(1);
                let share = t.saturating_sub(before) as f64 / span as f64;
                let share = if before == after { 0.0 } else { share };
                for &j in dimensions {
                    let (from, to) = (self.values[(before, j)], self.values[(after, j)]);
                    filled[(t, j)] = from + share * (to - from);
                }
            }
        }
        filled
    }
}

fn column_squares(values: &Array2<f64>) -> Array1<f64> {
    let mut squares = Array1::zeros(values.ncols());
    for row in values.rows() {
        ndarray::Zip::from(&mut squares).and(row).for_each(|s: &mut f64, &x| *s += x * x);
    }
    squares
}

fn patterns(mask: ArrayView2<'_, bool>) -> (Vec<Pattern>, Vec<usize>) {
    let mut known: HashMap<Vec<bool>, usize> = HashMap::new();
    let mut patterns = Vec::new();
    let pattern_of = mask
        .rows()
        .into_iter()
        .map(|row| {
            *known.entry(row.to_vec()).or_insert_with(|| {
                let (observed, missing): (Vec<usize>, _) = (0..row.len()).partition(|&j| row[j]);
                let complete = missing.is_empty();
                patterns.push(Pattern { observed, missing, complete });
                patterns.len() - 1
            })
        })
        .collect();
    (patterns, pattern_of)
}

fn gap_groups(mask: ArrayView2<'_, bool>) -> Vec<GapGroup> {
    let mut known: HashMap<Vec<usize>, usize> = HashMap::new();
    let mut groups: Vec<GapGroup> = Vec::new();
    for (j, column) in mask.columns().into_iter().enumerate() {
        let frames: Vec<usize> = (0..column.len()).filter(|&t| !column[t]).collect();
        if frames.is_empty() {
            continue;
        }
        let index = *known.entry(frames.clone()).or_insert_with(|| {
            groups.push(GapGroup { dimensions: Vec::new(), frames });
            groups.len() - 1
        });
        groups[index].dimensions.push(j);
    }
    groups
}
