//! Pictures of cameras.

mod from_png;

pub use from_png::PictureFault;

/// A picture of a camera: one value per pixel in each list, row by row from the top, each row from the left.
/// The pixel in column x of row y has index `y * width + x`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Displayed red, green and blue of each pixel, 0..=255; black where nothing is.
    pub rgb: Vec<u8>,
    /// Depth of the surface at each pixel's centre: its distance ahead of the camera, in units along the axis of view;
    /// infinity where nothing is.
    pub depth: Vec<f32>,
    /// Number of the object at each pixel's centre; 0 where nothing is.
    pub objects: Vec<u32>,
}

impl Picture {
    /// Largest number of pixels. Rows and columns are at most [`MOST_SIDE`](Self::MOST_SIDE).
    pub const MOST_PIXELS: u64 = 1 << 24;
    /// Largest number of rows, and of columns.
    pub const MOST_SIDE: u32 = 8192;

    /// Sets its size in pixels; their values are arbitrary afterwards.
    pub fn resize(&mut self, width: u32, height: u32) {
        let pixels = width as usize * height as usize;
        self.width = width;
        self.height = height;
        self.rgb.resize(pixels * 3, 0);
        self.depth.resize(pixels, f32::INFINITY);
        self.objects.resize(pixels, 0);
    }

    /// Index of a pixel in [`depth`](Self::depth) and [`objects`](Self::objects), if there is such a pixel.
    pub fn index(&self, column: u32, row: u32) -> Option<usize> {
        (column < self.width && row < self.height)
            .then_some(row as usize * self.width as usize + column as usize)
    }

    /// Red, green and blue of a pixel, if there is such a pixel.
    pub fn color(&self, column: u32, row: u32) -> Option<[u8; 3]> {
        let first = self.index(column, row)? * 3;
        self.rgb.get(first..first + 3)?.try_into().ok()
    }
}

#[expect(
    clippy::approx_constant,
    reason = "an angle of view is smaller than π, however little"
)]
const WIDEST_VIEW: f32 = 3.141;

/// The fault of pictures of this size with this angle of view, in rad.
pub(crate) fn fault_of_view(width: u32, height: u32, vertical_fov: f32) -> Option<String> {
    let sides = 1..=Picture::MOST_SIDE;
    let pixels = u64::from(width) * u64::from(height);
    if !sides.contains(&width) || !sides.contains(&height) || pixels > Picture::MOST_PIXELS {
        return Some(format!(
            "{width}x{height} is no size of a picture, expected sides of 1 to {} and at most {} pixels",
            Picture::MOST_SIDE,
            Picture::MOST_PIXELS
        ));
    }
    (!(0.001..=WIDEST_VIEW).contains(&vertical_fov))
        .then(|| format!("an angle of view of {vertical_fov} rad, expected 0.001 to {WIDEST_VIEW}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_are_counted_from_the_top_left_row_by_row() {
        let mut picture = Picture::default();
        picture.resize(3, 2);
        picture.rgb[3 * 4..3 * 5].copy_from_slice(&[7, 8, 9]);
        assert_eq!(picture.index(1, 1), Some(4));
        assert_eq!(picture.color(1, 1), Some([7, 8, 9]));
        assert_eq!(picture.color(3, 0), None);
        assert_eq!(picture.color(0, 2), None);
    }
}
