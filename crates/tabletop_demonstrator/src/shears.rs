//! Scissors in a hand.

use bevy::prelude::*;
use bevy_rapier3d::prelude::Velocity;
use tabletop_core::{Joint, JointKind, Pose};

/// Speed at which a hand closes scissors, in rad/s: against their spring, in a tenth of a second.
const SWING: f32 = 15.0;

/// The joint of the scissors that an object is a blade of.
pub(crate) fn shears_of(world: &mut World, blade: Entity) -> Option<Joint> {
    let is_of_blade = |joint: &&Joint| {
        matches!(joint.kind, JointKind::Shears { .. }) && joint.objects.contains(&blade)
    };
    let mut joints = world.query::<&Joint>();
    joints.iter(world).find(is_of_blade).copied()
}

/// Lets the other blade swing towards the held one.
pub(crate) fn swing_shut(world: &mut World, shears: Joint, held: Entity) {
    let [first, second] = shears.objects;
    let is_first_held = first == held;
    let other = if is_first_held { second } else { first };
    let frame = shears.frames[usize::from(is_first_held)];
    let Some(place) = world.get::<Transform>(other).map(Pose::from) else {
        return;
    };
    let hinge = place * frame;
    // The second blade closes against its axis, the first along it.
    let closing = if is_first_held { -SWING } else { SWING };
    let turn = hinge.rotation * Vec3::X * closing;
    if let Some(mut velocity) = world.get_mut::<Velocity>(other) {
        velocity.angular += turn;
        velocity.linear += turn.cross(place.location - hinge.location);
    }
}
