//! Experiments: small worlds with known results.

use crate::measurement::Measurement;

/// A small world with known results.
#[derive(Clone, Copy, Debug)]
pub struct Experiment {
    /// Its name, which is unique: its kind, and what is special, such as `slide-along-x`.
    pub name: &'static str,
    /// True if it takes more than a few seconds.
    pub is_long: bool,
    run: fn() -> Vec<Measurement>,
}

impl Experiment {
    pub(crate) const fn new(name: &'static str, run: fn() -> Vec<Measurement>) -> Self {
        Self {
            name,
            is_long: false,
            run,
        }
    }

    pub(crate) const fn long(mut self) -> Self {
        self.is_long = true;
        self
    }

    /// Carries it out, in a world of its own.
    pub fn measure(&self) -> Vec<Measurement> {
        let mut measurements = (self.run)();
        for measurement in &mut measurements {
            measurement.experiment = self.name;
        }
        measurements
    }
}
