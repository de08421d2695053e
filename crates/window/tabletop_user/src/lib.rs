//! The user before the window: keys and their actions, the camera he looks through, how and where he drags, the pace of time, the
//! next recording, those there are, the imitation and the edits of one that he watches, and the real robot that he connects to.
//!
//! View and panels share it and do not know each other. A world without a window has none of it.

mod ambience;
mod chosen;
mod connection;
mod curves;
mod drag_plane;
mod dragging;
mod editing;
mod ghost;
mod head_view;
mod held_axes;
mod imitating;
mod keymap;
mod measuring;
mod navigation;
mod neighborhood;
mod next_take;
mod notices;
mod pace;
mod preset_seeds;
mod quit_question;
mod robot_look;
mod shelf;
mod taught_program;

pub use ambience::Ambience;
pub use chosen::Chosen;
pub use connection::{Connection, ConnectionOrder, DrivingLeave};
pub use curves::{Curves, Quantity, RecordedCurves, ShownCurves};
pub use drag_plane::DragPlane;
pub use dragging::Dragging;
pub use editing::{EditOrder, Editing, TimelineEdit};
pub use ghost::{Ghost, Ghosts};
pub use head_view::HeadView;
pub use held_axes::HeldAxes;
pub use imitating::{ImitatedStep, Imitating, TaskOrder};
pub use keymap::{
    Action, ActionGroup, BindingError, Gamepad, GamepadControl, JointKeyError, KeyBinding,
    KeyLetters, KeySystems, KeyboardFocus, Keymap, Keys, Modifiers, Situation, StickWay, Way,
    was_struck,
};
pub use measuring::Measuring;
pub use navigation::{CameraMotion, CameraView, FirstView, Steering, UserCamera};
pub use neighborhood::Neighborhood;
pub use next_take::NextTake;
pub use notices::{Notice, Notices, Tone};
pub use pace::{Pace, PacePlugin, SingleStep};
pub use preset_seeds::PresetSeeds;
pub use quit_question::QuitQuestion;
pub use robot_look::RobotLook;
pub use shelf::{
    Errand, RecordingDigest, RunningErrand, Shelf, ShelfOrder, ShelvedRecording, TRASH,
};
pub use taught_program::{OtherProgram, TaughtProgram};

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
            .add_message::<ConnectionOrder>()
            .add_message::<EditOrder>()
            .add_message::<ShelfOrder>()
            .add_message::<TaskOrder>()
            .init_resource::<Chosen>()
            .init_resource::<Connection>()
            .init_resource::<DragPlane>()
            .init_resource::<Dragging>()
            .init_resource::<Editing>()
            .init_resource::<Ghosts>()
            .init_resource::<HeadView>()
            .init_resource::<Imitating>()
            .init_resource::<Gamepad>()
            .init_resource::<KeyLetters>()
            .init_resource::<KeyboardFocus>()
            .init_resource::<Keymap>()
            .init_resource::<Measuring>()
            .init_resource::<Ambience>()
            .init_resource::<RobotLook>()
            .init_resource::<NextTake>()
            .init_resource::<Notices>()
            .init_resource::<PresetSeeds>()
            .init_resource::<QuitQuestion>()
            .init_resource::<Shelf>()
            .init_resource::<Steering>()
            .init_resource::<TaughtProgram>()
            .register_type::<Chosen>()
            .register_type::<DragPlane>()
            .register_type::<Dragging>()
            .register_type::<Pace>()
            .register_type::<Steering>()
            .register_type::<UserCamera>()
            .configure_sets(
                RunFixedMainLoop,
                KeySystems.in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop),
            );
    }
}
