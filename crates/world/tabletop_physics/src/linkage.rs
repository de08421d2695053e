//! Linkages: bodies that joints hold together, such as a pendulum.
//!
//! In each of Rapier's sub-steps a body moves along the directions that its joints left it in the sub-step before. The part of its velocity across
//! them is lost: a share of up to (ω dt)² of the energy, which is a quarter of a pendulum's swing in 10 s. A linkage that nothing touches, drives or
//! stops has the energy that it had, and gets it back.

use std::collections::BTreeMap;

use bevy::prelude::*;
use bevy_rapier3d::{
    prelude::{
        RapierConfiguration, RapierContextJoints, RapierContextSimulation,
        RapierImpulseJointHandle, RapierRigidBodySet,
    },
    rapier::prelude::{
        ImpulseJoint, ImpulseJointSet, NarrowPhase, RigidBody, RigidBodyHandle, RigidBodySet,
    },
};
use tabletop_core::TICK_SECONDS;

use crate::{effort::substeps, encounter::is_pressed};

/// The greatest share of its speed that a linkage loses in a sub-step, as a multiple of (ω dt)²: what is lost otherwise is not given back.
const MOST_LOST: f64 = 2.0;

/// The greatest rate, in 1/s, at which rotations die away in a linkage that swings: links of chains are to come to rest.
const MOST_DAMPING: f32 = 5.0;

/// The linkages that swing freely, before a step.
#[derive(Resource, Default)]
pub(crate) struct FreeLinkages(Vec<Linkage>);

/// Bodies that joints hold together.
#[derive(Clone, Debug)]
struct Linkage {
    /// The bodies that forces move, in the order of their handles.
    bodies: Vec<RigidBodyHandle>,
    /// Length of a sub-step in s.
    substep: f64,
    /// Its energy before the step, in kg units²/s².
    energy: f64,
}

/// True if anything hangs on joints.
pub(crate) fn is_any_jointed(joints: Query<(), With<RapierImpulseJointHandle>>) -> bool {
    !joints.is_empty()
}

/// Notes the linkages that swing freely, and their energies, before a step.
pub(crate) fn note_energies(
    contexts: Query<(
        &RapierConfiguration,
        &RapierContextJoints,
        &RapierRigidBodySet,
    )>,
    mut free: ResMut<FreeLinkages>,
) {
    free.0.clear();
    for (configuration, joints, set) in &contexts {
        let bodies = &set.bodies;
        for linkage in linkages(&joints.impulse_joints, bodies) {
            let counts = linkage.iter().map(|handle| substeps(&bodies[*handle]));
            let substep = f64::from(TICK_SECONDS) / counts.max().unwrap_or(1) as f64;
            let motion = Swing::of(&linkage, bodies, configuration.gravity, 0.0);
            free.0.push(Linkage {
                bodies: linkage,
                substep,
                energy: motion.energy(substep) - motion.damped,
            });
        }
    }
}

/// Gives linkages back what the step has taken from their energy.
pub(crate) fn give_back(
    mut contexts: Query<(
        &RapierConfiguration,
        &RapierContextSimulation,
        &RapierContextJoints,
        &mut RapierRigidBodySet,
    )>,
    free: Res<FreeLinkages>,
) {
    for (configuration, simulation, joints, mut set) in &mut contexts {
        let bodies = &mut set.bodies;
        for linkage in &free.0 {
            if !linkage.is_free_after(&simulation.narrow_phase, &joints.impulse_joints, bodies) {
                continue;
            }
            let motion = Swing::of(&linkage.bodies, bodies, configuration.gravity, TICK_SECONDS);
            let share = linkage.growth(&motion);
            if share <= 1.0 {
                continue;
            }
            for handle in &linkage.bodies {
                if let Some(body) = bodies.get_mut(*handle) {
                    let [linear, angular] = [body.linvel(), body.angvel()];
                    body.set_linvel(linear * share as f32, false);
                    body.set_angvel(angular * share as f32, false);
                }
            }
        }
    }
}

impl Linkage {
    /// True if nothing has touched it in the step, and no joint was at its end.
    fn is_free_after(
        &self,
        narrow_phase: &NarrowPhase,
        joints: &ImpulseJointSet,
        bodies: &RigidBodySet,
    ) -> bool {
        self.bodies.iter().all(|handle| {
            bodies.get(*handle).is_some_and(|body| {
                !is_pressed(body, narrow_phase)
                    && joints
                        .attached_joints(*handle)
                        .all(|(.., joint)| !is_at_its_end(joint))
            })
        })
    }

    /// The factor of its velocities that gives it the energy that it had, as far as the step can have taken it.
    fn growth(&self, after: &Swing) -> f64 {
        let Swing {
            kinetic,
            potential,
            power,
            fastest_turn,
            damped: _,
        } = *after;
        if kinetic <= 0.0 {
            return 1.0;
        }
        // kinetic factor² + power factor substep/2 + potential = energy
        let half = 0.25 * power * self.substep;
        let root = half * half + kinetic * (self.energy - potential);
        let factor = (root.max(0.0).sqrt() - half) / kinetic;
        let steps = f64::from(TICK_SECONDS) / self.substep;
        let most = 1.0 + MOST_LOST * steps * (fastest_turn * self.substep).powi(2);
        factor.clamp(1.0, most)
    }
}

