//! The simulator in the hands of a program: single worlds, environments of reinforcement learning, and thousands of them on all cores.
//!
//! A [`TableWorld`] is stepped, commanded, seen, copied and restored. An [`TaskEnvironment`] adds a task: where episodes begin, what the robot can do,
//! what it observes, and a reward. [`VectorEnvironment`] steps many of them over threads, with the same bits for any number of threads. The Python
//! package is made of these.

mod action;
mod catalogue;
mod environment;
mod error;
mod goal;
mod instruction;
mod observation;
mod pick_place;
mod slot;
mod table_world;
mod task;
mod vector;

pub use action::ActionSpace;
pub use catalogue::{RegisteredTask, registered_tasks};
pub use environment::{EnvironmentMoment, EnvironmentOptions, Reward, TaskEnvironment, Transition};
pub use error::EnvironmentError;
pub use observation::{ObservationSpace, StateLayout};
pub use slot::Autoreset;
pub use table_world::{TableObject, TableWorld, WorldMoment, WorldOptions, WorldOrigin};
pub use task::EnvironmentTask;
pub use vector::{VectorEnvironment, VectorResults};
