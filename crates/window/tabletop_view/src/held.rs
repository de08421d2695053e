//! Objects as they are drawn: above all the one in the selected hand.

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

/// An object as it is drawn.
#[derive(Clone, Copy)]
pub(crate) struct DrawnObject<'a> {
    /// Its picture.
    pub visual: Entity,
    /// Its pose on the screen.
    pub pose: Pose,
    /// Its solids, in the frame of the object.
    pub solids: &'a [Primitive],
}

impl HeldVisual<'_, '_> {
    /// The object as it is drawn, if the selected hand holds one.
    pub fn get(&self) -> Option<DrawnObject<'_>> {
        self.of(self.hands.held_by(self.hands.selected)?)
    }

    /// An object as it is drawn.
    pub fn of(&self, object: Entity) -> Option<DrawnObject<'_>> {
        let visual = self.visuals.of(object)?;
        let (transform, filled) = self.filled.get(visual).ok()?;
        Some(DrawnObject {
            visual,
            pose: transform.into(),
            solids: &filled.0,
        })
    }
}
