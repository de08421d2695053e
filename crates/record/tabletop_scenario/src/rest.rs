//! Rest: an object is at rest if it has stayed in place for a while.

use std::collections::BTreeMap;

use bevy::prelude::*;
use tabletop_core::TICKS_PER_SECOND;
use tabletop_geometry::Pose;

use crate::seen::{ScenarioObject, Seen};

/// Largest motion of an object at rest, in units, and in radians for turns.
const TREMBLE: (f32, f32) = (0.005, 0.005);

/// Number of ticks without motion after which an object is at rest.
const TICKS_TO_REST: u32 = TICKS_PER_SECOND / 2;

/// Number of ticks after the last step for which checks of placement must go on to hold.
pub(crate) const TICKS_TO_LAST: u64 = 3 * TICKS_PER_SECOND as u64;

/// Number of ticks without motion after which a held object has arrived.
const TICKS_TO_ARRIVE: u32 = TICKS_PER_SECOND / 5;

/// The time for which every object has stayed in place. Objects that are gone are kept: undo brings them back as they were.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stillness(BTreeMap<Entity, Stay>);

#[derive(Clone, Copy, Debug)]
struct Stay {
    at: Pose,
    ticks: u32,
}

impl Stillness {
    /// Takes in the result of a tick.
    pub fn observe(&mut self, seen: &Seen) {
        if seen.paused {
            return;
        }
        for object in &seen.objects {
            let stay = match self.0.get(&object.entity) {
                Some(stay) if is_near(stay.at, object.pose) => Stay {
                    ticks: stay.ticks.saturating_add(1),
                    ..*stay
                },
                Some(_) | None => Stay {
                    at: object.pose,
                    ticks: 0,
                },
            };
            self.0.insert(object.entity, stay);
        }
    }

    /// Passes over this many ticks in which nothing moves.
    pub fn pass_over(&mut self, ticks: u64) {
        let ticks = u32::try_from(ticks).unwrap_or(u32::MAX);
        for stay in self.0.values_mut() {
            stay.ticks = stay.ticks.saturating_add(ticks);
        }
    }

    pub fn is_at_rest(&self, object: &ScenarioObject) -> bool {
        self.ticks(object) >= TICKS_TO_REST
    }

    pub fn has_arrived(&self, object: &ScenarioObject) -> bool {
        self.ticks(object) >= TICKS_TO_ARRIVE
    }

    /// The id of the first object that is not at rest.
    pub fn moving<'a>(&self, seen: &Seen<'a>) -> Option<&'a str> {
        let mut objects = seen.objects.iter();
        let moving = objects.find(|object| !self.is_at_rest(object))?;
        Some(&moving.spec.id)
    }

    fn ticks(&self, object: &ScenarioObject) -> u32 {
        self.0.get(&object.entity).map_or(0, |stay| stay.ticks)
    }
}

fn is_near(a: Pose, b: Pose) -> bool {
    a.location.distance(b.location) <= TREMBLE.0
        && a.rotation.angle_between(b.rotation) <= TREMBLE.1
}
