//! Ghosts: previews of objects at their goals.

use bevy::prelude::*;
use tabletop_core::Shape;
use tabletop_geometry::Pose;

/// Ghosts: translucent previews in the window, and only there, of objects at their goals. The crate that moves the objects sets them.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Ghosts(pub Vec<Ghost>);

/// The preview of an object at its goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Ghost {
    /// Id of the object.
    pub id: String,
    /// Its shape.
    pub shape: Shape,
    /// Its goal.
    pub pose: Pose,
    /// True for the next object to be moved: a line leads to the ghost from the object.
    pub is_next: bool,
}

impl Ghost {
    /// Opacity of a ghost, from 0 to 1.
    pub const OPACITY: f32 = 0.35;
}
