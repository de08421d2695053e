//! Contacts put where bodies touch.

use bevy::prelude::*;
use bevy_rapier3d::rapier::prelude::{
    Collider, ColliderHandle, ContactModificationContext, Pose, Shape, SolverContact,
};
use tabletop_core::TICK_SECONDS;

use super::{
    approach::{FlyingSolid, NearestApproach, TOUCHING, look, manifold, nearest_approach},
    closing::time_to_close,
    free_flights::{Encounter, FreeFlights},
};
use crate::effort::substeps;

/// Way, in units, before a touch from which the touch is looked for: on a shorter one, the nearest points hardly move.
const LEAST_WAY: f32 = 0.002;

/// Most contacts of a pair of solids that Rapier solves.
const MOST_CONTACTS: usize = 4;

/// Cosine of the angle, some 0.1°, within which normals are the same.
const SAME: f32 = 0.999_999;

/// A pair of solids that are about to meet.
struct ApproachingPair<'a, 'b> {
    contacts: &'a mut ContactModificationContext<'b>,
    movers: [FlyingSolid<'b>; 2],
    /// True for a solid that contacts move.
    is_moved: [bool; 2],
    /// The end of the time, in s, in which contacts act.
    latest: f32,
}

/// A point in which two solids touch.
#[derive(Clone, Copy)]
struct TouchPoint {
    /// The point of each solid, where it is at first.
    first: [Vec3; 2],
    /// The way, in units along the normal, that is left between them at first.
    gap: f32,
}

impl TouchPoint {
    fn of(known: SolverContact) -> (Self, SolverContact) {
        let first = [known.anchor1, known.anchor2];
        (
            Self {
                first,
                gap: known.dist,
            },
            known,
        )
    }
}

impl FreeFlights {
    /// Puts contacts that would act in the step where the bodies touch on their ways, or are nearest.
    pub(crate) fn put_where_bodies_touch(&self, contacts: &mut ContactModificationContext) {
        let Some(mut meeting) = self.meeting(contacts) else {
            return;
        };
        if let Some(nearest) = meeting.nearest()
            && let Some(encounter) = meeting.put_touches(nearest)
        {
            let colliders = [contacts.collider1, contacts.collider2];
            self.note(colliders, contacts.manifold, encounter);
        }
    }

    fn meeting<'a, 'b>(
        &self,
        contacts: &'a mut ContactModificationContext<'b>,
    ) -> Option<ApproachingPair<'a, 'b>> {
        let (bodies, colliders) = (contacts.bodies, contacts.colliders);
        let mover = |collider: ColliderHandle, part: u32, at| {
            let collider = colliders.get(collider)?;
            let (shape, first) = self.part(collider, part, at)?;
            let way = self.of(collider.parent(), bodies)?;
            Some(FlyingSolid { shape, first, way })
        };
        let manifold = contacts.manifold;
        let parts = [
            (manifold.subshape1, manifold.subshape_pos1()),
            (manifold.subshape2, manifold.subshape_pos2()),
        ];
        let first = mover(contacts.collider1, parts[0].0, parts[0].1)?;
        let second = mover(contacts.collider2, parts[1].0, parts[1].1)?;
        let both = [contacts.rigid_body1, contacts.rigid_body2];
        let both = both.map(|body| bodies.get(body?).filter(|body| body.is_dynamic()));
        let substeps = both.into_iter().flatten().map(substeps).min()?;
        Some(ApproachingPair {
            contacts,
            movers: [first, second],
            is_moved: both.map(|body| body.is_some()),
            // At the end of a sub-step, bodies are stopped that would meet in the next one.
            latest: TICK_SECONDS + TICK_SECONDS / substeps as f32,
        })
    }

    /// A convex part of a collider, and its pose in the world.
    fn part<'a>(
        &self,
        collider: &'a Collider,
        part: u32,
        at: Option<&Pose>,
    ) -> Option<(&'a dyn Shape, Pose)> {
        let Some(parts) = collider.shape().as_compound() else {
            return Some((collider.shape(), *collider.position()));
        };
        let (place, shape) = parts.shapes().get(part as usize)?;
        let at = at.unwrap_or(place);
        (!self.clusters).then(|| (&**shape, collider.position() * *at))
    }
}

impl ApproachingPair<'_, '_> {
    /// Where the solids touch or are nearest, if contacts would act before they do.
    fn nearest(&self) -> Option<NearestApproach> {
        let closing = self.closing()?;
        let is_ahead = self.way_until(closing) >= LEAST_WAY;
        (is_ahead || self.are_contacts_stale()).then_some(())?;
        nearest_approach(&self.movers, self.latest)
    }

    /// True if the solids are farther apart than their contacts say. Parry moves contacts along with them: those at a corner may be kept when it has gone
    /// past.
    fn are_contacts_stale(&self) -> bool {
        let contacts = self.contacts.solver_contacts.iter();
        let gap = contacts
            .map(|contact| contact.dist)
            .fold(f32::INFINITY, f32::min);
        look(&self.movers, 0.0).is_some_and(|(now, _)| now.gap > gap.max(0.0) + TOUCHING)
    }

