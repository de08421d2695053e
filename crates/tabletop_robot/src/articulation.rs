//! The robot's bodies, and the joints that carry them.

pub(crate) mod far_links;
pub(crate) mod link_entities;
pub(crate) mod self_collision;
pub(crate) mod tree;
