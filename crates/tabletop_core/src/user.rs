//! What the window's view and its panels must agree on.

use bevy::prelude::*;

/// Marks the camera through which the user looks. The view makes it; the panels are drawn over its picture.
#[derive(Component, Clone, Copy, Debug, Default)]
pub struct UserCamera;

/// Systems that read keys, in [`RunFixedMainLoop`] before the ticks of a frame. They are left out while a panel has the
/// keyboard.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct KeySystems;
