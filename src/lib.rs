//! A virtual demonstrator environment for robot imitation learning: a table with objects on it, simulated with or without
//! a window.
//!
//! | crate | content |
//! |---|---|
//! | [`core`] | the shared vocabulary: objects, scenes, commands, facts, the clock |
//! | [`geometry`] | poses, coloured solids, bounds and rays |
//! | [`xml`] | task files |
//! | [`physics`] | Rapier, configured |
//! | [`assembly`] | the content of a task file, taken apart into objects and joints |
//! | [`scene`] | the table, and the objects that come and go on it |
//! | [`history`] | undo and redo |
//! | [`demonstrator`] | the invisible hands |
//! | [`mechanism`] | controls and bonds |
//! | [`robot`] | the robot: its description, bodies, look and cameras |
//! | [`drive`] | the simulated drive that moves it: motors, pushes, grips |
//! | [`kinematics`] | robots from URDF |
//! | [`controller`] | the seam between the robot and what acts for it |
//! | [`camera`] | the view of the robot's head camera |
//! | [`recorder`] | recordings on disk |
//! | [`script`] | users' Matlab, Octave and Python scripts that drive the robot |
//! | [`storage`] | the user's files: each is replaced, moved and removed by one rule |
//! | [`task`] | the task that a recording shows |
//! | [`replay`] | recordings, simulated again |
//! | [`export`] | recordings as datasets of other tools |
//! | [`dataset`] | folders of recordings and datasets: imported, described, checked, edited |
//! | [`environment`] | worlds and environments in the hands of a program, thousands of them |
//! | [`validation`] | small worlds whose results mechanics gives in closed form |
//! | [`cli`] | the command line |
//! | [`imitation`], [`multiplication`] | whole episodes in worlds of their own |
//! | [`planner`] | the robot's plan for such a task |
//! | [`scenario`] | scripted demonstrations, for tests and datasets |
//!
//! [`TabletopSimPlugins`] is the simulator without a window. It runs on Bevy's `MinimalPlugins`:
//!
//! ```
//! use bevy::prelude::*;
//! use tabletop::prelude::*;
//!
//! let mut app = App::new();
//! app.add_plugins((MinimalPlugins, TabletopSimPlugins)).start();
//! app.world_mut()
//!     .write_command(SceneCommand::Load("tablesetup/default.xml".into()));
//! app.step(60);
//!
//! let index = app.world().resource::<ObjectIndex>();
//! let red_block = index.get("RedBlock").unwrap();
//! let pose = Pose::from(app.world().get::<Transform>(red_block).unwrap());
//! assert!((pose.location - Vec3::new(2.0, 0.0, 1.0)).length() < 0.005);
//! ```

pub use tabletop_assembly as assembly;
pub use tabletop_bridge as bridge;
pub use tabletop_camera as camera;
pub use tabletop_controller as controller;
pub use tabletop_core as core;
pub use tabletop_dataset as dataset;
pub use tabletop_demonstrator as demonstrator;
pub use tabletop_drive as drive;
pub use tabletop_environment as environment;
pub use tabletop_episodes::{
    Collection, CollectionError, StillScene, imitation, multiplication, robot_body, run_episodes,
    scene_at_beginning, shown_task, soak, watching,
};
pub use tabletop_export as export;
pub use tabletop_film as film;
pub use tabletop_geometry as geometry;
#[cfg(feature = "window")]
pub use tabletop_gui as gui;
pub use tabletop_history as history;
pub use tabletop_kinematics as kinematics;
pub use tabletop_mechanism as mechanism;
pub use tabletop_mesh as mesh;
pub use tabletop_perception as perception;
pub use tabletop_physics as physics;
pub use tabletop_planner as planner;
pub use tabletop_policy as policy;
pub use tabletop_real as real;
pub use tabletop_recorder as recorder;
pub use tabletop_replay as replay;
pub use tabletop_report as report;
pub use tabletop_robot as robot;
pub use tabletop_scenario as scenario;
pub use tabletop_scene as scene;
pub use tabletop_script as script;
pub use tabletop_script::engine;
pub use tabletop_sim::{
    RecordedSettingsPlugin, ResetPlugin, ShippedFilesPlugin, TabletopSimPlugins, final_state,
    headless_app, headless_app_with, reset, robots, scene_dump, shipped, task_files,
};
pub use tabletop_storage as storage;
pub use tabletop_task as task;
#[cfg(feature = "window")]
pub use tabletop_user as user;
pub use tabletop_validation as validation;
#[cfg(feature = "window")]
pub use tabletop_view as view;
pub use tabletop_vision as vision;
pub use tabletop_xml as xml;

pub mod cli;
mod progress;
#[cfg(test)]
#[cfg(feature = "window")]
mod test_folder;
#[cfg(feature = "window")]
pub mod window;

#[cfg(feature = "window")]
use bevy::{app::PluginGroupBuilder, prelude::*};

/// The types that most users of the simulator need.
pub mod prelude {
    #[doc(hidden)]
    pub use crate::{
        TabletopSimPlugins, headless_app, headless_app_with, physics::PhysicsPlugin,
        scene::ScenePlugin, xml::XmlPlugin,
    };
    #[doc(hidden)]
    pub use tabletop_core::prelude::*;
}

/// The window on a simulation, beside Bevy's `DefaultPlugins`: [`ViewPlugin`](view::ViewPlugin) shows the world,
/// [`GuiPlugin`](gui::GuiPlugin) has keys, mouse and panels, and [`PacePlugin`](user::PacePlugin) lets users choose the pace of time.
#[cfg(feature = "window")]
#[derive(Clone, Copy, Debug, Default)]
pub struct TabletopWindowPlugins;

#[cfg(feature = "window")]
impl PluginGroup for TabletopWindowPlugins {
    fn build(self) -> PluginGroupBuilder {
        PluginGroupBuilder::start::<Self>()
            .add(view::ViewPlugin)
            .add(gui::GuiPlugin)
            .add(user::PacePlugin)
    }
}
