//! Linear algebra on the joints of a limb.

use smallvec::SmallVec;

/// One number for every joint of a limb.
pub(crate) type Joints = SmallVec<[f64; 8]>;

/// One number for every pair of joints of a limb.
pub(crate) type Matrix = SmallVec<[Joints; 8]>;

/// Least pivot of a division. It is below the inertia of the smallest hand (in kg m²), so it matters only for descriptions without masses.
const LEAST_PIVOT: f64 = 1e-6;

/// A number for each joint.
pub(crate) fn each(joints: usize, number: impl FnMut(usize) -> f64) -> Joints {
    (0..joints).map(number).collect()
}

/// A number for each pair of joints.
pub(crate) fn each_pair(joints: usize, number: impl Fn(usize, usize) -> f64) -> Matrix {
    (0..joints)
        .map(|i| each(joints, |j| number(i, j)))
        .collect()
}

/// The factorisation L D Lᵀ of a symmetric, positive definite matrix.
pub(crate) struct Factors {
    lower: Matrix,
    pivots: Joints,
}

impl Factors {
    /// Factorises a matrix; only its diagonal and the part below it are read.
    pub fn of(matrix: &Matrix) -> Self {
        let joints = matrix.len();
        let mut factors = Self {
            lower: each_pair(joints, |_, _| 0.0),
            pivots: each(joints, |_| 0.0),
        };
        let Self { lower, pivots } = &mut factors;
        for row in 0..joints {
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

    /// The solution x of matrix · x = `right`.
    pub fn solve(&self, right: Joints) -> Joints {
        let mut x = right;
        for row in 0..x.len() {
            let known: f64 = (0..row).map(|k| self.lower[row][k] * x[k]).sum();
            x[row] -= known;
        }
        for row in (0..x.len()).rev() {
            let known: f64 = (row + 1..x.len()).map(|k| self.lower[k][row] * x[k]).sum();
            x[row] = x[row] / self.pivots[row] - known;
        }
        x
    }
}

/// The dot product.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equations_are_solved() {
        let root = each_pair(7, |i, j| ((3 * i + 5 * j) % 7) as f64 - 2.5);
        let matrix = each_pair(7, |i, j| {
            dot(&root[i], &root[j]) + if i == j { 1.0 } else { 0.0 }
        });
        let x = each(7, |i| i as f64 - 2.0);
        let right = each(7, |i| dot(&matrix[i], &x));
        let found = Factors::of(&matrix).solve(right);
        for (found, x) in found.into_iter().zip(x) {
            assert!((found - x).abs() < 1e-9, "{found} instead of {x}");
        }
    }
}
