//! NumPy's arrays.

use crate::dtype::Dtype;

/// The most dimensions of an array.
pub(crate) const MOST_DIMENSIONS: usize = 8;

/// An array of NumPy's: numbers of one type, the last index of the shape running fastest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NumpyArray {
    dtype: Dtype,
    shape: Vec<usize>,
    bytes: Vec<u8>,
}

impl NumpyArray {
    /// An array of these bytes, little-endian.
    ///
    /// # Errors
    /// They do not fit the shape.
    pub fn new(dtype: Dtype, shape: Vec<usize>, bytes: Vec<u8>) -> Result<Self, String> {
        if shape.len() > MOST_DIMENSIONS {
            return Err(format!(
                "{} dimensions, expected at most {MOST_DIMENSIONS}",
                shape.len()
            ));
        }
        let count = shape
            .iter()
            .try_fold(dtype.bytes(), |all, side| all.checked_mul(*side));
        if count != Some(bytes.len()) {
            return Err(format!(
                "{} bytes do not fit the shape {shape:?} of {}",
                bytes.len(),
                dtype.name()
            ));
        }
        Ok(Self {
            dtype,
            shape,
            bytes,
        })
    }

    /// An array of numbers in single precision: the first ones that the shape has room for, and 0 for those that are missing.
    pub fn of_floats(shape: &[usize], numbers: &[f32]) -> Self {
        let count: usize = shape.iter().product();
        let numbers = numbers.iter().copied().chain(std::iter::repeat(0.0));
        Self {
            dtype: Dtype::F32,
            shape: shape.to_vec(),
            bytes: numbers.take(count).flat_map(f32::to_le_bytes).collect(),
        }
    }

    /// An array of bytes: the first ones that the shape has room for, and 0 for those that are missing.
    pub fn of_bytes(shape: &[usize], mut bytes: Vec<u8>) -> Self {
        bytes.resize(shape.iter().product(), 0);
        Self {
            dtype: Dtype::U8,
            shape: shape.to_vec(),
            bytes,
        }
    }

    /// The type of its numbers.
    pub const fn dtype(&self) -> Dtype {
        self.dtype
    }

    /// Its shape.
    pub fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// Its bytes, little-endian.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Its numbers. Whole numbers beyond 2^53 are rounded.
    pub fn numbers(&self) -> impl Iterator<Item = f64> {
        let each = self.bytes.chunks_exact(self.dtype.bytes());
        each.map(|bytes| self.dtype.number(bytes))
    }

    /// The array whose numbers have their bytes in the other order.
    pub(crate) fn swapped(mut self) -> Self {
        let numbers = self.bytes.chunks_exact_mut(self.dtype.bytes());
        numbers.for_each(<[u8]>::reverse);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_fit_the_shape() {
        let array = NumpyArray::new(Dtype::I16, vec![2, 1], vec![1, 0, 0xff, 0xff]).unwrap();
        assert_eq!(array.numbers().collect::<Vec<_>>(), [1.0, -1.0]);
        let array = array.swapped();
        assert_eq!(array.numbers().collect::<Vec<_>>(), [256.0, -1.0]);
        let refusal = NumpyArray::new(Dtype::F32, vec![2, 3], vec![0; 20]).unwrap_err();
        assert_eq!(refusal, "20 bytes do not fit the shape [2, 3] of <f4");
        for shape in [vec![usize::MAX, 2], vec![1; 9], vec![usize::MAX, 0, 4]] {
            NumpyArray::new(Dtype::F64, shape, Vec::new()).unwrap_err();
        }
        NumpyArray::new(Dtype::F64, vec![0, 5], Vec::new()).unwrap();
        NumpyArray::new(Dtype::F64, Vec::new(), vec![0; 8]).unwrap();
    }

    #[test]
    fn numbers_fill_the_shape() {
        let array = NumpyArray::of_floats(&[3], &[1.0, 2.0]);
        assert_eq!(array.numbers().collect::<Vec<_>>(), [1.0, 2.0, 0.0]);
        assert_eq!(NumpyArray::of_bytes(&[2], vec![1, 2, 3]).bytes(), [1, 2]);
    }
}
