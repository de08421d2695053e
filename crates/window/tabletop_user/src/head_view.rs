//! The robot's view in the window.

use bevy::prelude::*;

/// The state of the window with the robot's view.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HeadView {
    is_shown: bool,
    /// True if what the robot believes is drawn over its picture.
    pub has_beliefs: bool,
}

impl HeadView {
    /// True if the user sees it.
    pub const fn is_shown(self) -> bool {
        self.is_shown
    }

    /// Shows or hides it.
    pub const fn toggle(&mut self) {
        self.is_shown = !self.is_shown;
    }

    /// Run condition: it is shown.
    pub fn is_on(view: Res<Self>) -> bool {
        view.is_shown
    }
}
