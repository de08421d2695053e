//! Bodies that take part in Rapier's steps, or not.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;

/// Lets bodies take part in Rapier's steps from now on, or not. The plugin does as they are marked only in ticks that are not paused, and
/// forgets marks that were taken away during longer pauses, so Rapier is told at once.
///
/// # Errors
///
/// The world has no Rapier context.
pub fn set_enabled(world: &mut World, bodies: &[Entity], enabled: bool) -> Result {
    for &body in bodies {
        let mut body = world.entity_mut(body);
        if !body.contains::<Collider>() {
            continue;
        }
        if enabled {
            body.remove::<RigidBodyDisabled>();
        } else {
            body.insert(RigidBodyDisabled);
        }
    }
    let mut contexts =
        world.query_filtered::<&mut RapierRigidBodySet, With<DefaultRapierContext>>();
    let mut set = contexts.single_mut(world)?;
    for body in bodies {
        let handle = set.entity2body().get(body).copied();
        if let Some(body) = handle.and_then(|handle| set.bodies.get_mut(handle)) {
            body.set_enabled(enabled);
        }
    }
    Ok(())
}
