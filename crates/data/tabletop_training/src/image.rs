//! Pictures without an alpha channel, as learners want them.

use tabletop_core::Picture;
use tabletop_film::Canvas;
use tabletop_storage::InnerFile;

use crate::error::EpisodeError;

/// A picture.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Image {
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Red, green and blue of each pixel, row by row from the top.
    pub rgb: Vec<u8>,
    /// The same as a PNG file.
    pub png: Vec<u8>,
}

impl Image {
    /// Reads a picture of a recording. Its pixels stay as they are; only the alpha channel, which is opaque, goes: readers would
    /// take it for a fourth colour.
    ///
    /// # Errors
    /// The file cannot be read, is behind a link, or is no picture of a camera.
    pub fn read(file: &InnerFile) -> Result<Self, EpisodeError> {
        let path = file.path();
        let bytes = file.read(Picture::MOST_FILE_BYTES);
        let bytes = bytes.map_err(EpisodeError::io(&path))?;
        Self::decode(&bytes).map_err(|problem| EpisodeError::picture(path, problem))
    }

    /// Reads a picture of a camera whose pictures have so many columns and rows, if that is known.
    ///
    /// # Errors
    /// As [`read`](Self::read), and if it has another size.
    pub fn read_sized(file: &InnerFile, size: Option<[u32; 2]>) -> Result<Self, EpisodeError> {
        let image = Self::read(file)?;
        let found = [image.width, image.height];
        match size.filter(|expected| *expected != found) {
            None => Ok(image),
            Some([width, height]) => {
                let [columns, rows] = found;
                let problem = format!(
                    "it has {columns}x{rows} pixels, the camera's pictures have {width}x{height}"
                );
                Err(EpisodeError::picture(file.path(), problem))
            }
        }
    }

    /// The picture in a PNG file.
    ///
    /// # Errors
    /// It is none of a camera, or has not 8 bits a colour.
    pub fn decode(bytes: &[u8]) -> Result<Self, String> {
        let Picture {
            width, height, rgb, ..
        } = Picture::from_png(bytes).map_err(|fault| fault.to_string())?;
        Self::new(width, height, rgb).map_err(|error| error.to_string())
    }

    /// A picture of these pixels.
    pub(crate) fn new(width: u32, height: u32, rgb: Vec<u8>) -> Result<Self, png::EncodingError> {
        let canvas = Canvas { width, height, rgb };
        let png = canvas.png()?;
        let rgb = canvas.rgb;
        Ok(Self {
            width,
            height,
            rgb,
            png,
        })
    }
}

/// Values of pixels in 16 bits as a PNG file.
pub fn gray_png(width: u32, height: u32, values: &[u16]) -> Vec<u8> {
    let bytes: Vec<u8> = values.iter().copied().flat_map(u16::to_be_bytes).collect();
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, width, height);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    encoder.set_compression(png::Compression::Fast);
    let written = encoder.write_header().and_then(|mut writer| {
        writer.write_image_data(&bytes)?;
        writer.finish()
    });
    debug_assert!(written.is_ok(), "a picture has the size of its camera");
    png
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pixels_stay_and_the_alpha_channel_goes() {
        let rgba: Vec<u8> = (0..12_u8).flat_map(|i| [i, 2 * i, 3 * i, 255]).collect();
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 4, 3);
        encoder.set_color(png::ColorType::Rgba);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&rgba).unwrap();
        writer.finish().unwrap();

        let image = Image::decode(&bytes).unwrap();
        let expected: Vec<u8> = (0..12_u8).flat_map(|i| [i, 2 * i, 3 * i]).collect();
        assert_eq!((image.width, image.height), (4, 3));
        assert_eq!(image.rgb, expected);
        assert_eq!(Image::decode(&image.png).unwrap(), image);
        assert!(Image::decode(&bytes[..20]).is_err());
    }
}
