//! GIF animations.

use gif::{Encoder, Frame, Repeat};

use crate::{canvas::Canvas, error::FilmError};

/// The care with which colours are chosen, from 1 (much) to 30.
const COLOR_SPEED: i32 = 10;

/// A GIF file that is shown for ever. A frame holds only the part of the picture that has changed.
pub(crate) struct Animation {
    encoder: Encoder<Vec<u8>>,
    fps: u32,
    /// Number of pictures so far.
    shown: u32,
    /// The frame that is not written yet, as it may be shown longer, and its first picture's number.
    waiting: Option<(Frame<'static>, u32)>,
    last: Canvas,
}

impl Animation {
    pub fn new(width: u32, height: u32, fps: u32) -> Result<Self, FilmError> {
        let side = |side: u32| {
            u16::try_from(side).map_err(|_| FilmError::Size {
                format: "a GIF file",
                width,
                height,
                expected: "expected sides of at most 65535 pixels",
            })
        };
        let encoder = Encoder::new(Vec::new(), side(width)?, side(height)?, &[]);
        let mut encoder = encoder.map_err(failed)?;
        encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
        Ok(Self {
            encoder,
            fps,
            shown: 0,
            waiting: None,
            last: Canvas::default(),
        })
    }

    pub fn push(&mut self, picture: &Canvas) -> Result<(), FilmError> {
        if let Some([columns, rows]) = changed_part(&self.last, picture) {
            self.flush()?;
            let part: Vec<u8> = rows
                .clone()
                .flat_map(|row| {
                    let from = (row * picture.width as usize + columns.start) * 3;
                    &picture.rgb[from..][..columns.len() * 3]
                })
                .copied()
                .collect();
            let [width, height] = [columns.len() as u16, rows.len() as u16];
            let mut frame = Frame::from_rgb_speed(width, height, &part, COLOR_SPEED);
            (frame.left, frame.top) = (columns.start as u16, rows.start as u16);
            self.waiting = Some((frame, self.shown));
            self.last.clone_from(picture);
        }
        self.shown += 1;
        Ok(())
    }

    pub fn finish(mut self) -> Result<Vec<u8>, FilmError> {
        self.flush()?;
        self.encoder.into_inner().map_err(failed)
    }

    /// Writes the waiting frame with the time until now, in hundredths of a second.
    fn flush(&mut self) -> Result<(), FilmError> {
        let Some((mut frame, since)) = self.waiting.take() else {
            return Ok(());
        };
        let hundredths = |picture: u32| u64::from(picture) * 100 / u64::from(self.fps.max(1));
        let time = hundredths(self.shown) - hundredths(since);
        frame.delay = time.min(u64::from(u16::MAX)) as u16;
        self.encoder.write_frame(&frame).map_err(failed)
    }
}

/// The columns and rows in which a picture differs from the one before; `None` if it is the same.
fn changed_part(before: &Canvas, now: &Canvas) -> Option<[std::ops::Range<usize>; 2]> {
    let [width, height] = [now.width as usize, now.height as usize];
    if [before.width, before.height] != [now.width, now.height] {
        return Some([0..width, 0..height]);
    }
    let (before, _) = before.rgb.as_chunks::<3>();
    let (now, _) = now.rgb.as_chunks::<3>();
    let differs = |index: &usize| before[*index] != now[*index];
    let mut part: Option<[std::ops::Range<usize>; 2]> = None;
    for index in (0..width * height).filter(differs) {
        let (column, row) = (index % width, index / width);
        let [columns, rows] = part.get_or_insert([column..column + 1, row..row + 1]);
        *columns = columns.start.min(column)..columns.end.max(column + 1);
        *rows = rows.start.min(row)..rows.end.max(row + 1);
    }
    part
}

fn failed(error: impl ToString) -> FilmError {
    FilmError::Failed(error.to_string())
}

#[cfg(test)]
mod tests {
    use gif::{ColorOutput, DecodeOptions};

    use super::*;

    #[test]
    fn frames_hold_the_changed_part_and_last_until_the_next_change() {
        let mut animation = Animation::new(8, 6, 10).unwrap();
        let plain = Canvas::new(8, 6, [40; 3]);
        let mut marked = plain.clone();
        marked.paste(&Canvas::new(2, 1, [200; 3]), [3, 4]);
        for picture in [&plain, &plain, &plain, &marked, &marked] {
            animation.push(picture).unwrap();
        }
        let bytes = animation.finish().unwrap();
        let mut options = DecodeOptions::new();
        options.set_color_output(ColorOutput::RGBA);
        let mut decoder = options.read_info(bytes.as_slice()).unwrap();
        let mut frames = Vec::new();
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            frames.push((
                [frame.left, frame.top, frame.width, frame.height],
                frame.delay,
                frame.buffer[0],
            ));
        }
        assert_eq!(frames[0], ([0, 0, 8, 6], 30, 40));
        assert_eq!(frames[1], ([3, 4, 2, 1], 20, 200));
        assert_eq!(frames.len(), 2);
    }
}
