//! What the fingers touch.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop_core::{Arm, ObjectIndex, Robot};

use crate::{
    grips::Grips,
    parts::Parts,
    skeleton::{Carrier, Skeleton},
};

/// Distance, in units, at which something is touched.
const TOUCHING: f32 = 0.01;

/// Notes what the grippers hold and what each finger touches; what a gripper holds, both of its fingers touch.
pub(crate) fn feel(
    skeleton: Res<Skeleton>,
    parts: Res<Parts>,
    grips: Res<Grips>,
    index: Res<ObjectIndex>,
    rapier: ReadRapierContext,
    mut robot: ResMut<Robot>,
) -> Result {
    let rapier = rapier.single()?;
    let mut touches: [[Vec<Entity>; 2]; 2] = default();
    for (body, &part) in skeleton.bodies.iter().zip(&parts.0) {
        let Carrier::Gripper(arm, side) = body.carrier else {
            continue;
        };
        let touched = &mut touches[arm as usize][usize::from(side > 0)];
        if robot.is_shown {
            touched.extend(touched_by(&rapier, part));
        }
        touched.extend(grips.of(arm).iter().map(|grip| grip.object));
    }
    for arm in Arm::BOTH {
        let holds = grips.of(arm).iter().map(|grip| grip.object);
        if !robot.arm(arm).holds.iter().copied().eq(holds.clone()) {
            robot.arms[arm as usize].holds = holds.collect();
        }
        let touches = std::mem::take(&mut touches[arm as usize]).map(|touched| {
            // In the order of their creation.
            let objects = index.iter();
            objects.filter(|object| touched.contains(object)).collect()
        });
        if robot.arm(arm).touches != touches {
            robot.arms[arm as usize].touches = touches;
        }
    }
    Ok(())
}

/// What touches a finger.
fn touched_by(rapier: &RapierContext, finger: Entity) -> Vec<Entity> {
    rapier
        .simulation
        .contact_pairs_with(rapier.colliders, rapier.rigidbody_set, finger)
        .filter(|pair| {
            pair.manifolds()
                .any(|manifold| manifold.points().any(|point| point.dist() < TOUCHING))
        })
        .filter_map(|pair| match (pair.collider1(), pair.collider2()) {
            (Some(a), other) if a == finger => other,
            (other, _) => other,
        })
        .collect()
}
