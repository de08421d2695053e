//! Twists: velocities of objects, for code that does not know Rapier.

use bevy::prelude::*;
use bevy_rapier3d::prelude::Velocity;
use tabletop_geometry::Twist;

/// Writes the twists of objects whose velocity has changed, by a step or by an undo.
pub(crate) fn note_twists(mut objects: Query<(&Velocity, &mut Twist), Changed<Velocity>>) {
    for (&Velocity { linear, angular }, mut twist) in &mut objects {
        twist.set_if_neq(Twist { linear, angular });
    }
}
