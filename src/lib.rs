//! A virtual demonstrator environment for robot imitation learning: a table with objects on it, simulated with or without
//! a window.
//!
//! | crate | content |
//! |---|---|
//! | [`core`] | The vocabulary shared by the parts of the tabletop simulator |
//! | [`geometry`] | Geometry: poses, twists, coloured solids, their bounds and distances, and the rays that meet them |
//! | [`kinematics`] | Robots from URDF: the poses of their links, inverse kinematics of their arms, and the forces that their weight exerts on the joints |
//! | [`mesh`] | Meshes: triangles and surfaces from STL, OBJ and COLLADA files, and the convex solids that fill them |
//! | [`storage`] | The user's files and folders: each is read, created, replaced, moved and removed by one rule |
//! | [`demonstrator`] | The demonstrator's invisible hands (report section 4): they grasp objects, move and turn them, release them and destroy them |
//! | [`history`] | Undo and redo: the world as it was at the beginning of a recording's segment, bit for bit |
//! | [`mechanism`] | Mechanisms: switches, buttons, lights and other controls, and the networks between them; screws, nuts and valves; scissors |
//! | [`physics`] | Physics of the tabletop simulator: the one place that adds and configures Rapier |
//! | [`scene`] | The table and the objects on it: how a scene becomes bodies and joints, and how they come and go |
//! | [`xml`] | Task files: the table and its objects as XML (report section 6.2) |
//! | [`program`] | Task programs: what is to be done with sets of objects (every, each, the largest first, until, patterns, counts, conditions), in sentences that are printed and parsed, and the next step of a program on the table as it is now |
//! | [`recorder`] | Recordings of demonstrations on disk, in the files of the original program, with further files for replays |
//! | [`scenario`] | Scripted demonstrations: files of steps and checks |
//! | [`task`] | The task that a recording demonstrates: the manipulations, the relations that each establishes, the goals with the freedoms that symmetry leaves, the order that matters, and the requirements on the objects that take its roles (report sections 1 and 4) |
//! | [`bridge`] | The connection to real robots |
//! | [`camera`] | The robot's eye: the view of its head camera, as a picture with depth and object numbers, with or without a window |
//! | [`controller`] | The seam between the robot and whoever acts for it: a planner, a learned policy, a device in a person's hand |
//! | [`drive`] | The simulated drive of the robot: its joints move as they are commanded, as far as nothing is in the way, push what is free and grip what is between their fingers (report section 5) |
//! | [`planner`] | Imitation of demonstrated tasks by a robot: grasps from the geometry of objects, collision-free paths, and a closed loop that looks after each step, compares with the relations of the task, and corrects |
//! | [`real`] | A real robot beside the simulated one |
//! | [`robot`] | The robot at the table: a Baxter, or another one that a `robot.ron` describes (report section 5) |
//! | [`script`] | The script bridge: a user's Matlab (or Octave, or Python) scripts sense and move the robot, a call a tick (report section 5.2) |
//! | [`vision`] | The robot's sight: poses of known objects from pictures, by analysis by synthesis |
//! | [`benchmark`] | Benchmarks: what is understood of task programs that are taught by demonstrations, and how often policies do tasks |
//! | [`environment`] | The simulator in the hands of a program: single worlds, environments of reinforcement learning, and thousands of them on all cores |
//! | [`film`] | Recordings on film: the pictures of any camera at any rate, and videos, animations and contact sheets of them |
//! | [`replay`] | Recordings, simulated again: replays, their verification, and any moment of a recording |
//! | [`validation`] | The simulator's physics beside the closed-form results of mechanics |
//! | [`book`] | The documentation as a book: one page with contents, search and the way from chapter to chapter, which a browser shows without network |
//! | [`dataset`] | Folders of recordings and exported datasets: imported from other programs, described, checked, repaired, merged and split |
//! | [`export`] | Recordings as datasets of other tools |
//! | [`policy`] | A policy learned from one demonstration: from the head camera's picture to what is to be taken next, and where it is to be put |
//! | [`report`] | Recordings as pages that a browser shows without network: what was done, a player of the pictures, plots and numbers of one recording, or a table of many; and how often a policy did tasks |
//! | [`training`] | Training episodes: recordings as learners read them, in frames at equal intervals, each with a state, an action and pictures, and the task in sentences |
//! | [`wire`] | Policies by wire: openpi's protocol, a client and a server of it, and the mappings of its keys to a robot |
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

pub use tabletop_benchmark as benchmark;
pub use tabletop_book as book;
pub use tabletop_bridge as bridge;
pub use tabletop_camera as camera;
pub use tabletop_controller as controller;
pub use tabletop_core as core;
pub use tabletop_dataset as dataset;
pub use tabletop_demonstrator as demonstrator;
pub use tabletop_drive as drive;
pub use tabletop_environment as environment;
pub use tabletop_episodes::{
    Collection, CollectionError, RecordedRobot, StillScene, imitation, multiplication, robot_body,
    scene_at_beginning, shown_task, soak, telling, watching,
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
pub use tabletop_physics as physics;
pub use tabletop_planner as planner;
pub use tabletop_policy as policy;
pub use tabletop_program as program;
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
    headless_app, headless_app_with, reset, robots, run_episodes, scene_dump, shipped, task_files,
};
pub use tabletop_storage as storage;
pub use tabletop_task as task;
pub use tabletop_training as training;
#[cfg(feature = "window")]
pub use tabletop_user as user;
pub use tabletop_validation as validation;
#[cfg(feature = "window")]
pub use tabletop_view as view;
pub use tabletop_vision as vision;
#[cfg(feature = "window")]
pub use tabletop_window as window;
#[cfg(feature = "window")]
pub use tabletop_window::TabletopWindowPlugins;
pub use tabletop_wire as wire;
pub use tabletop_xml as xml;

pub mod cli;

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
