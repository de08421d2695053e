//! The rebound from the impacts of a step.

use std::{
    collections::{BTreeMap, BTreeSet},
    iter,
};

use bevy::{
    math::{DMat3, DVec3},
    prelude::*,
};
use bevy_rapier3d::{
    prelude::{
        RapierConfiguration, RapierContextColliders, RapierContextJoints, RapierContextSimulation,
        RapierRigidBodySet,
    },
    rapier::{
        self,
        prelude::{ColliderHandle, RigidBody, RigidBodyHandle},
    },
};

use super::{
    Elasticity,
    contacts::{Meeting, touches},
    flight::{Flight, TICK},
    graph::{Collision, Parting, collide, part},
    onset::Onset,
    striker::{Striker, Velocity},
};
use crate::encounter::{FreeFlights, time_to_close};

/// Gives the bodies that have met elastic ones in the step the velocities with which they part.
pub(crate) fn rebound(
    mut contexts: Query<(
        &RapierConfiguration,
        &RapierContextSimulation,
        &RapierContextColliders,
        &RapierContextJoints,
        &mut RapierRigidBodySet,
    )>,
    surfaces: Query<&Elasticity>,
    onset: Res<Onset>,
    free_flights: Res<FreeFlights>,
) {
    for (configuration, simulation, colliders, joints, mut set) in &mut contexts {
        if !configuration.physics_pipeline_active {
            continue;
        }
        let elasticity = |collider: ColliderHandle| {
            let entity = colliders.collider_entity(collider);
            let surface = entity.and_then(|entity| surfaces.get(entity).ok());
            surface.map_or(0.0, |elasticity| f64::from(elasticity.0))
        };
        let touches = touches(
            &simulation.narrow_phase,
            &colliders.colliders,
            &set.bodies,
            &free_flights,
        );
        let joints = &joints.impulse_joints;
        let gravity = configuration.gravity.as_dvec3();
        let flights = Flights::new(&onset, &set.bodies, joints, gravity);
        let Some(impact) = flights.impact(&touches, elasticity) else {
            continue;
        };
        for (handle, velocity) in impact.rebound(&set.bodies) {
            if let Some(body) = set.bodies.get_mut(handle) {
                body.set_linvel(velocity.linear.as_vec3(), true);
                body.set_angvel(velocity.angular.as_vec3(), true);
            }
        }
    }
}

/// The bodies of a step, and their flights.
struct Flights<'a> {
    bodies: &'a rapier::prelude::RigidBodySet,
    handles: Vec<RigidBodyHandle>,
    flights: Vec<Flight>,
    /// Place of each body in the list, by the number of its handle.
    places: BTreeMap<u32, usize>,
}

/// The bodies that elastic impacts reach, and their contacts.
struct Impact {
    handles: Vec<RigidBodyHandle>,
    bodies: Vec<Striker>,
    contacts: Vec<Collision>,
    flights: Vec<Flight>,
}

impl<'a> Flights<'a> {
    fn new(
        onset: &Onset,
        bodies: &'a rapier::prelude::RigidBodySet,
        joints: &rapier::prelude::ImpulseJointSet,
        gravity: DVec3,
    ) -> Self {
        let moved = onset.0.iter().filter_map(|(handle, velocity)| {
            let is_jointed = joints.attached_joints(*handle).next().is_some();
            let flight = Flight::of(bodies.get(*handle)?, *velocity, gravity, is_jointed);
            Some((*handle, flight))
        });
        let (handles, flights): (Vec<_>, Vec<_>) = moved.unzip();
        let numbers = handles.iter().map(|handle| handle.into_raw_parts().0);
        Self {
            bodies,
            flights,
            places: numbers.zip(0..).collect(),
            handles,
        }
    }

