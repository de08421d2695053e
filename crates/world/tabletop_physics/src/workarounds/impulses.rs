//! Impulses of the last step, as Rapier reports them and as they were.

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::utils::PoseOpt,
    rapier::prelude::{ColliderSet, ContactPair, RigidBodySet},
};

use crate::effort::{BASE_SUBSTEPS, bodies_of, substeps};

/// The share of a pair's reported impulses that acted in the last step: Rapier counts the impulses at the beginning of the
/// step as well as those of all sub-steps.
pub fn impulse_share(pair: &ContactPair, bodies: &RigidBodySet, colliders: &ColliderSet) -> f32 {
    let touching = bodies_of(pair, colliders).into_iter().flatten();
    let most = touching.filter_map(|body| Some(substeps(bodies.get(body)?)));
    let substeps = most.max().unwrap_or(BASE_SUBSTEPS) as f32;
    substeps / (substeps + 1.0)
}

/// The points at which a pair was pressed together in the last step, in the frame of the first or of the second collider, and the impulses
/// that Rapier reports there.
pub fn solved_points(pair: &ContactPair, on_first: bool) -> impl Iterator<Item = (Vec3, f32)> {
    pair.solver_manifolds().iter().flat_map(move |manifold| {
        // Only points that the solver has used in this tick: others keep impulses of earlier ticks.
        let solved = manifold.data.solver_contacts.iter();
        let numbers = solved.flat_map(|solved| solved.contact_indices());
        let points = numbers.filter_map(|number| manifold.points.get(number as usize));
        points.map(move |point| {
            let at = match on_first {
                true => manifold.subshape_pos1().transform_point(point.local_p1),
                false => manifold.subshape_pos2().transform_point(point.local_p2),
            };
            (at, point.data.impulse)
        })
    })
}
