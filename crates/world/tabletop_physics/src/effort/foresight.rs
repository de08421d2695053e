//! The distance at which contacts can be predicted without too many pairs.

use bevy_rapier3d::{
    parry::bounding_volume::{Aabb, BoundingVolume as _},
    rapier::prelude::{Collider, QueryFilter, RigidBodyHandle},
};
use tabletop_geometry::PAIR_GAP;

use super::{engine::Engine, mode::PREDICTION};

/// The most pairs of solids for whose sake contacts are predicted far ahead. The engine keeps up to 3 kB for each.
const MOST_PAIRS: usize = 200_000;

impl Engine<'_> {
    /// The distance at which contacts are predicted, in units: this one, or less where it would make too many pairs.
    pub(super) fn affordable(&self, prediction: f32) -> f32 {
        let mut affordable = prediction;
        while affordable > PREDICTION && self.makes_too_many_pairs(affordable) {
            affordable = PREDICTION.max(affordable / 2.0);
        }
        affordable
    }

    fn makes_too_many_pairs(&self, prediction: f32) -> bool {
        let solids = self.colliders.len();
        if solids.saturating_mul(solids) / 2 <= MOST_PAIRS {
            return false;
        }
        let gap = prediction + PAIR_GAP - PREDICTION;
        // Of two awake bodies, each counts the other.
        let mut halves = 0;
        self.islands.active_bodies().any(|body| {
            halves += self.halves_of_pairs(body, gap);
            halves > 2 * MOST_PAIRS
        })
    }

    /// The number of pairs of a body's solids with awake bodies, plus twice the number of those with sleeping ones.
    fn halves_of_pairs(&self, handle: RigidBodyHandle, gap: f32) -> usize {
        let near = self.broad_phase.as_query_pipeline(
            self.narrow_phase.query_dispatcher(),
            self.bodies,
            self.colliders,
            QueryFilter::default().exclude_rigid_body(handle),
        );
        let count = |bounds: Aabb| {
            let near = near.intersect_aabb_conservative(bounds);
            let near = near.filter(|(_, other)| other.compute_aabb().intersects(&bounds));
            let halves = near.map(|(_, other)| if self.is_awake(other) { 1 } else { 2 });
            halves.take(2 * MOST_PAIRS).sum::<usize>()
        };
        let solids = self.bodies[handle].colliders().iter();
        let bounds = solids.map(|solid| self.colliders[*solid].compute_aabb().loosened(gap));
        bounds.map(count).sum()
    }

    fn is_awake(&self, solid: &Collider) -> bool {
        let body = solid.parent().and_then(|body| self.bodies.get(body));
        body.is_some_and(|body| !body.is_fixed() && !body.is_sleeping())
    }
}
