//! Datasets, read back.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod at_once;
#[path = "../../../tabletop_training/tests/training/demonstration.rs"]
mod demonstration;
mod hdf5;
mod lerobot;
mod mcap;
mod reading;
mod rlds;

use tabletop_storage::{Patience, Storage};

/// The file system, without waiting for others.
fn alone() -> Storage {
    Storage::default().with_patience(Patience::None)
}
