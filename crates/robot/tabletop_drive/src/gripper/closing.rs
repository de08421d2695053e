//! Closing of a gripper: whether it holds the objects between its fingers (report section 5, figure 11), and how far it can close.

use std::{collections::BTreeMap, f32::consts::PI};

use bevy::prelude::*;
use tabletop_geometry::Pose;
use tabletop_physics::Convex;

use crate::gripper::finger_pad::{FingerPad, FingerTouch, ProbeRay, opposite};

/// The angle θ of figure 11 below which an object is held.
pub const STEEPEST_GRIP: f32 = PI / 16.0;

/// Sum of the distances to both fingers, in units, at which an object counts as touched by both.
const TOUCHING: f32 = 0.004;

/// An object that may be between the fingers.
pub(crate) struct Graspable {
    /// The object.
    pub object: Entity,
    /// Its convex parts, in the table's frame.
    pub parts: Vec<Convex>,
}

/// The findings of a closing gripper.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Closing {
    /// Distance by which it can still close, in units.
    pub room: f32,
    /// The objects that both fingers touch.
    pub touched: Vec<Touched>,
}

/// An object that both fingers touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touched {
    /// The object.
    pub object: Entity,
    /// The angle θ.
    pub angle: f32,
    /// Contact points of the left and the right finger, in the table's frame.
    pub points: [Vec3; 2],
}

/// The closing of a gripper.
pub(crate) fn close(
    end_effector: Pose,
    opening: f32,
    finger: Vec3,
    between: &[Graspable],
) -> Closing {
    let pads = FingerPad::pair(end_effector, opening, finger);
    let mut closing = Closing {
        room: opening,
        touched: Vec::new(),
    };
    let mut filled = BTreeMap::new();
    for candidate in between {
        let [Some(left), Some(right)] = pads.map(|pad| pad.touch(&candidate.parts, opening)) else {
            continue;
        };
        let gap = left.distance + right.distance;
        closing.room = closing.room.min(gap.max(0.0));
        if gap <= TOUCHING {
            closing.touched.push(Touched {
                object: candidate.object,
                angle: angle(left, right, end_effector),
                points: [left.point, right.point],
            });
        }
        add_filled(&mut filled, pads, candidate, opening);
    }
    let thickest = filled.into_values().map(thickness).fold(0.0, f32::max);
    closing.room = closing.room.min((opening - thickest).max(0.0));
    closing
}

/// The angle between the line from contact to contact and the normal of the fingers' inner faces.
fn angle(left: FingerTouch, right: FingerTouch, end_effector: Pose) -> f32 {
    let across = right.point - left.point;
    across.angle_between(end_effector.rotation * Vec3::X)
}

/// Adds the part that an object fills of each line from finger to finger, from its nearest to its farthest point.
fn add_filled(
    filled: &mut BTreeMap<ProbeRay, Vec<[f32; 2]>>,
    [left, right]: [FingerPad; 2],
    candidate: &Graspable,
    opening: f32,
) {
    let from_right: BTreeMap<_, _> = right.probe(&candidate.parts, opening).collect();
    for (ray, from_left) in left.probe(&candidate.parts, opening) {
        if let Some(from_right) = from_right.get(&opposite(ray)) {
            let part = [from_left, opening - from_right];
            filled.entry(ray).or_default().push(part);
        }
    }
}

/// The thickness of objects along a line. Objects behind each other add up; an object inside another one does not count.
fn thickness(mut parts: Vec<[f32; 2]>) -> f32 {
    parts.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut end = f32::NEG_INFINITY;
    let lengths = parts.into_iter().map(|[from, to]| {
        let length = (to - from.max(end)).max(0.0);
        end = end.max(to);
        length
    });
    lengths.sum()
}

#[cfg(test)]
mod tests {
    use bevy_rapier3d::rapier::prelude::SharedShape;

    use super::*;

    const FINGER: Vec3 = Vec3::new(0.3, 0.4, 1.5);

    const OBJECT: Entity = Entity::PLACEHOLDER;

    fn candidate(shape: SharedShape, pose: Pose) -> Graspable {
        Graspable {
            object: OBJECT,
            parts: vec![Convex { pose, shape }],
        }
    }

