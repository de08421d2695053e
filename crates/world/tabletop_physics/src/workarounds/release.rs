//! The tick after a release.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop_core::SimTick;

/// An object that was let go of in this tick.
///
/// Rapier finds the support of a body only after the body has moved, so an object released at rest would fall freely for a
/// tick, into the thing below it. Instead it sinks for a tick by next to nothing, and falls from then on.
#[derive(Component, Clone, Copy, Debug, Reflect)]
#[reflect(Component)]
pub struct JustReleased {
    /// The tick.
    pub at: SimTick,
}

/// Speed at which it sinks in that tick, in units/s.
const SETTLING_SPEED: f32 = 1e-3;

/// The components of an object that is let go of in a tick.
pub(crate) fn settling(at: SimTick) -> impl Bundle {
    (
        GravityScale(0.0),
        Velocity::linear(Vec3::NEG_Z * SETTLING_SPEED),
        JustReleased { at },
    )
}

/// Lets objects fall that were released in the tick before. An object that undo has put back into the tick of its release waits.
pub(crate) fn let_fall(
    mut released: Query<(Entity, &JustReleased, &mut GravityScale)>,
    tick: Res<SimTick>,
    mut commands: Commands,
) {
    for (object, released, mut gravity) in &mut released {
        if released.at < *tick {
            gravity.0 = 1.0;
            commands.entity(object).remove::<JustReleased>();
        }
    }
}
