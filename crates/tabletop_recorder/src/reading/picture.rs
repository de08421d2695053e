//! Pictures of recordings, read back.

use std::{io, path::Path};

use tabletop_core::Picture;
use tabletop_storage::{Symlinks, read_regular_file};

use crate::RecorderError;

/// Largest size of a picture's file, in bytes.
const MOST_BYTES: u64 = 1 << 28;

/// Reads the colours of a picture: a PNG with 8 bits each of red, green and blue, perhaps with alpha, which is left out. Its depth is 0 everywhere, and it
/// shows no object.
///
/// # Errors
/// The file cannot be read, or is no such picture.
pub fn read_picture(path: &Path) -> Result<Picture, RecorderError> {
    let bytes = read_regular_file(path, MOST_BYTES, Symlinks::Followed);
    let decoded = bytes.and_then(|bytes| decode(&bytes));
    decoded.map_err(RecorderError::read(path))
}

fn decode(bytes: &[u8]) -> io::Result<Picture> {
    let unfit = |fault: &str| io::Error::new(io::ErrorKind::InvalidData, fault.to_owned());
    let mut reader = png::Decoder::new(io::Cursor::new(bytes)).read_info()?;
    let (width, height) = reader.info().size();
    let pixels = u64::from(width) * u64::from(height);
    if width.max(height) > Picture::MOST_SIDE || pixels > Picture::MOST_PIXELS {
        return Err(unfit("it has too many pixels"));
    }
    let size = reader.output_buffer_size();
    let mut samples = vec![0; size.ok_or_else(|| unfit("it has too many pixels"))?];
    let info = reader.next_frame(&mut samples)?;
    let samples = &samples[..info.buffer_size()];
    let rgb = match (info.color_type, info.bit_depth) {
        (png::ColorType::Rgb, png::BitDepth::Eight) => samples.to_vec(),
        (png::ColorType::Rgba, png::BitDepth::Eight) => {
            let (pixels, _) = samples.as_chunks();
            let colors = pixels
                .iter()
                .map(|&[red, green, blue, _]| [red, green, blue]);
            colors.flatten().collect()
        }
        _ => return Err(unfit("it has not 8 bits each of red, green and blue")),
    };
    Ok(Picture {
        width,
        height,
        rgb,
        depth: vec![0.0; pixels as usize],
        objects: vec![0; pixels as usize],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::picture::color_png;

    #[test]
    fn colours_come_back() {
        let mut picture = Picture::default();
        picture.resize(3, 2);
        for (index, value) in picture.rgb.iter_mut().enumerate() {
            *value = index as u8 * 10;
        }
        let read = decode(&color_png(&picture).unwrap()).unwrap();
        assert_eq!((read.width, read.height), (3, 2));
        assert_eq!(read.rgb, picture.rgb);
        assert_eq!(read.depth.len(), 6);
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        let mut picture = Picture::default();
        picture.resize(3, 2);
        let mut bytes = color_png(&picture).unwrap();
        for length in 0..bytes.len() - 12 {
            assert!(decode(&bytes[..length]).is_err(), "{length}");
        }
        // A width of millions.
        bytes[16] = 0x7f;
        assert!(decode(&bytes).is_err());
    }
}
