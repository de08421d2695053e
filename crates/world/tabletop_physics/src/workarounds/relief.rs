//! Relief, or depenetration: a body that a step has pressed deep into a fixed one is put back to its surface.
//!
//! To the solver, a table is as heavy as a hand that presses something on it, and either may win. Here the table always does; the hand then
//! finds something in its way, and yields.

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::bounding_volume::Aabb,
    prelude::{
        RapierConfiguration, RapierContextColliders, RapierContextJoints, RapierContextSimulation,
        RapierRigidBodySet,
    },
    rapier::prelude as rapier,
    rapier::prelude::{Collider, ColliderHandle, ColliderSet, ContactPair, QueryFilter},
};
use tabletop_geometry::Pose;

use crate::{
    effort::REACH,
    geometry::{Convex, placed_parts, pushed_out},
};

/// Depth, in units, that is left to the solver.
const DEEPEST: f32 = 0.04;

/// Depth, in units, to which a deeper body is lifted: a little less, so that rounding does not make it too deep again.
const LIFTED: f32 = 0.035;

/// Way of a body in a step, in units, from which it may penetrate a body that it did not touch before.
const QUICK: f32 = 0.01;

/// Moves every body that is too deep in fixed ones along the shortest way out.
pub(crate) fn relieve(
    mut contexts: Query<(
        &RapierConfiguration,
        &RapierContextSimulation,
        &mut RapierContextColliders,
        &mut RapierRigidBodySet,
        &RapierContextJoints,
    )>,
    places: Query<&Transform>,
) {
    let Ok((configuration, simulation, mut colliders, mut set, joints)) = contexts.single_mut()
    else {
        return;
    };
    if !configuration.physics_pipeline_active {
        return;
    }
    let relief = Relief {
        simulation,
        colliders: &colliders.colliders,
        bodies: &set.bodies,
        joints: &joints.impulse_joints,
    };
    let awake = simulation.islands.active_bodies();
    let pressed = awake.filter_map(|handle| {
        let body = relief.bodies.get(handle).filter(|body| body.is_dynamic())?;
        let before = set
            .rigid_body_entity(handle)
            .and_then(|entity| places.get(entity).ok())?;
        let obstacles = relief.obstacles(handle, body, before);
        if obstacles.is_empty() {
            return None;
        }
        let way = relief.way_out(body, &obstacles)?;
        Some((handle, way))
    });
    let mut pressed: Vec<_> = pressed.collect();
    // Rapier notes changed bodies in the order of their changes; its order of awake bodies depends on undone segments.
    pressed.sort_unstable_by_key(|(handle, _)| handle.into_raw_parts());
    for (handle, way) in pressed {
        let Some(body) = set.bodies.get_mut(handle) else {
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

/// Depenetration of bodies, from the state of Rapier after a step.
struct Relief<'a> {
    simulation: &'a RapierContextSimulation,
    colliders: &'a ColliderSet,
    bodies: &'a rapier::RigidBodySet,
    joints: &'a rapier::ImpulseJointSet,
}

impl Relief<'_> {
    /// The fixed shapes in which a body may be too deep, in the order of their handles. `before` is its pose before the step.
    fn obstacles(
        &self,
        handle: rapier::RigidBodyHandle,
        body: &rapier::RigidBody,
        before: &Transform,
    ) -> Vec<ColliderHandle> {
        let is_jointed = || self.joints.attached_joints(handle).next().is_some();
        let mut obstacles = match is_quick(body, before) && !is_jointed() {
            true => self.fixed_shapes_at(body),
            // A jointed body may penetrate its partner: only contacts tell.
            false => self.deep_contacts(body),
        };
        obstacles.sort_unstable_by_key(|shape| shape.into_raw_parts());
        obstacles.dedup();
        obstacles
    }

    /// The fixed shapes whose boxes a body's boxes are too deep in.
    fn fixed_shapes_at(&self, body: &rapier::RigidBody) -> Vec<ColliderHandle> {
        let shapes = body.colliders().iter();
        let shapes = shapes.filter_map(|shape| self.colliders.get(*shape));
        let met = shapes.filter(|shape| !shape.is_sensor()).flat_map(|shape| {
            let fixed = self.simulation.broad_phase.as_query_pipeline(
                self.simulation.narrow_phase.query_dispatcher(),
                self.bodies,
                self.colliders,
                QueryFilter::only_fixed()
                    .exclude_sensors()
                    .groups(shape.collision_groups()),
            );
            let met = fixed.intersect_aabb_conservative(core(&shape.compute_aabb()));
            met.map(|(shape, _)| shape).collect::<Vec<_>>()
        });
        met.collect()
    }

    /// The fixed shapes whose contacts with a body are too deep.
    fn deep_contacts(&self, body: &rapier::RigidBody) -> Vec<ColliderHandle> {
        let shapes = body.colliders().iter();
        let deep = shapes.flat_map(|&shape| {
            let pairs = self.simulation.narrow_phase.contact_pairs_with(shape);
            let pairs = pairs.map(move |pair| match pair.collider1 == shape {
                true => (pair, pair.collider2),
                false => (pair, pair.collider1),
            });
            pairs.filter(|(pair, other)| self.is_fixed(*other) && self.is_deep(pair))
        });
        deep.map(|(_, other)| other).collect()
    }

    fn is_fixed(&self, shape: ColliderHandle) -> bool {
        let body = self.colliders.get(shape).and_then(Collider::parent);
        let body = body.and_then(|body| self.bodies.get(body));
        body.is_none_or(rapier::RigidBody::is_fixed)
    }

    /// True if contacts were too deep at the beginning of the step, or became so in it: a rolling body is soon touched elsewhere.
    fn is_deep(&self, pair: &ContactPair) -> bool {
        let pose = |collider| self.colliders.get(collider).map(Collider::position);
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

    /// The shortest way, in units, on which a body leaves some shapes but for the depth that it may have. `None` if it is no deeper, or if
    /// there is none.
    fn way_out(&self, body: &rapier::RigidBody, obstacles: &[ColliderHandle]) -> Option<Vec3> {
        let pressed = self.parts(body.colliders());
        let fixed = self.parts(obstacles);
        let depths = [DEEPEST, LIFTED];
        let out = pushed_out(&pressed, Pose::IDENTITY, &fixed, depths, &mut Vec::new());
        let way = out?.location;
        (way != Vec3::ZERO && way.is_finite()).then_some(way)
    }

    fn parts(&self, shapes: &[ColliderHandle]) -> Vec<Convex> {
        let shapes = shapes.iter().filter_map(|shape| self.colliders.get(*shape));
        shapes.flat_map(placed_parts).collect()
    }
}

/// True if a step has moved a body so far that it may penetrate a body that it did not touch before.
fn is_quick(body: &rapier::RigidBody, before: &Transform) -> bool {
    let now = body.position();
    let way = now.translation.distance(before.translation);
    way + REACH * now.rotation.angle_between(before.rotation) > QUICK
}

/// The core of a box: a body that reaches into the core is too deep in the box. Inside out if the box is thin.
fn core(bounds: &Aabb) -> Aabb {
    let depth = Vec3::splat(DEEPEST);
    Aabb::new(bounds.mins + depth, bounds.maxs - depth)
}
