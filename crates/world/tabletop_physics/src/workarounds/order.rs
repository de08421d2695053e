//! The order of changes: that of Rapier's handles.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;

use super::outside::{ChangedBody, ChangedCollider};

/// Sorts the changed bodies that are noted in Rapier. The plugin notes them in the order in which Bevy stores entities, which depends on the whole
/// history, undone or not; Rapier wakes bodies and finds their pairs in the noted order.
pub(crate) fn note_changes(
    changed_bodies: Query<&RapierRigidBodyHandle, ChangedBody>,
    changed_colliders: Query<&RapierColliderHandle, ChangedCollider>,
    mut contexts: Query<
        (&mut RapierRigidBodySet, &mut RapierContextColliders),
        With<DefaultRapierContext>,
    >,
) {
    let Ok((mut bodies, mut colliders)) = contexts.single_mut() else {
        return;
    };
    let mut handles: Vec<_> = changed_colliders.iter().map(|handle| handle.0).collect();
    handles.sort_unstable_by_key(|handle| handle.into_raw_parts());
    for handle in handles {
        colliders.colliders.get_mut(handle);
    }
    let mut handles: Vec<_> = changed_bodies.iter().map(|handle| handle.0).collect();
    handles.sort_unstable_by_key(|handle| handle.into_raw_parts());
    for handle in handles {
        bodies.bodies.get_mut(handle);
    }
}
