//! Waking bodies that are about to be hit.
//!
//! Rapier wakes a body when it has been hit, after collision detection: its support would hold it only from the next step on, and a blow
//! from above would press it in.

use bevy_rapier3d::{
    parry::bounding_volume::BoundingVolume,
    rapier::prelude::{QueryFilter, RigidBodyHandle},
};

use crate::effort::{Engine, speed};

/// Speed, in units/s and rad/s together, below which a body presses nothing in.
const SPEED_OF_BLOW: f32 = 1.0;

/// Distance, in units, from the way of a body within which it may hit another one.
const MARGIN: f32 = 0.02;

impl Engine<'_> {
    /// Wakes sleeping bodies in the way of fast free and held bodies. Robots wake the bodies near their links.
    pub(crate) fn wake_sleepers_in_the_way(&mut self, held: impl Iterator<Item = RigidBodyHandle>) {
        let awake = self.islands.active_bodies();
        let free = awake.filter(|mover| self.bodies[*mover].is_dynamic());
        let mut movers: Vec<_> = free.chain(held).collect();
        // Rapier's own order depends on undone segments.
        movers.sort_unstable_by_key(|mover| mover.into_raw_parts());
        for mover in movers {
            for sleeper in self.asleep_in_the_way_of(mover) {
                self.islands.wake_up(self.bodies, sleeper, true);
            }
        }
    }

    fn asleep_in_the_way_of(&self, mover: RigidBodyHandle) -> Vec<RigidBodyHandle> {
        let Some(body) = self.bodies.get(mover) else {
            return Vec::new();
        };
        let dt = self.parameters.dt;
        let target = body.is_kinematic().then(|| *body.next_position());
        let speed = target.map_or_else(
            || speed(body),
            |target| {
                let way = target.translation - body.translation();
                way.length() / dt + body.angvel().length()
            },
        );
        if speed < SPEED_OF_BLOW {
            return Vec::new();
        }
        let next = target.unwrap_or_else(|| body.predict_position_using_velocity_and_forces(dt));
        let near = self.broad_phase.as_query_pipeline(
            self.narrow_phase.query_dispatcher(),
            self.bodies,
            self.colliders,
            QueryFilter::only_dynamic().exclude_rigid_body(mover),
        );
        let margin = self.gravity * dt * dt + MARGIN;
        let mut asleep = Vec::new();
        for shape in body.colliders() {
            let way = self.colliders[*shape].compute_swept_aabb(&next);
            let met = near.intersect_aabb_conservative(way.loosened(margin));
            let bodies = met.filter_map(|(_, met)| met.parent());
            asleep.extend(bodies.filter(|met| self.bodies[*met].is_sleeping()));
        }
        asleep
    }
}
