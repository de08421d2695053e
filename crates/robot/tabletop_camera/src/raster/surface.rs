//! Surfaces and their looks.

use crate::{
    camera::{Linear, SampleOffset},
    color::{nearest_byte, nearest_bytes, scaled_to_bytes},
    raster::{lighting::Lighting, quadric::Curve},
    scene::DrawnSolid,
};
use bevy::math::Vec3;

/// A surface of one colour: one face of a cuboid, an end or the side of a cylinder, a ball, a triangle of a figure.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RasterSurface {
    /// The number of its object.
    pub object: u32,
    /// Red, green, blue in 0..=255.
    color: Vec3,
    shading: Shading,
}

/// The part of a surface's look that is the same everywhere.
#[derive(Clone, Debug)]
pub(crate) struct FlatLook {
    /// The number of its object.
    pub object: u32,
    /// As many pixels as are copied at once.
    rgb: [u8; 48],
}

#[derive(Clone, Copy, Debug)]
enum Shading {
    /// A surface that shows this share of its colour.
    Flat(f32),
    Curved(Curve),
    /// The shares that the corners of a triangle show, divided by the depth, and linear in between.
    Gouraud(Linear),
}

impl FlatLook {
    /// The look of the background.
    pub const NOTHING: Self = Self {
        object: 0,
        rgb: [0; 48],
    };

    /// The look of a surface that shows this share of its colour.
    fn new(object: u32, color: Vec3, share: f32) -> Self {
        let shown = nearest_bytes(color * share);
        Self {
            object,
            rgb: std::array::from_fn(|i| shown[i % 3]),
        }
    }

    /// The look of a plane that faces this way.
    pub fn of(drawn: &DrawnSolid, normal: Vec3, lighting: &Lighting) -> Self {
        let color = lighting.lit(scaled_to_bytes(drawn.color));
        Self::new(drawn.object, color, lighting.share(normal))
    }

    /// Colours some pixels.
    pub fn paint(&self, rgb: &mut [u8]) {
        let mut pixels = rgb.chunks_exact_mut(self.rgb.len());
        for pixels in &mut pixels {
            pixels.copy_from_slice(&self.rgb);
        }
        let rest = pixels.into_remainder();
        rest.copy_from_slice(&self.rgb[..rest.len()]);
    }
}

impl RasterSurface {
    /// The background.
    pub const NOTHING: Self = Self {
        object: 0,
        color: Vec3::ZERO,
        shading: Shading::Flat(0.0),
    };

    /// A plane that faces this way.
    pub fn flat(drawn: &DrawnSolid, normal: Vec3, lighting: &Lighting) -> Self {
        Self::of(drawn, Shading::Flat(lighting.share(normal)), lighting)
    }

    /// A ball, or the side of a cylinder.
    pub fn curved(drawn: &DrawnSolid, curve: Curve, lighting: &Lighting) -> Self {
        Self::of(drawn, Shading::Curved(curve), lighting)
    }

    /// A triangle of this lit colour, red, green and blue in 0..=255.
    pub const fn gouraud(object: u32, color: Vec3, share_by_depth: Linear) -> Self {
        Self {
            object,
            color,
            shading: Shading::Gouraud(share_by_depth),
        }
    }

    fn of(drawn: &DrawnSolid, shading: Shading, lighting: &Lighting) -> Self {
        Self {
            object: drawn.object,
            color: lighting.lit(scaled_to_bytes(drawn.color)),
            shading,
        }
    }

    /// Red, green, blue in 0..=255 at this depth behind this point of the picture.
    pub fn shown(&self, lighting: &Lighting, x: f32, y: f32, depth: f32) -> Vec3 {
        self.color
            * match self.shading {
                Shading::Flat(share) => share,
                Shading::Curved(curve) => {
                    lighting.share(curve.normal(curve.rays.through(x, y), depth))
                }
                Shading::Gouraud(share_by_depth) => lighting.clamp(share_by_depth.at(x, y) * depth),
            }
    }

    /// Colours a part of a row, from this column on, where the surface is seen at these depths.
    pub fn paint(
        &self,
        lighting: &Lighting,
        row: u32,
        column: usize,
        depths: &[f32],
        rgb: &mut [u8],
    ) {
        match self.shading {
            Shading::Flat(share) => {
                let shown = nearest_bytes(self.color * share);
                for pixel in rgb.chunks_exact_mut(3) {
                    pixel.copy_from_slice(&shown);
                }
            }
            Shading::Curved(curve) => {
                let ray = curve.rays.on_row(row, SampleOffset::CENTER);
                self.paint_shares::<16>(column, depths, rgb, |x, depth| {
                    lighting.share(curve.normal(ray.at(x), depth))
                });
            }
            Shading::Gouraud(share_by_depth) => {
                let share_by_depth = share_by_depth.on_row(row, SampleOffset::CENTER);
                // Triangles are small.
                for (x, (depth, pixel)) in
                    (column as i32..).zip(depths.iter().zip(rgb.chunks_exact_mut(3)))
                {
                    let share = lighting.clamp(share_by_depth.at(x as f32) * depth);
                    pixel.copy_from_slice(&nearest_bytes(self.color * share));
                }
            }
        }
    }

    /// Works on `STEP` pixels at a time, in steps so simple that the compiler does several at once.
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
