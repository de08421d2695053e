//! Whole episodes, each in a world of its own: imitation of a recording, multiplication of a demonstration, hours of random acts.

mod beginning;
mod collection;
mod episodes;
pub mod imitation;
pub mod multiplication;
mod robot_body;
pub mod shown_task;
pub mod soak;
mod still_scene;
pub mod watching;

pub use beginning::scene_at_beginning;
pub use collection::{Collection, CollectionError};
pub use episodes::run_episodes;
pub use robot_body::robot_body;
pub use still_scene::StillScene;
