//! Fastening and loosening.

use std::collections::BTreeSet;

use bevy::prelude::*;
use tabletop_core::{
    Bond, Bonds, CommandId, Held, HostPoint, Joint, JointKind, ObjectIndex, ObjectSpec, Operator,
    Pose, Rollback, SimFact,
};
use tabletop_physics::{hold, put, remove_joint, take_in};

use crate::network::Network;

/// A host farther away than this, in units, is not fastened to.
const REACH: f32 = 2.0;

/// Marks the joint of a bond, by the id of its guest point.
#[derive(Component, Clone, Debug, PartialEq, Eq)]
#[require(Rollback)]
pub(crate) struct BondJoint(String);

/// Which way a guest is turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Turn {
    Tighter,
    Looser,
}

/// A step of a bond that can be taken.
#[derive(Clone, Debug)]
pub(crate) struct Step {
    /// The bond as it is afterwards.
    bond: Bond,
    turn: Turn,
}

/// A point of an object on the table.
struct Point<'w> {
    id: &'w str,
    object: Entity,
    /// Where it is, on the table.
    pose: Pose,
    /// Where it is in the object.
    place: Pose,
    fit: &'w str,
    spec: &'w ObjectSpec,
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
            fit: &point.what.fit,
            spec,
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
                fit: &point.what.fit,
                spec,
            };
            (point, host)
        }));
    }
    points
}

/// The step that a guest point, or the object that it is a part of, can take now, or why none.
pub(crate) fn step(world: &World, guest: &str, turn: Turn) -> Result<Step, String> {
    let bonds = &world.resource::<Bonds>().0;
    let hosts = hosts(world);
    let mut guests = guests(world);
    guests.retain(|point| point.id == guest || point.spec.id == guest);
    if guests.is_empty() {
        return Err(format!(
            "`{guest}` has no point at which it could be fastened"
        ));
    }
    let is_of_guest = |bond: &&Bond| guests.iter().any(|point| point.id == bond.guest_point);
    let bonded = bonds.iter().find(is_of_guest);
    match (bonded, turn) {
        (Some(bond), turn) => {
            let steps = hosts
                .iter()
                .find(|(point, _)| point.id == bond.host_point)
                .map_or(0, |(_, host)| host.steps.len() as u32);
            if is_locked(&hosts, bonds, &bond.host_point) {
                let host = &bond.host_point;
                return Err(format!("`{guest}` cannot be turned: `{host}` is locked"));
            }
            let tightness = match turn {
                Turn::Tighter if bond.tightness >= steps => {
                    return Err(format!("`{guest}` is as tight as can be"));
                }
                Turn::Tighter => bond.tightness + 1,
                Turn::Looser => bond.tightness - 1,
            };
            let bond = Bond {
                tightness,
                ..bond.clone()
            };
            Ok(Step { bond, turn })
        }
        (None, Turn::Looser) => Err(format!("`{guest}` is not fastened")),
        (None, Turn::Tighter) => {
            let (guest_point, host_point) = nearest(&guests, &hosts, bonds).ok_or_else(|| {
                format!("`{guest}` has nothing near that it could be fastened to")
            })?;
            if is_locked(&hosts, bonds, host_point.id) {
                let host = host_point.id;
                return Err(format!("`{guest}` cannot be fastened: `{host}` is locked"));
            }
            let bond = Bond {
                host_point: host_point.id.to_owned(),
                host: host_point.spec.id.clone(),
                guest_point: guest_point.id.to_owned(),
                guest: guest_point.spec.id.clone(),
                tightness: 1,
            };
            Ok(Step { bond, turn })
        }
    }
}

/// The guest point and the free host point for it that are nearest to each other.
fn nearest<'p, 'w>(
    guests: &'p [Point<'w>],
    hosts: &'p [(Point<'w>, &HostPoint)],
    bonds: &[Bond],
) -> Option<(&'p Point<'w>, &'p Point<'w>)> {
    let mut nearest = None;
    let mut least = REACH;
    for guest in guests {
        let connected = connected(&guest.spec.id, bonds);
        for (host, what) in hosts {
            let is_free = bonds.iter().all(|bond| bond.host_point != host.id);
            let fits = host.fit == guest.fit && !what.steps.is_empty();
            let distance = guest.pose.location.distance(host.pose.location);
            if is_free && fits && distance < least && !connected.contains(&*host.spec.id) {
                least = distance;
                nearest = Some((guest, host));
            }
        }
    }
    nearest
}

/// Whether a host point can be neither fastened to nor loosened from, because a bond elsewhere locks it.
fn is_locked(hosts: &[(Point, &HostPoint)], bonds: &[Bond], host_point: &str) -> bool {
    hosts.iter().any(|(point, host)| {
        host.downstream_lock == host_point
            && bonds.iter().any(|bond| {
                bond.host_point == point.id
                    && (bond.tightness.checked_sub(1))
                        .and_then(|step| host.steps.get(step as usize))
                        .is_some_and(|step| step.locks)
            })
    })
}

