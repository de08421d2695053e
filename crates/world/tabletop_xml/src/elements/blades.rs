//! The default blades of scissors.

use bevy::math::Vec3;
use tabletop_core::{ObjectSpec, Part, Shape};
use tabletop_geometry::{Pose, Rgb};

/// A blade's height and thickness as shares of its length, and its handle's length.
const HEIGHT: f32 = 0.14;
const THICKNESS: f32 = 0.12;
const HANDLE: f32 = 0.9;

/// The lower and the upper blade when shut, of this length from the hinge to the tip and of this mass together:
/// along Y of the joint, cutting edge to cutting edge. Each continues as a handle on the other side of the hinge.
pub(crate) fn blades(id: &str, length: f32, mass: f32, color: Rgb) -> [ObjectSpec; 2] {
    [("lower", -1.0), ("upper", 1.0)].map(|(name, side)| {
        let id = match id.is_empty() {
            true => name.to_owned(),
            false => format!("{id}_{name}"),
        };
        let height = HEIGHT * length;
        // Where parts go through each other, none of their faces is another's.
        let thickness = THICKNESS * length * if side < 0.0 { 1.0 } else { 0.98 };
        let part = |y: f32, z: f32, span: Vec3, color| {
            let pose = Pose::at(Vec3::new(0.0, y, z));
            Part::new("", pose, Shape::Block { span, color })
        };
        let bar = |length: f32, share: f32| Vec3::new(share * thickness, length, height);
        let handle = HANDLE * length;
        let parts = vec![
            part(length / 2.0, side * height / 2.0, bar(length, 1.0), color),
            part(
                0.0,
                0.0,
                Vec3::new(1.05 * thickness, height, 1.98 * height),
                color,
            ),
            part(
                -handle / 2.0,
                -side * height / 2.0,
                bar(handle, 0.96),
                Rgb::BLACK,
            ),
        ];
        ObjectSpec::new(id, Pose::IDENTITY, mass / 2.0, Shape::Composite { parts })
    })
}
