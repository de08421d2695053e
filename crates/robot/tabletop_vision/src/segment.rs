//! Segmentation by colour: which pixels may show which known colour, however bright it is lit.

use bevy::math::Vec3;
use tabletop_core::Picture;
use tabletop_geometry::Rgb;

use crate::transfer::ToneTransfer;

/// No known colour.
pub(crate) const NO_COLOR: u8 = u8::MAX;

/// Largest distance of a pixel's colour from a known one's ray through black, in grey levels.
const FARTHEST: f32 = 55.0;
/// Least and largest brightness of a lit surface, as a part of its colour.
const BRIGHTNESS: (f32, f32) = (0.42, 1.25);

/// The known colours.
#[derive(Clone, Debug, Default)]
pub(crate) struct Palette {
    colors: Vec<Rgb>,
}

/// Connected pixels of one colour.
#[derive(Clone, Debug)]
pub(crate) struct Blob {
    /// Indices of its pixels in the picture.
    pub pixels: Vec<usize>,
}

impl Palette {
    pub fn of(colors: impl IntoIterator<Item = Rgb>) -> Self {
        let mut palette = Self::default();
        for color in colors {
            if palette.colors.len() < usize::from(NO_COLOR) && !palette.colors.contains(&color) {
                palette.colors.push(color);
            }
        }
        palette
    }

    pub fn number(&self, color: Rgb) -> u8 {
        let found = self.colors.iter().position(|&own| own == color);
        found.map_or(NO_COLOR, |number| number as u8)
    }

    /// The known colour of each pixel, in light of this colour, after this transfer.
    pub fn classes(&self, picture: &Picture, light: Vec3, transfer: &ToneTransfer) -> Vec<u8> {
        let light = (light * transfer.gain).max(Vec3::splat(0.05));
        let known: Vec<_> = self
            .colors
            .iter()
            .map(|color| {
                let shown = Vec3::new(color.red, color.green, color.blue) * 255.0;
                (shown.normalize_or_zero(), shown.length())
            })
            .collect();
        let class = |rgb: &[u8]| {
            let seen = Vec3::new(f32::from(rgb[0]), f32::from(rgb[1]), f32::from(rgb[2]));
            let pixel = (seen - transfer.black) / light;
            let mut nearest = (FARTHEST, NO_COLOR);
            for (number, &(way, length)) in known.iter().enumerate() {
                let along = pixel.dot(way);
                let (least, most) = (BRIGHTNESS.0 * length, BRIGHTNESS.1 * length);
                // Beyond the brightness of lit surfaces, the distance from it counts, too.
                let beyond = (least - along).max(along - most).max(0.0);
                let distance = (pixel - way * along).length() + beyond;
                if distance < nearest.0 {
                    nearest = (distance, number as u8);
                }
            }
            nearest.1
        };
        picture.rgb.chunks_exact(3).map(class).collect()
    }
}

/// The connected parts of the pixels for which this is true, largest first; among equals, from the top.
pub(crate) fn blobs(width: usize, height: usize, is_in: impl Fn(usize) -> bool) -> Vec<Blob> {
    let mut is_taken = vec![false; width * height];
    let mut found = Vec::new();
    let mut next = Vec::new();
    for first in 0..width * height {
        if is_taken[first] || !is_in(first) {
            continue;
        }
        is_taken[first] = true;
        next.push(first);
        let mut pixels = Vec::new();
        while let Some(pixel) = next.pop() {
            pixels.push(pixel);
            let (column, row) = (pixel % width, pixel / width);
            let beside = [
                (column > 0).then(|| pixel - 1),
                (column + 1 < width).then_some(pixel + 1),
                (row > 0).then(|| pixel - width),
                (row + 1 < height).then_some(pixel + width),
            ];
            for other in beside.into_iter().flatten() {
                if !is_taken[other] && is_in(other) {
                    is_taken[other] = true;
                    next.push(other);
                }
            }
        }
        pixels.sort_unstable();
        found.push(Blob { pixels });
    }
    found.sort_by_key(|blob| (std::cmp::Reverse(blob.pixels.len()), blob.pixels[0]));
    found
}
