//! What moves bodies in the engine's place: hands and robots.

mod moved_body;

pub use moved_body::{MovedBody, MovedBodyItem};
