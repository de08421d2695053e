//! Fastening and loosening.

use bevy::prelude::*;
use tabletop_core::{
    Bond, Bonds, CommandId, Held, HostPoint, Joint, JointKind, MechanismFact, ObjectIndex,
    ObjectSpec, Operator, Rollback, SimFact, Turn,
};
use tabletop_geometry::Pose;
use tabletop_physics::{hold, put, remove_joint, take_in};

use crate::network::Network;

/// Marks the joint of a bond, by the id of its guest point.
#[derive(Component, Clone, Debug, PartialEq, Eq)]
#[require(Rollback)]
pub(crate) struct BondJoint(String);

/// A point of an object on the table.
struct Point<'w> {
    id: &'w str,
    object: Entity,
    /// Its pose on the table.
    pose: Pose,
    /// Its pose in the object.
    place: Pose,
}

fn objects(world: &World) -> impl Iterator<Item = (Entity, &ObjectSpec, Pose)> {
    let index = world.resource::<ObjectIndex>();
    index.iter().filter_map(|object| {
        let spec = world.get::<ObjectSpec>(object)?;
        let pose = world.get::<Transform>(object).map(Pose::from)?;
        Some((object, spec, pose))
    })
}

fn guests(world: &World) -> Vec<Point<'_>> {
    let mut points = Vec::new();
    for (object, spec, pose) in objects(world) {
        points.extend(spec.guest_points().into_iter().map(|(point, _)| Point {
            id: point.id,
            object,
            pose: pose * point.pose,
            place: point.pose,
        }));
    }
    points
}

fn hosts(world: &World) -> Vec<(Point<'_>, &HostPoint)> {
    let mut points = Vec::new();
    for (object, spec, pose) in objects(world) {
        points.extend(spec.host_points().into_iter().map(|(point, host)| {
            let point = Point {
                id: point.id,
                object,
                pose: pose * point.pose,
                place: point.pose,
            };
            (point, host)
        }));
    }
    points
}

/// A guest point and a host point on the table.
pub(crate) struct Pair {
    pub guest: Pose,
    pub host: Pose,
    pub what: HostPoint,
}

/// The points of a bond that there is or could be.
pub(crate) fn pair(world: &World, bond: &Bond) -> Option<Pair> {
    let guests = guests(world);
    let guest = guests.iter().find(|point| point.id == bond.guest_point)?;
    let hosts = hosts(world);
    let mut hosts = hosts.iter();
    let (host, what) = hosts.find(|(point, _)| point.id == bond.host_point)?;
    Some(Pair {
        guest: guest.pose,
        host: host.pose,
        what: (*what).clone(),
    })
}

/// The bond after turning a guest point, or an object's guest point, or the reason why it cannot be turned.
pub(crate) fn turned(world: &World, guest: &str, turn: Turn) -> Result<Bond, String> {
    let objects: Vec<_> = objects(world).map(|(_, spec, pose)| (spec, pose)).collect();
    world.resource::<Bonds>().turned(&objects, guest, turn)
}

/// The bond that a guest point has at first, or the reason why it cannot have it.
pub(crate) fn first(
    world: &World,
    guest_point: &str,
    host_point: &str,
    tightness: u32,
) -> Result<Bond, String> {
    let objects: Vec<_> = objects(world).map(|(_, spec, pose)| (spec, pose)).collect();
    let bonds = world.resource::<Bonds>();
    bonds.first(&objects, guest_point, host_point, tightness)
}

/// Turns a guest: it moves to its place with everything that is fastened to it, and stays there.
pub(crate) fn take_turn(
    world: &mut World,
    cause: Option<CommandId>,
    by: Operator,
    (bond, turn): (Bond, Turn),
) -> Result<(), String> {
    bring_about(world, &bond)?;
    let mut network = Network::of(world);
    have_effect(world, &mut network, &bond);
    world.write_message(match turn {
        Turn::Tighter => SimFact::Mechanism(MechanismFact::Fastened { cause, by, bond }),
        Turn::Looser => SimFact::Mechanism(MechanismFact::Loosened { cause, by, bond }),
    });
    network.take_effect(world, true);
    Ok(())
}

