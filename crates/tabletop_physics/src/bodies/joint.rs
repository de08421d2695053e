//! Joints: what physics makes of the connections between objects.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop_core::{Joint, JointKind, ObjectSpec};

use crate::settings::PhysicsSettings;

/// How fast dry friction takes up speed, in 1/s: within a tick.
const FRICTION_RATE: f32 = 60.0;

/// The component of a joint's constraint.
pub(crate) fn add_joint(world: &mut World, entity: Entity, joint: &Joint) {
    let [first, second] = joint.objects;
    let gravity = world.resource::<PhysicsSettings>().gravity;
    let mass = world
        .get::<ObjectSpec>(second)
        .map_or(0.0, |spec| spec.mass);
    let constraint = constraint(joint, mass * gravity);
    world
        .entity_mut(entity)
        .insert_if_new(ImpulseJoint::new(first, constraint));
}

fn constraint(joint: &Joint, weight_of_second: f32) -> TypedJoint {
    let locked = match joint.kind {
        JointKind::Ball => JointAxesMask::LOCKED_SPHERICAL_AXES,
        JointKind::Slider { .. } => JointAxesMask::LOCKED_PRISMATIC_AXES,
    };
    let [first, second] = joint.frames;
    let mut constraint = GenericJointBuilder::new(locked)
        .local_anchor1(first.location)
        .local_basis1(first.rotation)
        .local_anchor2(second.location)
        .local_basis2(second.rotation)
        .build();
    constraint.set_contacts_enabled(false);
    if let JointKind::Slider { travel, friction } = joint.kind {
        constraint
            .set_limits(JointAxis::LinX, [-travel, 0.0])
            .set_motor_velocity(JointAxis::LinX, 0.0, FRICTION_RATE)
            .set_motor_max_force(JointAxis::LinX, friction * weight_of_second);
    }
    TypedJoint::GenericJoint(constraint)
}
