//! Waking what is about to be hit.
//!
//! Rapier wakes it when it has been hit, after it has looked for contacts: what it stands on would not hold it before the next step, and a
//! blow from above would press it in.

use bevy_rapier3d::{
    parry::bounding_volume::BoundingVolume,
    rapier::prelude::{QueryFilter, RigidBodyHandle},
};

use crate::effort::{Engine, speed};

/// What is slower, in units/s and rad/s together, presses nothing in.
const SPEED_OF_BLOW: f32 = 1.0;

/// What is this near to the way of a body may be hit, in units.
const MARGIN: f32 = 0.02;

impl Engine<'_> {
    /// Wakes what sleeps in the way of something fast: of what moves freely, and of what is held. Robots wake what their links are near to.
    pub(crate) fn wake_what_is_hit(&mut self, held: impl Iterator<Item = RigidBodyHandle>) {
        let awake = self.islands.active_bodies();
        let free = awake.filter(|mover| self.bodies[*mover].is_dynamic());
        let mut movers: Vec<_> = free.chain(held).collect();
        // The world's own order depends on what was undone.
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
