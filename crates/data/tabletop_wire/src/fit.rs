//! Pictures as policies want them.

use serde::Deserialize;

use crate::array::NumpyArray;

/// The order of a picture's numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum PixelLayout {
    /// Rows × columns × colours.
    #[default]
    RowsColumnsColors,
    /// Colours × rows × columns.
    ColorsRowsColumns,
}

/// A picture within a larger black one. It is drawn at the size that it has there, so that nothing is resampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PictureFit {
    /// Columns and rows of the whole.
    pub size: [u32; 2],
    /// Columns and rows of what is drawn, in the middle.
    pub inner: [u32; 2],
}

impl PictureFit {
    /// The largest picture of this aspect, columns to rows, in one of this size; all of it if there is no aspect.
    pub fn new(size: [u32; 2], aspect: Option<[u32; 2]>) -> Self {
        let [columns, rows] = size.map(u64::from);
        let [wide, high] = aspect.unwrap_or(size).map(|side| u64::from(side.max(1)));
        let inner = match columns * high <= rows * wide {
            true => [columns, columns * high / wide],
            false => [rows * wide / high, rows],
        };
        Self {
            size,
            // Not more than the sides of `size`.
            inner: inner.map(|side| (side as u32).max(1)),
        }
    }

    /// The array of a picture that was drawn: red, green and blue of each pixel, row by row from the top. What is missing is black.
    pub fn array(&self, rgb: &[u8], is_mirrored: bool, layout: PixelLayout) -> NumpyArray {
        let [columns, rows] = self.size.map(|side| side as usize);
        let [wide, high] = self.inner.map(|side| side as usize);
        let (left, top) = ((columns - wide) / 2, (rows - high) / 2);
        let pixel_bytes = columns * rows * 3;
        let mut bytes = vec![0; pixel_bytes];
        let (pixels, _) = rgb.as_chunks::<3>();
        for (number, pixel) in pixels.iter().take(wide * high).enumerate() {
            let (row, column) = (number / wide + top, number % wide);
            let column = left
                + match is_mirrored {
                    true => wide - 1 - column,
                    false => column,
                };
            for (color, byte) in pixel.iter().enumerate() {
                let place = match layout {
                    PixelLayout::RowsColumnsColors => (row * columns + column) * 3 + color,
                    PixelLayout::ColorsRowsColumns => (color * rows + row) * columns + column,
                };
                bytes[place] = *byte;
            }
        }
        let shape = match layout {
            PixelLayout::RowsColumnsColors => [rows, columns, 3],
            PixelLayout::ColorsRowsColumns => [3, rows, columns],
        };
        NumpyArray::of_bytes(&shape, bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wide_picture_has_black_above_and_below() {
        let fit = PictureFit::new([224, 224], Some([16, 9]));
        assert_eq!(fit.inner, [224, 126]);
        assert_eq!(PictureFit::new([224, 224], Some([3, 4])).inner, [168, 224]);
        assert_eq!(PictureFit::new([200, 150], None).inner, [200, 150]);
        let fit = PictureFit::new([2, 3], Some([2, 1]));
        let array = fit.array(&[1, 2, 3, 4, 5, 6], false, PixelLayout::default());
        assert_eq!(array.shape(), [3, 2, 3]);
        assert_eq!(
            array.bytes(),
            [0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 0, 0, 0, 0, 0, 0]
        );
    }

    #[test]
    fn colours_can_come_first_and_columns_from_the_right() {
        let fit = PictureFit::new([2, 1], None);
        let array = fit.array(&[1, 2, 3, 4, 5, 6], true, PixelLayout::ColorsRowsColumns);
        assert_eq!(array.shape(), [3, 1, 2]);
        assert_eq!(array.bytes(), [4, 1, 5, 2, 6, 3]);
    }
}
