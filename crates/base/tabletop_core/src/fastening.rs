//! Fastening: the bonds that turning a guest makes, tightens and loosens.

use std::collections::BTreeSet;
use tabletop_geometry::Pose;

use crate::{Bond, BondPoint, Bonds, HostPoint, ObjectSpec, PlacedPart};

/// The greatest distance, in units, at which a host is fastened to.
const REACH: f32 = 2.0;

/// A direction in which a guest is turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// It fastens.
    Tighter,
    /// It loosens.
    Looser,
}

/// A bond point on the table.
struct FasteningPoint<'a> {
    id: &'a str,
    object: &'a str,
    at: Pose,
    fit: &'a str,
}

impl<'a> FasteningPoint<'a> {
    fn new(spec: &'a ObjectSpec, pose: Pose, point: &PlacedPart<'a, BondPoint>) -> Self {
        Self {
            id: point.id,
            object: &spec.id,
            at: pose * point.pose,
            fit: &point.what.fit,
        }
    }
}

fn guests<'a>(objects: &[(&'a ObjectSpec, Pose)]) -> Vec<FasteningPoint<'a>> {
    let of = |&(spec, pose): &(&'a ObjectSpec, Pose)| {
        let points = spec.guest_points().into_iter();
        points.map(move |(point, _)| FasteningPoint::new(spec, pose, &point))
    };
    objects.iter().flat_map(of).collect()
}

fn hosts<'a>(objects: &[(&'a ObjectSpec, Pose)]) -> Vec<(FasteningPoint<'a>, &'a HostPoint)> {
    let of = |&(spec, pose): &(&'a ObjectSpec, Pose)| {
        let points = spec.host_points().into_iter();
        points.map(move |(point, host)| (FasteningPoint::new(spec, pose, &point), host))
    };
    objects.iter().flat_map(of).collect()
}

impl Bonds {
    /// The bond after a guest point is turned by a step; for an object, its guest point is chosen. At tightness 0 the bond is gone.
    ///
    /// # Errors
    /// The reason why it cannot be turned.
    pub fn turned(
        &self,
        objects: &[(&ObjectSpec, Pose)],
        guest: &str,
        turn: Turn,
    ) -> Result<Bond, String> {
        let hosts = hosts(objects);
        let mut guests = guests(objects);
        guests.retain(|point| point.id == guest || point.object == guest);
        if guests.is_empty() {
            return Err(format!("`{guest}` has no guest point to fasten"));
        }
        let is_of_guest = |bond: &&Bond| guests.iter().any(|point| point.id == bond.guest_point);
        match (self.0.iter().find(is_of_guest), turn) {
            (Some(bond), turn) => {
                let host = hosts.iter().find(|(point, _)| point.id == bond.host_point);
                let steps = host.map_or(0, |(_, host)| host.steps.len() as u32);
                if self.is_locked(&hosts, &bond.host_point) {
                    let host = &bond.host_point;
                    return Err(format!("`{guest}` cannot be turned: `{host}` is locked"));
                }
                let tightness = match turn {
                    Turn::Tighter if bond.tightness >= steps => {
                        return Err(format!("`{guest}` is already as tight as possible"));
                    }
                    Turn::Tighter => bond.tightness + 1,
                    Turn::Looser => bond.tightness.saturating_sub(1),
                };
                Ok(Bond {
                    tightness,
                    ..bond.clone()
                })
            }
            (None, Turn::Looser) => Err(format!("`{guest}` is not fastened")),
            (None, Turn::Tighter) => {
                let Some((guest_point, host_point)) = self.nearest(&guests, &hosts) else {
                    return Err(format!("`{guest}` has no free host point near it"));
                };
                if self.is_locked(&hosts, host_point.id) {
                    let host = host_point.id;
                    return Err(format!("`{guest}` cannot be fastened: `{host}` is locked"));
                }
                Ok(Bond {
                    host_point: host_point.id.to_owned(),
                    host: host_point.object.to_owned(),
                    guest_point: guest_point.id.to_owned(),
                    guest: guest_point.object.to_owned(),
                    tightness: 1,
                })
            }
        }
    }

