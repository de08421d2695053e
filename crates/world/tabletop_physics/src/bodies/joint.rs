//! Joints: constraints between the bodies of objects.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop_core::{Joint, JointKind, ObjectSpec, TICK_SECONDS};
use tabletop_geometry::Pose;

use super::mass::mass_properties;
use crate::settings::PhysicsSettings;

/// Rate at which dry friction takes up speed, in 1/s: within a tick.
const FRICTION_RATE: f32 = 60.0;

/// Speed at which the spring of shears opens them, in rad/s.
const SPRING_RATE: f32 = 5.0;

/// How long, in s, a cap takes to come up: so long that a tick sees it down.
const RETURN_SECONDS: f32 = 0.15;

/// The component of a joint's constraint.
pub(crate) fn add_joint(world: &mut World, entity: Entity, joint: &Joint) {
    let [first, second] = joint.objects;
    let gravity = world.resource::<PhysicsSettings>().gravity;
    let load = world
        .get::<ObjectSpec>(second)
        .map_or(JointLoad::default(), |spec| JointLoad {
            weight: spec.mass * gravity,
            inertia: inertia_about_x(spec, joint.frames[1]),
        });
    let constraint = constraint(joint, load);
    world
        .entity_mut(entity)
        .insert_if_new(ImpulseJoint::new(first, constraint));
}

/// The load of the second object on a joint.
#[derive(Clone, Copy, Default)]
struct JointLoad {
    /// Its weight, in kg units/s².
    weight: f32,
    /// Its moment of inertia about the joint's X, in kg units².
    inertia: f32,
}

fn inertia_about_x(spec: &ObjectSpec, frame: Pose) -> f32 {
    let properties = mass_properties(&spec.shape, spec.mass);
    let axis = frame.rotation * Vec3::X;
    let in_principal = properties.principal_inertia_local_frame.inverse() * axis;
    let own = (in_principal * in_principal).dot(properties.principal_inertia);
    own + spec.mass * frame.location.reject_from(axis).length_squared()
}

/// Rate, in 1/s, of a damper that takes away this share of the speed in a tick.
fn rate(damping: f32) -> f32 {
    let left = (1.0 - damping).max(1e-4);
    damping / (left * TICK_SECONDS)
}

fn constraint(joint: &Joint, load: JointLoad) -> TypedJoint {
    let locked = match joint.kind {
        JointKind::Ball => JointAxesMask::LOCKED_SPHERICAL_AXES,
        JointKind::Slider { .. } | JointKind::PushButton { .. } => {
            JointAxesMask::LOCKED_PRISMATIC_AXES
        }
        JointKind::Hinge { .. } | JointKind::Shears { .. } => JointAxesMask::LOCKED_REVOLUTE_AXES,
        JointKind::Fixed => JointAxesMask::LOCKED_FIXED_AXES,
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
        JointKind::Ball | JointKind::Fixed => {}
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
                    .set_motor_max_force(JointAxis::LinX, friction * load.weight);
            } else if damping > 0.0 {
                constraint.set_motor_velocity(JointAxis::LinX, 0.0, rate(damping));
            }
        }
        JointKind::Hinge { min, max, damping } => {
            constraint.set_limits(JointAxis::AngX, [min, max]);
            if damping > 0.0 {
                // Rapier scales the motors of angles with the inertia about the body's centre, not about the hinge.
                constraint
                    .set_motor_model(JointAxis::AngX, MotorModel::ForceBased)
                    .set_motor_velocity(JointAxis::AngX, 0.0, rate(damping) * load.inertia);
            }
        }
        JointKind::Shears { min, max } => {
            let stiffness = SPRING_RATE * SPRING_RATE * load.inertia;
            constraint
                .set_limits(JointAxis::AngX, [min, max])
                .set_motor_model(JointAxis::AngX, MotorModel::ForceBased)
                .set_motor_position(JointAxis::AngX, max, stiffness, SPRING_RATE * load.inertia);
        }
        JointKind::PushButton { travel, stiffness } => {
            let damping = stiffness * RETURN_SECONDS;
            constraint
                .set_limits(JointAxis::LinX, [-travel, 0.0])
                .set_motor_model(JointAxis::LinX, MotorModel::ForceBased)
                .set_motor_position(JointAxis::LinX, travel, stiffness, damping);
        }
    }
    TypedJoint::GenericJoint(constraint)
}
