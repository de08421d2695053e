//! Balls and cylinders, each as the exact solid: every sample's ray is intersected with the round surface.
//!
//! A point `eye + ray * depth`, relative to the centre and without its component along the axis of a cylinder, lies on the
//! surface if its length is the radius. With the inverse depth, 1 / depth, this is a quadratic equation in the inverse depth. Two more
//! planes bound a cylinder; on them, the inverse depth is a linear function of the picture's coordinates. A ray enters
//! at the farthest of the surfaces that it has to be behind, if that is before the nearest of
//! those that it has to be in front of; this point is visible.

use std::ops::Range;

use bevy::math::Vec3;

use crate::{
    camera::{Linear, NEAR, PictureWindow, PinholeView, Rays, SampleOffset},
    raster::samples::{CenterRow, CenterSamples, SmoothSamples},
};

/// A small number that replaces 0 as a divisor.
const TINY: f32 = 1e-12;

/// A ball or cylinder in the picture.
#[derive(Clone, Debug)]
pub(crate) struct Quadric {
    /// The window in which it may be seen.
    pub window: PictureWindow,
    /// Its round surface.
    pub curve: Curve,
    /// The cross product of the eye and the rays; its length is the radius times the ray's length where a ray is tangential.
    miss: Rays,
    /// The negative dot product of the eye and the rays.
    middle: Linear,
    /// Square of the eye's distance from the centre or axis, minus the radius squared; below 0 inside.
    power: f32,
    ends: Ends,
    /// The round surface.
    side: u32,
    /// The flat surface of the end that faces the eye.
    end: u32,
}

/// Centre or axis of a round surface as the eye sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Curve {
    /// The eye relative to the centre, across the axis.
    pub eye: Vec3,
    /// The rays, across the axis.
    pub rays: Rays,
    pub radius: f32,
}

/// Planes at the ends of a cylinder, as inverse depths.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ends {
    /// Plane of the end that faces the eye: rays enter no nearer than this.
    enter: Linear,
    /// Planes of the other ends: rays leave no farther than this.
    leave: [Linear; 2],
}

impl Curve {
    /// The surface of a ball around this centre, given relative to the eye.
    pub fn around_point(view: &PinholeView, center: Vec3, radius: f32) -> Self {
        Self {
            eye: -center,
            rays: view.rays,
            radius,
        }
    }

    /// The surface around this axis of unit length.
    pub fn around_axis(view: &PinholeView, center: Vec3, axis: Vec3, radius: f32) -> Self {
        let across = |vector: Vec3| vector - axis * axis.dot(vector);
        Self {
            eye: across(-center),
            rays: view.rays.map(across),
            radius,
        }
    }

    /// The outward normal where a ray, across the axis, meets the surface at this depth.
    #[inline]
    pub fn normal(&self, ray: Vec3, depth: f32) -> Vec3 {
        (self.eye + ray * depth) / self.radius
    }
}

impl Ends {
    /// A ball has none.
    pub const NONE: Self = Self {
        enter: Linear::constant(f32::INFINITY),
        leave: [Linear::constant(f32::NEG_INFINITY); 2],
    };

    /// Those of a cylinder; its centre is given relative to the eye.
    pub fn of_cylinder(view: &PinholeView, center: Vec3, axis: Vec3, yspan: f32) -> Self {
        let mut ends = Self::NONE;
        for (outward, leave) in [axis, -axis].into_iter().zip(&mut ends.leave) {
            let eye_is_inside_by = not_zero(yspan / 2.0 + outward.dot(center));
            let inverse_depth = view.rays.dot(outward / eye_is_inside_by);
            if eye_is_inside_by < 0.0 {
                ends.enter = inverse_depth;
            } else {
                *leave = inverse_depth;
            }
        }
        ends
    }
}

/// The number, or a tiny one in place of 0, as a divisor.
fn not_zero(number: f32) -> f32 {
    if number.abs() < TINY { TINY } else { number }
}

impl Quadric {
    /// The solid within this curve and these ends. The surfaces are its side and the end that faces the eye.
    pub fn new(curve: Curve, ends: Ends, window: PictureWindow, [side, end]: [u32; 2]) -> Self {
        let power = curve.eye.length_squared() - curve.radius * curve.radius;
        Self {
            window,
            curve,
            miss: curve.rays.map(|ray| curve.eye.cross(ray)),
            middle: curve.rays.dot(-curve.eye),
            power: not_zero(power),
            ends,
            side,
            end,
        }
    }

    /// Draws it into the samples of these rows that see nothing nearer. The samples are those of the rows from `first_row` on; `single` is
    /// the memory for a row.
    pub fn draw_rows(
        &self,
        rows: Range<u32>,
        first_row: u32,
        centers: &mut CenterSamples,
        mut smooth: Option<&mut SmoothSamples>,
        single: &mut CenterSamples,
    ) {
        let columns = self.window.columns();
        for row in rows {
            let i = (row - first_row) as usize;
            self.draw(row, SampleOffset::CENTER, &mut centers.center_row(i));
            if let Some(smooth) = &mut smooth {
                single.resize(centers.columns(), 1);
                let mut single = single.center_row(0);
                let mut smooth = smooth.smooth_row(i);
                for (sample, offset) in SampleOffset::SMOOTH.into_iter().enumerate() {
                    single.clear(columns.clone());
                    self.draw(row, offset, &mut single);
                    smooth.merge(sample, columns.clone(), &single);
                }
            }
        }
    }

    /// Draws it into the samples of a row that see nothing nearer. `offset` is the samples' place in their pixels.
    pub fn draw(&self, row: u32, offset: SampleOffset, samples: &mut CenterRow) {
        let curve = &self.curve;
        let (ray, miss) = (
            curve.rays.on_row(row, offset),
            self.miss.on_row(row, offset),
        );
        let middle = self.middle.on_row(row, offset);
        let enter_end = self.ends.enter.on_row(row, offset);
        let leave_ends = self.ends.leave.map(|end| end.on_row(row, offset));
        let square = curve.radius * curve.radius;
        let (scale, eye_is_outside) = (1.0 / self.power, self.power > 0.0);
        let (side, end) = (self.side, self.end);

        samples.put(self.window.columns(), |x| {
            let discriminant = square * ray.at(x).length_squared() - miss.at(x).length_squared();
            let root = greater(discriminant, 0.0).sqrt();
            let enter_curve = if eye_is_outside {
                (middle.at(x) + root) * scale
            } else {
                f32::INFINITY
            };
            let leave_curve = (middle.at(x) - root) * scale;
            let enter_end = enter_end.at(x);
            let enter = lesser(enter_curve, enter_end);
            let leave = greater(
                leave_curve,
                greater(leave_ends[0].at(x), leave_ends[1].at(x)),
            );
            let is_seen = (discriminant >= 0.0) & (enter >= leave) & (enter <= 1.0 / NEAR);
            (
                if is_seen { enter } else { 0.0 },
                if enter_end < enter_curve { end } else { side },
            )
        });
    }
}

/// As `f32::max` of numbers, but one instruction.
fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// As `f32::min` of numbers, but one instruction.
fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}
