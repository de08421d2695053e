//! The invisible hands.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod desk;
mod hands;
mod undo;
