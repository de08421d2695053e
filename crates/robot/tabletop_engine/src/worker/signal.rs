//! Signals to the thread of an engine.

use std::time::Duration;

use crate::variables::{auxiliary::Aux, sensor::Sensor};

/// A signal to the worker.
#[derive(Debug)]
pub(crate) enum Signal {
    /// Run the init script.
    Init(Box<Aux>),
    /// Run the callback script.
    Step(Box<Sensor>),
    /// End, within this time.
    Stop(Duration),
    /// The engine has printed that a request is done.
    Done(u32),
    /// One of the engine's outputs has ended.
    Closed,
}
