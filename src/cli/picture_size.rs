//! Sizes of pictures as options.

use crate::core::{HeadCamera, Picture};

use super::range::NumberRange;

/// Sides of pictures, in pixels.
const SIDES: NumberRange<u32> = NumberRange::whole(1, Picture::MOST_SIDE);

/// Reads a picture size such as `640x480`.
pub(super) fn picture_size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once('x');
    let sides =
        sides.and_then(|(width, height)| Some((SIDES.read(width).ok()?, SIDES.read(height).ok()?)));
    let (width, height) =
        sides.ok_or_else(|| format!("expected a width and a height {SIDES}, such as 640x480"))?;
    let camera = HeadCamera {
        width,
        height,
        ..HeadCamera::default()
    };
    match camera.fault() {
        Some(fault) => Err(fault),
        None => Ok((width, height)),
    }
}
