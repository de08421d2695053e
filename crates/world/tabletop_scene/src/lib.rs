//! The table and the objects on it: how a scene becomes bodies and joints, and how they come and go.
//!
//! [`ScenePlugin`] carries out the commands that put objects on the table; [`present_scene`] is the way back to a task file.
//!
//! ```
//! use bevy::prelude::*;
//! use tabletop_core::prelude::*;
//! use tabletop_physics::PhysicsPlugin;
//! use tabletop_scene::ScenePlugin;
//!
//! let mut app = App::new();
//! app.add_plugins((MinimalPlugins, CorePlugin::default(), PhysicsPlugin::default(), ScenePlugin))
//!     .start();
//! let block = ObjectSpec {
//!     id: "block".into(),
//!     pose: Pose::at(Vec3::new(0.0, 0.0, 5.0)),
//!     mass: 1.0,
//!     shape: Shape::Block { span: Vec3::ONE, color: Rgb::GRAY },
//!     dynamics: Default::default(),
//!     descriptions: vec![],
//! };
//! let scene = SceneSpec { items: vec![SceneItem::Object(block)], ..default() };
//! app.world_mut().write_command(SceneCommand::Set(Box::new(scene)));
//! app.step(120);
//!
//! let block = app.world().resource::<ObjectIndex>().get("block").unwrap();
//! let height = app.world().get::<Transform>(block).unwrap().translation.z;
//! assert!((height - 0.5).abs() < 0.01, "it lies at {height}");
//! ```
//!
//! [`assemble`] takes the content of a task file apart into single objects with unique ids and the joints between them:
//!
//! ```
//! use tabletop_scene::{IdAllocator, assemble};
//! use tabletop_core::prelude::*;
//!
//! let ball = Shape::Sphere { radius: 0.5, color: Rgb::RED };
//! let ball = SceneItem::Object(ObjectSpec::new("ball", Pose::IDENTITY, 1.0, ball));
//! let scene = SceneSpec { items: vec![ball.clone(), ball], ..Default::default() };
//! let objects = assemble(&scene, &mut IdAllocator::default()).objects;
//! assert_eq!([&objects[0].id, &objects[1].id], ["ball", "ball#0"]);
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod assembly;
mod compound;
mod edit;
mod ids;
mod lifecycle;
mod present;
mod preset;
#[cfg(test)]
mod test_app;

pub use assembly::{Assembly, assemble};
pub use ids::{IdAllocator, with_unique_ids};
pub use present::{PresentScene, present_scene};

/// The names that most users of this crate need.
pub mod prelude {
    #[doc(hidden)]
    pub use crate::{PresentScene, ScenePlugin, present_scene};
}

use bevy::prelude::*;
use tabletop_core::{CommandSystems, RestingSystems, SimSystems, require};
use tabletop_history::{RollbackApp, is_rolling_back};
use tabletop_physics::PhysicsPlugin;

use crate::compound::Compounds;

/// Puts tables and objects into the world and takes them out. Needs [`CorePlugin`](tabletop_core::CorePlugin) and
/// [`PhysicsPlugin`].
#[derive(Clone, Copy, Debug, Default)]
pub struct ScenePlugin;

impl Plugin for ScenePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<IdAllocator>()
            .init_resource::<Compounds>()
            .rollback_resource::<Compounds>()
            .rollback_resource::<IdAllocator>()
            .add_systems(
                FixedUpdate,
                (
                    lifecycle::carry_out_commands.in_set(CommandSystems::Scene),
                    lifecycle::remove_fallen.in_set(SimSystems::Sense),
                )
                    .in_set(RestingSystems),
            )
            .add_observer(lifecycle::note_created.run_if(not(is_rolling_back)))
            .add_observer(lifecycle::note_despawned.run_if(not(is_rolling_back)))
            .add_observer(lifecycle::note_parked.run_if(not(is_rolling_back)));
    }

    fn finish(&self, app: &mut App) {
        require::<PhysicsPlugin>(app, self);
    }
}
