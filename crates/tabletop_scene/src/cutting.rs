//! Scissors cut chains.

use bevy::prelude::*;
use bevy_rapier3d::prelude::Collider;
use tabletop_core::{Joint, JointKind, ObjectIndex, ObjectSpec, Pose, Shape};
use tabletop_physics::{Convex, convex_parts, remove_object};

/// Distance, in units, at which something touches a blade.
const TOUCH: f32 = 0.02;

/// Removes the links of chains that both blades of scissors touch.
pub(crate) fn cut_links(
    joints: Query<&Joint>,
    objects: Query<(&ObjectSpec, &Transform, &Collider)>,
    index: Res<ObjectIndex>,
    mut commands: Commands,
) {
    let shears: Vec<_> = joints
        .iter()
        .filter(|joint| matches!(joint.kind, JointKind::Shears { .. }))
        .map(|joint| joint.objects.map(|blade| solids(&objects, blade)))
        .collect();
    if shears.is_empty() {
        return;
    }
    for object in index.iter() {
        let is_link = objects
            .get(object)
            .is_ok_and(|(spec, ..)| matches!(spec.shape, Shape::Link { .. }));
        if !is_link {
            continue;
        }
        let link = solids(&objects, object);
        let touches = |blade: &Vec<Convex>| {
            let is_near = |part: &Convex| link.iter().any(|link| part.is_near(link, TOUCH));
            blade.iter().any(is_near)
        };
        if shears.iter().any(|blades| blades.iter().all(touches)) {
            commands.queue(move |world: &mut World| remove_object(world, object));
        }
    }
}

fn solids(objects: &Query<(&ObjectSpec, &Transform, &Collider)>, object: Entity) -> Vec<Convex> {
    let Ok((_, place, collider)) = objects.get(object) else {
        return Vec::new();
    };
    convex_parts(Pose::from(place), &collider.raw)
}
