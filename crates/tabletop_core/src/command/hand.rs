//! Commands to the demonstrator's hands.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::Hand;

/// A command to the demonstrator's hands. [Selecting](Self::Select) a hand is one of them, because it says with which hand the
/// next ones are given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum HandCommand {
    /// Let mouse and panels act with this hand.
    Select(Hand),
    /// Take an object into a hand.
    Grasp {
        /// The hand.
        hand: Hand,
        /// Id of the object.
        object: String,
    },
    /// Move what a hand holds to this location, as far as nothing is in its way.
    MoveTo {
        /// The hand.
        hand: Hand,
        /// Where the object's origin is to be, in units.
        location: Vec3,
    },
    /// Move what a hand holds on from where it is to be.
    MoveBy {
        /// The hand.
        hand: Hand,
        /// How far, in units.
        offset: Vec3,
    },
    /// Turn what a hand holds about an axis of the world through the object's origin.
    Turn {
        /// The hand.
        hand: Hand,
        /// The axis; its length does not matter.
        axis: Vec3,
        /// The angle in degrees.
        degrees: f32,
    },
    /// Let go of what a hand holds.
    Release(Hand),
    /// Close the scissors that a hand holds by one of their blades.
    Cut(Hand),
    /// Remove what a hand holds from the world.
    Destroy(Hand),
}
