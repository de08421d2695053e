//! Turning the held object by dragging the arrow of an axis in the scene.

use bevy::prelude::*;
use tabletop_core::Hand;
use tabletop_user::HeldAxes;

use crate::turns::AXES;

/// Angle, in radians, between the line of sight and an arrow at which the arrow is hit: ten pixels.
const NEAR: f32 = 0.012;

/// Turn, in degrees, by a drag of a unit at the object's distance.
const DEGREES: f32 = 30.0;

/// The arrow of an axis is being dragged: what is in front of the axis follows the cursor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AxisTurn {
    /// The hand that holds the object.
    pub hand: Hand,
    /// The axis, by its place in [`AXES`].
    pub axis: usize,
    /// The sum of the turns about it at the start, in degrees.
    pub begun_at: i32,
    center: Vec3,
    /// The direction of the drag that turns it counterclockwise.
    along: Vec3,
    /// Where the drag began.
    from: Vec3,
}

impl AxisTurn {
    /// Takes the arrow along a line of sight, if there is one, of the axes through the held object.
    pub fn start(hand: Hand, center: Vec3, ray: Ray3d, sums: [i32; 3]) -> Option<Self> {
        let (axis, direction) = AXES
            .into_iter()
            .enumerate()
            .find(|&(_, axis)| HeldAxes::arrow(center, axis).any(|point| is_near(ray, point)))?;
        let to_eye = ray.origin - center;
        let along = direction.cross(to_eye).try_normalize()?;
        Some(Self {
            hand,
            axis,
            begun_at: sums[axis],
            center,
            along,
            from: at_center(ray, center)?,
        })
    }

    /// The sum of the turns, in degrees, for the present line of sight.
    pub fn degrees(&self, ray: Ray3d) -> Option<i32> {
        let moved = at_center(ray, self.center)? - self.from;
        Some(self.begun_at + (moved.dot(self.along) * DEGREES).round() as i32)
    }
}

fn is_near(ray: Ray3d, point: Vec3) -> bool {
    (point - ray.origin).angle_between(*ray.direction) < NEAR
}

/// The point of a line of sight that is as far away as the object.
fn at_center(ray: Ray3d, center: Vec3) -> Option<Vec3> {
    let plane = InfinitePlane3d {
        normal: Dir3::new(ray.origin - center).ok()?,
    };
    ray.plane_intersection_point(center, plane)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_world::towards;

    #[test]
    fn an_arrow_is_taken_and_turns_what_is_in_front_of_it_with_the_cursor() {
        let tip = |axis: Vec3| Vec3::Z + axis * 4.9;
        for (index, axis) in AXES.into_iter().enumerate() {
            let turn = AxisTurn::start(Hand::Any, Vec3::Z, towards(tip(axis)), [10, 20, 30]);
            let turn = turn.unwrap();
            assert_eq!(turn.axis, index);
            let still = turn.degrees(towards(tip(axis))).unwrap();
            assert_eq!(still, [10, 20, 30][index]);
        }
        let upright = AxisTurn::start(Hand::Any, Vec3::Z, towards(tip(Vec3::Z)), [0; 3]).unwrap();
        let right = upright.degrees(towards(tip(Vec3::Z) + Vec3::X)).unwrap();
        assert!((20..45).contains(&right), "{right}");
    }

    #[test]
    fn beside_the_arrows_nothing_is_taken() {
        for beside in [Vec3::Z, Vec3::new(2.0, 0.0, 1.0), Vec3::new(5.0, 1.0, 1.0)] {
            let turn = AxisTurn::start(Hand::Any, Vec3::Z, towards(beside), [0; 3]);
            assert_eq!(turn, None, "{beside}");
        }
    }
}