    /// The bond that a guest point has at first.
    ///
    /// # Errors
    /// The reason why it cannot have this bond.
    pub fn first(
        &self,
        objects: &[(&ObjectSpec, Pose)],
        guest_point: &str,
        host_point: &str,
        tightness: u32,
    ) -> Result<Bond, String> {
        let (hosts, guests) = (hosts(objects), guests(objects));
        let guest = guests
            .iter()
            .find(|point| point.id == guest_point)
            .ok_or_else(|| format!("there is no guest point `{guest_point}`"))?;
        let (host, what) = hosts
            .iter()
            .find(|(point, _)| point.id == host_point)
            .ok_or_else(|| format!("there is no host point `{host_point}`"))?;
        if guest.fit != host.fit {
            return Err(format!("`{host_point}` is of type `{}`", host.fit));
        }
        if self.0.iter().any(|bond| bond.host_point == host_point) {
            return Err(format!("`{host_point}` has a guest already"));
        }
        if self.connected(guest.object).contains(host.object) {
            return Err(format!("it is connected with `{}` already", host.object));
        }
        let steps = what.steps.len();
        if tightness as usize > steps {
            return Err(format!("`{host_point}` has only {steps} steps"));
        }
        Ok(Bond {
            host_point: host_point.to_owned(),
            host: host.object.to_owned(),
            guest_point: guest_point.to_owned(),
            guest: guest.object.to_owned(),
            tightness,
        })
    }

    /// The object and all that bonds connect with it, in the order of their ids.
    pub fn connected<'a>(&'a self, object: &'a str) -> BTreeSet<&'a str> {
        let mut connected = BTreeSet::from([object]);
        let mut due = vec![object];
        while let Some(object) = due.pop() {
            for bond in &self.0 {
                for (one, other) in [(&bond.host, &bond.guest), (&bond.guest, &bond.host)] {
                    if one == object && connected.insert(other) {
                        due.push(other);
                    }
                }
            }
        }
        connected
    }

    /// The nearest pair of a guest point and a free host point that fits it.
    fn nearest<'p, 'a>(
        &self,
        guests: &'p [FasteningPoint<'a>],
        hosts: &'p [(FasteningPoint<'a>, &HostPoint)],
    ) -> Option<(&'p FasteningPoint<'a>, &'p FasteningPoint<'a>)> {
        let mut nearest = None;
        let mut least = REACH;
        for guest in guests {
            let connected = self.connected(guest.object);
            for (host, what) in hosts {
                let is_free = self.0.iter().all(|bond| bond.host_point != host.id);
                let fits = host.fit == guest.fit && !what.steps.is_empty();
                let distance = guest.at.location.distance(host.at.location);
                if is_free && fits && distance < least && !connected.contains(host.object) {
                    least = distance;
                    nearest = Some((guest, host));
                }
            }
        }
        nearest
    }

    /// True if a bond elsewhere locks the host point: nothing can be fastened to it or loosened from it.
    fn is_locked(&self, hosts: &[(FasteningPoint, &HostPoint)], host_point: &str) -> bool {
        hosts.iter().any(|(point, host)| {
            host.downstream_lock == host_point
                && self.0.iter().any(|bond| {
                    bond.host_point == point.id
                        && host.step(bond.tightness).is_some_and(|step| step.locks)
                })
        })
    }
}

#[cfg(test)]
mod tests {
    use bevy::prelude::*;

    use super::*;
    use crate::{BondEnd, GuestPoint, Part, Shape, TightnessStep};

    fn object(id: &str, at: Vec3, points: &[(&str, BondEnd)]) -> ObjectSpec {
        let part = |(id, end): &(&str, BondEnd)| {
            let (fit, end) = ("screw".to_owned(), end.clone());
            let point = Shape::BondPoint(BondPoint { fit, end });
            Part::new(*id, Pose::IDENTITY, point)
        };
        let parts = points.iter().map(part).collect();
        ObjectSpec::new(id, Pose::at(at), 1.0, Shape::Composite { parts })
    }

