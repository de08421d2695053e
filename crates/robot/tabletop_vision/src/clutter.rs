//! Clutter: what is in a picture and is not known.

use tabletop_camera::PictureWindow;

use crate::segment::blobs;

/// Connected pixels that nothing known explains.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Clutter {
    /// The window around them.
    pub window: PictureWindow,
    /// Their number.
    pub area: usize,
}

/// Least number of connected pixels that are no noise.
const LEAST_AREA: usize = 6;

/// The clutter of a picture of this size, largest first, if these pixels are not explained.
pub(crate) fn clutter(
    [width, height]: [u32; 2],
    is_unexplained: impl Fn(usize) -> bool,
) -> Vec<Clutter> {
    let found = blobs(width as usize, height as usize, is_unexplained);
    let large = found
        .into_iter()
        .filter(|blob| blob.pixels.len() >= LEAST_AREA);
    let clutter = large.map(|blob| {
        let columns = || blob.pixels.iter().map(|&pixel| pixel as u32 % width);
        let rows = || blob.pixels.iter().map(|&pixel| pixel as u32 / width);
        let around =
            |low: Option<u32>, high: Option<u32>| low.unwrap_or(0)..high.map_or(0, |last| last + 1);
        Clutter {
            window: PictureWindow {
                columns: around(columns().min(), columns().max()),
                rows: around(rows().min(), rows().max()),
            },
            area: blob.pixels.len(),
        }
    });
    clutter.collect()
}
