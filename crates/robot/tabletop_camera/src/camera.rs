//! Cameras: their poses, fields of view and rays.

mod four;
mod linear;

use std::ops::Range;

use bevy::{
    math::{Vec2, Vec3, Vec4},
    prelude::Quat,
};
use tabletop_core::{HandCamera, HeadCamera, Light, Table};
use tabletop_geometry::Pose;

pub(crate) use four::{FourTurned, FourVectors, transposed};
pub(crate) use linear::{FourLinear, Linear, OnRow, Rays, SampleOffset};

/// Nearest visible distance in units, along the axis of view (report section 4, "head camera").
pub(crate) const NEAR: f32 = 0.01;

/// The narrowest and the widest field of view, in radians.
const FIELDS_OF_VIEW: Range<f32> = 1e-3..3.1;

/// A camera: everything that a picture depends on except the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Its pose. It looks along its own -Z; its X is to the right in the picture and its Y is up, as for a camera
    /// of Bevy.
    pub pose: Pose,
    /// Angle between the lower and the upper edge of the picture in radians; taken as the nearest of 0.001 to 3.1.
    pub vertical_fov: f32,
    /// Makes the angle between the left and right edges the same, so that pixels are square only in a square picture.
    pub square_fov: bool,
    /// Columns of the picture.
    pub width: u32,
    /// Rows of the picture.
    pub height: u32,
    /// Smooths edges by four samples a pixel. This changes only colours, and only of pixels that show more than one
    /// surface.
    pub antialiasing: bool,
    /// The light in its pictures.
    pub light: Light,
}

impl Camera {
    /// The robot's head camera at this table.
    pub fn of_head(head: &HeadCamera, table: &Table) -> Self {
        Self {
            pose: head.pose(table),
            vertical_fov: head.vertical_fov,
            square_fov: head.square_fov,
            width: head.width,
            height: head.height,
            antialiasing: head.antialiasing,
            light: head.light,
        }
    }

    /// A camera in the robot's hand, at this pose, with the smoothing and in the light of the head camera.
    pub fn of_hand(hand: &HandCamera, pose: Pose, head: &HeadCamera) -> Self {
        Self {
            pose,
            vertical_fov: hand.vertical_fov,
            square_fov: false,
            width: hand.width,
            height: hand.height,
            antialiasing: head.antialiasing,
            light: head.light,
        }
    }

    /// The direction of the ray through a point of the picture, whose part along the axis of view is 1. The point is given as for [`pixel_of`](Self::pixel_of).
    pub fn ray_through(&self, pixel: Vec2) -> Vec3 {
        PinholeView::of(self).rays.through(pixel.x, pixel.y)
    }

    /// The pixel of a point, as column and row; the centre of the upper left pixel is (0, 0). `None` for points that are
    /// not in front of the camera; others may lie outside the picture.
    pub fn pixel_of(&self, point: Vec3) -> Option<Vec2> {
        self.projection()(point)
    }

    /// [`pixel_of`](Self::pixel_of), for many points.
    pub fn projection(&self) -> impl Fn(Vec3) -> Option<Vec2> + use<> {
        let view = PinholeView::of(self);
        move |point| view.pixel_of(point - view.eye)
    }
}

/// The rays of a camera. The ray through the point (x, y) of the picture, in pixels from the centre of the upper left one,
/// has the direction `first + x * right + y * down`, whose component along the axis of view is 1. So a point at
/// that direction times z has depth z.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PinholeView {
    pub eye: Vec3,
    pub width: u32,
    pub height: u32,
    pub rays: Rays,
    /// Largest distance of a pixel's samples from its centre, to the right and down, in pixels.
    pub reach: f32,
    axes: Quat,
    pixel: Vec2,
    center: Vec2,
}

/// A rectangle in a picture, in pixels.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PictureWindow {
    /// Its columns.
    pub columns: Range<u32>,
    /// Its rows.
    pub rows: Range<u32>,
}

