//! The user before the window: keys and their actions, the camera he looks through, the plane he drags in, the pace of time, the
//! next recording, those there are, and the imitation and the edits of one that he watches.
//!
//! View and panels share it and do not know each other. A world without a window has none of it.

mod curves;
mod drag_plane;
mod editing;
mod ghost;
mod imitating;
mod keymap;
mod navigation;
mod next_take;
mod pace;
mod shelf;

pub use curves::{Curves, Quantity, RecordedCurves, ShownCurves};
pub use drag_plane::DragPlane;
pub use editing::{EditOrder, Editing, TimelineEdit};
pub use ghost::{Ghost, Ghosts};
pub use imitating::{Imitating, TaskOrder};
pub use keymap::{
    Action, ActionGroup, BindingError, JointKeyError, KeyBinding, KeyLetters, KeySystems,
    KeyboardFocus, Keymap, Keys, Modifiers, Situation, Way, was_struck,
};
pub use navigation::{CameraMotion, CameraView, Steering, UserCamera};
pub use next_take::NextTake;
pub use pace::{Pace, PacePlugin, SingleStep};
pub use shelf::{
    Errand, RecordingDigest, RunningErrand, Shelf, ShelfOrder, ShelvedRecording, TRASH,
};

use bevy::prelude::*;

/// Adds the resources that view and panels share. Both of them add it, unless the other one already has.
#[derive(Clone, Copy, Debug, Default)]
pub struct UserPlugin;

impl UserPlugin {
    /// Adds it to an app that does not have it yet.
    pub fn add_to(app: &mut App) {
        if !app.is_plugin_added::<Self>() {
            app.add_plugins(Self);
        }
    }
}

impl Plugin for UserPlugin {
    fn build(&self, app: &mut App) {
        app.add_message::<CameraMotion>()
            .add_message::<EditOrder>()
            .add_message::<ShelfOrder>()
            .add_message::<TaskOrder>()
            .init_resource::<DragPlane>()
            .init_resource::<Editing>()
            .init_resource::<Ghosts>()
            .init_resource::<Imitating>()
            .init_resource::<KeyLetters>()
            .init_resource::<KeyboardFocus>()
            .init_resource::<Keymap>()
            .init_resource::<NextTake>()
            .init_resource::<Shelf>()
            .init_resource::<Steering>()
            .register_type::<DragPlane>()
            .register_type::<Pace>()
            .register_type::<Steering>()
            .register_type::<UserCamera>()
            .configure_sets(
                RunFixedMainLoop,
                KeySystems.in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop),
            );
    }
}
