//! Script engines: MATLAB, GNU Octave and Python as child processes that run the scripts of users (report section 5.2).
//!
//! An engine is found by [`EngineLocator::find`] and started by [`EngineHandle::start`]. It lives on a thread of its own;
//! requests ([`init`](EngineHandle::init), [`step`](EngineHandle::step)) return at once, and each is answered by one [`Reply`].
//! Whatever the script does, the caller never waits longer than it wants to, and a script's faults come as an
//! [`EngineError`] that says where they are.
//!
//! ```
//! use std::{env, fs, time::Duration};
//! use tabletop_engine::prelude::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let folder = env::temp_dir().join(format!("tabletop-example-{}", std::process::id()));
//! fs::create_dir_all(&folder)?;
//! fs::write(folder.join("agentBehavior.m"), "function [i, c] = agentBehavior(), i = @turnInit; c = @turnCallback; end")?;
//! fs::write(folder.join("turnInit.m"), "speed = 0.5; aux.drawMarkers = [1 2 3];")?;
//! fs::write(folder.join("turnCallback.m"), "motor.jointVelocities(2, 3) = speed; aux.exit = 1;")?;
//!
//! let octave = EngineLocator::system().find(&"octave".parse::<EngineChoice>()?)?;
//! let mut config = EngineConfig::new(octave);
//! config.agent = folder.clone();
//! let engine = EngineHandle::start(config)?;
//! let (least, largest) = ([[-1.5; 7]; 2], [[1.5; 7]; 2]);
//! engine.init(Aux { min_joint_angles: least.into(), max_joint_angles: largest.into() });
//! engine.step(Sensor { time_elapsed: 1.0 / 60.0, ..Sensor::at_rest([2, 7]) });
//!
//! while let Some(reply) = engine.recv_timeout(Duration::from_secs(60)) {
//!     match reply {
//!         Reply::Started { description } => assert!(description.starts_with("GNU Octave")),
//!         Reply::Init(reply) => assert_eq!(reply.draw_markers, [[1.0, 2.0, 3.0]]),
//!         Reply::Step(reply) => {
//!             assert_eq!(reply.motor.joint_velocities[1][2], 0.5);
//!             assert!(reply.exit);
//!             break;
//!         }
//!         Reply::Failed(error) => return Err(error.into()),
//!     }
//! }
//! # fs::remove_dir_all(folder)?;
//! # Ok(())
//! # }
//! ```
//!
//! Program and engine exchange named arrays in files of a private folder in memory; see [`protocol`] and
//! `docs/script-protocol.md`. An engine learns by a [`Trigger`] that there is something to do. Its process and all that it
//! starts are a group of their own, which ends with the last [`EngineHandle`] or, on Unix, with this program, however that ends.

/// The types that most users of the crate need.
pub mod prelude {
    #[doc(hidden)]
    pub use crate::{
        Aux, EngineChoice, EngineConfig, EngineError, EngineHandle, EngineKind, EngineLocator,
        JointMatrix, MotorCommand, Reply, Sensor,
    };
}

mod config;
mod console;
mod discovery;
mod engine;
mod error;
mod kind;
mod octave;
mod private_folder;
pub mod protocol;
mod regular_file;
mod reply;
mod variables;
mod worker;

pub use config::{EngineConfig, Timeouts, Trigger};
pub use console::{ConsoleLimit, ConsoleLine, Stream};
pub use discovery::{
    choice::{ENGINE_VARIABLE, EngineChoice},
    locator::{EngineLocator, FoundEngine},
    platform::Platform,
};
pub use engine::EngineHandle;
pub use error::{EngineError, ScriptError, ScriptLocation};
pub use kind::EngineKind;
pub use reply::{Reply, StepReply};
pub use variables::{
    auxiliary::{Aux, InitReply},
    invalid_field::{InvalidField, MatrixElement},
    matrix::JointMatrix,
    motor::MotorCommand,
    sensor::{
        RgbImage, SensedBelief, SensedContact, SensedControl, SensedObject, SensedStep, Sensor,
    },
};
