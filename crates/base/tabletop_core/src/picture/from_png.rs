//! Pictures in PNG files, whoever has made them.

use std::io::Cursor;

use png::{BitDepth, ColorType, Decoder, DecodingError, Transformations};
use thiserror::Error;

use super::Picture;

/// The reason why a file is no picture.
#[derive(Debug, Error)]
pub enum PictureFault {
    /// It is no PNG file, or a damaged one.
    #[error("it is no whole PNG file: {0}")]
    Damaged(#[from] DecodingError),
    /// It has more pixels than a camera has.
    #[error(
        "it has {width}x{height} pixels, expected sides of at most {} and at most {} pixels",
        Picture::MOST_SIDE,
        Picture::MOST_PIXELS
    )]
    TooLarge {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// It has other colours.
    #[error("it has {color:?} of {depth:?} bits, expected red, green and blue of 8 bits each")]
    OtherColors {
        /// The kind of its colours.
        color: ColorType,
        /// Bits of each.
        depth: BitDepth,
    },
}

impl Picture {
    /// Largest size of a picture's file, in bytes.
    pub const MOST_FILE_BYTES: u64 = 1 << 27;

    /// The colours of a PNG file with 8 bits each of red, green and blue, perhaps with alpha, which is left out. Without depths and objects.
    ///
    /// # Errors
    /// It is none, or has more pixels than a picture of a camera.
    pub fn from_png(file: &[u8]) -> Result<Self, PictureFault> {
        let mut decoder = Decoder::new(Cursor::new(file));
        decoder.set_transformations(Transformations::EXPAND);
        let mut reader = decoder.read_info()?;
        // Said before anything is reserved for them.
        let (width, height) = reader.info().size();
        let too_large = PictureFault::TooLarge { width, height };
        let pixels = u64::from(width) * u64::from(height);
        if width.max(height) > Self::MOST_SIDE || pixels > Self::MOST_PIXELS {
            return Err(too_large);
        }
        let mut samples = vec![0; reader.output_buffer_size().ok_or(too_large)?];
        let info = reader.next_frame(&mut samples)?;
        samples.truncate(info.buffer_size());
        let rgb = match (info.color_type, info.bit_depth) {
            (ColorType::Rgb, BitDepth::Eight) => samples,
            (ColorType::Rgba, BitDepth::Eight) => {
                let (pixels, _) = samples.as_chunks();
                let colors = pixels
                    .iter()
                    .map(|&[red, green, blue, _]| [red, green, blue]);
                colors.flatten().collect()
            }
            (color, depth) => return Err(PictureFault::OtherColors { color, depth }),
        };
        Ok(Self {
            width: info.width,
            height: info.height,
            rgb,
            ..Self::default()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn png(color: ColorType, size: [u32; 2], samples: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
        encoder.set_color(color);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(samples).unwrap();
        writer.finish().unwrap();
        bytes
    }

    #[test]
    fn colours_come_back_without_alpha() {
        let rgba: Vec<u8> = (0..6).flat_map(|i| [i, 2 * i, 3 * i, 255]).collect();
        let rgb: Vec<u8> = (0..6).flat_map(|i| [i, 2 * i, 3 * i]).collect();
        for file in [
            png(ColorType::Rgba, [3, 2], &rgba),
            png(ColorType::Rgb, [3, 2], &rgb),
        ] {
            let picture = Picture::from_png(&file).unwrap();
            assert_eq!((picture.width, picture.height), (3, 2));
            assert_eq!(picture.rgb, rgb);
        }
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        let whole = png(ColorType::Rgb, [3, 2], &[7; 18]);
        // The last 12 bytes are the mark of the end.
        for length in 0..whole.len() - 12 {
            assert!(Picture::from_png(&whole[..length]).is_err(), "{length}");
        }
        let gray = Picture::from_png(&png(ColorType::Grayscale, [3, 2], &[7; 6])).unwrap_err();
        assert!(gray.to_string().contains("Grayscale"), "{gray}");
    }

    #[test]
    fn what_it_says_of_its_size_is_checked_before_it_is_believed() {
        // A whole file, and no pixel in it, of a size that would take 12 GB.
        let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
        let header = [
            &b"IHDR"[..],
            &65_535_u32.to_be_bytes(),
            &65_535_u32.to_be_bytes(),
            &[8, 2, 0, 0, 0],
        ]
        .concat();
        for chunk in [header, b"IDAT".to_vec(), b"IEND".to_vec()] {
            bytes.extend((chunk.len() as u32 - 4).to_be_bytes());
            bytes.extend(&chunk);
            bytes.extend(crc(&chunk).to_be_bytes());
        }
        let error = Picture::from_png(&bytes).unwrap_err().to_string();
        assert!(error.contains("65535x65535 pixels"), "{error}");
    }

    /// The checksum of a chunk.
    fn crc(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(!0, |crc: u32, byte| {
            (0..8).fold(crc ^ u32::from(*byte), |crc, _| match crc & 1 {
                0 => crc >> 1,
                _ => (crc >> 1) ^ 0xedb8_8320,
            })
        })
    }
}
