//! Mechanisms: switches, buttons, lights and other controls, and the networks between them; screws, nuts and valves; scissors.
//!
//! The state of a [`Control`](tabletop_core::Control) is part of its object's [`ObjectSpec`](tabletop_core::ObjectSpec), so physics,
//! pictures and saved files follow it. A control whose state changes passes its number on to those downstream. [`Bonds`] lists the objects
//! that are fastened to each other; a fixed joint holds each bond.
//!
//! ```
//! use bevy::prelude::*;
//! use tabletop_core::{Control, ControlKind, Side, ToggleSwitch, prelude::*};
//! use tabletop_mechanism::MechanismPlugin;
//! use tabletop_physics::PhysicsPlugin;
//! use tabletop_scene::ScenePlugin;
//!
//! let mut app = App::new();
//! app.add_plugins((MinimalPlugins, CorePlugin::default(), PhysicsPlugin::default()))
//!     .add_plugins((ScenePlugin, MechanismPlugin))
//!     .start();
//! let switch = Control::new(ControlKind::ToggleSwitch(ToggleSwitch {
//!     span: Vec3::new(0.6, 0.3, 0.1),
//!     angle: 6.0,
//!     color: Rgb::GRAY,
//!     pressed: Side::Left,
//!     states: 2,
//! }));
//! let switch = ObjectSpec::new("power", Pose::IDENTITY, 0.0, Shape::Control(switch));
//! let scene = SceneSpec { items: vec![SceneItem::Object(switch)], ..default() };
//! app.world_mut().write_command(SceneCommand::Set(Box::new(scene)));
//! app.world_mut().write_command(MechanismCommand::Trigger {
//!     hand: Hand::Any,
//!     control: "power".into(),
//!     part: None,
//! });
//! app.step(1);
//!
//! let power = app.world().resource::<ObjectIndex>().get("power").unwrap();
//! let spec = app.world().get::<ObjectSpec>(power).unwrap();
//! assert_eq!(spec.control("power").unwrap().state, 1);
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod bonds;
mod button;
mod limb;
mod network;
mod obey;
mod press;
mod settle;
mod shears;
mod wrench;

use bevy::prelude::*;
use tabletop_core::{
    Bonds, CommandSystems, MechanismSystems, RestApp as _, RestingSystems, require,
};
use tabletop_history::{RollbackApp, is_rolling_back};
use tabletop_physics::{PhysicsPlugin, take_in};

/// Adds controls and bonds. Needs [`CorePlugin`](tabletop_core::CorePlugin) and [`PhysicsPlugin`]. With
/// [`HistoryPlugin`](tabletop_history::HistoryPlugin), acts on them can be undone.
#[derive(Clone, Copy, Debug, Default)]
pub struct MechanismPlugin;

impl Plugin for MechanismPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<settle::New>()
            .rollback_resource::<settle::New>()
            .init_resource::<press::Pressed>()
            .rollback_resource::<press::Pressed>()
            .init_resource::<wrench::Wrenches>()
            .rollback_resource::<wrench::Wrenches>()
            .rollback_resource::<Bonds>()
            .rollback_component::<bonds::BondJoint>()
            .rollback_component::<press::Pressable>()
            .rollback_component::<shears::Snip>()
            .add_systems(
                FixedUpdate,
                (
                    (settle::settle.run_if(settle::any), obey::obey)
                        .chain()
                        .in_set(MechanismSystems::Obey),
                    (
                        wrench::turn.run_if(wrench::is_possible),
                        press::press.run_if(press::is_possible),
                        button::moved_caps.pipe(button::follow_caps),
                        shears::cut_links.run_if(shears::are_there),
                    )
                        .chain()
                        .in_set(MechanismSystems::React),
                    take_in.in_set(CommandSystems::Mechanisms),
                )
                    .chain()
                    .in_set(RestingSystems),
            )
            .wake_while(settle::any)
            .add_observer(settle::note_new.run_if(not(is_rolling_back)))
            .add_observer(settle::note_despawned.run_if(not(is_rolling_back)))
            .add_observer(settle::note_parked.run_if(not(is_rolling_back)));
    }

    fn finish(&self, app: &mut App) {
        require::<PhysicsPlugin>(app, self);
    }
}
