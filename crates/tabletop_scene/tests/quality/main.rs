//! The quality bar of the physics: what must stand still stands still, what falls falls as it should, nothing tunnels.

mod world;

mod chains;
mod falling;
mod lids;
mod resting;