    /// The time, in s, after which the first contact would act; `None` if none would, or if the solids touch already.
    fn closing(&self) -> Option<f32> {
        let [first, second] = [0, 1].map(|side| self.movers[side].way);
        let normal = *self.contacts.normal;
        let acceleration = (first.acceleration - second.acceleration).dot(normal);
        let mut earliest = f32::INFINITY;
        for contact in &*self.contacts.solver_contacts {
            let velocity =
                first.velocity(contact.anchor1, 0.0) - second.velocity(contact.anchor2, 0.0);
            let speed = velocity.dot(normal);
            if contact.dist <= 0.0 && speed * TICK_SECONDS < LEAST_WAY {
                return None;
            }
            let [gap, speed, acceleration] =
                [contact.dist.max(0.0), speed, acceleration].map(f64::from);
            earliest = earliest.min(time_to_close(gap, speed, acceleration) as f32);
        }
        (earliest <= self.latest).then_some(earliest)
    }

    /// The way, in units, that one solid makes past the other one until a time.
    fn way_until(&self, time: f32) -> f32 {
        let contacts = self.contacts.solver_contacts.iter();
        let ways = contacts.map(|contact| {
            let [first, second] = [(0, contact.anchor1), (1, contact.anchor2)]
                .map(|(side, point)| self.movers[side].way.velocity(point, 0.0));
            (first - second).length() * time
        });
        ways.fold(0.0, f32::max)
    }

    fn put_touches(&mut self, nearest: NearestApproach) -> Option<Encounter> {
        let (normal, touches) = self.touches(nearest);
        touches.first()?;
        let known = std::mem::take(self.contacts.solver_contacts);
        let any = *known.first()?;
        // Rapier has chosen and ordered the corners of a face so that things land well.
        let is_same = self.is_moved.contains(&false) && normal.dot(*self.contacts.normal) > SAME;
        let contacts: Vec<_> = match is_same {
            true => known.into_iter().map(TouchPoint::of).collect(),
            false => {
                let most = self.contacts.manifold.points.len().min(MOST_CONTACTS);
                let numbered = (0..).zip(touches).take(most);
                let contact = |number| {
                    let mut contact = any;
                    contact.contact_id = [number];
                    contact
                };
                numbered
                    .map(|(number, touch)| (touch, contact(number)))
                    .collect()
            }
        };
        *self.contacts.normal = normal;
        let are_both_moved = self.is_moved == [true; 2];
        let mut ways = contacts
            .iter()
            .map(|(touch, _)| touch.first[1] - touch.first[0]);
        let is_skewed = are_both_moved
            && ways.any(|way| way.reject_from_normalized(normal).length() > LEAST_WAY);
        let arms = contacts.into_iter().map(|(touch, contact)| {
            self.put(touch, contact);
            let arm = |side: usize| self.movers[side].way.arm(touch.first[side], nearest.time);
            (contact.contact_indices()[0], [0, 1].map(arm))
        });
        Some(Encounter {
            arms: arms.collect(),
            is_skewed,
        })
    }

    /// The normal and the points of touch where the solids are nearest.
    fn touches(&self, nearest: NearestApproach) -> (Vec3, Vec<TouchPoint>) {
        let touches = match manifold(&self.movers, nearest) {
            Some(found) => {
                let at = [0, 1].map(|side| self.movers[side].at(nearest.time));
                let touches = found.points.iter().map(|point| {
                    let here = [at[0] * point.local_p1, at[1] * point.local_p2];
                    self.touch(here, point.dist, nearest)
                });
                touches.collect()
            }
            None => vec![self.touch(nearest.points, nearest.gap, nearest)],
        };
        (nearest.normal, touches)
    }

    /// A point of touch, from where it is on both solids then, and their gap there.
    fn touch(&self, here: [Vec3; 2], gap: f32, then: NearestApproach) -> TouchPoint {
        let first = [0, 1].map(|side| self.movers[side].way.first(here[side], then.time));
        let way = (here[0] - first[0]) - (here[1] - first[1]);
        let gap = gap + way.dot(then.normal);
        TouchPoint { first, gap }
    }

    /// Puts a contact, with the arms of its points as they are when they touch. Rapier takes the middle of the gap for the point in which both bodies are
    /// pushed.
    fn put(&mut self, touch: TouchPoint, mut contact: SolverContact) {
        let [first, second] = touch.first;
        let middle = match self.is_moved {
            [true, false] => first,
            [false, true] => second,
            [true, true] | [false, false] => first.midpoint(second),
        };
        let half = *self.contacts.normal * (0.5 * touch.gap);
        contact.anchor1 = middle - half;
        contact.anchor2 = middle + half;
        contact.dist = touch.gap;
        self.contacts.solver_contacts.push(contact);
    }
}
