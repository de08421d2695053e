//! Sensing of grips and contacts.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop_core::{ObjectIndex, Robot, RobotContact, Table};

use crate::{
    articulation::link_entities::LinkEntities,
    articulation::tree::{Articulation, Carrier},
    contacts::contact::{Contact, Thing, with_near, with_pressed},
    gripper::grips::Grips,
};

/// Writes the robot's grips and contacts.
pub(crate) fn sense_contacts(
    articulation: Res<Articulation>,
    parts: Res<LinkEntities>,
    grips: Res<Grips>,
    tables: Query<Entity, With<Table>>,
    index: Res<ObjectIndex>,
    rapier: ReadRapierContext,
    mut robot: ResMut<Robot>,
) {
    for limb in articulation.layout.limb_ids() {
        let holds = grips.of(limb).iter().map(|grip| grip.object);
        if !robot.limb(limb).holds.iter().copied().eq(holds.clone()) {
            robot.limbs[limb.index()].holds = holds.collect();
        }
    }
    let mut contacts = Vec::new();
    if robot.is_shown {
        let Ok(rapier) = rapier.single() else {
            return;
        };
        let order: Vec<_> = tables.iter().chain(index.iter()).collect();
        let things = order.iter().filter_map(|&it| Thing::new(&rapier, it));
        let things: Vec<_> = things.collect();
        for (body, part) in articulation.bodies.iter().zip(&parts.0) {
            let Some(&part) = rapier.colliders.entity2collider().get(part) else {
                continue;
            };
            let touched = with_gripped(body.carrier, &grips, &robot)
                .chain(with_pressed(&rapier, part))
                .chain(with_near(&rapier, part, &things));
            let touched = once_in_order(touched, &order);
            contacts.extend(touched.map(|contact| RobotContact {
                body: body.id.clone(),
                thing: contact.thing,
                point: contact.point,
                impulse: contact.impulse,
            }));
        }
    }
    if robot.contacts != contacts {
        robot.contacts = contacts;
    }
}

/// The contacts of a finger with the objects that its gripper holds.
fn with_gripped(carrier: Carrier, grips: &Grips, robot: &Robot) -> impl Iterator<Item = Contact> {
    let finger = match carrier {
        Carrier::Gripper(limb, side) => Some((limb, usize::from(side > 0))),
        Carrier::Link(_) => None,
    };
    finger.into_iter().flat_map(move |(limb, finger)| {
        grips.of(limb).iter().map(move |grip| Contact {
            thing: grip.object,
            point: robot.limb(limb).end_effector * grip.points[finger],
            impulse: 0.0,
        })
    })
}

/// The first contact with each thing, in the order of the things.
fn once_in_order(
    contacts: impl Iterator<Item = Contact>,
    order: &[Entity],
) -> impl Iterator<Item = Contact> {
    let mut placed: Vec<_> = contacts
        .filter_map(|contact| {
            let place = order.iter().position(|&thing| thing == contact.thing)?;
            Some((place, contact))
        })
        .collect();
    placed.sort_by_key(|(place, _)| *place);
    placed.dedup_by_key(|(place, _)| *place);
    placed.into_iter().map(|(_, contact)| contact)
}
