//! The contacts of a step.

use bevy::{math::DVec3, prelude::*};
use bevy_rapier3d::rapier::prelude::{
    ColliderHandle, ColliderSet, ContactPair, NarrowPhase, RigidBodyHandle, RigidBodySet,
    SolverFlags,
};

use crate::{effort::bodies_of, encounter::FreeFlights};

/// A point in which two bodies touched in a step, or might have.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    pub bodies: [Option<RigidBodyHandle>; 2],
    pub colliders: [ColliderHandle; 2],
    /// The point, from each body's centre of mass; in the world's frame for one that no force moves.
    pub arms: [DVec3; 2],
    /// Direction from the first body to the second one.
    pub normal: DVec3,
    /// Distance at the beginning of the step, in units.
    pub gap: f64,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// True if Rapier has pushed the bodies elsewhere.
    pub is_skewed: bool,
}

/// All touches of awake bodies, in the order of their handles: Rapier's own depends on undone segments.
pub(super) fn touches(
    narrow_phase: &NarrowPhase,
    colliders: &ColliderSet,
    bodies: &RigidBodySet,
    flights: &FreeFlights,
) -> Vec<Meeting> {
    let mut pairs: Vec<_> = narrow_phase
        .contact_pairs()
        .filter(|pair| pair.has_any_active_contact())
        .collect();
    pairs.sort_unstable_by_key(|pair| {
        [pair.collider1, pair.collider2].map(ColliderHandle::into_raw_parts)
    });
    let is_moving = |handle: &RigidBodyHandle| {
        let body = bodies.get(*handle);
        body.is_some_and(|body| body.is_dynamic() && !body.is_sleeping())
    };
    pairs
        .into_iter()
        .map(|pair| (pair, bodies_of(pair, colliders)))
        .filter(|(_, bodies)| bodies.iter().flatten().any(is_moving))
        .flat_map(|(pair, bodies)| touches_of(pair, bodies, flights))
        .collect()
}

fn touches_of(
    pair: &ContactPair,
    bodies: [Option<RigidBodyHandle>; 2],
    flights: &FreeFlights,
) -> impl Iterator<Item = Meeting> {
    let colliders = [pair.collider1, pair.collider2];
    let solved = pair.solver_manifolds().iter().filter(|manifold| {
        let flags = manifold.data.solver_flags;
        flags.contains(SolverFlags::COMPUTE_IMPULSES)
    });
    solved.flat_map(move |manifold| {
        let encounter = flights.encounter(colliders, manifold);
        let points = manifold.data.solver_contacts.iter();
        points.filter_map(move |solved| {
            let number = solved.contact_indices()[0];
            let point = manifold.points.get(number as usize)?;
            let arms = encounter.as_ref().and_then(|it| it.arms_of(number));
            let is_skewed = encounter.as_ref().is_some_and(|it| it.is_skewed);
            let arms = arms.unwrap_or([point.data.solver_dp1, point.data.solver_dp2]);
            Some(Meeting {
                bodies,
                colliders,
                arms: arms.map(Vec3::as_dvec3),
                normal: manifold.data.normal.as_dvec3(),
                gap: f64::from(solved.dist),
                friction: f64::from(manifold.data.friction),
                is_skewed,
            })
        })
    })
}
