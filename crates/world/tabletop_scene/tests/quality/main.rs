//! The quality bar of the physics: towers stand still, objects fall as they should, and nothing tunnels.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod world;

mod chains;
mod falling;
mod joints;
mod lids;
mod resting;
mod surfaces;
