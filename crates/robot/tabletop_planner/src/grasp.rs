//! Grasps of objects.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use bevy::math::{Quat, Vec3};
use tabletop_core::Shape;
use tabletop_geometry::{PlacedSolid, Pose, Solid};

/// From where an object is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GraspSide {
    /// From above.
    Above,
    /// From beside it, or from halfway up.
    Beside,
    /// From any of these sides.
    Any,
}

impl GraspSide {
    /// How far the way back from the object leans from the vertical, in rad.
    const fn leans(self) -> &'static [f32] {
        match self {
            Self::Above => &[0.0],
            Self::Beside => &[FRAC_PI_4, -FRAC_PI_4, FRAC_PI_2, -FRAC_PI_2],
            Self::Any => &[0.0, FRAC_PI_4, -FRAC_PI_4, FRAC_PI_2, -FRAC_PI_2],
        }
    }
}

/// A way to take an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grasp {
    /// Pose of the end effector, in the object's frame.
    pub end_effector: Pose,
    /// Width of the part between the fingers, in units.
    pub width: f32,
    /// Distance from the middle of the grasped part, and height above its lowest hold, in units.
    pub off: f32,
}

/// Least gap between a finger and the part that it grasps, in units.
const PLAY: f32 = 0.05;
/// Least height of the fingertips above the object's support, in units.
const ABOVE_GROUND: f32 = 0.03;
/// Least depth to which fingers reach down, in units.
const SHALLOW: f32 = 0.2;
/// Depth to which fingers reach down at a high object, in units.
const DEPTH: f32 = 0.45;

/// The ways to take an object that stands like this: at the whole of it or at a part such as a handle, by opposite faces that fit between
/// the fingers. `finger` are a finger's extents, the last along it, `widest` the largest opening, in units.
pub fn grasps(
    shape: &Shape,
    rotation: Quat,
    side: GraspSide,
    finger: Vec3,
    widest: f32,
) -> Vec<Grasp> {
    let length = finger.z;
    let upright = Pose::new(Vec3::ZERO, rotation);
    let solids = |shape: &Shape, pose: Pose| -> Vec<PlacedSolid> {
        let solids = shape.colliding();
        solids
            .iter()
            .map(|solid| PlacedSolid::of(solid, upright * pose))
            .collect()
    };
    let mut wholes = vec![solids(shape, Pose::IDENTITY)];
    let parts = shape.simple_parts();
    if parts.len() > 1 {
        wholes.extend(parts.iter().map(|part| solids(&part.shape, part.pose)));
    }
    // The fingers must not go below the object's support, for any grasped part.
    let ground = wholes[0]
        .iter()
        .map(|solid| solid.heights()[0])
        .fold(f32::INFINITY, f32::min);
    let mut all = Vec::<Grasp>::new();
    for whole in wholes {
        for yaw in yaws(&whole) {
            for &lean in side.leans() {
                let frame = Quat::from_rotation_z(yaw) * Quat::from_rotation_x(lean);
                let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z]
                    .map(|axis| PlacedSolid::extent(&whole, frame * axis));
                let width = x[1] - x[0];
                if width > widest - PLAY {
                    continue;
                }
                let middle = [x, y].map(|[low, high]| f32::midpoint(low, high));
                // From the middle of the fingers down to their lowest corners.
                let below = (length * lean.cos() + finger.y * lean.sin().abs()) / 2.0;
                let base = (frame * Vec3::new(middle[0], middle[1], 0.0)).z;
                let lowest = match lean.cos() > 0.1 {
                    true => (ground + ABOVE_GROUND + below - base) / lean.cos(),
                    false => f32::NEG_INFINITY,
                };
                let height = lowest.max(z[1] - DEPTH);
                if height - length / 2.0 > z[1] - 0.1 {
                    continue;
                }
                let room = (y[1] - y[0]) / 2.0 - 0.3;
                let offsets: &[f32] = if room > 0.4 {
                    &[0.0, 0.35, -0.35, 0.7, -0.7]
                } else {
                    &[0.0]
                };
                // Higher grasps leave room for objects below and around.
                let highest = z[1] + length / 2.0 - SHALLOW;
                let rises = [0.0, 0.5, 1.0].map(|share| (highest - height).max(0.0) * share);
                // Fingers that lean reach a flat thing only near the ground.
                let deep = (lowest.is_finite() && lean != 0.0).then_some(lowest - height);
                for (number, rise) in rises.into_iter().chain(deep).enumerate() {
                    if number > 0 && rise.abs() < 0.05 {
                        continue;
                    }
                    for offset in offsets {
                        let aside = offset * room.max(0.0);
                        let at = frame * Vec3::new(middle[0], middle[1] + aside, height + rise);
                        for turn in [0.0, PI] {
                            let there = Pose::new(at, frame * Quat::from_rotation_z(turn));
                            if is_between(&whole, there, finger.with_x(width)) {
                                all.push(Grasp {
                                    end_effector: upright.inverse() * there,
                                    width,
                                    off: aside.abs() + rise.abs(),
                                });
                            }
                        }
                    }
                }
            }
        }
    }
    all
}

/// True if a part is well between fingers with this room between them.
fn is_between(part: &[PlacedSolid], end_effector: Pose, room: Vec3) -> bool {
    let inner = room - Vec3::new(0.0, 2.0 * PLAY, 2.0 * PLAY);
    let room = PlacedSolid {
        pose: end_effector,
        solid: Solid::Cuboid(inner.max(Vec3::splat(1e-3))),
    };
    part.iter().any(|solid| solid.is_within(1e-3, &room))
}

