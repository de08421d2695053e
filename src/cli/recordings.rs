//! Recordings as arguments.

use std::path::PathBuf;

use crate::dataset;

use super::{Failure, import::failed};

/// The recordings in these folders: each of them, or those in it, numbers in their order.
pub(super) fn recordings_in(folders: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut all = Vec::new();
    for folder in folders {
        let inner = dataset::recordings_in(folder).map_err(failed)?;
        if inner.is_empty() {
            return Err(Failure::input(format!(
                "{}: neither a recording nor a folder of recordings",
                folder.display()
            )));
        }
        all.extend(inner);
    }
    Ok(all)
}
