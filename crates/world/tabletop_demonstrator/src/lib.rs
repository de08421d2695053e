//! The demonstrator's invisible hands (report section 4): they grasp objects, move and turn them, release them and
//! destroy them.
//!
//! [`SimCommand`](tabletop_core::SimCommand)s control the hands, and [`SimFact`](tabletop_core::SimFact)s report the results. A held object
//! does not fall; it slides along obstacles (the table, fixed objects, objects in another hand) and pushes free objects. An object that joints
//! hold as well, such as a chain's link or a lid, follows its joints.
//!
//! ```
//! use bevy::prelude::*;
//! use tabletop_core::prelude::*;
//! use tabletop_demonstrator::DemonstratorPlugin;
//! use tabletop_physics::PhysicsPlugin;
//! use tabletop_scene::ScenePlugin;
//!
//! let mut app = App::new();
//! app.add_plugins((MinimalPlugins, CorePlugin::default(), PhysicsPlugin::default()))
//!     .add_plugins((ScenePlugin, DemonstratorPlugin))
//!     .start();
//! let block = ObjectSpec {
//!     id: "block".into(),
//!     pose: Pose::at(Vec3::new(0.0, 0.0, 0.5)),
//!     mass: 1.0,
//!     shape: Shape::Block { span: Vec3::ONE, color: Rgb::GRAY },
//!     dynamics: Default::default(),
//!     descriptions: vec![],
//! };
//! let scene = SceneSpec { items: vec![SceneItem::Object(block)], ..default() };
//! app.world_mut().write_command(SceneCommand::Set(Box::new(scene)));
//! app.step(1);
//!
//! let hand = Hand::Right;
//! let location = Vec3::new(3.0, 1.0, 4.0);
//! app.world_mut().write_command(HandCommand::Grasp { hand, object: "block".into() });
//! app.world_mut().write_command(HandCommand::MoveTo { hand, location });
//! app.step(60);
//!
//! let block = app.world().resource::<Hands>().held_by(hand).unwrap();
//! assert_eq!(app.world().get::<Transform>(block).unwrap().translation, location);
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod carry;
mod grasp;
mod obstacles;
mod rules;

pub use grasp::CarryTarget;

/// The names that most users of this crate need.
pub mod prelude {
    #[doc(hidden)]
    pub use crate::{CarryTarget, DemonstratorPlugin};
}

use bevy::prelude::*;
use tabletop_core::{ActuateSystems, CommandSystems, RestingSystems, require};
use tabletop_history::{RollbackApp, is_rolling_back};
use tabletop_physics::PhysicsPlugin;

/// Adds the hands. Needs [`CorePlugin`](tabletop_core::CorePlugin) and [`PhysicsPlugin`]. With
/// [`HistoryPlugin`](tabletop_history::HistoryPlugin), their acts can be undone.
#[derive(Clone, Copy, Debug, Default)]
pub struct DemonstratorPlugin;

impl Plugin for DemonstratorPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<CarryTarget>()
            .rollback_component::<CarryTarget>()
            .add_systems(
                FixedUpdate,
                (
                    grasp::obey.in_set(CommandSystems::Hands),
                    carry::carry.in_set(ActuateSystems::Hands),
                )
                    .in_set(RestingSystems),
            )
            .add_observer(grasp::note_lost.run_if(not(is_rolling_back)))
            .add_observer(grasp::note_carried_anew.run_if(not(is_rolling_back)));
    }

    fn finish(&self, app: &mut App) {
        require::<PhysicsPlugin>(app, self);
    }
}
