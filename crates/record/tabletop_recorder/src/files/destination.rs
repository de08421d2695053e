//! The destination of recordings: their folder and files.

use std::path::PathBuf;

use tabletop_storage::Storage;

use crate::files::{channels::Channels, durability::Durability, hand_pictures::HandPictures};

/// The destination of recordings: their folder and files.
#[derive(Clone, Debug)]
pub(crate) struct Destination {
    pub(crate) folder: PathBuf,
    pub(crate) channels: Channels,
    pub(crate) hand_pictures: HandPictures,
    pub(crate) durability: Durability,
    pub(crate) storage: Storage,
}
