//! The selection in the lists of the Objects window.

use std::path::PathBuf;

use bevy::prelude::*;

use super::list::ObjectList;

/// The selection in the lists.
#[derive(Resource, Default)]
pub(super) struct Selection {
    pub task: Option<PathBuf>,
    pub entry: usize,
    pub objects: ObjectList,
}
