//! A virtual demonstrator environment for robot imitation learning.
pub use tabletop_core as core;
