//! Recordings of the whole simulator.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod damaged;
mod demonstration;
mod dock;
mod ending;
mod every_command;
mod faults;
mod hand_cameras;
mod history_size;
mod mechanisms;
mod passed_over;
mod pauses;
mod playback;
mod random;
mod rest;
mod robot;
mod rollback;
mod settings;
mod undo;
mod window;
