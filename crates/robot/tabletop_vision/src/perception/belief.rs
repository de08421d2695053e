//! Beliefs: where the robot thinks that the objects are.

use std::sync::atomic::{AtomicBool, Ordering};

use bevy::prelude::*;
use tabletop_core::SimTick;

use crate::ObjectPercept;

/// The objects as the robot believes them to be.
#[derive(Resource, Clone, Debug, Default)]
pub struct Perception {
    /// The tick of the picture in which they were seen.
    pub tick: SimTick,
    /// The objects, in the order of their creation.
    pub objects: Vec<PerceivedObject>,
}

/// An object as the robot believes it to be.
#[derive(Clone, Debug, PartialEq)]
pub struct PerceivedObject {
    /// Its id.
    pub id: String,
    /// The object.
    pub object: Entity,
    /// What was seen of it.
    pub seen: ObjectPercept,
}

/// The demand for perception of the next picture. Asking twice is the same as asking once; without a demand the eyes are closed.
#[derive(Resource, Debug, Default)]
pub struct PerceptionDemand(AtomicBool);

impl PerceptionDemand {
    /// Asks for perception of the next picture.
    pub fn ask(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Takes the request back.
    pub(crate) fn clear(&mut self) {
        *self.0.get_mut() = false;
    }

    pub(crate) fn is_asked(demand: Res<Self>) -> bool {
        demand.0.load(Ordering::Relaxed)
    }
}
