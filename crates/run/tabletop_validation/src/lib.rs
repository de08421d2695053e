//! The simulator's physics beside the closed-form results of mechanics.
//!
//! An [`Experiment`] is a small world of its own that is simulated for some seconds and yields [`Measurement`]s: quantities with the value
//! that a textbook expects, the value that was measured, and a [`Tolerance`]. [`EXPERIMENTS`] lists them all.
//!
//! ```
//! use tabletop_validation::experiments;
//!
//! let fall = experiments().find(|experiment| experiment.name == "fall-ball").unwrap();
//! for measurement in fall.measure() {
//!     println!("{}: {} instead of {}", measurement.name(), measurement.measured, measurement.expected);
//! }
//! ```

mod chart;
mod experiment;
mod measurement;
mod small_world;
mod specimen;
mod table;

mod bonds;
mod bouncing;
mod carrying;
mod chains;
mod collisions;
mod crowds;
mod fall;
mod gripping;
mod joints;
mod masses;
mod passing;
mod rocking;
mod rolling;
mod seams;
mod skidding;
mod sleeping;
mod sliding;
mod slopes;
mod spinning;
mod towers;

pub use chart::chart;
pub use experiment::Experiment;
pub use measurement::{Measurement, Tolerance};
pub use table::{Peer, table};

/// All experiments, by their kinds.
pub const EXPERIMENTS: [&[Experiment]; 20] = [
    fall::EXPERIMENTS,
    sliding::EXPERIMENTS,
    slopes::EXPERIMENTS,
    rolling::EXPERIMENTS,
    bouncing::EXPERIMENTS,
    skidding::EXPERIMENTS,
    seams::EXPERIMENTS,
    collisions::EXPERIMENTS,
    passing::EXPERIMENTS,
    crowds::EXPERIMENTS,
    masses::EXPERIMENTS,
    towers::EXPERIMENTS,
    sleeping::EXPERIMENTS,
    spinning::EXPERIMENTS,
    rocking::EXPERIMENTS,
    carrying::EXPERIMENTS,
    joints::EXPERIMENTS,
    chains::EXPERIMENTS,
    bonds::EXPERIMENTS,
    gripping::EXPERIMENTS,
];

/// All experiments, in the order of the table.
pub fn experiments() -> impl Iterator<Item = &'static Experiment> {
    EXPERIMENTS.into_iter().flatten()
}
