//! The vocabulary shared by the parts of the tabletop simulator.
//!
//! This crate holds everything that two parts need which must not know each other: objects ([`ObjectSpec`], [`Shape`]), the contents of
//! task files ([`SceneSpec`]), commands and facts ([`SimCommand`], [`SimFact`]), and the phases of a tick ([`SimSystems`]).
//!
//! The world is right-handed with its origin at the centre of the table's top: X to the right, Y away from the robot,
//! **Z up**. A unit of length is 10 cm; masses are in kg, times in s. Angles are in radians in code, in degrees in files.
//!
//! ```
//! use bevy::prelude::*;
//! use tabletop_core::prelude::*;
//!
//! let mut app = App::new();
//! app.add_plugins((MinimalPlugins, CorePlugin::default()))
//!     .start()
//!     .step(60);
//! assert_eq!(app.world().resource::<SimTick>().0, 60);
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod agent;
mod bond;
mod clock;
mod command;
mod control;
mod fact;
mod fastening;
mod figure;
mod hand;
mod hand_camera;
mod idle;
mod joint;
mod jointed;
mod light;
pub mod limits;
mod manipulator;
mod mechanism;
mod mesh;
mod misspelling;
mod mount;
mod number;
mod object;
mod object_edit;
mod object_index;
mod operator;
mod paused;
mod phase;
mod picture;
mod playback;
mod preset;
mod push_button;
mod random;
mod reach;
mod recording;
mod reflection;
mod requirement;
mod rest;
mod robot;
mod robot_event;
mod rollback;
mod ron_fault;
mod scene;
mod sensor;
mod shape;
mod shipped;
mod shown_task;
mod tick;
mod timeline;

pub use agent::{Agent, ScriptCommand, ScriptEvent, SimBlocked};
pub use bond::{Bond, BondEnd, BondPoint, Bonds, GuestPoint, HostPoint, TightnessStep};
pub use clock::{StepApp, step_world};
pub use command::{
    Actor, Cause, ClockCommand, CommandId, CommandKind, CommandWriter, HandCommand, HistoryCommand,
    IssuedCommand, MechanismCommand, RecordingCommand, RobotCommand, SceneCommand, SimCommand,
    WriteCommand, carry_out,
};
pub use control::{
    button::{PressMode, PushButton},
    lights::{IndicatorLights, LightState},
    switch::{Side, ToggleSwitch},
};
pub use fact::{
    HandFact, HistoryFact, MechanismFact, RecordingFact, RobotFact, SceneFact, SimFact,
};
pub use fastening::Turn;
pub use figure::{CarriesHeadCamera, Figure};
pub use hand::{Hand, Hands};
pub use hand_camera::{HandCamera, HandCameras, HandImages};
pub use idle::{Idle, IdlePlugin};
pub use joint::{Joint, JointKind, JointSpec};
pub use jointed::{JointMotion, JointedSpec};
pub use light::{LIGHT, Light};
pub use manipulator::{Held, Manipulator};
pub use mechanism::{PlacedPart, TouchedSurface};
pub use mesh::{MeshError, MeshSpec};
pub use misspelling::nearest_name;
pub use number::Decimal;
pub use object::{
    Change, Control, ControlKind, CustomControl, CustomState, Dynamics, ObjectSpec, Part, Shape,
};
pub use object_edit::ObjectEdit;
pub use object_index::ObjectIndex;
pub use operator::{Operator, OperatorError};
pub use paused::Paused;
pub use phase::{
    ActuateSystems, CommandSystems, MechanismSystems, OrderSystems, SimSystems, TickSystems,
};
pub use picture::{Picture, PictureFault};
pub use playback::{Playback, PlaybackOrder};
pub use preset::Preset;
pub use random::Random;
pub use reach::Reach;
pub use recording::{History, OpenRecording, Recording, Replaying};
pub use requirement::require;
pub use rest::{RestApp, RestingSystems, Upkeep};
pub use robot::{
    Arm, BaseLayout, CameraCarrier, CameraLayout, Drive, FINGER_SPEED, Face, FingerLook,
    GripperKind, GripperLayout, HandCameraLayout, JOINTS_PER_ARM, JointId, JointLayout, JointName,
    JointRole, JointState, LayoutError, LayoutFile, LimbId, LimbLayout, LimbName, LimbState,
    LinkFrame, MANUAL_SPEED, Markers, MeasuredJoint, NameError, Obstacle, Robot, RobotContact,
    RobotJoint, RobotLayout, RobotMode, UrdfJoint, WIDEST_GRIP, snake_case,
};
pub use rollback::Rollback;
pub use ron_fault::{located_ron_fault, ron_fault};
pub use scene::{ChainSpec, LidBoxSpec, SceneItem, SceneSpec, Table};
pub use sensor::{HeadCamera, PictureDemand, PictureSystems, SensorImage};
pub use shape::{Composition, attributes::AttributeValue};
pub use shipped::{ShippedFile, ShippedFiles, is_shipped, seen_from};
pub use shown_task::{Required, ShownProperty, ShownRole, ShownStep, ShownTask};
pub use tick::{SimTick, TICK_SECONDS, TICKS_PER_SECOND};
pub use timeline::{
    Act, Timeline, TimelineGrip, TimelinePicture, TimelineSegment, TimelineStage, Verb,
};

