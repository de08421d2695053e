//! The robot's bodies, and how its joints carry them.

pub(crate) mod link_entities;
pub(crate) mod self_collision;
pub(crate) mod tree;
