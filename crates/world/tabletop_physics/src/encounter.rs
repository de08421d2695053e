//! Encounters: contacts where bodies will touch.
//!
//! Rapier predicts contacts: it knows where two bodies are nearest at the beginning of a step, and takes the plane between those points for a wall. A
//! body that passes an edge runs into that wall, and a glancing blow leaves in the direction in which the bodies lay before. Here a contact that
//! would act is put where the bodies are nearest on their ways: where they touch, or where they pass each other.

mod approach;
mod closing;
mod free_flight;
mod free_flights;
mod touch;

pub(crate) use closing::time_to_close;
pub(crate) use free_flights::{FreeFlights, is_pressed, look_ahead};
