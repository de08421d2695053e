//! Contacts between bodies of the robot and things.

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::bounding_volume::{Aabb, BoundingVolume},
    prelude::RapierContext,
    rapier::prelude::{Collider, ColliderHandle, ContactPair},
};
use tabletop_physics::{contact, impulse_share, limits::MARGIN, solved_points};

/// Distance, in units, at which something is touched: an arm stops at the margin before an obstacle, or a little earlier.
const REACHED: f32 = 1.5 * MARGIN;

/// A contact with a thing.
pub(crate) struct Contact {
    /// An object or the table.
    pub thing: Entity,
    /// Its place on the thing's surface, in the table's frame.
    pub point: Vec3,
    /// Impulse of the last tick, in kg units/s.
    pub impulse: f32,
}

/// Adds the contacts of a body in the last tick, as Rapier reports them.
pub(crate) fn add_pressed(
    contacts: &mut Vec<Contact>,
    rapier: &RapierContext,
    body: ColliderHandle,
) {
    let pairs = rapier.simulation.narrow_phase.contact_pairs_with(body);
    contacts.extend(pairs.filter_map(|pair| {
        let is_first = pair.collider2 == body;
        let thing = match is_first {
            true => pair.collider1,
            false => pair.collider2,
        };
        let at = rapier.colliders.colliders.get(thing)?.position();
        let (centre, reported) = pressure(pair, is_first)?;
        let bodies = &rapier.rigidbody_set.bodies;
        let impulse = reported * impulse_share(pair, bodies, &rapier.colliders.colliders);
        Some(Contact {
            thing: rapier.colliders.collider_entity(thing)?,
            point: *at * centre,
            impulse,
        })
    }));
}

/// The centre of pressure on the first or the second collider of a pair, in its frame, and the impulse along the normals that Rapier
/// reports.
fn pressure(pair: &ContactPair, on_first: bool) -> Option<(Vec3, f32)> {
    let (mut moment, mut impulse) = (Vec3::ZERO, 0.0);
    for (place, at_point) in solved_points(pair, on_first) {
        moment += place * at_point;
        impulse += at_point;
    }
    (impulse > 0.0).then(|| (moment / impulse, impulse))
}

/// A thing that bodies may come near.
pub(crate) struct Thing<'a> {
    entity: Entity,
    collider: &'a Collider,
    /// The box around all its colliders.
    bounds: Aabb,
}

impl<'a> Thing<'a> {
    /// An object or the table.
    pub fn new(rapier: &'a RapierContext, entity: Entity) -> Option<Self> {
        let handle = *rapier.colliders.entity2collider().get(&entity)?;
        let collider = rapier.colliders.colliders.get(handle)?;
        Some(Self {
            entity,
            collider,
            bounds: collider.compute_aabb().loosened(REACHED),
        })
    }
}

/// Adds the things that a body has reached, each with the nearest point and no impulse. The ball about the body's origin has this radius, in
/// units.
pub(crate) fn add_near(
    contacts: &mut Vec<Contact>,
    rapier: &RapierContext,
    body: ColliderHandle,
    radius: f32,
    things: &[Thing],
) {
    let Some(body) = rapier.colliders.colliders.get(body) else {
        return;
    };
    let at = body.position().translation;
    let around = Aabb::new(at - radius, at + radius);
    let mut bounds = None;
    for thing in things {
        let is_near = thing.bounds.intersects(&around)
            && thing
                .bounds
                .intersects(bounds.get_or_insert_with(|| body.compute_aabb()));
        if !is_near {
            continue;
        }
        let nearest = contact(
            body.position(),
            body.shape(),
            thing.collider.position(),
            thing.collider.shape(),
            REACHED,
        );
        contacts.extend(nearest.map(|nearest| Contact {
            thing: thing.entity,
            point: nearest.point2,
            impulse: 0.0,
        }));
    }
}