/// Angles about the vertical at which fingers meet opposite faces.
fn yaws(solids: &[PlacedSolid]) -> Vec<f32> {
    let Some(first) = solids.first() else {
        return Vec::new();
    };
    let level = |axis: Vec3| axis.z.abs() < 0.1;
    let angle = |axis: Vec3| axis.y.atan2(axis.x);
    let axes = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| first.pose.rotation * axis);
    match first.solid {
        Solid::Ball(_) => around(8),
        Solid::Cylinder { .. } if !level(axes[1]) => around(8),
        // Across a lying cylinder.
        Solid::Cylinder { .. } => vec![angle(axes[1]) + FRAC_PI_2],
        Solid::Cuboid(_) => {
            let level: Vec<_> = axes.into_iter().filter(|axis| level(*axis)).collect();
            level.into_iter().map(angle).collect()
        }
        Solid::Polyhedron(ref polyhedron) => match polyhedron.axis() {
            Some(axis) => match first.pose.rotation * axis {
                axis if level(axis) => vec![angle(axis) + FRAC_PI_2],
                _ => around(8),
            },
            None => {
                let normals = polyhedron
                    .faces()
                    .filter_map(|[a, b, c]| (b - a).cross(c - a).try_normalize());
                let mut yaws: Vec<_> = normals
                    .map(|normal| first.pose.rotation * normal)
                    .filter(|normal| level(*normal))
                    .map(|normal| angle(normal).rem_euclid(PI))
                    .collect();
                yaws.sort_by(f32::total_cmp);
                yaws.dedup_by(|a, b| (*a - *b).abs() < 1e-2);
                yaws
            }
        },
    }
}

fn around(count: u16) -> Vec<f32> {
    (0..count)
        .map(|i| PI * f32::from(i) / f32::from(count))
        .collect()
}

#[cfg(test)]
mod tests {
    use tabletop_geometry::Rgb;

    use super::*;

    const FINGER: Vec3 = Vec3::new(0.3, 0.4, 1.5);

    fn block(x: f32, y: f32, z: f32) -> Shape {
        Shape::Block {
            span: Vec3::new(x, y, z),
            color: Rgb::RED,
        }
    }

    fn widths(shape: &Shape) -> Vec<f32> {
        let all = grasps(shape, Quat::IDENTITY, GraspSide::Above, FINGER, 2.0);
        let rounded = |width: f32| (width * 1e3).round() / 1e3;
        let mut widths: Vec<_> = all.iter().map(|grasp| rounded(grasp.width)).collect();
        widths.dedup();
        widths
    }

    #[test]
    fn a_block_is_taken_by_the_faces_that_fit() {
        assert_eq!(widths(&block(1.0, 1.5, 1.0)), [1.0, 1.5]);
        assert_eq!(widths(&block(1.0, 3.0, 1.0)), [1.0]);
        assert!(widths(&block(2.5, 3.0, 1.0)).is_empty());
    }

    #[test]
    fn a_lid_is_taken_by_its_handle() {
        let lid = Shape::Lid {
            span: Vec3::new(4.0, 4.0, 0.2),
            color: Rgb::RED,
            handle_span: Vec3::new(0.5, 0.8, 0.5),
            handle_thickness: 0.1,
            handle_color: Rgb::RED,
        };
        for grasp in grasps(&lid, Quat::IDENTITY, GraspSide::Above, FINGER, 2.0) {
            assert!(
                grasp.width < 0.81 && grasp.end_effector.location.z > 0.5,
                "{grasp:?}"
            );
        }
        assert!(!grasps(&lid, Quat::IDENTITY, GraspSide::Above, FINGER, 2.0).is_empty());
    }

    #[test]
    fn fingers_meet_opposite_faces_from_beside_too() {
        let block = block(1.0, 1.5, 3.0);
        let all = grasps(&block, Quat::IDENTITY, GraspSide::Beside, FINGER, 2.0);
        for grasp in &all {
            let [across, back] = [Vec3::X, Vec3::Z].map(|axis| grasp.end_effector.rotation * axis);
            assert!(across.z.abs() < 1e-4 && back.z < 0.8, "{grasp:?}");
        }
        assert!(!all.is_empty());
    }

    #[test]
    fn a_plate_is_between_fingers_that_lean() {
        let plate = block(1.9, 4.0, 0.2);
        let all = grasps(&plate, Quat::IDENTITY, GraspSide::Beside, FINGER, 2.0);
        for grasp in &all {
            let back = grasp.end_effector.rotation * Vec3::Z;
            let tips = grasp.end_effector.location - back * FINGER.z / 2.0;
            assert!(tips.z < 0.15 && tips.y.abs() < 2.0, "{grasp:?}");
        }
        assert!(!all.is_empty());
    }

    #[test]
    fn fingers_stay_above_the_ground() {
        for height in [0.3, 1.0, 3.0] {
            let block = block(1.0, 1.0, height);
            for grasp in grasps(&block, Quat::IDENTITY, GraspSide::Above, FINGER, 2.0) {
                let ends = grasp.end_effector.location.z - 0.75;
                assert!(ends >= -height / 2.0 + 0.029, "{grasp:?}");
            }
        }
    }
}
