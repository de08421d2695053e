//! The robot's bodies, and the joints that carry them.

pub(crate) mod link_entities;
pub(crate) mod passive_links;
pub(crate) mod tree;
