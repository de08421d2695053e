//! The contacts of a step.

use bevy::{math::DVec3, prelude::*};
use bevy_rapier3d::rapier::prelude::{
    ColliderHandle, ColliderSet, ContactPair, NarrowPhase, RigidBodyHandle, RigidBodySet,
    SolverFlags,
};

use crate::effort::bodies_of;

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
}

/// All touches of awake bodies, in the order of their handles: Rapier's own depends on undone segments.
pub(super) fn touches(
    narrow_phase: &NarrowPhase,
    colliders: &ColliderSet,
    bodies: &RigidBodySet,
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
        .flat_map(|(pair, bodies)| touches_of(pair, bodies))
        .collect()
}

fn touches_of(
    pair: &ContactPair,
    bodies: [Option<RigidBodyHandle>; 2],
) -> impl Iterator<Item = Meeting> {
    let solved = pair.solver_manifolds().iter().filter(|manifold| {
        let flags = manifold.data.solver_flags;
        flags.contains(SolverFlags::COMPUTE_IMPULSES)
    });
    solved.flat_map(move |manifold| {
        let points = manifold.data.solver_contacts.iter();
        points.filter_map(move |solved| {
            let number = solved.contact_indices()[0];
            let point = manifold.points.get(number as usize)?;
            Some(Meeting {
                bodies,
                colliders: [pair.collider1, pair.collider2],
                arms: [point.data.solver_dp1, point.data.solver_dp2].map(Vec3::as_dvec3),
                normal: manifold.data.normal.as_dvec3(),
                gap: f64::from(solved.dist),
            })
        })
    })
}
