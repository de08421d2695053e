//! Pictures as PNG files.

use tabletop_core::Picture;

/// Depths in a depth image are counted in tenths of a millimetre, of which a unit has this many.
const DEPTHS_PER_UNIT: f32 = 1000.0;

/// A picture with 8 bits each of red, green, blue and alpha, as the original program wrote it.
pub(crate) fn color_png(picture: &Picture) -> Result<Vec<u8>, png::EncodingError> {
    let (pixels, _) = picture.rgb.as_chunks();
    let rgba: Vec<u8> = pixels
        .iter()
        .flat_map(|&[red, green, blue]| [red, green, blue, u8::MAX])
        .collect();
    encode(picture, png::ColorType::Rgba, png::BitDepth::Eight, &rgba)
}

/// The depth of each pixel, in 16 bits: tenths of a millimetre along the axis of view, 0 where nothing
/// is, 65535 for that far and beyond.
pub(crate) fn depth_png(picture: &Picture) -> Result<Vec<u8>, png::EncodingError> {
    let values = picture.depth.iter().map(|&depth| match depth {
        f32::INFINITY => 0,
        depth => (depth * DEPTHS_PER_UNIT).round() as u16,
    });
    encode_16_bits(picture, values)
}

/// The object of each pixel in 16 bits: 0 for none, or the number at its place in the list.
pub(crate) fn ids_png(picture: &Picture, numbers: &[u16]) -> Result<Vec<u8>, png::EncodingError> {
    let values = picture.objects.iter().map(|&object| {
        let place = (object as usize).checked_sub(1);
        place
            .and_then(|place| numbers.get(place))
            .copied()
            .unwrap_or(0)
    });
    encode_16_bits(picture, values)
}

fn encode_16_bits(
    picture: &Picture,
    values: impl Iterator<Item = u16>,
) -> Result<Vec<u8>, png::EncodingError> {
    let bytes: Vec<u8> = values.flat_map(u16::to_be_bytes).collect();
    encode(
        picture,
        png::ColorType::Grayscale,
        png::BitDepth::Sixteen,
        &bytes,
    )
}

fn encode(
    picture: &Picture,
    color: png::ColorType,
    depth: png::BitDepth,
    data: &[u8],
) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width, picture.height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(data)?;
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pixels of an encoded picture.
    fn decoded(bytes: &[u8]) -> (png::OutputInfo, Vec<u8>) {
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
            .read_info()
            .unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        (info, pixels)
    }

    #[test]
    fn the_pixels_come_back_opaque() {
        let mut picture = Picture::default();
        picture.resize(3, 2);
        for (index, value) in picture.rgb.iter_mut().enumerate() {
            *value = index as u8 * 10;
        }
        let (info, pixels) = decoded(&color_png(&picture).unwrap());
        assert_eq!((info.width, info.height), (3, 2));
        assert_eq!(info.color_type, png::ColorType::Rgba);
        assert_eq!(info.bit_depth, png::BitDepth::Eight);
        for (index, pixel) in pixels.chunks(4).enumerate() {
            assert_eq!(pixel[..3], picture.rgb[index * 3..index * 3 + 3]);
            assert_eq!(pixel[3], 255);
        }
    }

    #[test]
    fn depths_are_tenths_of_a_millimetre_and_objects_have_their_numbers() {
        let mut picture = Picture::default();
        picture.resize(2, 2);
        picture.depth = vec![f32::INFINITY, 1.0, 12.3456, 70.0];
        picture.objects = vec![0, 1, 2, 3];
        let (info, pixels) = decoded(&depth_png(&picture).unwrap());
        assert_eq!(info.bit_depth, png::BitDepth::Sixteen);
        assert_eq!(info.color_type, png::ColorType::Grayscale);
        let values = |pixels: &[u8]| -> Vec<u16> {
            let (values, _) = pixels.as_chunks();
            values
                .iter()
                .map(|&value| u16::from_be_bytes(value))
                .collect()
        };
        assert_eq!(values(&pixels), [0, 1000, 12346, 65535]);
        let (_, pixels) = decoded(&ids_png(&picture, &[1, 9]).unwrap());
        assert_eq!(values(&pixels), [0, 1, 9, 0]);
    }
}
