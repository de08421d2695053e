//! Script engines: MATLAB, GNU Octave and Python as child processes that run the scripts of users (report section 5.2).
//!
//! An engine is found by [`Surroundings::find`] and started by [`EngineHandle::start`]. It lives on a thread of its own;
//! requests ([`init`](EngineHandle::init), [`step`](EngineHandle::step)) return at once, and each is answered by one [`Reply`].
//! Whatever the script does, the caller never waits longer than it wants to, and a script's faults come as an
//! [`EngineError`] that says where they are.
//!
//! ```
//! use std::{env, fs, time::Duration};
//! use tabletop_engine::{Aux, EngineChoice, EngineConfig, EngineHandle, Reply, Sensor, Surroundings};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let folder = env::temp_dir().join(format!("tabletop-example-{}", std::process::id()));
//! fs::create_dir_all(&folder)?;
//! fs::write(folder.join("agentBehavior.m"), "function [i, c] = agentBehavior(), i = @turnInit; c = @turnCallback; end")?;
//! fs::write(folder.join("turnInit.m"), "speed = 0.5; aux.drawMarkers = [1 2 3];")?;
//! fs::write(folder.join("turnCallback.m"), "motor.jointVelocities(2, 3) = speed; aux.exit = 1;")?;
//!
//! let octave = Surroundings::system().find(&"octave".parse::<EngineChoice>()?)?;
//! let mut config = EngineConfig::new(octave);
//! config.agent = folder.clone();
//! let engine = EngineHandle::start(config)?;
//! engine.init(Aux::default());
//! engine.step(Sensor { time_elapsed: 1.0 / 60.0, ..Sensor::default() });
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

mod agent;
mod choice;
mod console;
mod driver;
mod engine;
mod error;
mod find;
mod frames;
mod hint;
mod launch;
mod misuse;
mod motor;
mod output;
mod places;
mod private_folder;
mod process;
pub mod protocol;
mod readiness;
mod scripts;
mod sensor;
mod session;
mod stand_ins;
mod trigger;
mod worker;

pub use agent::{Aux, InitReply};
pub use choice::{ENGINE_VARIABLE, EngineChoice, EngineKind};
pub use console::{ConsoleLine, Output, Stream};
pub use engine::{EngineConfig, EngineHandle, Reply, StepReply, Timeouts, Trigger};
pub use error::{EngineError, Place, ScriptError};
pub use find::{FoundEngine, Surroundings};
pub use misuse::{Element, Misuse};
pub use motor::Motor;
pub use places::Platform;
pub use sensor::{Picture, SensedContact, SensedObject, Sensor};
