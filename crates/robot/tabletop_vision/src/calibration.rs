//! Calibration: where the camera is, from the edges of the table.
//!
//! Points of the edges are looked for across the edges, near where they are expected (Harris, "Tracking with rigid models", 1992).

use bevy::math::{Vec2, Vec3};
use tabletop_camera::Camera;
use tabletop_core::{Picture, Table};
use tabletop_geometry::{Pose, turn_about};

use crate::normal::LeastSquares;

/// The parameters: translation along and rotation about the camera's own axes.
const PARAMETERS: usize = 6;
/// The angle, in rad, that moves the picture about as much as a unit does.
const RADIANS_PER_UNIT: f32 = 0.08;
/// Step of the derivatives, in units.
const STEP: f32 = 0.01;
/// Number of points of an edge.
const POINTS: usize = 120;
/// How far the edges are looked for, in pixels: at first where they may be, then nearer.
const REACHES: [f32; 10] = [14.0, 12.0, 8.0, 6.0, 4.0, 3.0, 3.0, 2.0, 2.0, 2.0];
/// Distance of the samples across an edge, in pixels.
const SAMPLE: f32 = 0.25;
/// Distance, in pixels, of a found point from an edge at which it counts as one of something else.
const OUTLIER: f32 = 0.5;
/// How well the pose is known before, as the weight of a squared unit beside those of squared pixels: it decides what edges leave open.
const KNOWN_BEFORE: f32 = 1e-3;
/// The part of the difference between the table's brightness and its surroundings' that is an edge at least.
const CONTRAST: f32 = 0.15;

/// The camera, at the pose from which the edges of the table look as in a picture: it may be some tenths of a unit and some degrees from where it
/// is thought to be. Objects on the table do no harm, as long as they do not hide most of its edges. A picture of another size than the
/// camera's changes nothing.
#[must_use]
pub fn calibrated(picture: &Picture, camera: &Camera, table: &Table) -> Camera {
    let is_of_camera = picture.width == camera.width
        && picture.height == camera.height
        && picture.rgb.len() == 3 * picture.width as usize * picture.height as usize;
    if !is_of_camera {
        return *camera;
    }
    let mut change = [0.0; PARAMETERS];
    for reach in REACHES {
        let now = moved(camera, &change);
        let mut equations = LeastSquares::<PARAMETERS>::default();
        for point in edge_points(table) {
            let Some(expected) = ExpectedPoint::of(&now, &point) else {
                continue;
            };
            let Some(distance) = expected.distance(picture, reach) else {
                continue;
            };
            let derivatives = std::array::from_fn(|parameter| {
                let mut changed = change;
                changed[parameter] += STEP;
                let pixel = moved(camera, &changed).pixel_of(point.at);
                pixel.map_or(0.0, |pixel| {
                    (pixel - expected.pixel).dot(expected.outward) / STEP
                })
            });
            let outlier = OUTLIER.max(reach / 4.0);
            let weight = outlier * outlier / (outlier * outlier + distance * distance);
            equations.add(&derivatives, distance, weight * weight);
        }
        for (parameter, by) in change.iter().enumerate() {
            let mut own = [0.0; PARAMETERS];
            own[parameter] = 1.0;
            equations.add(&own, -by, KNOWN_BEFORE);
        }
        for (own, by) in change.iter_mut().zip(equations.step(0.0)) {
            *own += by as f32;
        }
    }
    moved(camera, &change)
}

/// A point of an upper edge of the table, and a point a little farther out.
struct EdgePoint {
    at: Vec3,
    beyond: Vec3,
}

fn edge_points(table: &Table) -> impl Iterator<Item = EdgePoint> + use<> {
    let half = Vec3::new(table.xspan, table.yspan, 0.0) / 2.0;
    let edges = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y].into_iter();
    edges.flat_map(move |outward| {
        let along = Vec3::new(outward.y, outward.x, 0.0).abs() * half;
        (0..POINTS).map(move |i| {
            let part = (i as f32 + 0.5) / POINTS as f32 * 2.0 - 1.0;
            let at = outward * half + along * part;
            EdgePoint {
                at,
                beyond: at + outward * 0.05,
            }
        })
    })
}

/// A point of an edge where it is expected in the picture, and the direction across the edge, away from the table.
struct ExpectedPoint {
    pixel: Vec2,
    outward: Vec2,
}

impl ExpectedPoint {
    fn of(camera: &Camera, point: &EdgePoint) -> Option<Self> {
        let (pixel, beyond) = (camera.pixel_of(point.at)?, camera.pixel_of(point.beyond)?);
        Some(Self {
            pixel,
            outward: (beyond - pixel).try_normalize()?,
        })
    }

    /// The distance, in pixels outwards, at which the picture turns from the table's brightness to something darker; none if it does not, or if that
    /// is too near to the picture's border.
    fn distance(&self, picture: &Picture, reach: f32) -> Option<f32> {
        let count = (2.0 * reach / SAMPLE) as usize;
        let place = |i: usize| i as f32 * SAMPLE - reach;
        let brightness = |i: usize| brightness_at(picture, self.pixel + self.outward * place(i));
        let inner = brightness(0)?;
        let mut before = inner;
        // The first place that is far darker than the table, and where halfway there it is passed.
        let dark = (1..count).find_map(|i| {
            let now = brightness(i)?;
            let is_edge = now < inner * (1.0 - CONTRAST) && (now - before).abs() < inner * 0.02;
            before = now;
            is_edge.then_some((i, now))
        });
        let (end, outer) = dark?;
        let halfway = (inner + outer) / 2.0;
        let mut before = inner;
        for i in 1..=end {
            let now = brightness(i)?;
            if now <= halfway {
                let part = (before - halfway) / (before - now).max(1e-3);
                return Some(place(i - 1) + part * SAMPLE);
            }
            before = now;
        }
        None
    }
}

/// The brightness at a point of the picture, between the middles of pixels.
fn brightness_at(picture: &Picture, at: Vec2) -> Option<f32> {
    let low = at.floor();
    let is_within = low.x >= 0.0
        && low.y >= 0.0
        && low.x + 1.0 < picture.width as f32
        && low.y + 1.0 < picture.height as f32;
    if !is_within {
        return None;
    }
    let (column, row) = (low.x as u32, low.y as u32);
    let of = |column, row| {
        let [red, green, blue] = picture.color(column, row)?.map(f32::from);
        Some(red + green + blue)
    };
    let part = at - low;
    let upper = of(column, row)? * (1.0 - part.x) + of(column + 1, row)? * part.x;
    let lower = of(column, row + 1)? * (1.0 - part.x) + of(column + 1, row + 1)? * part.x;
    Some(upper * (1.0 - part.y) + lower * part.y)
}

fn moved(camera: &Camera, change: &[f32; PARAMETERS]) -> Camera {
    let [x, y, z, about_x, about_y, about_z] = *change;
    let angles = Vec3::new(about_x, about_y, about_z) * RADIANS_PER_UNIT;
    let turn = turn_about(angles.normalize_or(Vec3::X), angles.length());
    let mut pose = camera.pose * Pose::new(Vec3::new(x, y, z), turn);
    pose.rotation = pose.rotation.normalize();
    Camera { pose, ..*camera }
}
