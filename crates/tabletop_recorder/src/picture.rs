//! Pictures as PNG files.

use std::{fs, path::Path};

use tabletop_core::Picture;

use crate::RecorderError;

/// Writes a picture with 8 bits each of red, green, blue and alpha, as the original program did. Under its name the file
/// is never incomplete.
pub(crate) fn write_png(picture: &Picture, path: &Path) -> Result<(), RecorderError> {
    let bytes = encode(picture).map_err(|source| RecorderError::Picture {
        path: path.to_owned(),
        source,
    })?;
    let part = path.with_extension("png.part");
    fs::write(&part, bytes)
        .and_then(|()| fs::rename(&part, path))
        .map_err(|error| {
            // What could not be written need not be there.
            let _removed = fs::remove_file(&part);
            RecorderError::write(path)(error)
        })
}

fn encode(picture: &Picture) -> Result<Vec<u8>, png::EncodingError> {
    let (pixels, _) = picture.rgb.as_chunks();
    let rgba: Vec<u8> = pixels
        .iter()
        .flat_map(|&[red, green, blue]| [red, green, blue, u8::MAX])
        .collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width, picture.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&rgba)?;
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pixels_come_back_opaque() {
        let mut picture = Picture::default();
        picture.resize(3, 2);
        for (index, value) in picture.rgb.iter_mut().enumerate() {
            *value = index as u8 * 10;
        }
        let bytes = encode(&picture).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
            .read_info()
            .unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert_eq!((info.width, info.height), (3, 2));
        assert_eq!(info.color_type, png::ColorType::Rgba);
        assert_eq!(info.bit_depth, png::BitDepth::Eight);
        for (index, pixel) in pixels.chunks(4).enumerate() {
            assert_eq!(pixel[..3], picture.rgb[index * 3..index * 3 + 3]);
            assert_eq!(pixel[3], 255);
        }
    }
}
