//! Where recordings go, and what is written of them.

use std::path::PathBuf;

use crate::files::{channels::Channels, durability::Durability, storage::Storage};

/// Where recordings go, and what is written of them.
#[derive(Clone, Debug)]
pub(crate) struct Destination {
    pub(crate) folder: PathBuf,
    pub(crate) channels: Channels,
    pub(crate) durability: Durability,
    pub(crate) storage: Storage,
}
