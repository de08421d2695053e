//! How hard bodies press onto each other.

use bevy::prelude::*;
use bevy_rapier3d::{prelude::*, rapier::prelude::Collider};
use tabletop_core::TICK_SECONDS;
use tabletop_geometry::UNITS_PER_METER;

use crate::workarounds::impulses::{impulse_share, solved_points};

/// A point at which something presses onto an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pressure {
    /// The object.
    pub on: Entity,
    /// The pressing object.
    pub by: Entity,
    /// Where, in the table's frame.
    pub point: Vec3,
    /// How hard in the last tick, on the average, in newtons.
    pub force: f32,
}

/// The pressures onto objects in the last tick. Bodies that hands or robots move press onto movable objects, and not onto immovable ones.
pub fn pressures_on(world: &mut World, objects: &[Entity]) -> Vec<Pressure> {
    let mut contexts = world.query_filtered::<(
        &RapierContextSimulation,
        &RapierContextColliders,
        &RapierRigidBodySet,
    ), With<DefaultRapierContext>>();
    let Ok((simulation, colliders, bodies)) = contexts.single(world) else {
        return Vec::new();
    };
    let mut pressures = Vec::new();
    for &on in objects {
        let Some(&own) = colliders.entity2collider().get(&on) else {
            continue;
        };
        for pair in simulation.narrow_phase.contact_pairs_with(own) {
            let is_first = pair.collider1 == own;
            let other = match is_first {
                true => pair.collider2,
                false => pair.collider1,
            };
            let place = colliders.colliders.get(own).map(Collider::position);
            let (Some(by), Some(place)) = (colliders.collider_entity(other), place) else {
                continue;
            };
            let share = impulse_share(pair, &bodies.bodies, &colliders.colliders);
            let per_impulse = share / (TICK_SECONDS * UNITS_PER_METER as f32);
            pressures.extend(solved_points(pair, is_first).map(|(at, impulse)| Pressure {
                on,
                by,
                point: *place * at,
                force: impulse * per_impulse,
            }));
        }
    }
    pressures
}
