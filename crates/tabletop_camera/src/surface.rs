//! Surfaces and what they look like.

use bevy::math::Vec3;
use tabletop_core::{LIGHT, Rgb};

use crate::{camera::Linear, round::Curve, row::Offset, scene::DrawnSolid};

/// A surface of one colour: one face of a cuboid, an end or the side of a cylinder, a ball, a triangle of a figure.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface {
    /// The number of its object.
    pub object: u32,
    /// Surfaces of the same patch are parts of a smooth surface, and between them is no edge.
    pub patch: u32,
    /// Red, green, blue in 0..=255.
    color: Vec3,
    form: Form,
}

#[derive(Clone, Copy, Debug)]
enum Form {
    /// What it shows of its colour.
    Flat(f32),
    Round(Curve),
    /// What the corners of a triangle show of its colour, divided by the depth, and linear in between.
    Shaded(Linear),
}

impl Surface {
    /// What is seen where nothing is.
    pub const NOTHING: Self = Self {
        object: 0,
        patch: 0,
        color: Vec3::ZERO,
        form: Form::Flat(0.0),
    };

    /// A plane that faces this way.
    pub fn flat(drawn: &DrawnSolid, patch: u32, normal: Vec3) -> Self {
        Self::of(drawn, patch, Form::Flat(LIGHT.share(normal)))
    }

    /// A ball, or the side of a cylinder.
    pub fn round(drawn: &DrawnSolid, patch: u32, curve: Curve) -> Self {
        Self::of(drawn, patch, Form::Round(curve))
    }

    /// A triangle of this colour, red, green and blue in 0..=255.
    pub const fn shaded(object: u32, patch: u32, color: Vec3, share_by_depth: Linear) -> Self {
        Self {
            object,
            patch,
            color,
            form: Form::Shaded(share_by_depth),
        }
    }

    fn of(drawn: &DrawnSolid, patch: u32, form: Form) -> Self {
        Self {
            object: drawn.object,
            patch,
            color: in_bytes(drawn.color),
            form,
        }
    }

    /// Red, green, blue in 0..=255 where it is met at this depth behind this point of the picture.
    pub fn shown(&self, x: f32, y: f32, depth: f32) -> Vec3 {
        self.color
            * match self.form {
                Form::Flat(share) => share,
                Form::Round(curve) => LIGHT.share(curve.normal(curve.rays.through(x, y), depth)),
                Form::Shaded(share_by_depth) => bounded(share_by_depth.at(x, y) * depth),
            }
    }

    /// Colours a part of a row, from this column on, in which it is seen at these depths.
    pub fn paint(&self, row: u32, column: usize, depths: &[f32], rgb: &mut [u8]) {
        match self.form {
            Form::Flat(share) => {
                let shown = bytes(self.color * share);
                for pixel in rgb.chunks_exact_mut(3) {
                    pixel.copy_from_slice(&shown);
                }
            }
            Form::Round(curve) => {
                let ray = curve.rays.on_row(row, Offset::CENTER);
                self.paint_shares::<16>(column, depths, rgb, |x, depth| {
                    LIGHT.share(curve.normal(ray.at(x), depth))
                });
            }
            Form::Shaded(share_by_depth) => {
                let share_by_depth = share_by_depth.on_row(row, Offset::CENTER);
                // Triangles are small.
                self.paint_shares::<4>(column, depths, rgb, |x, depth| {
                    bounded(share_by_depth.at(x) * depth)
                });
            }
        }
    }

    /// Works on so many pixels at a time, in steps that are so simple that the compiler does several at once.
    #[inline]
    fn paint_shares<const STEP: usize>(
        &self,
        column: usize,
        depths: &[f32],
        rgb: &mut [u8],
        share_at: impl Fn(f32, f32) -> f32,
    ) {
        let color = self.color.to_array();
        let steps = depths.chunks(STEP).zip(rgb.chunks_mut(3 * STEP));
        for (column, (depths, rgb)) in (column as i32..).step_by(STEP).zip(steps) {
            let mut shares = [0.0; STEP];
            for (x, (share, depth)) in (column..).zip(shares.iter_mut().zip(depths)) {
                *share = share_at(x as f32, *depth);
            }
            let mut shown = [0; STEP];
            for (shown, share) in shown.iter_mut().zip(&shares) {
                let [red, green, blue] = color.map(|part| nearest_byte(part * share));
                *shown = red | green << 8 | blue << 16;
            }
            for (pixel, shown) in rgb.chunks_exact_mut(3).zip(shown) {
                let [red, green, blue, _] = shown.to_le_bytes();
                pixel.copy_from_slice(&[red, green, blue]);
            }
        }
    }
}

/// A share between those at the corners of a triangle, which rounding may bring a little beyond them.
pub(crate) fn bounded(share: f32) -> f32 {
    share.max(LIGHT.least()).min(1.0)
}

/// A colour as numbers of 0..=255.
pub(crate) fn in_bytes(color: Rgb) -> Vec3 {
    Vec3::new(color.red, color.green, color.blue).clamp(Vec3::ZERO, Vec3::ONE) * 255.0
}

/// The nearest bytes to numbers of 0..=255.
pub(crate) fn bytes(shown: Vec3) -> [u8; 3] {
    shown.to_array().map(|part| nearest_byte(part) as u8)
}

/// The nearest whole number to one of 0..=255.
fn nearest_byte(number: f32) -> u32 {
    // From 2^23 on there are only whole numbers, and the last bits of such a number count them.
    const WHOLE: f32 = 8_388_608.0;
    (number + WHOLE).to_bits() & 0xff
}
