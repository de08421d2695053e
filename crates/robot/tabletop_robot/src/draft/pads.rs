//! The parts of two fingers that touch things, measured.

use bevy::math::DVec3;
use tabletop_geometry::UNITS_PER_METER;

/// Least and largest length of the part of a finger that is taken to touch things, in m from the tip.
const LENGTHS: [f64; 2] = [0.02, 0.05];

/// Least and largest extents of a finger across and along the opening, in units.
const WIDTHS: [f64; 2] = [0.1, 0.3];
const DEPTHS: [f64; 2] = [0.1, 0.4];

/// Least way, in units, between a closed and an open gripper.
const LEAST_WAY: f64 = 0.05;

/// The pads of a left and a right finger.
pub(super) struct Pads {
    /// Least and largest distance of their faces, in units; `None` if the points do not tell.
    pub opening: Option<[f64; 2]>,
    /// Extents of a finger, in units.
    pub finger: DVec3,
    /// The middle between them, in m.
    pub middle: DVec3,
}

impl Pads {
    /// Measures fingers by their points where they are closed and, in the same order, where they are open: the left finger's and the right one's, in m,
    /// with x from left to right and z back to the wrist.
    pub fn measure(closed: &[Vec<DVec3>; 2], open: &[Vec<DVec3>; 2]) -> Self {
        let [low, high] = bounds(&closed[1]);
        let [shortest, longest] = LENGTHS;
        let length = (high.z - low.z).clamp(shortest, longest);
        let touching = |sides: &[Vec<DVec3>; 2]| {
            [0, 1].map(|side| {
                let pairs = closed[side].iter().zip(&sides[side]);
                let touching = pairs.filter(|(closed, _)| closed.z < low.z + length);
                bounds(touching.map(|(_, point)| point))
            })
        };
        let [shut, wide] = [touching(closed), touching(open)];
        let opening = [&shut, &wide].map(|[left, right]| {
            let gap = right[0].x - left[1].x;
            round(gap.max(0.0) * UNITS_PER_METER)
        });
        let is_told = opening[1].is_finite() && opening[1] - opening[0] > LEAST_WAY;
        let [least, most] = shut[1];
        let span = (most - least) * UNITS_PER_METER;
        let extent = |span: f64, [least, most]: [f64; 2]| round(span.clamp(least, most));
        Self {
            opening: is_told.then_some(opening),
            finger: DVec3::new(
                extent(span.x, WIDTHS),
                extent(span.y, DEPTHS),
                round(length * UNITS_PER_METER),
            ),
            middle: DVec3::new(
                match is_told {
                    true => (wide[0][1].x + wide[1][0].x) / 2.0,
                    false => 0.0,
                },
                (least.y + most.y) / 2.0,
                low.z + length / 2.0,
            ),
        }
    }
}

/// The least and the largest coordinates of some points.
fn bounds<'p>(points: impl IntoIterator<Item = &'p DVec3>) -> [DVec3; 2] {
    let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let points = points.into_iter();
    points.fold(none, |[low, high], point| {
        [low.min(*point), high.max(*point)]
    })
}

/// Two digits after the point.
fn round(number: f64) -> f64 {
    (number * 100.0).round() / 100.0
}
