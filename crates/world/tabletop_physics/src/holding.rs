//! Holding and releasing of bodies.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop_core::{Held, Joint, Manipulator, ObjectSpec, SimTick, TICK_SECONDS};
use tabletop_geometry::Pose;

use crate::{
    mover::limits::FASTEST,
    workarounds::{
        release::{JustReleased, settling},
        short_turn::short_turn,
    },
};

/// Lets hands and links be met when they are there, and not ahead. Seen from afar, the edge of a finger that goes down beside a block is a slope
/// that would push the block aside.
pub const MET_WHEN_THERE: SoftCcd = SoftCcd { prediction: 1e-6 };

/// Part of the way to its target by which a jointed object is pulled in a tick.
const PULLED_PER_TICK: f32 = 0.25;

/// The way in which a held object follows its holder.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[reflect(Component)]
pub enum Carry {
    /// It goes exactly where its [`Transform`] says; no force moves it.
    Freely,
    /// It is pulled towards its target, as far as its joints allow.
    AgainstJoints,
}

/// Gives an object to a holder. Returns how it is carried.
pub fn hold(world: &mut World, object: Entity, by: Manipulator) -> Carry {
    let is_jointed = world
        .query::<&Joint>()
        .iter(world)
        .any(|joint| joint.objects.contains(&object));
    let mut object = world.entity_mut(object);
    let is_fixed = object.get().is_some_and(ObjectSpec::is_fixed);
    let carry = match is_jointed && !is_fixed {
        true => Carry::AgainstJoints,
        false => Carry::Freely,
    };
    object.insert((Held { by }, carry)).remove::<JustReleased>();
    match carry {
        Carry::Freely => object.insert((RigidBody::KinematicPositionBased, MET_WHEN_THERE)),
        Carry::AgainstJoints => object.insert(GravityScale(0.0)),
    };
    if carry == Carry::AgainstJoints && object.get() != Some(&RigidBody::Dynamic) {
        object.insert(RigidBody::Dynamic);
    }
    carry
}

/// Releases an object, at rest. It then has no holder.
pub fn let_go(world: &mut World, object: Entity) {
    let at = *world.resource::<SimTick>();
    let mut object = world.entity_mut(object);
    object
        .remove::<(Held, Carry)>()
        .insert(SoftCcd { prediction: 0.0 });
    let is_fixed = object.get().is_some_and(ObjectSpec::is_fixed);
    if is_fixed {
        object.insert(RigidBody::Fixed);
    } else {
        object.insert((RigidBody::Dynamic, settling(at)));
    }
}

/// The velocity that pulls a jointed object to its target.
pub fn pull_velocity(here: Pose, target: Pose) -> Velocity {
    let per_second = PULLED_PER_TICK / TICK_SECONDS;
    let turn = short_turn(here.rotation, target.rotation);
    Velocity {
        linear: ((target.location - here.location) * per_second).clamp_length_max(FASTEST.0),
        angular: (turn * per_second).clamp_length_max(FASTEST.1),
    }
}

/// Makes an object faster: by a velocity of its centre of mass, in units/s, and by an angular velocity, in rad/s.
pub fn push(world: &mut World, object: Entity, linear: Vec3, angular: Vec3) {
    if let Some(mut velocity) = world.get_mut::<Velocity>(object) {
        velocity.linear += linear;
        velocity.angular += angular;
    }
}

/// Puts an object at another pose at once, at rest.
pub fn put(world: &mut World, object: Entity, pose: Pose) {
    let mut object = world.entity_mut(object);
    object.insert(Transform::from(pose));
    if let Some(mut velocity) = object.get_mut::<Velocity>() {
        *velocity = Velocity::default();
    }
    if let Some(mut sleeping) = object.get_mut::<Sleeping>() {
        sleeping.sleeping = false;
    }
}
