//! The demonstrator's invisible hands.

use std::fmt;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

/// One of the demonstrator's hands (report section 4, figure 8a). At most two of them hold something at the same time.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Hash,
    PartialOrd,
    Ord,
    Serialize,
    Deserialize,
    Reflect,
)]
pub enum Hand {
    /// The left hand.
    Left,
    /// The right hand.
    Right,
    /// Both hands together.
    Both,
    /// Whichever hand is free.
    #[default]
    Any,
}

impl Hand {
    /// The hands, in the order of the panel that selects one.
    pub const ALL: [Self; 4] = [Self::Left, Self::Right, Self::Both, Self::Any];

    /// Its name in recordings: `LeftHand`, `RightHand`, `BothHands` or `AnyHand`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "LeftHand",
            Self::Right => "RightHand",
            Self::Both => "BothHands",
            Self::Any => "AnyHand",
        }
    }
}

impl fmt::Display for Hand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The selected hand, and the object in each hand.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub struct Hands {
    /// The hand that mouse and panels act with.
    pub selected: Hand,
    held: [Option<Entity>; 4],
}

impl Hands {
    /// The object that this hand holds.
    pub fn held_by(&self, hand: Hand) -> Option<Entity> {
        self.held[hand as usize]
    }

    /// The hand that holds this object.
    pub fn holder_of(&self, object: Entity) -> Option<Hand> {
        Hand::ALL
            .into_iter()
            .find(|&hand| self.held_by(hand) == Some(object))
    }

    /// True if any hand holds an object.
    pub fn hold_something(&self) -> bool {
        self.held.iter().any(Option::is_some)
    }

    /// Puts an object into a hand, or empties the hand.
    pub fn set_held(&mut self, hand: Hand, object: Option<Entity>) {
        self.held[hand as usize] = object;
    }
}
