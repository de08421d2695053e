//! Numbers for the joints of a robot's limbs.

use std::ops::{Index, IndexMut};

use crate::protocol::{Array, Data};

/// A number for each joint of each limb: a row for a limb, a column for a joint from the limb's base to its tip. Limbs with fewer
/// joints than others have zeros at the end.
///
/// ```
/// use tabletop_engine::JointMatrix;
///
/// let mut velocities = JointMatrix::zeros([2, 7]); // Baxter's: left, right; S0, S1, E0, E1, W0, W1, W2
/// velocities[1][2] = 0.5;
/// assert_eq!(velocities.size(), [2, 7]);
/// assert_eq!(velocities.rows().nth(1), Some(&[0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0][..]));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointMatrix {
    limbs: usize,
    joints: usize,
    /// Row by row.
    numbers: Vec<f64>,
}

impl JointMatrix {
    /// Zeros for so many limbs with so many joints each.
    pub fn zeros([limbs, joints]: [usize; 2]) -> Self {
        let numbers = vec![0.0; limbs * joints];
        Self {
            limbs,
            joints,
            numbers,
        }
    }

    /// A row for each limb; shorter ones get zeros.
    pub fn from_rows(rows: &[Vec<f64>]) -> Self {
        let joints = rows.iter().map(Vec::len).max().unwrap_or(0);
        let mut matrix = Self::zeros([rows.len(), joints]);
        for (limb, row) in rows.iter().enumerate() {
            matrix[limb][..row.len()].copy_from_slice(row);
        }
        matrix
    }

    /// The number of its limbs and joints.
    pub const fn size(&self) -> [usize; 2] {
        [self.limbs, self.joints]
    }

    /// The numbers of each limb.
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        (0..self.limbs).map(|limb| &self[limb])
    }

    /// As scripts get it.
    pub(crate) fn array(&self) -> Array {
        let columns = (0..self.joints).flat_map(|joint| self.rows().map(move |row| row[joint]));
        Array {
            dims: vec![self.limbs as u32, self.joints as u32],
            data: Data::Double(columns.collect()),
        }
    }

    /// A matrix from numbers column by column, as scripts write them. Missing numbers are 0.
    pub(crate) fn from_columns([limbs, joints]: [usize; 2], numbers: &[f64]) -> Self {
        let mut matrix = Self::zeros([limbs, joints]);
        for (place, number) in numbers.iter().enumerate().take(limbs * joints) {
            matrix[place % limbs][place / limbs] = *number;
        }
        matrix
    }
}

impl<const LIMBS: usize, const JOINTS: usize> From<[[f64; JOINTS]; LIMBS]> for JointMatrix {
    fn from(rows: [[f64; JOINTS]; LIMBS]) -> Self {
        Self {
            limbs: LIMBS,
            joints: JOINTS,
            numbers: rows.into_iter().flatten().collect(),
        }
    }
}

impl<const LIMBS: usize, const JOINTS: usize> PartialEq<[[f64; JOINTS]; LIMBS]> for JointMatrix {
    fn eq(&self, rows: &[[f64; JOINTS]; LIMBS]) -> bool {
        self.size() == [LIMBS, JOINTS] && self.rows().eq(rows.iter().map(<[f64; JOINTS]>::as_slice))
    }
}

impl Index<usize> for JointMatrix {
    type Output = [f64];

    fn index(&self, limb: usize) -> &[f64] {
        &self.numbers[limb * self.joints..(limb + 1) * self.joints]
    }
}

impl IndexMut<usize> for JointMatrix {
    fn index_mut(&mut self, limb: usize) -> &mut [f64] {
        &mut self.numbers[limb * self.joints..(limb + 1) * self.joints]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scripts_have_columns_first() {
        let matrix = JointMatrix::from([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        let array = matrix.array();
        assert_eq!(array, Array::matrix(&[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]));
        let Data::Double(columns) = &array.data else {
            panic!("{array:?}")
        };
        assert_eq!(JointMatrix::from_columns([2, 3], columns), matrix);
    }

    #[test]
    fn a_short_limb_ends_with_zeros() {
        let matrix = JointMatrix::from_rows(&[vec![1.0], vec![2.0, 3.0]]);
        assert_eq!(matrix, JointMatrix::from([[1.0, 0.0], [2.0, 3.0]]));
        assert_eq!(JointMatrix::from_rows(&[]).array().dims, [0, 0]);
    }
}
