//! Sensing of grips and contacts.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop_core::{ObjectIndex, Robot, RobotContact, Table};

use tabletop_robot::{Articulation, Carrier, LinkEntities};

use crate::{
    contacts::contact::Contact, contacts::contact::Thing, contacts::contact::add_near,
    contacts::contact::add_pressed, gripper::grips::Grips,
};

/// Writes the robot's grips and contacts.
pub(crate) fn sense_contacts(
    articulation: Res<Articulation>,
    parts: Res<LinkEntities>,
    grips: Res<Grips>,
    tables: Query<Entity, With<Table>>,
    index: Res<ObjectIndex>,
    handles: Query<&RapierColliderHandle>,
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
        let mut touched = Vec::new();
        for (body, part) in articulation.bodies.iter().zip(&parts.0) {
            let Ok(&RapierColliderHandle(part)) = handles.get(*part) else {
                continue;
            };
            touched.clear();
            add_gripped(&mut touched, body.carrier, &grips, &robot);
            add_pressed(&mut touched, &rapier, part);
            add_near(&mut touched, &rapier, part, body.radius, &things);
            keep_first_in_order(&mut touched, &order);
            contacts.extend(touched.iter().map(|contact| RobotContact {
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

/// Adds the contacts of a finger with the objects that its gripper holds.
fn add_gripped(contacts: &mut Vec<Contact>, carrier: Carrier, grips: &Grips, robot: &Robot) {
    let (limb, finger) = match carrier {
        Carrier::Gripper(limb, side) => (limb, usize::from(side > 0)),
        Carrier::Link(_) => return,
    };
    contacts.extend(grips.of(limb).iter().map(|grip| Contact {
        thing: grip.object,
        point: robot.limb(limb).end_effector * grip.points[finger],
        impulse: 0.0,
    }));
}

/// Keeps the first contact with each thing, in the order of the things.
fn keep_first_in_order(contacts: &mut Vec<Contact>, order: &[Entity]) {
    if contacts.is_empty() {
        return;
    }
    let place = |thing: Entity| order.iter().position(|&it| it == thing);
    contacts.retain(|contact| place(contact.thing).is_some());
    contacts.sort_by_key(|contact| place(contact.thing));
    contacts.dedup_by_key(|contact| contact.thing);
}
