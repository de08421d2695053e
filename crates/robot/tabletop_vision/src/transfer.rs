//! The transfer from what is drawn to the picture that is seen of it: exposure, black level, and how far brightness and colours are spread. A lens out of
//! focus blurs both; JPEG and video have colours at a lower resolution.

use std::borrow::Cow;

use bevy::math::{Vec3, Vec4};
use tabletop_camera::PictureWindow;
use tabletop_core::Picture;

use crate::pixels::rows;

/// The share of red, green and blue in the brightness of a colour (ITU-R BT.601).
pub(crate) const BRIGHTNESS: Vec3 = Vec3::new(0.299, 0.587, 0.114);
/// Standard deviation, in pixels, by which colours are spread before they are compared if they have a lower resolution: then it does not matter which
/// pixels share a colour.
const COMPARED: f32 = 0.7;
/// A spread, in pixels, that no pixel shows.
const SHARP: f32 = 0.05;

/// The transfer from what is drawn to what is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToneTransfer {
    /// The factor of red, green and blue, before nothing gets brighter than white.
    pub gain: Vec3,
    /// What is added to each, in grey levels.
    pub black: Vec3,
    /// Standard deviation of the spread of brightness, in pixels.
    pub blur: f32,
    /// Standard deviation of the spread of colours, in pixels; that of brightness at least.
    pub color_blur: f32,
}

impl ToneTransfer {
    /// Everything is seen as it is drawn.
    pub const EXACT: Self = Self {
        gain: Vec3::ONE,
        black: Vec3::ZERO,
        blur: 0.0,
        color_blur: 0.0,
    };

    /// True if colours have a lower resolution than brightness.
    pub(crate) fn has_coarse_colors(&self) -> bool {
        self.color_blur > self.blur + SHARP
    }

    /// The number of pixels across which something is spread.
    pub(crate) fn reach(&self) -> u32 {
        let [brightness, colors] = self.kernels();
        brightness.reach().max(colors.reach()) as u32
    }

    /// The spread of brightness and of colours between what is drawn and what is [compared](Self::compared).
    fn kernels(&self) -> [Kernel; 2] {
        let colors = match self.has_coarse_colors() {
            true => self.compared_color_blur(),
            false => self.blur,
        };
        [Kernel::of(self.blur), Kernel::of(colors)]
    }

    /// The spread of coarse colours between what is drawn and what is [compared](Self::compared), in pixels.
    pub(crate) fn compared_color_blur(&self) -> f32 {
        (self.color_blur * self.color_blur + COMPARED * COMPARED).sqrt()
    }

    /// A seen picture as it is compared with [shown](Self::show) ones.
    pub(crate) fn compared<'p>(&self, seen: &'p Picture) -> Cow<'p, Picture> {
        if !self.has_coarse_colors() {
            return Cow::Borrowed(seen);
        }
        let values = spread_colors(seen, &[Kernel::of(0.0), Kernel::of(COMPARED)]);
        let parts = values.into_iter().flat_map(rounded);
        Cow::Owned(Picture {
            rgb: parts.collect(),
            ..seen.clone()
        })
    }

    /// A drawn picture as it is compared with a seen one, in a window. The drawn one must be valid as far as this [reaches](Self::reach) around it.
    pub(crate) fn show(
        &self,
        drawn: &Picture,
        window: &PictureWindow,
        memory: &mut TransferMemory,
    ) {
        let size = [drawn.width, drawn.height];
        memory.fit(drawn);
        let wide = window.widened(self.reach(), size);
        let is_exposed = self.gain != Vec3::ONE || self.black != Vec3::ZERO;
        memory.values.clear();
        for row in rows(&wide, drawn.width) {
            let pixels = drawn.rgb[3 * row.start..3 * row.end].chunks_exact(3);
            memory.values.extend(pixels.map(|rgb| {
                let color = Vec3::new(f32::from(rgb[0]), f32::from(rgb[1]), f32::from(rgb[2]));
                let color = match is_exposed {
                    true => (color * self.gain + self.black).clamp(Vec3::ZERO, Vec3::splat(255.0)),
                    false => color,
                };
                with_brightness(color)
            }));
        }
        spread(
            &mut memory.values,
            &mut memory.other,
            &wide,
            &self.kernels(),
        );
        let columns = wide.columns.len();
        for row in window.rows.clone() {
            let first = (row - wide.rows.start) as usize * columns;
            let first = first + (window.columns.start - wide.columns.start) as usize;
            let values = &memory.values[first..first + window.columns.len()];
            let start = 3 * (row as usize * drawn.width as usize + window.columns.start as usize);
            let shown = memory.shown.rgb[start..].chunks_exact_mut(3);
            for (shown, value) in shown.zip(values) {
                shown.copy_from_slice(&rounded(value.truncate()));
            }
            let pixels = start / 3..start / 3 + window.columns.len();
            memory.shown.objects[pixels.clone()].copy_from_slice(&drawn.objects[pixels]);
        }
    }
}