    fn unit_block(pose: Pose) -> Graspable {
        candidate(SharedShape::cuboid(0.5, 0.5, 0.5), pose)
    }

    /// θ once the gripper has closed on this without moving it.
    fn theta(candidate: Graspable) -> f32 {
        let candidates = [candidate];
        let free = close(Pose::IDENTITY, 2.0, FINGER, &candidates);
        let closed = close(Pose::IDENTITY, 2.0 - free.room, FINGER, &candidates);
        assert!(closed.room < 1e-3, "{closed:?}");
        closed.touched[0].angle
    }

    fn turned(degrees: Vec3) -> Pose {
        Pose::from_degrees(Vec3::ZERO, degrees)
    }

    #[test]
    fn the_angle_decides_between_ten_and_fifteen_degrees() {
        for held in [0.0, 5.0, 10.0] {
            let theta = theta(unit_block(turned(Vec3::Z * held)));
            assert!(theta < STEEPEST_GRIP, "{held}°: {theta}");
        }
        for refused in [15.0, 20.0, 30.0] {
            let theta = theta(unit_block(turned(Vec3::Z * refused)));
            assert!(theta > STEEPEST_GRIP, "{refused}°: {theta}");
        }
    }

    #[test]
    fn round_things_are_touched_at_opposite_points() {
        let lying_across = turned(Vec3::ZERO);
        let lying_along = turned(Vec3::Z * 90.0);
        let standing = turned(Vec3::X * 90.0);
        for pose in [lying_across, lying_along, standing] {
            let theta = theta(candidate(SharedShape::cylinder(0.5, 0.4), pose));
            assert!(theta < 0.02, "{pose:?}: {theta}");
        }
        assert!(theta(candidate(SharedShape::ball(0.5), Pose::IDENTITY)) < 0.02);
    }

    #[test]
    fn a_block_off_the_centre_leaves_the_same_room() {
        for x in [0.0, 0.2, -0.4] {
            let closing = close(
                Pose::IDENTITY,
                2.0,
                FINGER,
                &[unit_block(Pose::at(Vec3::X * x))],
            );
            assert!((closing.room - 1.0).abs() < 1e-4, "{closing:?}");
            assert!(closing.touched.is_empty());
        }
    }

    #[test]
    fn blocks_behind_each_other_add_up() {
        let halves = [-0.5, 0.4]
            .map(|x| candidate(SharedShape::cuboid(0.25, 0.5, 0.5), Pose::at(Vec3::X * x)));
        let closing = close(Pose::IDENTITY, 2.0, FINGER, &halves);
        assert!((closing.room - 1.0).abs() < 1e-4, "{closing:?}");
        assert!(closing.touched.is_empty());
    }

    #[test]
    fn the_content_of_a_box_does_not_keep_the_fingers_from_its_walls() {
        let wall = |x: f32| Convex {
            pose: Pose::at(Vec3::X * x),
            shape: SharedShape::cuboid(0.05, 0.8, 0.5),
        };
        let walls = Graspable {
            object: OBJECT,
            parts: vec![wall(-0.75), wall(0.75)],
        };
        let content = candidate(SharedShape::cuboid(0.5, 0.5, 0.5), Pose::IDENTITY);
        let closing = close(Pose::IDENTITY, 1.9, FINGER, &[walls, content]);
        assert!((closing.room - 0.3).abs() < 1e-4, "{closing:?}");
    }

    #[test]
    fn blocks_above_each_other_are_both_touched() {
        let stacked = [-0.3, 0.3]
            .map(|z| candidate(SharedShape::cuboid(0.25, 0.25, 0.25), Pose::at(Vec3::Z * z)));
        let closing = close(Pose::IDENTITY, 0.5, FINGER, &stacked);
        assert_eq!(closing.touched.len(), 2);
        assert_eq!(closing.room, 0.0);
    }

    #[test]
    fn nothing_between_the_fingers_lets_them_meet() {
        assert_eq!(close(Pose::IDENTITY, 1.5, FINGER, &[]).room, 1.5);
    }
}
