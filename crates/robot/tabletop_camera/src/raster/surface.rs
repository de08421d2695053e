//! Surfaces and their looks.

use bevy::math::{Vec3, Vec4};

use crate::{
    camera::{Linear, SampleOffset, transposed},
    color::{nearest_byte, nearest_bytes, scaled_to_bytes},
    raster::{
        lighting::Lighting,
        quadric::{Curve, Quadric},
    },
    scene::DrawnSolid,
};

/// A surface of one colour: one face of a cuboid, an end or the side of a cylinder, a ball, a triangle of a figure. Its numbers stand where four
/// surfaces can be painted at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RasterSurface {
    /// Red, green, blue in 0..=255, and the bits of the number of its object.
    color: Vec4,
    /// Of a triangle, the shares that its corners show, divided by the depth, and linear in between. The fourth part is the share that a plane
    /// shows, [`GOURAUD`](Self::GOURAUD) or [`CURVED`](Self::CURVED), whose first part has the bits of the number of its quadric.
    shading: Vec4,
}

/// Four pixels of a row, one after the other.
#[derive(Debug)]
pub(crate) struct FourPixels<'a> {
    pub rgb: &'a mut [u8; 12],
    pub depth: &'a mut [f32; 4],
    pub objects: &'a mut [u32; 4],
}

/// The part of a surface's look that is the same everywhere.
#[derive(Clone, Debug)]
pub(crate) struct FlatLook {
    /// The number of its object.
    pub object: u32,
    /// As many pixels as are copied at once.
    rgb: [u8; 48],
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
    /// In the place of a plane's share: that of a triangle varies.
    const GOURAUD: f32 = f32::INFINITY;

    /// In the place of a plane's share: that of a ball, or of the side of a cylinder, varies.
    const CURVED: f32 = f32::NEG_INFINITY;

    /// The background.
    pub const NOTHING: Self = Self {
        color: Vec4::ZERO,
        shading: Vec4::ZERO,
    };

    /// A plane that faces this way.
    pub fn flat(drawn: &DrawnSolid, normal: Vec3, lighting: &Lighting) -> Self {
        let color = lighting.lit(scaled_to_bytes(drawn.color));
        let share = lighting.share(normal);
        Self::new(drawn.object, color, Vec3::ZERO.extend(share))
    }

    /// A ball, or the side of a cylinder, which is the quadric of this number.
    pub fn curved(drawn: &DrawnSolid, quadric: usize, lighting: &Lighting) -> Self {
        let color = lighting.lit(scaled_to_bytes(drawn.color));
        let number = f32::from_bits(quadric as u32);
        Self::new(
            drawn.object,
            color,
            Vec4::new(number, 0.0, 0.0, Self::CURVED),
        )
    }

    /// A triangle of this lit colour, red, green and blue in 0..=255.
    #[inline]
    pub fn gouraud(object: u32, color: Vec3, share_by_depth: Linear) -> Self {
        let Linear { first, right, down } = share_by_depth;
        Self::new(object, color, Vec4::new(first, right, down, Self::GOURAUD))
    }

    #[inline]
    fn new(object: u32, color: Vec3, shading: Vec4) -> Self {
        Self {
            color: color.extend(f32::from_bits(object)),
            shading,
        }
    }

    /// The number of its quadric, if it is a ball or the side of a cylinder.
    pub fn quadric(&self) -> Option<usize> {
        (self.shading.w == Self::CURVED).then(|| self.shading.x.to_bits() as usize)
    }

    /// Red, green, blue in 0..=255 at this depth behind this point of the picture.
    pub fn shown(
        &self,
        quadrics: &[Quadric],
        lighting: &Lighting,
        x: f32,
        y: f32,
        depth: f32,
    ) -> Vec3 {
        let color = self.color.truncate();
        if let Some(quadric) = self.quadric() {
            return quadrics[quadric].curve.shown(color, lighting, x, y, depth);
        }
        let [first, right, down, share] = self.shading.to_array();
        if share == Self::GOURAUD {
            let share_by_depth = Linear { first, right, down };
            return color * lighting.clamp(share_by_depth.at(x, y) * depth);
        }
        color * share
    }

