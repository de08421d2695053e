//! Flat landings.

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::bounding_volume::BoundingVolume,
    rapier::prelude::{ColliderHandle, QueryFilter, RigidBody, RigidBodyHandle},
};

use super::{engine::Engine, substeps::speed};

/// Speed, in units/s and rad/s together, below which a landing body does not slide.
const LANDING_SPEED: f32 = 1.0;

/// Distance from the way of a body, in units, within which something may be hit.
const MARGIN: f32 = 0.02;

/// Cosine of the angle, some 2.5°, within which faces are parallel.
const PARALLEL: f32 = 0.999;

/// Speed, in units/s, at which a body may hit something flat in the next step; 0 if it does not.
pub(crate) fn landing_speed(engine: &Engine, handle: RigidBodyHandle) -> f32 {
    let body = &engine.bodies[handle];
    if speed(body) < LANDING_SPEED {
        return 0.0;
    }
    let near = engine.broad_phase.as_query_pipeline(
        engine.narrow_phase.query_dispatcher(),
        engine.bodies,
        engine.colliders,
        QueryFilter::default().exclude_rigid_body(handle),
    );
    let dt = engine.parameters.dt;
    let next = body.predict_position_using_velocity_and_forces(dt);
    let margin = engine.gravity * dt * dt + MARGIN;
    let lands = body.colliders().iter().any(|shape| {
        let way = engine.colliders[*shape].compute_swept_aabb(&next);
        near.intersect_aabb_conservative(way.loosened(margin))
            .any(|(other, _)| {
                engine.meets(body, other)
                    && engine.are_aligned(*shape, other)
                    && !engine.presses(*shape, other)
            })
    });
    if lands {
        engine.fastest_point(body)
    } else {
        0.0
    }
}

impl Engine<'_> {
    /// True if a body moves against the body of a shape.
    fn meets(&self, body: &RigidBody, other: ColliderHandle) -> bool {
        let other = self.colliders[other].parent();
        let other = other.and_then(|other| self.bodies.get(other));
        let (linear, angular) = other.map_or_else(default, |it| (it.linvel(), it.angvel()));
        let closing = (body.linvel() - linear).length() + (body.angvel() - angular).length();
        closing >= LANDING_SPEED
    }

    /// True if an axis of a shape is parallel to one of another, so that a face may hit a face.
    fn are_aligned(&self, shape: ColliderHandle, other: ColliderHandle) -> bool {
        let [first, second] = [shape, other].map(|it| self.colliders[it].rotation());
        are_aligned(first, second)
    }

    /// True if two shapes press on each other.
    fn presses(&self, shape: ColliderHandle, other: ColliderHandle) -> bool {
        let pair = self.narrow_phase.contact_pair(shape, other);
        pair.is_some_and(|pair| pair.total_impulse_magnitude() > 0.0)
    }
}

fn are_aligned(first: Quat, second: Quat) -> bool {
    let axes = |rotation: Quat| Vec3::AXES.map(|axis| rotation * axis);
    let second = axes(second);
    let pairs = axes(first)
        .into_iter()
        .flat_map(|a| second.map(|b| a.dot(b)));
    pairs.map(f32::abs).any(|cosine| cosine > PARALLEL)
}

#[cfg(test)]
mod tests {
    use std::f32::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn faces_are_parallel_whichever_axes_they_have() {
        let yawed = Quat::from_rotation_z(0.4);
        assert!(are_aligned(yawed, Quat::IDENTITY));
        assert!(are_aligned(
            yawed * Quat::from_rotation_x(FRAC_PI_2),
            Quat::IDENTITY
        ));
        assert!(!are_aligned(
            yawed * Quat::from_rotation_x(0.4),
            Quat::IDENTITY
        ));
    }
}