/// The memory of a picture that is shown.
#[derive(Clone, Debug, Default)]
pub(crate) struct TransferMemory {
    pub shown: Picture,
    values: Vec<Vec4>,
    other: Vec<Vec4>,
}

impl TransferMemory {
    fn fit(&mut self, drawn: &Picture) {
        if self.shown.width != drawn.width || self.shown.height != drawn.height {
            self.shown = drawn.clone();
        }
    }
}

/// The weights of a pixel and of its neighbours, by their distance: normally distributed, and of three pixels alone if they are as narrow as that.
#[derive(Clone, Debug)]
pub(crate) struct Kernel(Vec<f32>);

impl Kernel {
    /// The part of the weight of the pixel itself that a neighbour has at least.
    const LEAST: f32 = 0.02;
    /// The largest standard deviation, in pixels, of three pixels alone.
    const NARROW: f32 = 0.6;

    /// The kernel of this standard deviation, in pixels.
    pub fn of(deviation: f32) -> Self {
        if deviation < SHARP {
            return Self(vec![1.0]);
        }
        if deviation < Self::NARROW {
            let beside = deviation * deviation / 2.0;
            return Self(vec![1.0 - 2.0 * beside, beside]);
        }
        let weight = |by: i32| libm::expf(-((by * by) as f32) / (2.0 * deviation * deviation));
        let mut weights: Vec<_> = (0..)
            .map(weight)
            .take_while(|weight| *weight > Self::LEAST)
            .collect();
        let sum = 2.0 * weights.iter().sum::<f32>() - 1.0;
        for weight in &mut weights {
            *weight /= sum;
        }
        Self(weights)
    }

    fn reach(&self) -> usize {
        self.0.len() - 1
    }

    /// The mean about a place in a line of this many values, of which those beyond the ends are as at the ends.
    #[inline]
    fn mean(&self, at: usize, count: usize, value: impl Fn(usize) -> Vec4) -> Vec4 {
        let sides = (1..).zip(&self.0[1..]);
        sides.fold(value(at) * self.0[0], |sum, (by, &weight)| {
            let before = value(at.saturating_sub(by));
            let after = value((at + by).min(count - 1));
            sum + (before + after) * weight
        })
    }
}

/// A colour with its brightness.
#[inline]
fn with_brightness(color: Vec3) -> Vec4 {
    color.extend(color.dot(BRIGHTNESS))
}

/// A colour as a pixel has it.
fn rounded(color: Vec3) -> [u8; 3] {
    color
        .to_array()
        .map(|part| (part + 0.5).clamp(0.0, 255.0) as u8)
}

/// The colours of the pixels of a picture.
pub(crate) fn colors_of(picture: &Picture) -> Vec<Vec3> {
    let pixels = picture.rgb.chunks_exact(3);
    let colors =
        pixels.map(|rgb| Vec3::new(f32::from(rgb[0]), f32::from(rgb[1]), f32::from(rgb[2])));
    colors.collect()
}

/// Spreads brightness and colours of the pixels of a window, given with their brightness.
fn spread(
    values: &mut Vec<Vec4>,
    other: &mut Vec<Vec4>,
    window: &PictureWindow,
    [brightness, colors]: &[Kernel; 2],
) {
    if colors.reach() == 0 || window.is_empty() {
        return;
    }
    let (width, height) = (window.columns.len(), window.rows.len());
    let is_same = brightness.0 == colors.0;
    for is_across in [true, false] {
        std::mem::swap(values, other);
        values.clear();
        let (count, step) = match is_across {
            true => (width, 1),
            false => (height, width),
        };
        for row in 0..height {
            for column in 0..width {
                let (at, first) = match is_across {
                    true => (column, row * width),
                    false => (row, column),
                };
                let value = |i: usize| other[first + i * step];
                let color = colors.mean(at, count, value);
                values.push(match is_same {
                    true => color,
                    false => {
                        // Colours keep their distances from grey.
                        let own = brightness.mean(at, count, value).w;
                        color + (own - color.w)
                    }
                });
            }
        }
    }
}

/// The pixels of a whole picture, spread by kernels of brightness and colours.
pub(crate) fn spread_colors(picture: &Picture, kernels: &[Kernel; 2]) -> Vec<Vec3> {
    let whole = PictureWindow {
        columns: 0..picture.width,
        rows: 0..picture.height,
    };
    let colors = colors_of(picture).into_iter();
    let mut values: Vec<_> = colors.map(with_brightness).collect();
    spread(&mut values, &mut Vec::new(), &whole, kernels);
    values.into_iter().map(Vec4::truncate).collect()
}