    /// The impact of bodies that meet in these touches; `None` if nothing bounces.
    fn impact(
        mut self,
        touches: &[Meeting],
        elasticity: impl Fn(ColliderHandle) -> f64,
    ) -> Option<Impact> {
        let mut contacts: Vec<_> = touches
            .iter()
            .map(|touch| self.contact(touch, &elasticity))
            .collect();
        let before: Vec<_> = self.flights.iter().map(|flight| flight.velocity).collect();
        let resting = resting(&contacts, touches, &before);
        for (contact, touch) in contacts.iter_mut().zip(touches) {
            let gap = touch.gap.max(0.0);
            let falls = |body: usize| gap == 0.0 || !resting.contains(&body);
            let gain = |gain: fn(Flight) -> DVec3| {
                let [first, second] = contact.bodies.map(|body| {
                    let falling = body.filter(|body| falls(*body));
                    falling.map_or(DVec3::ZERO, |body| gain(self.flights[body]))
                });
                (first - second).dot(contact.normal)
            };
            let acceleration = gain(|flight| flight.acceleration);
            let lag = if gap > 0.0 {
                gain(Flight::lag_of_free)
            } else {
                0.0
            };
            let approach = contact.approach(&before) + lag;
            let time = time_to_close(gap, approach, acceleration);
            // Rapier stops bodies that are about to meet in the first sub-step of the next step.
            let meets = time <= TICK + self.substep(contact);
            let way = approach * TICK + 0.5 * acceleration * TICK * TICK;
            let left = if meets { (gap - way).max(0.0) } else { 0.0 };
            contact.meets_from = if meets { 0.0 } else { gap / TICK };
            contact.ahead = 2.0 * acceleration.max(0.0) * left;
            contact.rests_below = 0.5 * acceleration.max(0.0) * TICK;
            for &body in contact.bodies.iter().flatten() {
                let until = &mut self.flights[body].until;
                *until = until.min(time);
            }
        }
        let velocities: Vec<_> = self.flights.iter().map(|flight| flight.last()).collect();
        let reached = reached(&contacts, &velocities);
        if reached.is_empty() {
            return None;
        }
        contacts.retain(|contact| {
            let mut bodies = contact.bodies.iter().flatten();
            bodies.any(|body| reached.contains(body))
        });
        let bodies = self.handles.iter().map(|handle| &self.bodies[*handle]);
        let bodies = bodies.zip(velocities).map(|(body, velocity)| Striker {
            inverse_mass: f64::from(body.mass_properties().effective_inv_mass.x),
            inverse_inertia: inverse_inertia(body),
            velocity,
        });
        Some(Impact {
            bodies: bodies.collect(),
            contacts,
            flights: self.flights,
            handles: self.handles,
        })
    }

    /// Where two bodies touch. When they meet is not known yet.
    fn contact(&self, touch: &Meeting, elasticity: impl Fn(ColliderHandle) -> f64) -> Collision {
        let place = |handle: RigidBodyHandle| self.places.get(&handle.into_raw_parts().0).copied();
        let [first, second] = touch.colliders.map(elasticity);
        Collision {
            bodies: touch.bodies.map(|body| place(body?)),
            arms: touch.arms,
            normal: touch.normal,
            drive: self.drive(touch, 0) - self.drive(touch, 1),
            restitution: (first + second) / 2.0,
            friction: touch.friction,
            is_skewed: touch.is_skewed,
            meets_from: 0.0,
            ahead: 0.0,
            rests_below: 0.0,
        }
    }

    /// The velocity, at the point of touch, of a body that no force moves; 0 if forces do.
    fn drive(&self, touch: &Meeting, side: usize) -> DVec3 {
        let is_moved =
            |handle: &RigidBodyHandle| self.places.contains_key(&handle.into_raw_parts().0);
        let body = touch.bodies[side].filter(|handle| !is_moved(handle));
        let body = body.and_then(|body| self.bodies.get(body));
        body.map_or(DVec3::ZERO, |body| {
            let velocity = body.velocity_at_point(touch.arms[side].as_vec3());
            velocity.as_dvec3()
        })
    }

    /// Duration of the longer sub-step of two bodies, in s.
    fn substep(&self, contact: &Collision) -> f64 {
        let bodies = contact.bodies.iter().flatten();
        let substeps = bodies.map(|&body| self.flights[body].substep);
        substeps.fold(0.0, f64::max)
    }
}

impl Impact {
    /// The velocities that change, with which bodies part.
    fn rebound(&self, bodies: &rapier::prelude::RigidBodySet) -> Vec<(RigidBodyHandle, Velocity)> {
        let (parted, collided) = collide(&self.bodies, &self.contacts);
        let contacts = self.contacts.iter().enumerate();
        let targets: Vec<_> = contacts
            .filter(|(number, _)| collided[*number])
            .map(|(number, contact)| {
                let parting = (-contact.approach(&parted)).max(0.0);
                let parting = (parting * parting - contact.ahead).max(0.0).sqrt();
                Parting {
                    contact: number,
                    speed: parting + self.lag(contact),
                    slip: contact.slip(&parted),
                }
            })
            .collect();
        let stopped = self.handles.iter();
        let stopped: Vec<_> = stopped
            .map(|handle| Velocity::of(&bodies[*handle]))
            .collect();
        let mut after = stopped.clone();
        for body in self.moved_by_impacts_alone(&collided) {
            after[body] = parted[body];
        }
        part(&self.bodies, &self.contacts, &targets, &mut after);
        let changed = self.handles.iter().zip(stopped.into_iter().zip(after));
        changed
            .filter(|(_, (stopped, after))| stopped != after)
            .map(|(handle, (_, after))| (*handle, after))
            .collect()
    }

