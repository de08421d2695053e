//! Sides on which an object can lie.

use bevy::math::{Quat, Vec3};
use tabletop_core::Shape;
use tabletop_geometry::{PlacedSolid, Pose};
use tabletop_task::Symmetry;

/// Angle by which the table is thought to be tilted to find the edges of a side, in rad.
const TILT: f32 = 0.02;
/// Number of directions in which it is.
const WAYS: u16 = 16;

/// The orientations in which a shape rests on a side that one of its axes meets, one for each that looks different.
pub(crate) fn sides(shape: &Shape) -> Vec<Quat> {
    let symmetry = Symmetry::of(shape);
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let mut found = Vec::<(Vec3, Quat)>::new();
    for down in axes.into_iter().chain(axes.map(|axis| -axis)) {
        let rotation = Quat::from_rotation_arc(down, Vec3::NEG_Z);
        let pose = Pose::new(Vec3::ZERO, rotation);
        let looks_like = |known: Vec3| {
            let mut alike = symmetry.variants(pose).into_iter();
            alike.any(|pose| (pose.rotation.inverse() * Vec3::NEG_Z).angle_between(known) < 0.1)
        };
        let is_new = !found.iter().any(|(known, _)| looks_like(*known));
        if is_new && rests(shape, pose, symmetry.centre) {
            found.push((down, rotation));
        }
    }
    found.into_iter().map(|(_, rotation)| rotation).collect()
}

/// True if a shape in this pose does not tip over: its centre is above the edges of its lowest side.
fn rests(shape: &Shape, pose: Pose, centre: Vec3) -> bool {
    let solids: Vec<_> = shape
        .colliding()
        .iter()
        .map(|solid| PlacedSolid::of(solid, pose))
        .collect();
    let centre = pose * centre;
    (0..WAYS).all(|i| {
        let turn = Quat::from_rotation_z(std::f32::consts::TAU * f32::from(i) / f32::from(WAYS));
        let way = turn * Vec3::X;
        let down = Vec3::NEG_Z + way * TILT;
        let points = solids.iter().map(|solid| solid.farthest(down));
        let lowest = points.max_by(|a, b| a.dot(down).total_cmp(&b.dot(down)));
        lowest.is_some_and(|lowest| (lowest - centre).dot(way) > 0.0)
    })
}

#[cfg(test)]
mod tests {
    use tabletop_core::Part;
    use tabletop_geometry::Rgb;

    use super::*;

    fn block(x: f32, y: f32, z: f32) -> Shape {
        Shape::Block {
            span: Vec3::new(x, y, z),
            color: Rgb::RED,
        }
    }

    #[test]
    fn a_brick_lies_on_three_sides_and_a_cube_on_one() {
        let can = Shape::Cylinder {
            radius: 0.5,
            yspan: 2.0,
            color: Rgb::RED,
        };
        let container = Shape::Box {
            span: Vec3::ONE,
            thickness: 0.1,
            color: Rgb::RED,
        };
        for (shape, count) in [
            (block(1.0, 2.0, 3.0), 3),
            (block(1.0, 1.0, 3.0), 2),
            (block(1.0, 1.0, 1.0), 1),
            (can, 2),
            // Its walls look the same, though two of them are between the others.
            (container, 3),
        ] {
            assert_eq!(sides(&shape).len(), count, "{shape:?}");
        }
    }

    #[test]
    fn nothing_lies_on_a_side_beyond_which_it_hangs() {
        let part = |shape, at| Part {
            pointable: false,
            id: String::new(),
            pose: Pose::at(at),
            shape,
        };
        let parts = vec![
            part(block(1.0, 1.0, 1.0), Vec3::ZERO),
            part(block(5.0, 1.0, 1.0), Vec3::new(3.0, 0.0, 1.0)),
        ];
        let hook = Shape::Composite { parts };
        let upright = Pose::IDENTITY;
        let centre = Symmetry::of(&hook).centre;
        assert!(!rests(&hook, upright, centre));
        let upside_down = Pose::from_degrees(Vec3::ZERO, Vec3::X * 180.0);
        assert!(rests(&hook, upside_down, centre));
    }
}
