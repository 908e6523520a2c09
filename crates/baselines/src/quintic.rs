//! Interpolation by pieces of degree five.

/// The natural quintic spline through samples: of all smooth curves through them the one with the smallest
/// integral of the squared third derivative.
///
/// It is held by its value, slope and curvature at the knots; beyond the outermost knots it would go on as
/// a parabola.
///
/// Implements [Woltring86] with half order 3 and no smoothing.
pub(crate) struct Quintic {
    knots: Vec<f64>,
    values: Vec<f64>,
    /// Slope and second derivative at each knot.
    bends: Vec<[f64; 2]>,
}

/// A block of the normal equations.
type Block = [[f64; 2]; 2];

impl Quintic {
    /// Through three samples or more, at rising knots.
    ///
    /// The integral is a quadratic form in the slopes and curvatures; a knot's form couples with that of the next one
    /// only. Its minimum is found by block elimination.
    pub fn through(knots: Vec<f64>, values: Vec<f64>) -> Self {
        let n = knots.len();
        let mut diagonal: Vec<Block> = vec![[[0.0; 2]; 2]; n];
        let mut upper: Vec<Block> = vec![[[0.0; 2]; 2]; n.saturating_sub(1)];
        let mut right = vec![[0.0; 2]; n];
        for i in 0..n - 1 {
            let h = knots[i + 1] - knots[i];
            let rise = (values[i + 1] - values[i]) / h;
            let (a, b, c) = (192.0 / (h * h * h), 36.0 / (h * h), 9.0 / h);
            accumulate(&mut diagonal[i], [[a, b], [b, c]]);
            accumulate(&mut diagonal[i + 1], [[a, -b], [-b, c]]);
            let (a, b, c) = (168.0 / (h * h * h), 24.0 / (h * h), -3.0 / h);
            upper[i] = [[a, -b], [b, c]];
            let (slope, bend) = (360.0 * rise / (h * h * h), 60.0 * rise / (h * h));
            right[i] = [right[i][0] + slope, right[i][1] + bend];
            right[i + 1] = [right[i + 1][0] + slope, right[i + 1][1] - bend];
        }
        let bends = eliminate(diagonal, &upper, right);
        Self { knots, values, bends }
    }

    /// Value at `x`, which must lie between the first and the last knot.
    pub fn at(&self, x: f64) -> f64 {
        let i = self.knots.partition_point(|&k| k < x).clamp(1, self.knots.len() - 1);
        let h = self.knots[i] - self.knots[i - 1];
        let u = (x - self.knots[i - 1]) / h;
        self.share_of_end(i - 1, u, h) + self.share_of_end(i, 1.0 - u, -h)
    }

    /// The share of one end in a piece of length `h`, at a distance of `u` times the length from it.
    fn share_of_end(&self, i: usize, u: f64, h: f64) -> f64 {
        let v = 1.0 - u;
        let [slope, bend] = self.bends[i];
        let cubic = v * v * v;
        let value = 1.0 + 3.0 * u + 6.0 * u * u;
        let (first, second) = (u * (1.0 + 3.0 * u), 0.5 * u * u);
        cubic * (value * self.values[i] + first * h * slope + second * h * h * bend)
    }
}

fn accumulate(block: &mut Block, other: Block) {
    for (row, added) in block.iter_mut().zip(other) {
        row.iter_mut().zip(added).for_each(|(x, y)| *x += y);
    }
}

/// Solves a symmetric positive definite block-tridiagonal system.
fn eliminate(mut diagonal: Vec<Block>, upper: &[Block], mut right: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let n = diagonal.len();
    for i in 1..n {
        let above = upper[i - 1];
        let inverse = inverse(diagonal[i - 1]);
        // The row of blocks to the left is the transpose of the one above.
        let factor = multiply(transpose(above), inverse);
        let taken = multiply(factor, above);
        accumulate(&mut diagonal[i], taken.map(|row| row.map(|x| -x)));
        let carried = apply(factor, right[i - 1]);
        right[i] = [right[i][0] - carried[0], right[i][1] - carried[1]];
    }
    for i in (0..n).rev() {
        if i + 1 < n {
            let known = apply(upper[i], right[i + 1]);
            right[i] = [right[i][0] - known[0], right[i][1] - known[1]];
        }
        right[i] = apply(inverse(diagonal[i]), right[i]);
    }
    right
}

fn inverse([[a, b], [c, d]]: Block) -> Block {
    let determinant = a * d - b * c;
    [[d, -b], [-c, a]].map(|row| row.map(|x| x / determinant))
}

fn transpose([[a, b], [c, d]]: Block) -> Block {
    [[a, c], [b, d]]
}

fn multiply(p: Block, q: Block) -> Block {
    std::array::from_fn(|i| std::array::from_fn(|j| p[i][0] * q[0][j] + p[i][1] * q[1][j]))
}

fn apply(p: Block, x: [f64; 2]) -> [f64; 2] {
    p.map(|row| row[0] * x[0] + row[1] * x[1])
}
