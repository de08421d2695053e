//! Datasets, read back.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod demonstration;
mod hdf5;
mod lerobot;
mod mcap;
mod pictures;
mod reading;
mod rlds;