impl PinholeView {
    pub fn of(camera: &Camera) -> Self {
        let (width, height) = (camera.width as f32, camera.height as f32);
        let fov = camera.vertical_fov;
        let fov = f64::from(fov.clamp(FIELDS_OF_VIEW.start, FIELDS_OF_VIEW.end));
        let spread = (2.0 * libm::tan(fov / 2.0)) as f32;
        let across = if camera.square_fov { width } else { height };
        let pixel = Vec2::new(spread / across, spread / height);
        let center = Vec2::new(width - 1.0, height - 1.0) / 2.0;
        let axes = camera.pose.rotation;
        let right = axes * Vec3::X * pixel.x;
        let down = axes * Vec3::NEG_Y * pixel.y;
        Self {
            eye: camera.pose.location,
            width: camera.width,
            height: camera.height,
            rays: Rays {
                first: axes * Vec3::NEG_Z - right * center.x - down * center.y,
                right,
                down,
            },
            reach: match camera.antialiasing {
                true => SampleOffset::REACH,
                false => 0.0,
            },
            axes,
            pixel,
            center,
        }
    }

    /// Its bits, which identify it.
    pub fn bits(&self) -> [u32; 12] {
        let ([x, y, z], [a, b, c, d]) = (self.eye.to_array(), self.axes.to_array());
        let [right, down] = self.pixel.to_array();
        let size = [self.width, self.height].map(|count| count as f32);
        [
            x, y, z, a, b, c, d, right, down, size[0], size[1], self.reach,
        ]
        .map(f32::to_bits)
    }

    /// The pixel of a point given relative to the eye.
    pub fn pixel_of(&self, point: Vec3) -> Option<Vec2> {
        self.pixel_of_local(self.axes.inverse() * point)
    }

    /// The pixels, as columns and rows, of points given in the frame of a body, four at a time. They are NaN for points that are not in front of
    /// the camera.
    pub fn pixels_of(&self, body: Pose) -> impl Fn(FourVectors) -> [Vec4; 2] {
        let to_camera = self.axes.inverse();
        let turned = FourTurned::by(to_camera * body.rotation);
        let origin = FourVectors::splat(to_camera * (body.location - self.eye));
        let [center, pixel] = [self.center, self.pixel];
        move |points| {
            let FourVectors { x, y, z } = turned.apply(points) + origin;
            let depth = -z;
            let column = x / (depth * pixel.x) + center.x;
            let row = -y / (depth * pixel.y) + center.y;
            let is_in_front = depth.cmpge(Vec4::splat(NEAR));
            let column = Vec4::select(is_in_front, column, Vec4::NAN);
            let row = Vec4::select(is_in_front, row, Vec4::NAN);
            [column, row]
        }
    }

    /// The pixel of a point given in the frame of the camera.
    fn pixel_of_local(&self, point: Vec3) -> Option<Vec2> {
        let depth = -point.z;
        (depth >= NEAR).then(|| self.center + Vec2::new(point.x, -point.y) / (depth * self.pixel))
    }

    /// The window around the convex hull of these points, given relative to the eye.
    pub fn window_of(&self, corners: &[Vec3; 8]) -> Option<PictureWindow> {
        let is_drawable = |corner: &Vec3| corner.abs().cmplt(Vec3::splat(FARTHEST)).all();
        if !corners.iter().all(is_drawable) {
            return None;
        }
        let seen = corners.map(|corner| self.pixel_of(corner));
        if seen.iter().all(Option::is_none) {
            return None;
        }
        let (mut least, mut most) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for corner in seen {
            let Some(corner) = corner else {
                let all = PictureWindow {
                    columns: 0..self.width,
                    rows: 0..self.height,
                };
                return (!self.is_beside(corners)).then_some(all);
            };
            least = least.min(corner);
            most = most.max(corner);
        }
        let window = PictureWindow {
            columns: pixels_between(least.x, most.x, self.width),
            rows: pixels_between(least.y, most.y, self.height),
        };
        (!window.columns.is_empty() && !window.rows.is_empty()).then_some(window)
    }