/// The motion of a linkage. Units: kg, s and those of the world.
#[derive(Clone, Copy, Debug, Default)]
struct Swing {
    kinetic: f64,
    potential: f64,
    /// The most that joints lose in a step because the bodies were damped one by one.
    damped: f64,
    /// Of its weight.
    power: f64,
    fastest_turn: f64,
}

impl Swing {
    /// That of bodies before they were damped for a time, in s, as Rapier does at the end of a step.
    fn of(linkage: &[RigidBodyHandle], bodies: &RigidBodySet, gravity: Vec3, damped: f32) -> Self {
        let mut all = Self::default();
        for body in linkage.iter().filter_map(|handle| bodies.get(*handle)) {
            let mass = f64::from(body.mass());
            let weight = (gravity * body.gravity_scale()).as_dvec3() * mass;
            let linear = body.linvel() * (1.0 + damped * body.linear_damping());
            let angular = body.angvel() * (1.0 + damped * body.angular_damping());
            let [linear, angular] = [linear, angular].map(Vec3::as_dvec3);
            let properties = &body.mass_properties().local_mprops;
            let axes = body.rotation() * properties.principal_inertia_local_frame;
            let along = axes.as_dquat().inverse() * angular;
            let inertia = properties.principal_inertia().as_dvec3();
            let moving = 0.5 * mass * linear.length_squared();
            let turning = 0.5 * inertia.dot(along * along);
            let [slowing, dying] = [body.linear_damping(), body.angular_damping()]
                .map(|rate| f64::from(rate * TICK_SECONDS).powi(2));
            all.kinetic += moving + turning;
            all.damped += moving * slowing + turning * dying;
            all.potential -= weight.dot(body.center_of_mass().as_dvec3());
            all.power += weight.dot(linear);
            all.fastest_turn = all.fastest_turn.max(angular.length());
        }
        all
    }

    /// The energy that stays the same with sub-steps of this length, in s. Rapier's velocities are those of half a sub-step earlier.
    fn energy(self, substep: f64) -> f64 {
        self.kinetic + self.potential + 0.5 * substep * self.power
    }
}

/// A body that forces move, on joints.
#[derive(Clone, Debug)]
struct JointedBody {
    handle: RigidBodyHandle,
    /// The others at its joints.
    others: Vec<RigidBodyHandle>,
    /// True if no motor moves one of its joints, nor anything kinematic, and it is not to come to rest.
    is_conservative: bool,
}

/// The bodies of linkages that nothing drives or brings to rest, in the order of their handles.
fn linkages(joints: &ImpulseJointSet, bodies: &RigidBodySet) -> Vec<Vec<RigidBodyHandle>> {
    let mut jointed = jointed_bodies(joints, bodies);
    let mut linkages = Vec::new();
    while let Some((_, first)) = jointed.pop_first() {
        let mut linkage = vec![first.handle];
        let mut is_conservative = first.is_conservative;
        let mut ahead = first.others;
        while let Some(handle) = ahead.pop() {
            if let Some(next) = jointed.remove(&handle.into_raw_parts()) {
                linkage.push(handle);
                is_conservative &= next.is_conservative;
                ahead.extend(next.others);
            }
        }
        if is_conservative {
            linkage.sort_unstable_by_key(|handle| handle.into_raw_parts());
            linkages.push(linkage);
        }
    }
    linkages
}

/// By their handles.
fn jointed_bodies(
    joints: &ImpulseJointSet,
    bodies: &RigidBodySet,
) -> BTreeMap<(u32, u32), JointedBody> {
    let mut jointed = BTreeMap::new();
    for (_, joint) in joints.iter() {
        let ends = [joint.body1(), joint.body2()];
        let is_kinematic =
            |end: &RigidBodyHandle| bodies.get(*end).is_none_or(RigidBody::is_kinematic);
        let is_driven = !joint.data.motor_axes.is_empty() || ends.iter().any(is_kinematic);
        for [handle, other] in [ends, [ends[1], ends[0]]] {
            let Some(body) = bodies.get(handle).filter(|body| is_moved(body)) else {
                continue;
            };
            let jointed = jointed
                .entry(handle.into_raw_parts())
                .or_insert_with(|| JointedBody {
                    handle,
                    others: Vec::new(),
                    is_conservative: body.angular_damping() <= MOST_DAMPING,
                });
            jointed.others.push(other);
            jointed.is_conservative &= !is_driven;
        }
    }
    jointed
}

fn is_moved(body: &RigidBody) -> bool {
    body.is_dynamic() && body.is_enabled() && !body.is_sleeping()
}

/// True if a joint was stopped by its limits in the last step.
fn is_at_its_end(joint: &ImpulseJoint) -> bool {
    joint.data.limits.iter().any(|limit| limit.impulse != 0.0)
}
