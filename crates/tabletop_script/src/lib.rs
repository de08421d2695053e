//! The script bridge: a user's Matlab (or Octave, or Python) scripts sense and move the robot, a call a tick (report
//! section 5.2).
//!
//! An [`AgentOrder`](tabletop_core::AgentOrder) starts and stops them; what they order becomes
//! [`SimCommand`](tabletop_core::SimCommand)s, so a recording of what they do runs again without them. What becomes of them
//! is told by [`AgentNews`](tabletop_core::AgentNews) and stands in [`Agent`](tabletop_core::Agent).
//!
//! The simulation waits for the script; what is drawn does not. At such a [`Standstill`] frames go by
//! without ticks, each looks for the answer once, and messages are kept for the next tick. Without a window
//! ([`Waiting::Blocking`]) a run is the same every time, and what the script orders is the same either way.
//!
//! What takes time to tell is told to scripts that mention it ([`Tell`]). `docs/scripts.md` is written for those who write
//! scripts.
//!
//! ```no_run
//! use bevy::prelude::*;
//! use tabletop_core::{prelude::*, AgentOrder};
//! use tabletop_script::{ScriptPlugin, ScriptSettings};
//!
//! let mut app = App::new();
//! app.add_plugins((MinimalPlugins, CorePlugin::default()))
//!     .add_plugins(ScriptPlugin { settings: ScriptSettings::default() })
//!     .start();
//! app.world_mut().write_message(AgentOrder::Start); // runs the scripts that matlab/agentBehavior.m names
//! app.step(600);
//! ```

mod act;
mod agency;
mod mentions;
mod news;
mod sense;
mod session;
mod settings;
mod standstill;

pub use settings::{ScriptSettings, Tell, Waiting};
pub use tabletop_engine::{
    ENGINE_VARIABLE, EngineChoice, EngineConfig, EngineError, EngineKind, Surroundings, Timeouts,
};

use bevy::{ecs::system::RunSystemOnce as _, prelude::*};
use tabletop_core::{
    HeadCamera, ObjectIndex, OrderSystems, Paused, PictureDemand, SensorImage, Standstill,
};

use agency::{Agency, call};
use standstill::{drop_overstep, keep_messages, try_again};

/// Ends the script, if there is one, and waits until its engine has ended. What it still prints is told.
pub fn see_off(world: &mut World) {
    // Without the plugin there is no script.
    drop(world.run_system_once(agency::see_off));
}

/// Adds the script bridge. Needs [`CorePlugin`](tabletop_core::CorePlugin).
#[derive(Clone, Debug, Default)]
pub struct ScriptPlugin {
    /// Which scripts run in which engine, and how; they stay as a resource.
    pub settings: ScriptSettings,
}

impl Plugin for ScriptPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(self.settings.clone())
            .init_resource::<Agency>()
            .init_resource::<HeadCamera>()
            .init_resource::<ObjectIndex>()
            .init_resource::<PictureDemand>()
            .init_resource::<SensorImage>()
            .add_systems(
                FixedUpdate,
                (
                    // A frame that begins at a standstill has no other tick even if the answer has come.
                    drop_overstep.run_if(not(Standstill::is_over)),
                    Paused::will_be.pipe(call),
                    drop_overstep.run_if(not(Standstill::is_over)),
                )
                    .chain()
                    .in_set(OrderSystems::Script),
            )
            .add_systems(
                RunFixedMainLoop,
                (try_again, keep_messages)
                    .run_if(not(Standstill::is_over))
                    .in_set(RunFixedMainLoopSystems::AfterFixedMainLoop),
            );
    }
}
