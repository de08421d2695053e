//! Joints: what physics makes of the connections between objects.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop_core::{Joint, JointKind, ObjectSpec, TICK_SECONDS};

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

/// How fast a damper takes up speed, in 1/s, that takes away a share of it in a tick.
fn rate(damping: f32) -> f32 {
    let left = (1.0 - damping).max(1e-4);
    damping / (left * TICK_SECONDS)
}

fn constraint(joint: &Joint, weight_of_second: f32) -> TypedJoint {
    let locked = match joint.kind {
        JointKind::Ball => JointAxesMask::LOCKED_SPHERICAL_AXES,
        JointKind::Slider { .. } => JointAxesMask::LOCKED_PRISMATIC_AXES,
        JointKind::Hinge { .. } => JointAxesMask::LOCKED_REVOLUTE_AXES,
    };
    let [first, second] = joint.frames;
    let mut constraint = GenericJointBuilder::new(locked)
        .local_anchor1(first.location)
        .local_basis1(first.rotation)
        .local_anchor2(second.location)
        .local_basis2(second.rotation)
        .build();
    constraint.set_contacts_enabled(joint.collides);
    match joint.kind {
        JointKind::Ball => {}
        JointKind::Slider {
            min,
            max,
            friction,
            damping,
        } => {
            constraint.set_limits(JointAxis::LinX, [-max, -min]);
            if friction > 0.0 {
                constraint
                    .set_motor_velocity(JointAxis::LinX, 0.0, FRICTION_RATE)
                    .set_motor_max_force(JointAxis::LinX, friction * weight_of_second);
            } else if damping > 0.0 {
                constraint.set_motor_velocity(JointAxis::LinX, 0.0, rate(damping));
            }
        }
        JointKind::Hinge { min, max, damping } => {
            constraint.set_limits(JointAxis::AngX, [min, max]);
            if damping > 0.0 {
                constraint.set_motor_velocity(JointAxis::AngX, 0.0, rate(damping));
            }
        }
    }
    TypedJoint::GenericJoint(constraint)
}
