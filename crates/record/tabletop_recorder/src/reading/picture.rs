//! Pictures of recordings, read back.

use std::io;

use tabletop_core::Picture;
use tabletop_storage::InnerFile;

use crate::RecorderError;

/// Reads the colours of a picture: a PNG with 8 bits each of red, green and blue, perhaps with alpha, which is left out. Its depth is 0 everywhere, and it
/// shows no object.
///
/// # Errors
/// The file cannot be read, is behind a link, or is no such picture.
pub fn read_picture(file: &InnerFile) -> Result<Picture, RecorderError> {
    let bytes = file.read(Picture::MOST_FILE_BYTES);
    let decoded = bytes.and_then(|bytes| Picture::from_png(&bytes).map_err(io::Error::other));
    let colors = decoded.map_err(RecorderError::read(&file.path()))?;
    let pixels = colors.rgb.len() / 3;
    Ok(Picture {
        depth: vec![0.0; pixels],
        objects: vec![0; pixels],
        ..colors
    })
}
