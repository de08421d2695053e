//! The rebound from the impacts of a step.

use std::collections::{BTreeMap, BTreeSet};

use bevy::{
    math::{DMat3, DVec3},
    prelude::*,
};
use bevy_rapier3d::{
    prelude::{
        RapierConfiguration, RapierContextColliders, RapierContextSimulation, RapierRigidBodySet,
    },
    rapier::{
        self,
        prelude::{ColliderHandle, RigidBody, RigidBodyHandle},
    },
};

use super::{
    Elasticity,
    contacts::{Meeting, touches},
    flight::{Flight, TICK, time_to_close},
    graph::{Collision, Striker, Velocity, collide, part},
    onset::Onset,
};

/// Gives the bodies that have met elastic ones in the step the velocities with which they part.
pub(crate) fn rebound(
    mut contexts: Query<(
        &RapierConfiguration,
        &RapierContextSimulation,
        &RapierContextColliders,
        &mut RapierRigidBodySet,
    )>,
    surfaces: Query<&Elasticity>,
    onset: Res<Onset>,
) {
    for (configuration, simulation, colliders, mut set) in &mut contexts {
        if !configuration.physics_pipeline_active {
            continue;
        }
        let elasticity = |collider: ColliderHandle| {
            let entity = colliders.collider_entity(collider);
            let surface = entity.and_then(|entity| surfaces.get(entity).ok());
            surface.map_or(0.0, |elasticity| f64::from(elasticity.0))
        };
        let touches = touches(&simulation.narrow_phase, &colliders.colliders, &set.bodies);
        let flights = Flights::new(&onset, &set.bodies, configuration.gravity.as_dvec3());
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
    lags: Vec<DVec3>,
}

impl<'a> Flights<'a> {
    fn new(onset: &Onset, bodies: &'a rapier::prelude::RigidBodySet, gravity: DVec3) -> Self {
        let moved = onset.0.iter().filter_map(|(handle, velocity)| {
            let flight = Flight::of(bodies.get(*handle)?, *velocity, gravity);
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
        let accelerations: Vec<_> = contacts.iter().map(|it| self.acceleration(it)).collect();
        for ((contact, touch), acceleration) in contacts.iter_mut().zip(touches).zip(accelerations)
        {
            let (gap, approach) = (touch.gap.max(0.0), contact.approach(&before));
            let time = time_to_close(gap, approach, acceleration);
            // Rapier stops bodies that are about to meet in the first sub-step of the next step.
            let meets = time <= TICK + self.substep(contact);
            let later = if meets { (time - TICK).max(0.0) } else { 0.0 };
            let way = (approach + acceleration * TICK) * later;
            contact.meets_from = if meets { 0.0 } else { gap / TICK };
            contact.ahead = 2.0 * acceleration.max(0.0) * way;
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
            lags: self.flights.iter().map(|flight| flight.lag()).collect(),
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
            meets_from: 0.0,
            ahead: 0.0,
            rests_below: 0.0,
        }
    }

    /// The speed along the normal of a body that no force moves; 0 if forces do.
    fn drive(&self, touch: &Meeting, side: usize) -> f64 {
        let is_moved =
            |handle: &RigidBodyHandle| self.places.contains_key(&handle.into_raw_parts().0);
        let body = touch.bodies[side].filter(|handle| !is_moved(handle));
        let body = body.and_then(|body| self.bodies.get(body));
        body.map_or(0.0, |body| {
            let velocity = body.velocity_at_point(touch.arms[side].as_vec3());
            velocity.as_dvec3().dot(touch.normal)
        })
    }

    /// Duration of the longer sub-step of two bodies, in s.
    fn substep(&self, contact: &Collision) -> f64 {
        let bodies = contact.bodies.iter().flatten();
        let substeps = bodies.map(|&body| self.flights[body].substep);
        substeps.fold(0.0, f64::max)
    }

    /// The acceleration with which gravity lets two bodies approach.
    fn acceleration(&self, contact: &Collision) -> f64 {
        let [first, second] = contact
            .bodies
            .map(|body| body.map_or(DVec3::ZERO, |body| self.flights[body].acceleration));
        (first - second).dot(contact.normal)
    }
}

impl Impact {
    /// The velocities that change, with which bodies part.
    fn rebound(&self, bodies: &rapier::prelude::RigidBodySet) -> Vec<(RigidBodyHandle, Velocity)> {
        let (mut parted, collided) = collide(&self.bodies, &self.contacts);
        for (velocity, lag) in parted.iter_mut().zip(&self.lags) {
            velocity.linear -= *lag;
        }
        let contacts = self.contacts.iter().enumerate();
        let targets: Vec<_> = contacts
            .filter(|(number, _)| collided[*number])
            .map(|(number, contact)| {
                let parting = (-contact.approach(&parted)).max(0.0);
                (number, (parting * parting - contact.ahead).max(0.0).sqrt())
            })
            .collect();
        let stopped = self.handles.iter();
        let stopped: Vec<_> = stopped
            .map(|handle| Velocity::of(&bodies[*handle]))
            .collect();
        let mut after = stopped.clone();
        part(&self.bodies, &self.contacts, &targets, &mut after);
        let changed = self.handles.iter().zip(stopped.into_iter().zip(after));
        changed
            .filter(|(_, (stopped, after))| stopped != after)
            .map(|(handle, (_, after))| (*handle, after))
            .collect()
    }
}

/// The bodies that impacts reach: those that bounce, and all that touch them.
fn reached(contacts: &[Collision], velocities: &[Velocity]) -> BTreeSet<usize> {
    let mut neighbours = vec![Vec::new(); velocities.len()];
    for contact in contacts {
        if let [Some(first), Some(second)] = contact.bodies {
            neighbours[first].push(second);
            neighbours[second].push(first);
        }
    }
    let bounces = contacts
        .iter()
        .filter(|contact| contact.bounces(velocities));
    let mut next: Vec<_> = bounces
        .flat_map(|contact| contact.bodies.into_iter().flatten())
        .collect();
    let mut reached = BTreeSet::new();
    while let Some(body) = next.pop() {
        if reached.insert(body) {
            next.extend(&neighbours[body]);
        }
    }
    reached
}

fn inverse_inertia(body: &RigidBody) -> DMat3 {
    let inertia = body.mass_properties().effective_world_inv_inertia;
    let column = |axis: Vec3| (inertia * axis).as_dvec3();
    DMat3::from_cols(column(Vec3::X), column(Vec3::Y), column(Vec3::Z))
}
