//! The motion of bodies by hands and robots, instead of by forces. They reach a free object in one tick, push it from the next one on, and never
//! squeeze it into an immovable one.

mod approach;
mod environment;
pub mod limits;
mod moved_body;
mod pile;
mod swept_solid;

pub use approach::Approach;
pub use environment::{Environment, FreeObject};
pub use moved_body::{MovedBody, MovedBodyItem};
pub use pile::Pushed;
pub use swept_solid::{SweptSolid, are_near};