/// Gives a bond its tightness; at tightness 0 the bond is removed.
pub(crate) fn bring_about(world: &mut World, bond: &Bond) -> Result<(), String> {
    let missing = || {
        format!(
            "`{}` or `{}` is not there",
            bond.host_point, bond.guest_point
        )
    };
    let (guest, guest_place) = guests(world)
        .iter()
        .find(|point| point.id == bond.guest_point)
        .map(|point| (point.object, point.place))
        .ok_or_else(missing)?;
    let (host, host_place, host_pose) = hosts(world)
        .iter()
        .find(|(point, _)| point.id == bond.host_point)
        .map(|(point, host)| {
            let step = host.place(bond.tightness);
            (point.object, point.place * step, point.pose * step)
        })
        .ok_or_else(missing)?;

    let mut bonds = world.resource::<Bonds>().0.clone();
    bonds.retain(|other| other.guest_point != bond.guest_point);
    let here = world.get::<Transform>(guest).map(Pose::from);
    let motion = host_pose * guest_place.inverse() * here.unwrap_or_default().inverse();
    let mut bonds = Bonds(bonds);
    let moved = bonds.connected(&bond.guest).into_iter();
    let index = world.resource::<ObjectIndex>();
    let moved: Vec<_> = moved.filter_map(|id| index.get(id)).collect();
    for object in moved {
        if let Some(here) = world.get::<Transform>(object).map(Pose::from) {
            put(world, object, motion * here);
        }
    }

    remove_joint_of(world, &bond.guest_point);
    if bond.tightness > 0 {
        bonds.0.push(bond.clone());
        let joint = Joint {
            objects: [host, guest],
            frames: [host_place, guest_place],
            kind: JointKind::Fixed,
            collides: false,
        };
        world.spawn((joint, BondJoint(bond.guest_point.clone()), ChildOf(guest)));
    }
    world.insert_resource(bonds);
    take_in(world).map_err(|error| error.to_string())?;
    for object in [host, guest] {
        if let Some(held) = world.get::<Held>(object).copied() {
            hold(world, object, held.by);
        }
    }
    Ok(())
}

fn remove_joint_of(world: &mut World, guest_point: &str) {
    let mut joints = world.query::<(Entity, &BondJoint)>();
    let joint = joints
        .iter(world)
        .find(|(_, bond)| bond.0 == guest_point)
        .map(|(joint, _)| joint);
    if let Some(joint) = joint {
        remove_joint(world, joint);
    }
}

/// Passes the tightness of a bond on to the controls downstream of its host point.
pub(crate) fn have_effect(world: &World, network: &mut Network, bond: &Bond) {
    let hosts = hosts(world);
    let host = hosts.iter().find(|(point, _)| point.id == bond.host_point);
    if let Some((_, host)) = host {
        network.set_state(&host.downstream, bond.tightness);
        let step = host.step(bond.tightness);
        network.set_override(&host.downstream_override, step.and_then(|step| step.state));
    }
}

/// Forgets the bonds of an object that is gone, whose partners are then loose.
pub(crate) fn forget(world: &mut World, object: &str) {
    let bonds = std::mem::take(&mut world.resource_mut::<Bonds>().0);
    let (gone, left): (Vec<_>, Vec<_>) = bonds
        .into_iter()
        .partition(|bond| bond.guest == object || bond.host == object);
    world.resource_mut::<Bonds>().0 = left;
    if gone.is_empty() {
        return;
    }
    let mut network = Network::of(world);
    for bond in gone {
        let loose = Bond {
            tightness: 0,
            ..bond
        };
        have_effect(world, &mut network, &loose);
    }
    network.take_effect(world, true);
}
