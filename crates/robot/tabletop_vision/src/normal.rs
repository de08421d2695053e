//! Small least-squares problems, as normal equations.

/// A least-squares problem of weighted differences: the normal equations `JᵀWJ δ = JᵀWr` of up to `N` parameters.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LeastSquares<const N: usize> {
    pub curvature: [[f64; N]; N],
    pub slope: [f64; N],
}

impl<const N: usize> Default for LeastSquares<N> {
    fn default() -> Self {
        Self {
            curvature: [[0.0; N]; N],
            slope: [0.0; N],
        }
    }
}

impl<const N: usize> LeastSquares<N> {
    /// Adds a difference with its derivatives and weight.
    #[inline]
    pub fn add(&mut self, derivatives: &[f32; N], difference: f32, weight: f32) {
        for i in 0..N {
            let weighted = f64::from(derivatives[i] * weight);
            self.slope[i] += weighted * f64::from(difference);
            for (own, other) in self.curvature[i].iter_mut().zip(&derivatives[..=i]) {
                *own += weighted * f64::from(*other);
            }
        }
    }

    /// The step to the minimum, damped by this part of the curvature (Marquardt's); parameters without curvature stay.
    pub fn step(&self, damping: f64) -> [f64; N] {
        self.solve(&self.slope, damping)
    }

    /// The diagonal of the inverse of the curvature: the variances, but for that of a difference. Infinite without curvature.
    pub fn variances(&self) -> [f64; N] {
        std::array::from_fn(|i| {
            let mut unit = [0.0; N];
            unit[i] = 1.0;
            match self.curvature[i][i] > 0.0 {
                true => self.solve(&unit, 1e-9)[i].max(0.0),
                false => f64::INFINITY,
            }
        })
    }

    /// Cholesky's decomposition, and both substitutions.
    fn solve(&self, right: &[f64; N], damping: f64) -> [f64; N] {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut factor = [[0.0; N]; N];
        let mut solved = [0.0; N];
        for (i, (row, right)) in self.curvature.iter().zip(right).enumerate() {
            let mut own = [0.0; N];
            for (j, other) in factor.iter().enumerate().take(i) {
                own[j] = (row[j] - dot(&own[..j], &other[..j])) / other[j];
            }
            let square = row[i] * (1.0 + damping) + 1e-9 - dot(&own[..i], &own[..i]);
            own[i] = square.max(1e-12).sqrt();
            solved[i] = (right - dot(&own[..i], &solved[..i])) / own[i];
            factor[i] = own;
        }
        for i in (0..N).rev() {
            let column: [f64; N] = std::array::from_fn(|k| factor[k][i]);
            let known = dot(&column[i + 1..], &solved[i + 1..]);
            solved[i] = (solved[i] - known) / factor[i][i];
        }
        solved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_fitted_and_an_outlier_weighs_little() {
        let mut equations = LeastSquares::<2>::default();
        for x in 0..10 {
            let x = x as f32;
            equations.add(&[x, 1.0], 3.0 * x - 2.0, 1.0);
        }
        equations.add(&[5.0, 1.0], 1e3, 1e-9);
        let [slope, offset] = equations.step(0.0);
        assert!((slope - 3.0).abs() < 1e-5 && (offset + 2.0).abs() < 1e-4);
        // The variances of a line through ten points with unit errors.
        let [slope, offset] = equations.variances();
        assert!((slope - 1.0 / 82.5).abs() < 1e-6, "{slope}");
        assert!((offset - 285.0 / 825.0).abs() < 1e-6, "{offset}");
    }
}
