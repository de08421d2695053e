//! Datasets, read back.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod at_once;
mod demonstration;
mod hdf5;
mod lerobot;
mod mcap;
mod pictures;
mod program;
mod reading;
mod rlds;
