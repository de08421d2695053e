//! The pixels of a window of a picture.

use std::ops::Range;

use tabletop_camera::PictureWindow;

/// The indices of the pixels of a window, row by row.
pub(crate) fn rows(
    window: &PictureWindow,
    width: u32,
) -> impl Iterator<Item = Range<usize>> + use<> {
    let columns = window.columns.clone();
    window.rows.clone().map(move |row| {
        let first = row as usize * width as usize;
        first + columns.start as usize..first + columns.end as usize
    })
}