    /// False if nothing within the convex hull of these points, given relative to the eye, can be seen.
    pub fn may_see(&self, [near, far]: &[FourVectors; 2]) -> bool {
        let edge = (self.center + REACH) * self.pixel;
        let to_camera = FourTurned::by(self.axes.inverse());
        let farthest = Vec4::splat(FARTHEST);
        let [near, far] = [near, far].map(|points| {
            let FourVectors { x, y, z } = to_camera.apply(*points);
            let (depth, right, top) = (-z, edge.x * -z, edge.y * -z);
            let is_beyond = [
                depth.cmplt(Vec4::splat(NEAR)),
                x.cmpgt(right),
                (-x).cmpgt(right),
                y.cmpgt(top),
                (-y).cmpgt(top),
            ];
            let size = x.abs().max(y.abs()).max(depth.abs());
            (is_beyond, size.cmplt(farthest).all())
        });
        let is_beside = (near.0.into_iter().zip(far.0)).any(|(near, far)| (near & far).all());
        let has_pixels = self.width > 0 && self.height > 0;
        has_pixels && near.1 && far.1 && !is_beside
    }

    /// True if all of these points, given relative to the eye, lie beyond the same edge of the picture, in front of the camera or behind it.
    pub fn is_beside(&self, points: &[Vec3]) -> bool {
        let edge = (self.center + REACH) * self.pixel;
        let to_camera = self.axes.inverse();
        let beyond = points.iter().map(|&point| {
            let point = to_camera * point;
            let (side, edge) = (point.truncate(), edge * -point.z);
            let [right, left] = [side.cmpgt(edge), (-side).cmpgt(edge)];
            right.bitmask() | left.bitmask() << 2
        });
        beyond.fold(0b1111, |common, beyond| common & beyond) != 0
    }
}

impl PictureWindow {
    /// True if it has no pixel.
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty() || self.rows.is_empty()
    }

    /// Number of its pixels.
    pub fn area(&self) -> usize {
        self.columns.len() * self.rows.len()
    }

    /// The pixels that it shares with another one.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        let common = |one: &Range<u32>, other: &Range<u32>| {
            let start = one.start.max(other.start);
            start..one.end.min(other.end).max(start)
        };
        Self {
            columns: common(&self.columns, &other.columns),
            rows: common(&self.rows, &other.rows),
        }
    }

    /// The window with this many more pixels on each side, as far as the picture has them.
    #[must_use]
    pub fn widened(&self, by: u32, [width, height]: [u32; 2]) -> Self {
        let wider =
            |range: &Range<u32>, end| range.start.saturating_sub(by)..(range.end + by).min(end);
        Self {
            columns: wider(&self.columns, width),
            rows: wider(&self.rows, height),
        }
    }

    /// The window around two.
    #[must_use]
    pub fn joined(&self, other: &Self) -> Self {
        let around = |one: &Range<u32>, other: &Range<u32>| {
            one.start.min(other.start)..one.end.max(other.end)
        };
        Self {
            columns: around(&self.columns, &other.columns),
            rows: around(&self.rows, &other.rows),
        }
    }

    /// The columns as indices.
    pub(crate) fn columns(&self) -> Range<usize> {
        self.columns.start as usize..self.columns.end as usize
    }
}

/// Reach of the outermost samples beyond the middle of the outermost pixels, with room for rounding, in pixels.
const REACH: f32 = 1.0;

/// Largest distance along an axis, in units, of a corner that is drawn: beyond it, numbers are too coarse.
const FARTHEST: f32 = 1e9;

