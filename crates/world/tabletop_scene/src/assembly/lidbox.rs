//! Lid boxes: a box and a lid that slides on top of it.

use bevy::prelude::*;
use tabletop_core::{JointKind, JointSpec, LidBoxSpec, ObjectSpec};
use tabletop_geometry::Pose;

use crate::ids::IdAllocator;

/// Friction between lid and box: that of two ordinary surfaces.
const LID_FRICTION: f32 = 0.25;

/// The box, the lid, and the joint between them.
pub(super) fn build(spec: &LidBoxSpec, ids: &mut IdAllocator) -> ([ObjectSpec; 2], JointSpec) {
    let id = ids.unique(&spec.id);
    let top = Pose::at(Vec3::Z * spec.span.z / 2.0);
    let lid_bottom = Pose::at(Vec3::NEG_Z * spec.thickness / 2.0);
    let body = ObjectSpec {
        id: ids.unique(&format!("{id}-box")),
        pose: spec.pose,
        mass: spec.box_mass,
        shape: spec.container(),
        dynamics: Default::default(),
        descriptions: spec.descriptions.clone(),
    };
    let lid = ObjectSpec {
        id: ids.unique(&format!("{id}-lid")),
        pose: spec.pose * top * lid_bottom.inverse(),
        mass: spec.lid_mass,
        shape: spec.lid(),
        dynamics: Default::default(),
        descriptions: Vec::new(),
    };
    let joint = JointSpec {
        objects: [body.id.clone(), lid.id.clone()],
        frames: [top, lid_bottom],
        kind: JointKind::Slider {
            min: 0.0,
            max: spec.span.x,
            friction: LID_FRICTION,
            damping: 0.0,
        },
        collides: false,
    };
    ([body, lid], joint)
}

#[cfg(test)]
mod tests {
    use tabletop_core::{SceneItem, SceneSpec};
    use tabletop_geometry::Rgb;

    use super::*;
    use crate::assemble;

    #[test]
    fn the_lid_lies_on_the_box_whichever_way_it_is_turned() {
        for (location, rotation, lid_location) in [
            (Vec3::Z * 2.5, Vec3::ZERO, Vec3::new(0.0, 0.0, 5.3)),
            (
                Vec3::Z * 3.0,
                Vec3::new(0.0, 90.0, -90.0),
                Vec3::new(0.0, -2.8, 3.0),
            ),
        ] {
            let spec = LidBoxSpec {
                id: String::new(),
                pose: Pose::from_degrees(location, rotation),
                span: Vec3::new(6.0, 5.0, 5.0),
                thickness: 0.6,
                box_mass: 9.0,
                lid_mass: 1.0,
                color: Rgb::GRAY,
                handle_span: Vec3::splat(0.5),
                handle_thickness: 0.1,
                handle_color: Rgb::GRAY,
                descriptions: Vec::new(),
            };
            let scene = SceneSpec {
                items: vec![SceneItem::LidBox(spec)],
                ..default()
            };
            let assembly = assemble(&scene, &mut IdAllocator::default());
            let [body, lid] = &assembly.objects[..] else {
                panic!("{} objects", assembly.objects.len());
            };
            assert_eq!([&*body.id, &*lid.id], ["obj-box", "obj-lid"]);
            assert!((lid.pose.location - lid_location).length() < 1e-5);
        }
    }
}
