//! The quality bar of the physics: what must stand still stands still, what falls falls as it should, nothing tunnels.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod world;

mod chains;
mod falling;
mod joints;
mod lids;
mod resting;
mod surfaces;
