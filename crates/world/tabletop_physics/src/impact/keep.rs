//! Bodies in flight keep their speed when their sub-steps change.

use bevy::prelude::*;
use bevy_rapier3d::{
    prelude::{RapierConfiguration, RapierContextSimulation, RapierRigidBodySet},
    rapier::prelude::{ContactPair, NarrowPhase, RigidBody, RigidBodyHandle, RigidBodySet},
};
use tabletop_core::TICK_SECONDS;

use crate::effort::substeps;

/// The numbers of sub-steps of the awake bodies in the last step.
#[derive(Resource, Default)]
pub(crate) struct SubstepsBefore(Vec<(RigidBodyHandle, usize)>);

/// Notes the numbers of sub-steps, before those of the next step are chosen.
pub(crate) fn note_substeps(
    contexts: Query<(&RapierContextSimulation, &RapierRigidBodySet)>,
    mut before: ResMut<SubstepsBefore>,
) {
    before.0.clear();
    for (simulation, set) in &contexts {
        let awake = simulation.islands.active_bodies();
        let awake = awake.filter_map(|handle| Some((handle, set.bodies.get(handle)?)));
        let moved = awake.filter(|(_, body)| body.is_dynamic());
        before
            .0
            .extend(moved.map(|(handle, body)| (handle, substeps(body))));
    }
    // Rapier's own order depends on undone segments.
    before
        .0
        .sort_unstable_by_key(|(handle, _)| handle.into_raw_parts());
}

/// Lets bodies in flight keep their speed. Rapier's velocities are those of half a sub-step earlier: with other sub-steps, the same one is another.
pub(crate) fn keep_speed(
    mut contexts: Query<(
        &RapierConfiguration,
        &RapierContextSimulation,
        &mut RapierRigidBodySet,
    )>,
    before: Res<SubstepsBefore>,
) {
    for (configuration, simulation, mut set) in &mut contexts {
        for &(handle, before) in &before.0 {
            let bodies = &set.bodies;
            let Some(body) = bodies.get(handle) else {
                continue;
            };
            let now = substeps(body);
            let gravity = configuration.gravity * body.gravity_scale();
            if now == before || !flies(body, bodies, &simulation.narrow_phase, gravity.length()) {
                continue;
            }
            let earlier = [before, now].map(|substeps| 0.5 * TICK_SECONDS / substeps as f32);
            let velocity = body.linvel() + gravity * (earlier[0] - earlier[1]);
            if let Some(body) = set.bodies.get_mut(handle) {
                body.set_linvel(velocity, false);
            }
        }
    }
}

/// True if nothing has pressed on a body in the last step, or it leaves what has for longer than a tick.
fn flies(
    body: &RigidBody,
    bodies: &RigidBodySet,
    narrow_phase: &NarrowPhase,
    gravity: f32,
) -> bool {
    let shapes = body.colliders().iter();
    let mut pairs = shapes.flat_map(|shape| narrow_phase.contact_pairs_with(*shape));
    pairs.all(|pair| {
        pair.total_impulse_magnitude() == 0.0
            || slowest_parting(pair, bodies) > 0.5 * gravity * TICK_SECONDS
    })
}

/// The least speed, in units/s, with which two bodies part in a point.
fn slowest_parting(pair: &ContactPair, bodies: &RigidBodySet) -> f32 {
    let partings = pair.solver_manifolds().iter().flat_map(|manifold| {
        let data = &manifold.data;
        let both = [data.rigid_body1, data.rigid_body2].map(|body| bodies.get(body?));
        let velocity = move |side: usize, arm: Vec3| {
            let body = both[side].filter(|body| body.is_dynamic());
            body.map_or(Vec3::ZERO, |body| body.linvel() + body.angvel().cross(arm))
        };
        manifold.points.iter().map(move |point| {
            let velocities =
                velocity(1, point.data.solver_dp2) - velocity(0, point.data.solver_dp1);
            velocities.dot(data.normal)
        })
    });
    partings.fold(f32::INFINITY, f32::min)
}
