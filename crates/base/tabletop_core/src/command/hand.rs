//! Commands to the demonstrator's hands.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::Hand;

/// A command to the demonstrator's hands. [Selecting](Self::Select) a hand is one too: it decides which hand the next
/// commands of the mouse and the panels are for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum HandCommand {
    /// Select the hand that mouse and panels act with.
    Select(Hand),
    /// Take an object into a hand.
    Grasp {
        /// The hand.
        hand: Hand,
        /// Id of the object.
        object: String,
    },
    /// Move the held object to this location, as far as nothing is in its way.
    MoveTo {
        /// The hand.
        hand: Hand,
        /// Target of the object's origin, in units.
        location: Vec3,
    },
    /// Move the held object on from its present target.
    MoveBy {
        /// The hand.
        hand: Hand,
        /// Displacement, in units.
        offset: Vec3,
    },
    /// Turn the held object about an axis of the world through its origin.
    Turn {
        /// The hand.
        hand: Hand,
        /// The axis; its length does not matter.
        axis: Vec3,
        /// The angle in degrees.
        degrees: f32,
    },
    /// Let go of the held object.
    Release(Hand),
    /// Remove the held object from the world.
    Destroy(Hand),
}
