//! The script bridge: a user's Matlab (or Octave, or Python) scripts sense and move the robot, a call a tick (report
//! section 5.2).
//!
//! A [`ScriptCommand`](tabletop_core::ScriptCommand) starts and stops them. Their replies become
//! [`SimCommand`](tabletop_core::SimCommand)s, so a recording of their acts runs again without them.
//! [`ScriptEvent`](tabletop_core::ScriptEvent)s report what becomes of them, and [`Agent`](tabletop_core::Agent) holds their
//! state.
//!
//! The simulation waits for the script; drawing does not. While [`SimBlocked`] is set, frames go by
//! without ticks, each looks for the answer once, and messages are kept for the next tick. Without a window
//! ([`Waiting::Blocking`]) a run is the same every time, and the script's commands are the same either way.
//!
//! Fields of `sensor` that take time are sent only to scripts that mention them ([`FieldPolicy`]). `docs/scripts.md` is for
//! those who write scripts.
//!
//! ```
//! use std::{env, fs, process};
//! use bevy::prelude::*;
//! use tabletop_core::{Agent, ScriptCommand, prelude::*};
//! use tabletop_script::prelude::*;
//!
//! # fn main() -> std::io::Result<()> {
//! let script = env::temp_dir().join(format!("tabletop-example-{}.py", process::id()));
//! fs::write(&script, "
//! def init(aux):
//!     aux.drawMarkers = [[1, 2, 3]]
//!
//! def callback(sensor, motor, aux):
//!     aux.exit = True
//! ")?;
//! let settings = ScriptSettings {
//!     engine: EngineChoice::Kind(EngineKind::Python),
//!     agent: Some(script.clone()),
//!     ..default()
//! };
//! let mut app = App::new();
//! app.add_plugins((MinimalPlugins, CorePlugin::default(), ScriptPlugin { settings }))
//!     .start();
//!
//! app.world_mut().write_message(ScriptCommand::Start);
//! app.step(1); // The script's init has run.
//! assert!(app.world().resource::<Agent>().is_on());
//! app.step(1); // Its callback has run, and ended it.
//! assert_eq!(*app.world().resource::<Agent>(), Agent::Off);
//! # fs::remove_file(script)
//! # }
//! ```

/// The types that most users of the crate need.
pub mod prelude {
    #[doc(hidden)]
    pub use crate::{
        EngineChoice, EngineKind, FieldPolicy, ScriptPlugin, ScriptSettings, Waiting, shut_down,
    };
}

mod blocked;
mod events;
mod mentions;
mod motor_commands;
mod runner;
mod sense;
mod session;
mod settings;
mod simulation;

pub use settings::{FieldPolicy, ScriptSettings, Waiting};
pub use tabletop_engine as engine;
pub use tabletop_engine::{
    ENGINE_VARIABLE, EngineChoice, EngineConfig, EngineError, EngineKind, EngineLocator, Timeouts,
};

use bevy::{ecs::system::RunSystemOnce as _, prelude::*};
use tabletop_core::{
    HeadCamera, ObjectIndex, OrderSystems, Paused, PictureDemand, RestApp as _, RestingSystems,
    SensorImage, SimBlocked,
};
use tabletop_vision::{Perception, PerceptionDemand};

use blocked::{drop_overstep, keep_messages, try_again};
use runner::{ScriptRunner, call, is_running};

/// Ends the script, if there is one, and waits until its engine has ended. Its last output becomes events.
pub fn shut_down(world: &mut World) {
    // Without the plugin there is no script.
    drop(world.run_system_once(runner::shut_down));
}

/// Adds the script bridge. Needs [`CorePlugin`](tabletop_core::CorePlugin).
#[derive(Clone, Debug, Default)]
pub struct ScriptPlugin {
    /// The scripts, their engine and its settings, which stay as a resource.
    pub settings: ScriptSettings,
}

impl Plugin for ScriptPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(self.settings.clone())
            .init_resource::<ScriptRunner>()
            .init_resource::<HeadCamera>()
            .init_resource::<ObjectIndex>()
            .init_resource::<PictureDemand>()
            .init_resource::<SensorImage>()
            .init_resource::<Perception>()
            .init_resource::<PerceptionDemand>()
            .add_systems(
                FixedUpdate,
                (
                    // A frame that begins while the simulation is blocked has no other tick even if the answer has come.
                    drop_overstep.run_if(not(SimBlocked::is_clear)),
                    Paused::will_be.pipe(call),
                    drop_overstep.run_if(not(SimBlocked::is_clear)),
                )
                    .chain()
                    .in_set(OrderSystems::Script)
                    .in_set(RestingSystems),
            )
            .wake_while(is_running)
            .add_systems(
                RunFixedMainLoop,
                (try_again, keep_messages)
                    .run_if(not(SimBlocked::is_clear))
                    .in_set(RunFixedMainLoopSystems::AfterFixedMainLoop),
            );
    }
}
