//! The object in the selected hand, as it is drawn.

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::Hands;
use tabletop_geometry::{Pose, Primitive};

use crate::visual::{Filled, Visuals};

/// The picture of the object that the selected hand holds.
#[derive(SystemParam)]
pub(crate) struct HeldVisual<'w, 's> {
    hands: Res<'w, Hands>,
    visuals: Res<'w, Visuals>,
    filled: Query<'w, 's, (&'static Transform, &'static Filled)>,
}

/// A held object as it is drawn.
#[derive(Clone, Copy)]
pub(crate) struct DrawnHeld<'a> {
    /// Its picture.
    pub visual: Entity,
    /// Its pose on the screen.
    pub pose: Pose,
    /// Its solids, in the frame of the object.
    pub solids: &'a [Primitive],
}

impl HeldVisual<'_, '_> {
    /// The object as it is drawn, if the selected hand holds one.
    pub fn get(&self) -> Option<DrawnHeld<'_>> {
        let object = self.hands.held_by(self.hands.selected)?;
        let visual = self.visuals.of(object)?;
        let (transform, filled) = self.filled.get(visual).ok()?;
        Some(DrawnHeld {
            visual,
            pose: transform.into(),
            solids: &filled.0,
        })
    }
}
