//! What the mouse is doing, for those who show it.

use bevy::{ecs::system::SystemParam, prelude::*};

use crate::{mouse::MousePress, navigate::Gesture};

/// The pressed buttons of the mouse.
#[derive(SystemParam)]
pub struct MouseGrip<'w> {
    press: Res<'w, MousePress>,
    gesture: Res<'w, Gesture>,
}

impl MouseGrip<'_> {
    /// True if the mouse moves or turns an object.
    pub fn is_drag(&self) -> bool {
        self.press.is_drag()
    }

    /// True if the mouse moves the camera, or may be about to.
    pub fn is_on_camera(&self) -> bool {
        *self.gesture != Gesture::Idle
    }
}
