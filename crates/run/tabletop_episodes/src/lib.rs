//! Whole episodes, each in a world of its own: imitation of a recording, multiplication of a demonstration, hours of random acts.

mod beginning;
mod collection;
pub mod imitation;
pub mod multiplication;
mod recorded_robot;
mod robot_body;
pub mod shown_task;
pub mod soak;
mod still_scene;
pub mod telling;
pub mod watching;

pub use beginning::scene_at_beginning;
pub use collection::{Collection, CollectionError};
pub use recorded_robot::RecordedRobot;
pub use robot_body::robot_body;
pub use still_scene::{StillScene, has_in_view};
