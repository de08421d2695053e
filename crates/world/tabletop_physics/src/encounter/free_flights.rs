//! The ways of the bodies in the next step.

use std::{
    collections::BTreeMap,
    sync::{Mutex, PoisonError},
};

use bevy::prelude::*;
use bevy_rapier3d::{
    prelude::{
        RapierConfiguration, RapierContextColliders, RapierContextJoints, RapierContextSimulation,
        RapierRigidBodySet,
    },
    rapier::prelude::{
        ActiveHooks, ColliderHandle, ContactManifold, NarrowPhase, RigidBody, RigidBodyHandle,
        RigidBodySet,
    },
};

use super::free_flight::FreeFlight;
use crate::effort::REACH;

/// Speed, in units/s, of the fastest point of a body from which it is looked where it touches others. Below it, the nearest points hardly move in a
/// tick, and Rapier keeps those of bodies that move less than 0.05 units/s.
const LEAST_SPEED: f32 = 0.5;

/// The ways of the bodies that forces move, and the encounters on them.
#[derive(Resource, Default)]
pub(crate) struct FreeFlights {
    /// The accelerations of the bodies without joints, by the numbers of their handles, in units/s².
    accelerations: BTreeMap<u32, Vec3>,
    /// True if Rapier merges the contacts of compound bodies: it is not known which parts touch.
    pub(super) clusters: bool,
    /// Written while Rapier looks for contacts, in which it lends itself for reading only.
    encounters: Mutex<BTreeMap<Place, Encounter>>,
}

/// An encounter of two solids.
#[derive(Clone, Debug)]
pub(crate) struct Encounter {
    /// The points of touch from both bodies' centres of mass, each with the number of its point in the manifold.
    pub arms: Vec<(u32, [Vec3; 2])>,
    /// True if Rapier has pushed the bodies in other points: it pushes both in the same one, and they touch where they have not been before.
    pub is_skewed: bool,
}

impl Encounter {
    /// The arms of a point of the manifold.
    pub(crate) fn arms_of(&self, point: u32) -> Option<[Vec3; 2]> {
        let found = self.arms.iter().find(|(number, _)| *number == point);
        found.map(|(_, arms)| *arms)
    }
}

/// Two colliders, and a part of each.
type Place = [(u32, u32); 2];

impl FreeFlights {
    /// The way of a body; `None` if it is moved by a hand, a robot or joints.
    pub(super) fn of(
        &self,
        body: Option<RigidBodyHandle>,
        bodies: &RigidBodySet,
    ) -> Option<FreeFlight> {
        let Some((handle, body)) = body.and_then(|handle| Some((handle, bodies.get(handle)?)))
        else {
            return Some(FreeFlight::STILL);
        };
        if body.is_fixed() || body.is_dynamic() && body.is_sleeping() {
            return Some(FreeFlight::STILL);
        }
        let number = handle.into_raw_parts().0;
        let acceleration = self.accelerations.get(&number)?;
        Some(FreeFlight::of(body, *acceleration))
    }

    /// The encounter of the last step whose contacts are those of a manifold.
    pub(crate) fn encounter(
        &self,
        colliders: [ColliderHandle; 2],
        manifold: &ContactManifold,
    ) -> Option<Encounter> {
        let encounters = self
            .encounters
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        encounters.get(&place(colliders, manifold)).cloned()
    }

    /// True if any body is fast.
    pub(crate) fn is_any(&self) -> bool {
        !self.accelerations.is_empty()
    }

    /// True if Rapier has pushed any bodies elsewhere than where they meet.
    pub(crate) fn is_any_skewed(&self) -> bool {
        let encounters = self
            .encounters
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        encounters.values().any(|encounter| encounter.is_skewed)
    }

    pub(super) fn note(
        &self,
        colliders: [ColliderHandle; 2],
        manifold: &ContactManifold,
        encounter: Encounter,
    ) {
        let mut encounters = self
            .encounters
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        encounters.insert(place(colliders, manifold), encounter);
    }
}

fn place(colliders: [ColliderHandle; 2], manifold: &ContactManifold) -> Place {
    let [first, second] = colliders.map(|collider| collider.into_raw_parts().0);
    [(first, manifold.subshape1), (second, manifold.subshape2)]
}

/// Notes the ways of bodies before a step, and lets Rapier ask about the contacts of those that are fast.
pub(crate) fn look_ahead(
    mut contexts: Query<(
        &RapierConfiguration,
        &RapierContextSimulation,
        &mut RapierContextColliders,
        &RapierRigidBodySet,
        &RapierContextJoints,
    )>,
    mut ways: ResMut<FreeFlights>,
) {
    let FreeFlights {
        accelerations,
        clusters,
        encounters,
    } = &mut *ways;
    accelerations.clear();
    encounters
        .get_mut()
        .unwrap_or_else(PoisonError::into_inner)
        .clear();
    for (configuration, simulation, mut colliders, set, joints) in &mut contexts {
        *clusters = simulation.integration_parameters.contact_clustering;
        let awake = simulation.islands.active_bodies();
        let awake = awake.filter_map(|handle| Some((handle, set.bodies.get(handle)?)));
        let awake: Vec<_> = awake.filter(|(_, body)| body.is_dynamic()).collect();
        let is_jointed = |handle| {
            joints
                .impulse_joints
                .attached_joints(handle)
                .next()
                .is_some()
        };
        let mut is_any_fast = false;
        for (handle, body) in &awake {
            let asks = is_fast(body) && !is_jointed(*handle);
            is_any_fast |= asks;
            for shape in body.colliders() {
                ask(&mut colliders, *shape, asks);
            }
        }
        if !is_any_fast {
            continue;
        }
        for (handle, body) in awake {
            if !is_jointed(handle) {
                let falls = !is_pressed(body, &simulation.narrow_phase);
                let gravity = if falls {
                    configuration.gravity
                } else {
                    Vec3::ZERO
                };
                let number = handle.into_raw_parts().0;
                accelerations.insert(number, gravity * body.gravity_scale());
            }
        }
    }
}

fn is_fast(body: &RigidBody) -> bool {
    body.linvel().length() + REACH * body.angvel().length() > LEAST_SPEED
}

/// True if something pressed on a body in the last step: what it lies on keeps it from falling.
pub(crate) fn is_pressed(body: &RigidBody, narrow_phase: &NarrowPhase) -> bool {
    let shapes = body.colliders().iter();
    let mut pairs = shapes.flat_map(|shape| narrow_phase.contact_pairs_with(*shape));
    pairs.any(|pair| pair.total_impulse_magnitude() > 0.0)
}

/// Lets Rapier ask about the contacts of a shape, or no longer.
fn ask(colliders: &mut Mut<RapierContextColliders>, shape: ColliderHandle, asks: bool) {
    let wanted = match asks {
        true => ActiveHooks::MODIFY_SOLVER_CONTACTS,
        false => ActiveHooks::empty(),
    };
    let known = colliders.colliders.get(shape);
    if known.is_some_and(|known| known.active_hooks() != wanted)
        && let Some(shape) = colliders.colliders.get_mut(shape)
    {
        shape.set_active_hooks(wanted);
    }
}