/// The pixels that have a sample between these two points, and perhaps their neighbours.
fn pixels_between(least: f32, most: f32, count: u32) -> Range<u32> {
    let first = (least - 0.5).floor().max(0.0) as u32;
    let last = (most + 0.5).ceil().max(-1.0);
    first..((last + 1.0) as u32).min(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head(camera: HeadCamera) -> Camera {
        Camera::of_head(&camera, &Table::default())
    }

    #[test]
    fn points_are_seen_where_the_original_program_shows_them() {
        let camera = head(HeadCamera {
            width: 1024,
            height: 600,
            square_fov: true,
            ..HeadCamera::default()
        });
        // Measured from the picture's corner, and with the original's axis of view turned by 0.0008.
        for (point, pixel) in [
            (Vec3::ZERO, Vec2::new(511.6, 321.8)),
            (Vec3::new(10.0, 6.0, 0.0), Vec2::new(1034.8, 164.6)),
            (Vec3::new(-10.0, 6.0, 0.0), Vec2::new(-12.2, 165.0)),
            (Vec3::new(10.0, -6.0, 0.0), Vec2::new(1377.6, 581.0)),
        ] {
            let seen = camera.pixel_of(point).unwrap() + 0.5;
            assert!((seen - pixel).length() < 1.2, "{point} is seen at {seen}");
        }
    }

    #[test]
    fn true_pixels_are_square() {
        let camera = head(HeadCamera::default());
        let center = camera.pose * (Vec3::NEG_Z * 10.0);
        let seen = |offset: Vec3| camera.pixel_of(center + camera.pose.rotation * offset);
        let middle = Vec2::new(99.5, 74.5);
        assert!((seen(Vec3::ZERO).unwrap() - middle).length() < 1e-3);
        // The upper edge is seen under 30° from the axis: 10 tan 30° = 5.7735 units.
        assert!((seen(Vec3::Y * 5.7735).unwrap() - Vec2::new(99.5, -0.5)).length() < 1e-2);
        assert!((seen(Vec3::X * 5.7735).unwrap() - Vec2::new(174.5, 74.5)).length() < 1e-2);
        let square = HeadCamera {
            square_fov: true,
            ..HeadCamera::default()
        };
        let edge = head(square).pixel_of(center + camera.pose.rotation * (Vec3::X * 5.7735));
        assert!((edge.unwrap() - Vec2::new(199.5, 74.5)).length() < 1e-2);
    }

    #[test]
    fn a_box_around_the_camera_is_seen_and_one_beside_its_view_is_not() {
        let camera = head(HeadCamera::default());
        let view = PinholeView::of(&camera);
        let at = |middle: Vec3, half: Vec3| {
            let corners: [Vec3; 8] = std::array::from_fn(|corner| {
                let side = |axis: usize| [-1.0, 1.0][corner >> axis & 1];
                let corner = middle + half * Vec3::new(side(0), side(1), side(2));
                camera.pose.rotation * corner
            });
            view.window_of(&corners).is_some()
        };
        // From behind the camera to 8 units in front of it.
        let half = Vec3::new(0.5, 0.5, 5.0);
        assert!(at(Vec3::NEG_Z * 3.0, half));
        for side in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y] {
            assert!(!at(side * 15.0 + Vec3::NEG_Z * 3.0, half), "{side}");
            // Its far end reaches into the picture.
            assert!(at(side * 2.0 + Vec3::NEG_Z * 3.0, half), "{side}");
        }
        // Its corners are beyond different edges.
        assert!(at(Vec3::NEG_Z * 3.0, Vec3::new(50.0, 0.5, 5.0)));
    }

    #[test]
    fn four_pixels_are_those_of_each() {
        let camera = head(HeadCamera::default());
        let view = PinholeView::of(&camera);
        let body = Pose::new(Vec3::new(0.5, -2.0, 1.0), Quat::from_rotation_y(0.7));
        let points = [
            Vec3::ZERO,
            Vec3::new(1.0, 2.0, -0.5),
            Vec3::new(-3.0, 0.2, 0.1),
            body.inverse() * (view.eye - view.rays.through(0.0, 0.0)),
        ];
        let part = |axis: usize| Vec4::from_array(points.map(|point| point[axis]));
        let [columns, rows] = view.pixels_of(body)(FourVectors {
            x: part(0),
            y: part(1),
            z: part(2),
        });
        for (lane, point) in points.into_iter().enumerate() {
            match camera.pixel_of(body * point) {
                Some(pixel) => {
                    assert!((pixel - Vec2::new(columns[lane], rows[lane])).length() < 1e-3);
                }
                None => assert!(columns[lane].is_nan() && rows[lane].is_nan()),
            }
        }
        assert!(columns[3].is_nan() && !columns[2].is_nan());
    }

    #[test]
    fn the_ray_through_a_pixel_inverts_the_projection() {
        let camera = head(HeadCamera::default());
        let view = PinholeView::of(&camera);
        for pixel in [Vec2::ZERO, Vec2::new(17.25, 140.5), Vec2::new(199.0, 3.0)] {
            let point = view.eye + view.rays.through(pixel.x, pixel.y) * 13.0;
            assert!((camera.pixel_of(point).unwrap() - pixel).length() < 1e-3);
            assert!(((camera.pose.inverse() * point).z + 13.0).abs() < 1e-4);
        }
        assert_eq!(
            camera.pixel_of(view.eye - view.rays.through(0.0, 0.0)),
            None
        );
    }
}