use bevy::prelude::*;

/// The types that most users of the simulator need.
pub mod prelude {
    #[doc(hidden)]
    pub use crate::{
        Actor, Arm, ClockCommand, CommandWriter, CorePlugin, Drive, Hand, HandCommand, HandFact,
        Hands, HistoryCommand, HistoryFact, IssuedCommand, MechanismCommand, MechanismFact,
        ObjectIndex, ObjectSpec, Paused, Preset, RecordingCommand, RecordingFact, Robot,
        RobotCommand, RobotFact, RobotJoint, SceneCommand, SceneFact, SceneItem, SceneSpec, Shape,
        SimCommand, SimFact, SimSystems, SimTick, StepApp, Table, WriteCommand,
    };
    #[doc(hidden)]
    pub use tabletop_geometry::{Pose, Rgb};
}

/// Adds clock, commands and facts. Every other plugin of the simulator needs it.
#[derive(Clone, Copy, Debug)]
pub struct CorePlugin {
    /// Run the fixed schedules on one thread, which is much faster for them. With `false`, the app's executors stay as they are.
    pub one_thread: bool,
}

impl Default for CorePlugin {
    fn default() -> Self {
        Self { one_thread: true }
    }
}

impl Plugin for CorePlugin {
    fn build(&self, app: &mut App) {
        app.add_message::<IssuedCommand>()
            .add_message::<SimFact>()
            .add_message::<ScriptCommand>()
            .add_message::<ScriptEvent>()
            .add_message::<OpenRecording>()
            .add_message::<PlaybackOrder>()
            .init_resource::<Agent>()
            .init_resource::<Bonds>()
            .init_resource::<Cause>()
            .init_resource::<command::NextCommandId>()
            .init_resource::<SimBlocked>()
            .init_resource::<HandCameras>()
            .init_resource::<HandImages>()
            .init_resource::<Hands>()
            .init_resource::<History>()
            .init_resource::<Markers>()
            .init_resource::<Playback>()
            .init_resource::<Recording>()
            .init_resource::<Replaying>()
            .init_resource::<Robot>()
            .init_resource::<RobotLayout>()
            .init_resource::<ShownTask>()
            .init_resource::<ObjectIndex>()
            .init_resource::<Timeline>()
            .add_systems(
                FixedUpdate,
                paused::carry_out
                    .in_set(CommandSystems::Clock)
                    .in_set(RestingSystems),
            );
        clock::configure(app);
        rest::configure(app);
        reflection::register(app);
        if self.one_thread {
            clock::run_ticks_on_one_thread(app);
        }
    }
}
