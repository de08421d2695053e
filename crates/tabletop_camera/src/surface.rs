//! Surfaces and what they look like.

use bevy::math::Vec3;
use tabletop_core::Rgb;

use crate::{
    camera::{Linear, View},
    light::{AMBIENT, LAMP, light},
    round::Curve,
    row::Offset,
    scene::DrawnSolid,
};

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
    /// So many units below the lamp, measured along its normal; 0 if it is turned away from it.
    Flat {
        below_lamp: f32,
    },
    Round(Curve),
    /// What the light is at the corners of a triangle, divided by the depth, and linear in between.
    Shaded(Linear),
}

impl Surface {
    /// What is seen where nothing is.
    pub const NOTHING: Self = Self {
        object: 0,
        patch: 0,
        color: Vec3::ZERO,
        form: Form::Flat { below_lamp: 0.0 },
    };

    /// A plane through a point that is given relative to the eye.
    pub fn flat(view: &View, drawn: &DrawnSolid, patch: u32, point: Vec3, normal: Vec3) -> Self {
        let below_lamp = normal.dot(LAMP - view.eye - point).max(0.0);
        Self::of(drawn, patch, Form::Flat { below_lamp })
    }

    /// A ball, or the side of a cylinder.
    pub fn round(drawn: &DrawnSolid, patch: u32, curve: Curve) -> Self {
        Self::of(drawn, patch, Form::Round(curve))
    }

    /// A triangle of this colour, red, green and blue in 0..=255.
    pub const fn shaded(object: u32, patch: u32, color: Vec3, light_by_depth: Linear) -> Self {
        Self {
            object,
            patch,
            color,
            form: Form::Shaded(light_by_depth),
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
    pub fn shown(&self, view: &View, x: f32, y: f32, depth: f32) -> Vec3 {
        let to_lamp = LAMP - view.eye - view.rays.through(x, y) * depth;
        self.lit(match self.form {
            Form::Flat { below_lamp: 0.0 } => AMBIENT,
            Form::Flat { below_lamp } => light(below_lamp, to_lamp),
            Form::Round(curve) => {
                let normal = curve.normal(curve.rays.through(x, y), depth);
                light(normal.dot(to_lamp), to_lamp)
            }
            Form::Shaded(light_by_depth) => (light_by_depth.at(x, y) * depth).max(AMBIENT),
        })
    }

    /// Colours a part of a row, from this column on, in which it is seen at these depths.
    pub fn paint(&self, view: &View, row: u32, column: usize, depths: &[f32], rgb: &mut [u8]) {
        let ray = view.rays.on_row(row, Offset::CENTER);
        let eye_to_lamp = LAMP - view.eye;
        let to_lamp = |x: f32, depth: f32| eye_to_lamp - ray.at(x) * depth;
        match self.form {
            Form::Flat { below_lamp: 0.0 } => {
                let shown = bytes(self.lit(AMBIENT));
                for pixel in rgb.chunks_exact_mut(3) {
                    pixel.copy_from_slice(&shown);
                }
            }
            Form::Flat { below_lamp } => self.paint_lit::<16>(column, depths, rgb, |x, depth| {
                light(below_lamp, to_lamp(x, depth))
            }),
            Form::Round(curve) => {
                let own_ray = curve.rays.on_row(row, Offset::CENTER);
                self.paint_lit::<16>(column, depths, rgb, |x, depth| {
                    let to_lamp = to_lamp(x, depth);
                    light(curve.normal(own_ray.at(x), depth).dot(to_lamp), to_lamp)
                });
            }
            Form::Shaded(light_by_depth) => {
                let light_by_depth = light_by_depth.on_row(row, Offset::CENTER);
                // Triangles are small.
                self.paint_lit::<4>(column, depths, rgb, |x, depth| {
                    (light_by_depth.at(x) * depth).max(AMBIENT)
                });
            }
        }
    }

    /// Works on so many pixels at a time, in steps that are so simple that the compiler does several at once.
    #[inline]
    fn paint_lit<const STEP: usize>(
        &self,
        column: usize,
        depths: &[f32],
        rgb: &mut [u8],
        light_at: impl Fn(f32, f32) -> f32,
    ) {
        let color = self.color.to_array();
        let steps = depths.chunks(STEP).zip(rgb.chunks_mut(3 * STEP));
        for (column, (depths, rgb)) in (column as i32..).step_by(STEP).zip(steps) {
            let mut lights = [0.0; STEP];
            for (x, (light, depth)) in (column..).zip(lights.iter_mut().zip(depths)) {
                *light = light_at(x as f32, *depth);
            }
            let mut shown = [0; STEP];
            for (shown, light) in shown.iter_mut().zip(&lights) {
                let [red, green, blue] = color.map(|part| nearest_byte((part * light).min(255.0)));
                *shown = red | green << 8 | blue << 16;
            }
            for (pixel, shown) in rgb.chunks_exact_mut(3).zip(shown) {
                let [red, green, blue, _] = shown.to_le_bytes();
                pixel.copy_from_slice(&[red, green, blue]);
            }
        }
    }

    fn lit(&self, light: f32) -> Vec3 {
        (self.color * light).min(Vec3::splat(255.0))
    }
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
