//! Effort where it is needed: the solver settings of the next step, chosen from Rapier's state alone.
//!
//! The solver is most of a tick. An object that stands alone needs few sub-steps; one deep in a stack, or handled, needs many; a
//! landing needs many sweeps.

mod care;
mod depth;
mod engine;
mod foresight;
mod landing;
mod mode;
mod substeps;
mod touches;

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop_core::Held;

pub use care::Care;
pub use engine::Engine;
pub(crate) use engine::REACH;
pub(crate) use mode::PREDICTION;
pub(crate) use substeps::{BASE_SUBSTEPS, SUBSTEPS_OF_FREE, speed, substeps};
pub(crate) use touches::bodies_of;

use crate::{
    settings::PhysicsSettings,
    workarounds::{memory::forget, release::JustReleased},
};

pub(crate) fn configure_solver(
    mut contexts: Query<(
        &mut RapierContextSimulation,
        &RapierContextColliders,
        &mut RapierRigidBodySet,
        &RapierContextJoints,
    )>,
    released: Query<(), With<JustReleased>>,
    held: Query<&RapierRigidBodyHandle, With<Held>>,
    settings: Res<PhysicsSettings>,
    mut care: ResMut<Care>,
) {
    if !released.is_empty() {
        care.expect_landing();
    }
    for (mut simulation, colliders, mut bodies, joints) in &mut contexts {
        let simulation = &mut *simulation;
        forget(simulation, joints);
        let mut engine = Engine {
            parameters: &mut simulation.integration_parameters,
            islands: &mut simulation.islands,
            broad_phase: &simulation.broad_phase,
            narrow_phase: &simulation.narrow_phase,
            bodies: &mut bodies.bodies,
            colliders: &colliders.colliders,
            joints: &joints.impulse_joints,
            gravity: settings.gravity,
        };
        engine.wake_sleepers_in_the_way(held.iter().map(|handle| handle.0));
        care.spend(engine);
    }
}