    fn guest() -> BondEnd {
        BondEnd::Guest(GuestPoint::default())
    }

    fn host(steps: usize, lock: &str) -> BondEnd {
        let step = TightnessStep {
            locks: true,
            ..default()
        };
        BondEnd::Host(HostPoint {
            downstream_lock: lock.into(),
            steps: vec![step; steps],
            ..default()
        })
    }

    /// Turns a screw as far as it goes.
    fn turns(bonds: &mut Bonds, objects: &[ObjectSpec], guest: &str, turn: Turn) -> (u32, String) {
        let objects: Vec<_> = objects.iter().map(|spec| (spec, spec.pose)).collect();
        let mut turns = 0;
        loop {
            match bonds.turned(&objects, guest, turn) {
                Ok(bond) => {
                    bonds
                        .0
                        .retain(|other| other.guest_point != bond.guest_point);
                    if bond.tightness > 0 {
                        bonds.0.push(bond);
                    }
                    turns += 1;
                }
                Err(reason) => return (turns, reason),
            }
        }
    }

    #[test]
    fn a_screw_goes_in_step_by_step_and_comes_out_again() {
        let objects = [
            object("screw", Vec3::ZERO, &[("tip", guest())]),
            object("near", Vec3::X, &[("hole", host(3, ""))]),
            object("nearer", Vec3::X * 0.5, &[("hole2", host(2, ""))]),
        ];
        let mut bonds = Bonds::default();
        let (steps, reason) = turns(&mut bonds, &objects, "tip", Turn::Tighter);
        assert_eq!(
            (steps, &*reason),
            (2, "`tip` is already as tight as possible")
        );
        assert_eq!(bonds.0[0].host_point, "hole2");
        let (steps, reason) = turns(&mut bonds, &objects, "screw", Turn::Looser);
        assert_eq!((steps, &*reason), (2, "`screw` is not fastened"));
    }

    #[test]
    fn a_host_two_units_away_or_with_another_guest_is_none() {
        let objects = [
            object("screw", Vec3::ZERO, &[("tip", guest())]),
            object("other", Vec3::ZERO, &[("tip2", guest())]),
            object("far", Vec3::X * 2.0, &[("hole", host(1, ""))]),
            object("near", Vec3::X, &[("hole2", host(1, ""))]),
        ];
        let mut bonds = Bonds::default();
        assert_eq!(turns(&mut bonds, &objects, "screw", Turn::Tighter).0, 1);
        assert_eq!(turns(&mut bonds, &objects, "other", Turn::Tighter).0, 0);
    }

    #[test]
    fn a_locked_host_keeps_its_guest_and_takes_no_other() {
        let two = [("hole", host(1, "hole2")), ("hole2", host(1, ""))];
        let objects = [
            object("panel", Vec3::ZERO, &two),
            object("screw", Vec3::ZERO, &[("tip", guest())]),
            object("other", Vec3::ZERO, &[("tip2", guest())]),
        ];
        let mut bonds = Bonds::default();
        assert_eq!(turns(&mut bonds, &objects, "screw", Turn::Tighter).0, 1);
        let (steps, reason) = turns(&mut bonds, &objects, "other", Turn::Tighter);
        assert_eq!(
            (steps, &*reason),
            (0, "`other` cannot be fastened: `hole2` is locked")
        );
    }

    #[test]
    fn connected_objects_are_not_fastened_again() {
        let objects = [
            object("a", Vec3::ZERO, &[("tip", guest()), ("hole", host(1, ""))]),
            object(
                "b",
                Vec3::ZERO,
                &[("tip2", guest()), ("hole2", host(1, ""))],
            ),
        ];
        let mut bonds = Bonds::default();
        assert_eq!(turns(&mut bonds, &objects, "tip", Turn::Tighter).0, 1);
        assert_eq!(turns(&mut bonds, &objects, "tip2", Turn::Tighter).0, 0);
    }
}
