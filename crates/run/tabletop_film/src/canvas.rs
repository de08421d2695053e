//! Pictures to put together and to write on.

use ab_glyph::{Font as _, FontRef, Glyph, PxScale, ScaleFont as _, point};
use tabletop_core::Picture;

/// A picture to put others on, and to write on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Canvas {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green and blue of each pixel, row by row from the top.
    pub rgb: Vec<u8>,
}

/// The height of a line, as a multiple of the height of its letters.
const LINE: f32 = 1.25;

impl Canvas {
    /// A canvas of one colour.
    pub fn new(width: u32, height: u32, color: [u8; 3]) -> Self {
        Self {
            width,
            height,
            rgb: color.repeat(width as usize * height as usize),
        }
    }

    /// A picture of a camera.
    pub fn of(picture: &Picture) -> Self {
        Self {
            width: picture.width,
            height: picture.height,
            rgb: picture.rgb.clone(),
        }
    }

    /// Puts another one on it, its upper left corner at this column and row. Parts beyond the edge are left out.
    pub fn paste(&mut self, other: &Self, [left, top]: [u32; 2]) {
        let columns = other.width.min(self.width.saturating_sub(left)) as usize;
        for row in 0..other.height.min(self.height.saturating_sub(top)) {
            let from = (row * other.width) as usize * 3;
            let to = self.offset(left, top + row);
            self.rgb[to..][..columns * 3].copy_from_slice(&other.rgb[from..][..columns * 3]);
        }
    }

    /// Darkens its rows from this one on, so that light letters can be read.
    pub fn shade(&mut self, top: u32) {
        let from = self.offset(0, top.min(self.height));
        for value in &mut self.rgb[from..] {
            *value = (u16::from(*value) * 2 / 5) as u8;
        }
    }

    /// Writes a line, its upper left corner at this column and row, with letters of this height in pixels.
    pub fn write(&mut self, text: &str, [left, top]: [u32; 2], height: f32, color: [u8; 3]) {
        for glyph in glyphs(text, height) {
            let Some(outline) = font().and_then(|font| font.outline_glyph(glyph)) else {
                continue;
            };
            let bounds = outline.px_bounds();
            outline.draw(|x, y, cover| {
                let column = left as f32 + bounds.min.x + x as f32;
                let row = top as f32 + bounds.min.y + y as f32;
                let is_inside = (0.0..self.width as f32).contains(&column)
                    && (0.0..self.height as f32).contains(&row);
                if is_inside {
                    let at = self.offset(column as u32, row as u32);
                    for (value, wanted) in self.rgb[at..at + 3].iter_mut().zip(color) {
                        let mixed = f32::from(*value) * (1.0 - cover) + f32::from(wanted) * cover;
                        *value = mixed.round().clamp(0.0, 255.0) as u8;
                    }
                }
            });
        }
    }

    /// The height of a line of letters of this height.
    pub fn line_height(height: f32) -> u32 {
        (height * LINE).ceil() as u32
    }

    /// The picture as a PNG file.
    ///
    /// # Errors
    /// It has no pixels.
    pub fn png(&self) -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Fast);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.rgb)?;
        writer.finish()?;
        Ok(bytes)
    }

    fn offset(&self, column: u32, row: u32) -> usize {
        (row as usize * self.width as usize + column as usize) * 3
    }
}

/// A text in lines that are not wider than this, in pixels, with letters of this height. A word that is wider has a line of its own.
pub(crate) fn wrapped(text: &str, width: u32, height: f32) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let longer = lines.last().map(|line| format!("{line} {word}"));
        match longer.filter(|line| width_of(line, height) <= width as f32) {
            Some(longer) => {
                lines.pop();
                lines.push(longer);
            }
            None => lines.push(word.to_owned()),
        }
    }
    lines
}

/// The font of the window.
fn font() -> Option<FontRef<'static>> {
    FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).ok()
}

fn width_of(text: &str, height: f32) -> f32 {
    let Some(font) = font() else {
        return 0.0;
    };
    let font = font.as_scaled(PxScale::from(height));
    text.chars()
        .map(|letter| font.h_advance(font.glyph_id(letter)))
        .sum()
}

/// The letters of a line, side by side.
fn glyphs(text: &str, height: f32) -> Vec<Glyph> {
    let Some(font) = font() else {
        return Vec::new();
    };
    let font = font.as_scaled(PxScale::from(height));
    let mut column = 0.0;
    text.chars()
        .map(|letter| {
            let mut glyph = font.scaled_glyph(letter);
            glyph.position = point(column, font.ascent());
            column += font.h_advance(glyph.id);
            glyph
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_pasted_within_the_edges() {
        let mut canvas = Canvas::new(4, 3, [0; 3]);
        canvas.paste(&Canvas::new(3, 3, [9; 3]), [2, 1]);
        let column = |row: usize| -> Vec<u8> {
            (0..4)
                .map(|column| canvas.rgb[(row * 4 + column) * 3])
                .collect()
        };
        assert_eq!(
            [column(0), column(1), column(2)],
            [[0, 0, 0, 0], [0, 0, 9, 9], [0, 0, 9, 9]]
        );
        canvas.paste(&Canvas::new(1, 1, [5; 3]), [7, 7]);
    }

    #[test]
    fn letters_are_where_they_are_written() {
        let mut canvas = Canvas::new(60, 24, [0; 3]);
        canvas.write("HI", [4, 2], 16.0, [255; 3]);
        let lit = |columns: std::ops::Range<usize>| {
            let rows = (0..24).flat_map(|row| columns.clone().map(move |column| row * 60 + column));
            rows.filter(|pixel| canvas.rgb[pixel * 3] > 128).count()
        };
        assert_eq!(lit(0..4), 0);
        assert!(lit(4..30) > 20, "{}", lit(4..30));
        assert_eq!(lit(40..60), 0);
    }

    #[test]
    fn texts_are_wrapped_between_words() {
        let lines = wrapped("put it on the green block", 90, 16.0);
        assert!(lines.len() > 1, "{lines:?}");
        assert_eq!(lines.join(" "), "put it on the green block");
        assert!(lines.iter().all(|line| width_of(line, 16.0) <= 90.0));
        assert_eq!(wrapped("incomprehensibilities", 10, 16.0).len(), 1);
        assert!(wrapped("", 10, 16.0).is_empty());
    }
}