    /// The bodies whose velocities only the impact changes: Rapier's impulses have other arms, or other friction, and are taken back, from all that
    /// collide with each other.
    fn moved_by_impacts_alone(&self, collided: &[bool]) -> BTreeSet<usize> {
        let contacts = self.contacts.iter().zip(collided);
        let collided: Vec<_> = contacts
            .filter(|(_, collided)| **collided)
            .map(|(contact, _)| contact)
            .collect();
        let neighbours = Neighbours::new(self.bodies.len(), collided.iter().copied());
        let is_bound = |body: &usize| self.flights[*body].is_jointed;
        let mut moved = BTreeSet::new();
        for contact in collided {
            for body in contact.bodies.into_iter().flatten() {
                if !moved.contains(&body) && (contact.is_skewed || self.flights[body].meets()) {
                    let group = neighbours.reached_from([body]);
                    if !group.iter().any(is_bound) {
                        moved.extend(group);
                    }
                }
            }
        }
        moved
    }

    /// The speed, in units/s, by which two bodies truly part more slowly than Rapier's velocities say.
    fn lag(&self, contact: &Collision) -> f64 {
        let [first, second] = contact
            .bodies
            .map(|body| body.map_or(DVec3::ZERO, |body| self.flights[body].lag()));
        (first - second).dot(contact.normal)
    }
}

/// The bodies that touch something from which they do not part.
fn resting(
    contacts: &[Collision],
    touches: &[Meeting],
    velocities: &[Velocity],
) -> BTreeSet<usize> {
    let contacts = contacts.iter().zip(touches);
    let touching =
        contacts.filter(|(contact, touch)| touch.gap <= 0.0 && contact.approach(velocities) >= 0.0);
    let bodies = touching.flat_map(|(contact, _)| contact.bodies);
    bodies.flatten().collect()
}

/// The bodies that impacts reach: those that bounce, and all that touch them, and pairs that Rapier has pushed elsewhere than where they meet.
fn reached(contacts: &[Collision], velocities: &[Velocity]) -> BTreeSet<usize> {
    let count = velocities.len();
    let bounces = contacts.iter().filter(|it| it.bounces(velocities));
    let bounces = bounces.flat_map(|it| it.bodies.into_iter().flatten());
    let mut reached = Neighbours::new(count, contacts.iter()).reached_from(bounces);
    let mut strikes = contacts
        .iter()
        .filter(|it| it.is_skewed && it.meets(velocities));
    if let Some(first) = strikes.next() {
        let meeting = contacts.iter().filter(|it| it.meets_from == 0.0);
        let meeting = Neighbours::new(count, meeting);
        // Among many, Rapier's solution is as good as another one.
        let alone = iter::once(first)
            .chain(strikes)
            .filter(|it| meeting.are_alone(it.bodies));
        reached.extend(alone.flat_map(|it| it.bodies.into_iter().flatten()));
    }
    reached
}

/// The bodies that touch each body.
struct Neighbours(Vec<Vec<usize>>);

impl Neighbours {
    fn new<'a>(count: usize, contacts: impl Iterator<Item = &'a Collision>) -> Self {
        let mut neighbours = vec![Vec::new(); count];
        for contact in contacts {
            if let [Some(first), Some(second)] = contact.bodies {
                neighbours[first].push(second);
                neighbours[second].push(first);
            }
        }
        Self(neighbours)
    }

    /// True if two bodies touch nothing but each other, and what no force moves.
    fn are_alone(&self, bodies: [Option<usize>; 2]) -> bool {
        let mut both = bodies.iter().flatten();
        both.all(|body| {
            self.0[*body]
                .iter()
                .all(|other| bodies.contains(&Some(*other)))
        })
    }

    /// These bodies, and all that touch them, directly or by others.
    fn reached_from(&self, bodies: impl IntoIterator<Item = usize>) -> BTreeSet<usize> {
        let mut next: Vec<_> = bodies.into_iter().collect();
        let mut reached = BTreeSet::new();
        while let Some(body) = next.pop() {
            if reached.insert(body) {
                next.extend(&self.0[body]);
            }
        }
        reached
    }
}

fn inverse_inertia(body: &RigidBody) -> DMat3 {
    let inertia = body.mass_properties().effective_world_inv_inertia;
    let column = |axis: Vec3| (inertia * axis).as_dvec3();
    DMat3::from_cols(column(Vec3::X), column(Vec3::Y), column(Vec3::Z))
}
