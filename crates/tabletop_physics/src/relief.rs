//! Relief: what a step has pressed deep into something that does not move is put back to its surface.
//!
//! To the solver, a table is as heavy as a hand that presses something on it, and either may win. Here the table always does; the hand then
//! finds something in its way, and yields.

use std::collections::BTreeMap;

use bevy::prelude::*;
use bevy_rapier3d::{
    prelude::{
        RapierColliderHandle, RapierConfiguration, RapierContextColliders, RapierContextSimulation,
        RapierRigidBodySet, RigidBody,
    },
    rapier::prelude::{Collider, ColliderHandle, ColliderSet, ContactPair, RigidBodyHandle},
};
use tabletop_core::Pose;

use crate::geometry::{Convex, convex_parts, nearest};

/// Depth, in units, that is left to the solver.
const DEEPEST: f32 = 0.04;

/// Largest number of shifts after which a body is left where it is: the solids that it is in leave no room.
const MOST_SHIFTS: usize = 8;

/// Moves every body that is too deep in a fixed one along the shortest way out.
pub(crate) fn relieve(
    mut contexts: Query<(
        &RapierConfiguration,
        &RapierContextSimulation,
        &mut RapierContextColliders,
        &mut RapierRigidBodySet,
    )>,
    shapes: Query<(&RigidBody, &RapierColliderHandle)>,
) {
    let Ok((configuration, simulation, mut colliders, mut set)) = contexts.single_mut() else {
        return;
    };
    if !configuration.physics_pipeline_active {
        return;
    }
    let fixed = shapes
        .iter()
        .filter(|(body, _)| matches!(body, RigidBody::Fixed));
    let mut ways = BTreeMap::<_, Vec3>::new();
    for (_, &RapierColliderHandle(fixed)) in fixed {
        for pair in simulation.narrow_phase.contact_pairs_with(fixed) {
            if !is_deep(pair, &colliders.colliders) {
                continue;
            }
            let pressed = match pair.collider1 == fixed {
                true => pair.collider2,
                false => pair.collider1,
            };
            let body = colliders.colliders.get(pressed).and_then(Collider::parent);
            let way = way_out(pressed, fixed, &colliders.colliders);
            if let (Some(body), Some(way)) = (body, way) {
                let longest = ways.entry(body.into_raw_parts()).or_default();
                *longest = longer(*longest, way);
            }
        }
    }
    for ((number, generation), way) in ways {
        let body = RigidBodyHandle::from_raw_parts(number, generation);
        let body = set.bodies.get_mut(body).filter(|body| body.is_dynamic());
        let Some(body) = body else {
            continue;
        };
        body.set_translation(body.translation() + way, true);
        for &shape in body.colliders() {
            if let Some(shape) = colliders.colliders.get_mut(shape) {
                shape.set_translation(shape.translation() + way);
            }
        }
    }
}

/// The longer of two ways; of equal ones the same in any order.
fn longer(one: Vec3, other: Vec3) -> Vec3 {
    let key = |way: Vec3| [way.length_squared(), way.x, way.y, way.z];
    match key(one) < key(other) {
        true => other,
        false => one,
    }
}

/// True if the contacts that a step began with were too deep, or have become so in it: what rolls is soon touched elsewhere.
fn is_deep(pair: &ContactPair, colliders: &ColliderSet) -> bool {
    let pose = |collider| colliders.get(collider).map(Collider::position);
    let (Some(first), Some(second)) = (pose(pair.collider1), pose(pair.collider2)) else {
        return false;
    };
    let mut manifolds = pair.manifolds.iter();
    manifolds.any(|manifold| {
        let first = manifold.subshape_pos1().map_or(*first, |part| first * part);
        let second = manifold
            .subshape_pos2()
            .map_or(*second, |part| second * part);
        let normal = first.rotation * manifold.local_n1;
        let gap = |own: Vec3, other: Vec3| (second * other - first * own).dot(normal);
        let mut points = manifold.points.iter();
        points.any(|point| point.dist.min(gap(point.local_p1, point.local_p2)) < -DEEPEST)
    })
}

/// The shortest way, in units, on which a shape leaves another one but for the depth that it may have. `None` if there is none.
fn way_out(
    pressed: ColliderHandle,
    fixed: ColliderHandle,
    colliders: &ColliderSet,
) -> Option<Vec3> {
    let [pressed, fixed] = [pressed, fixed].map(|shape| colliders.get(shape).map(parts));
    let (pressed, fixed) = (pressed?, fixed?);
    let mut way = Vec3::ZERO;
    for _ in 0..MOST_SHIFTS {
        let deepest = nearest(&pressed, Pose::at(way), &fixed, 0.0)
            .min_by(|one, other| one.distance.total_cmp(&other.distance))
            .filter(|nearest| nearest.distance < -DEEPEST);
        let Some(deepest) = deepest else {
            return (way != Vec3::ZERO && way.is_finite()).then_some(way);
        };
        way += deepest.away * (-DEEPEST - deepest.distance);
    }
    None
}

fn parts(shape: &Collider) -> Vec<Convex> {
    let at = shape.position();
    convex_parts(Pose::new(at.translation, at.rotation), shape.shared_shape())
}