    /// Paints four pixels of a row, from this column on, that see these surfaces at these depths. The colours of curved surfaces are arbitrary.
    /// Returns whether the same surfaces have the same colours elsewhere.
    #[inline]
    pub fn paint_four(
        [a, b, c, d]: [&Self; 4],
        lighting: &Lighting,
        row: u32,
        column: usize,
        depths: Vec4,
        pixels: FourPixels,
    ) -> bool {
        const LANES: Vec4 = Vec4::new(0.0, 1.0, 2.0, 3.0);
        let [first, right, down, share] = transposed([a.shading, b.shading, c.shading, d.shading]);
        let SampleOffset { x, y } = SampleOffset::CENTER;
        let on_row = first + down * (row as f32 + y) + right * x;
        let by_depth = on_row + right * (LANES + column as i32 as f32);
        let is_gouraud = share.cmpeq(Vec4::splat(Self::GOURAUD));
        let gouraud = lighting.clamp_four(by_depth * depths);
        let share = Vec4::select(is_gouraud, gouraud, share);
        let [red, green, blue, objects] = transposed([a.color, b.color, c.color, d.color]);
        *pixels.rgb = packed(
            (red * share).to_array(),
            (green * share).to_array(),
            (blue * share).to_array(),
        );
        *pixels.depth = depths.to_array();
        *pixels.objects = objects.to_array().map(f32::to_bits);
        !is_gouraud.any()
    }
}

impl Curve {
    /// Red, green, blue in 0..=255 where it is seen at this depth behind this point of the picture, if this is its colour.
    pub fn shown(&self, color: Vec3, lighting: &Lighting, x: f32, y: f32, depth: f32) -> Vec3 {
        color * lighting.share(self.normal(self.rays.through(x, y), depth))
    }

    /// Colours a part of a row, from this column on, where it is seen at these depths.
    pub fn paint(
        &self,
        surface: &RasterSurface,
        lighting: &Lighting,
        row: u32,
        column: usize,
        depths: &[f32],
        rgb: &mut [u8],
    ) {
        /// Number of pixels that are computed in steps so simple that the compiler does several at once.
        const STEP: usize = 16;
        let [red, green, blue, _] = surface.color.to_array();
        let ray = self.rays.on_row(row, SampleOffset::CENTER);
        let steps = depths.chunks(STEP).zip(rgb.chunks_mut(3 * STEP));
        for (column, (depths, rgb)) in (column as i32..).step_by(STEP).zip(steps) {
            let mut shares = [0.0; STEP];
            for (x, (share, depth)) in (column..).zip(shares.iter_mut().zip(depths)) {
                *share = lighting.share(self.normal(ray.at(x as f32), *depth));
            }
            let mut shown = [0; STEP];
            for (shown, share) in shown.iter_mut().zip(&shares) {
                let [red, green, blue] = [red, green, blue].map(|part| nearest_byte(part * share));
                *shown = red | green << 8 | blue << 16;
            }
            for (pixel, shown) in rgb.chunks_exact_mut(3).zip(shown) {
                let [red, green, blue, _] = shown.to_le_bytes();
                pixel.copy_from_slice(&[red, green, blue]);
            }
        }
    }
}

/// The nearest bytes to the red, green and blue of four pixels.
#[inline]
fn packed(red: [f32; 4], green: [f32; 4], blue: [f32; 4]) -> [u8; 12] {
    let pixel =
        |i: usize| nearest_byte(red[i]) | nearest_byte(green[i]) << 8 | nearest_byte(blue[i]) << 16;
    let [a, b, c, d] = [pixel(0), pixel(1), pixel(2), pixel(3)];
    let words = [a | b << 24, b >> 8 | c << 16, c >> 16 | d << 8];
    let mut bytes = [0; 12];
    for (bytes, word) in bytes.as_chunks_mut::<4>().0.iter_mut().zip(words) {
        *bytes = word.to_le_bytes();
    }
    bytes
}
