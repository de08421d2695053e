//! Contact sheets: moments of a recording side by side.

use crate::canvas::{Canvas, wrapped};

/// A moment on a contact sheet.
pub(crate) struct Still {
    pub picture: Canvas,
    /// The words below it.
    pub caption: String,
}

/// The height of letters, in parts of a picture's height.
const LETTERS: f32 = 0.075;
/// Lines below a picture.
const LINES: u32 = 2;
const PAPER: [u8; 3] = [250; 3];
const INK: [u8; 3] = [20; 3];

/// Pictures in rows of so many, with their captions below them.
pub(crate) fn contact_sheet(moments: &[Still], columns: u32) -> Canvas {
    let Some(Still { picture, .. }) = moments.first() else {
        return Canvas::default();
    };
    let letters = (picture.height as f32 * LETTERS).max(10.0);
    let line = Canvas::line_height(letters);
    let margin = line / 2;
    let columns = columns.clamp(1, moments.len() as u32);
    let rows = (moments.len() as u32).div_ceil(columns);
    let cell = [
        picture.width + margin,
        picture.height + LINES * line + margin,
    ];
    let mut sheet = Canvas::new(columns * cell[0] + margin, rows * cell[1] + margin, PAPER);
    for (number, moment) in (0..).zip(moments) {
        let left = margin + number % columns * cell[0];
        let top = margin + number / columns * cell[1];
        sheet.paste(&moment.picture, [left, top]);
        let lines = wrapped(&moment.caption, picture.width, letters);
        for (row, text) in (0..LINES).zip(lines) {
            let below = top + picture.height + row * line + line / 8;
            sheet.write(&text, [left, below], letters, INK);
        }
    }
    sheet
}
