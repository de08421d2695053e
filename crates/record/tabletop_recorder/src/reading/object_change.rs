//! What an event says of the objects.

use bevy::math::Vec3;

use crate::reading::event::Occurrence;

/// A change of the objects there are, or of where they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ObjectChange<'e> {
    /// An object is there for the first time.
    Create {
        /// Its id.
        id: &'e str,
        /// Its properties, as key and value.
        properties: &'e [(String, String)],
    },
    /// An object has gone.
    Delete {
        /// Its id.
        id: &'e str,
    },
    /// An object is somewhere else, or turned.
    Move {
        /// Its id.
        id: &'e str,
        /// Its present location, in units.
        location: Vec3,
        /// Its angles in degrees about the fixed X, then Y, then Z axis.
        degrees: Vec3,
    },
}

impl Occurrence {
    /// What it says of the objects; `None` if it is an act, or a change of something else.
    pub fn object_change(&self) -> Option<ObjectChange<'_>> {
        match self {
            Self::Create { id, properties } => Some(ObjectChange::Create { id, properties }),
            Self::Delete { id } => Some(ObjectChange::Delete { id }),
            &Self::Move {
                ref id,
                location,
                degrees,
            } => Some(ObjectChange::Move {
                id,
                location,
                degrees,
            }),
            Self::Grasp { .. }
            | Self::Release { .. }
            | Self::Destroy { .. }
            | Self::Grip { .. }
            | Self::LetGo { .. }
            | Self::InitializeControl { .. }
            | Self::ChangeControlState { .. }
            | Self::Trigger { .. }
            | Self::PointTo { .. }
            | Self::Fasten { .. }
            | Self::Loosen { .. }
            | Self::Cut { .. } => None,
        }
    }
}