/// The objects that bonds connect with one, with itself.
fn connected<'a>(object: &'a str, bonds: &'a [Bond]) -> BTreeSet<&'a str> {
    let mut connected = BTreeSet::from([object]);
    let mut due = vec![object];
    while let Some(object) = due.pop() {
        for bond in bonds {
            for (one, other) in [(&bond.host, &bond.guest), (&bond.guest, &bond.host)] {
                if one == object && connected.insert(other) {
                    due.push(other);
                }
            }
        }
    }
    connected
}

/// Takes a step: the guest goes to its place, with all that is fastened to it, and stays there.
pub(crate) fn take(
    world: &mut World,
    cause: Option<CommandId>,
    by: Operator,
    step: Step,
) -> Result<(), String> {
    let Step { bond, turn } = step;
    bring_about(world, &bond)?;
    let mut network = Network::of(world);
    have_effect(world, &mut network, &bond);
    world.write_message(match turn {
        Turn::Tighter => SimFact::Fastened { cause, by, bond },
        Turn::Looser => SimFact::Loosened { cause, by, bond },
    });
    network.take_effect(world, true);
    Ok(())
}

/// Makes a bond as tight as it says; of tightness 0, it is no more afterwards.
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
            let step = bond.tightness.checked_sub(1);
            let step = step.and_then(|step| host.steps.get(step as usize));
            let step = step.map_or(Pose::IDENTITY, |step| step.pose);
            (point.object, point.place * step, point.pose * step)
        })
        .ok_or_else(missing)?;

    let mut bonds = world.resource::<Bonds>().0.clone();
    bonds.retain(|other| other.guest_point != bond.guest_point);
    let here = world.get::<Transform>(guest).map(Pose::from);
    let motion = host_pose * guest_place.inverse() * here.unwrap_or_default().inverse();
    let moved = connected(&bond.guest, &bonds).into_iter();
    let index = world.resource::<ObjectIndex>();
    let moved: Vec<_> = moved.filter_map(|id| index.get(id)).collect();
    for object in moved {
        if let Some(here) = world.get::<Transform>(object).map(Pose::from) {
            put(world, object, motion * here);
        }
    }

    remove_joint_of(world, &bond.guest_point);
    if bond.tightness > 0 {
        bonds.push(bond.clone());
        let joint = Joint {
            objects: [host, guest],
            frames: [host_place, guest_place],
            kind: JointKind::Fixed,
            collides: false,
        };
        world.spawn((joint, BondJoint(bond.guest_point.clone()), ChildOf(guest)));
    }
    world.resource_mut::<Bonds>().0 = bonds;
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

/// Hands the tightness of a bond on to the controls downstream of its host point.
pub(crate) fn have_effect(world: &World, network: &mut Network, bond: &Bond) {
    let hosts = hosts(world);
    let host = hosts.iter().find(|(point, _)| point.id == bond.host_point);
    if let Some((_, host)) = host {
        network.set_state(&host.downstream, bond.tightness);
        let step = bond.tightness.checked_sub(1);
        let step = step.and_then(|step| host.steps.get(step as usize));
        network.set_override(&host.downstream_override, step.and_then(|step| step.state));
    }
}

/// Forgets the bonds of an object that has gone: what it was fastened to is loose.
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

/// The bond that a guest point has at first, or why it cannot.
pub(crate) fn first(
    world: &World,
    guest: &ObjectSpec,
    guest_point: &str,
    tightness: u32,
    host_point: &str,
) -> Result<Bond, String> {
    let bonds = &world.resource::<Bonds>().0;
    let hosts = hosts(world);
    let (host, what) = hosts
        .iter()
        .find(|(point, _)| point.id == host_point)
        .ok_or_else(|| format!("there is no host point `{host_point}`"))?;
    let fit = guests(world)
        .iter()
        .find(|point| point.id == guest_point)
        .map(|point| point.fit.to_owned());
    if fit.as_deref() != Some(host.fit) {
        return Err(format!("`{host_point}` is of type `{}`", host.fit));
    }
    if bonds.iter().any(|bond| bond.host_point == host_point) {
        return Err(format!("`{host_point}` has a guest already"));
    }
    if connected(&guest.id, bonds).contains(&*host.spec.id) {
        let host = &host.spec.id;
        return Err(format!("it is connected with `{host}` already"));
    }
    if tightness > what.steps.len() as u32 {
        let steps = what.steps.len();
        return Err(format!("`{host_point}` has only {steps} steps"));
    }
    Ok(Bond {
        host_point: host_point.to_owned(),
        host: host.spec.id.clone(),
        guest_point: guest_point.to_owned(),
        guest: guest.id.clone(),
        tightness,
    })
}
