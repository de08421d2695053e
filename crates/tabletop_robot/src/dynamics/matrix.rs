//! Equations in the joints of an arm.

use tabletop_core::JOINTS_PER_ARM;

/// One number for every joint of an arm.
pub(crate) type Joints = [f64; JOINTS_PER_ARM];

/// One number for every pair of joints of an arm.
pub(crate) type Matrix = [Joints; JOINTS_PER_ARM];

/// Least pivot that is divided by. It is below what the smallest hand has (kg m²), so it only matters to descriptions without masses.
const LEAST_PIVOT: f64 = 1e-6;

/// A symmetric, positive definite matrix taken apart into L D Lᵀ, to solve equations with.
pub(crate) struct Factors {
    lower: Matrix,
    pivots: Joints,
}

impl Factors {
    /// Takes a matrix apart; only what is on and below its diagonal counts.
    pub fn of(matrix: &Matrix) -> Self {
        let mut factors = Self {
            lower: [[0.0; JOINTS_PER_ARM]; JOINTS_PER_ARM],
            pivots: [0.0; JOINTS_PER_ARM],
        };
        let Self { lower, pivots } = &mut factors;
        for row in 0..JOINTS_PER_ARM {
            for column in 0..=row {
                let known: f64 = (0..column)
                    .map(|k| lower[row][k] * lower[column][k] * pivots[k])
                    .sum();
                let left = matrix[row][column] - known;
                if row == column {
                    pivots[row] = left.max(LEAST_PIVOT);
                } else {
                    lower[row][column] = left / pivots[column];
                }
            }
        }
        factors
    }

    /// The x for which the matrix times x is the right side.
    pub fn solve(&self, right: Joints) -> Joints {
        let mut x = right;
        for row in 0..JOINTS_PER_ARM {
            let known: f64 = (0..row).map(|k| self.lower[row][k] * x[k]).sum();
            x[row] -= known;
        }
        for row in (0..JOINTS_PER_ARM).rev() {
            let known: f64 = (row + 1..JOINTS_PER_ARM)
                .map(|k| self.lower[k][row] * x[k])
                .sum();
            x[row] = x[row] / self.pivots[row] - known;
        }
        x
    }
}

/// The sum of products.
pub(crate) fn dot(a: &Joints, b: &Joints) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use std::array::from_fn;

    use super::*;

    #[test]
    fn equations_are_solved() {
        let root: Matrix = from_fn(|i| from_fn(|j| ((3 * i + 5 * j) % 7) as f64 - 2.5));
        let matrix: Matrix =
            from_fn(|i| from_fn(|j| dot(&root[i], &root[j]) + if i == j { 1.0 } else { 0.0 }));
        let x: Joints = from_fn(|i| i as f64 - 2.0);
        let right = matrix.map(|row| dot(&row, &x));
        let found = Factors::of(&matrix).solve(right);
        for (found, x) in found.into_iter().zip(x) {
            assert!((found - x).abs() < 1e-9, "{found} instead of {x}");
        }
    }
}
