//! Measurements: quantities beside their expected values.

use std::fmt;

use serde::Serialize;

/// A quantity of an experiment beside its expected value. Units: 10 cm, kg, s, rad.
#[derive(Clone, Debug, Serialize)]
pub struct Measurement {
    /// The name of the experiment.
    pub experiment: &'static str,
    /// The quantity, which is unique in the experiment.
    pub quantity: &'static str,
    /// The formula of the expected value.
    pub formula: &'static str,
    /// The expected value.
    pub expected: f64,
    /// The measured value.
    pub measured: f64,
    /// The greatest error.
    pub tolerance: Tolerance,
}

/// The greatest error of a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum Tolerance {
    /// A share of the expected value.
    Share(f64),
    /// A difference.
    Difference(f64),
}

impl Measurement {
    /// A quantity that may be off by a share of its expected value.
    pub(crate) fn close(
        quantity: &'static str,
        formula: &'static str,
        expected: f64,
        measured: f64,
        share: f64,
    ) -> Self {
        Self {
            experiment: "",
            quantity,
            formula,
            expected,
            measured,
            tolerance: Tolerance::Share(share),
        }
    }

    /// A quantity that may be off by a difference.
    pub(crate) fn near(
        quantity: &'static str,
        formula: &'static str,
        expected: f64,
        measured: f64,
        difference: f64,
    ) -> Self {
        Self {
            tolerance: Tolerance::Difference(difference),
            ..Self::close(quantity, formula, expected, measured, 0.0)
        }
    }

    /// A quantity that is to be nothing.
    pub(crate) fn none(quantity: &'static str, measured: f64, difference: f64) -> Self {
        Self::near(quantity, "0", 0.0, measured, difference)
    }

    /// Its name, which is unique: `slide-along-x: distance`.
    pub fn name(&self) -> String {
        format!("{}: {}", self.experiment, self.quantity)
    }

    /// Its error, in the sense of its tolerance.
    pub fn error(&self) -> f64 {
        self.error_of(self.measured)
    }

    /// The error of another measured value.
    pub fn error_of(&self, measured: f64) -> f64 {
        let difference = measured - self.expected;
        match self.tolerance {
            Tolerance::Share(_) => difference / self.expected,
            Tolerance::Difference(_) => difference,
        }
    }

    /// The size of an error as a multiple of the tolerance: 1 is the most that holds.
    pub fn excess(&self, error: f64) -> f64 {
        let (Tolerance::Share(most) | Tolerance::Difference(most)) = self.tolerance;
        match error.is_nan() {
            true => f64::INFINITY,
            false => error.abs() / most,
        }
    }

    /// True if its error is within its tolerance.
    pub fn holds(&self) -> bool {
        self.excess(self.error()) <= 1.0
    }
}

impl Tolerance {
    /// An error in the sense of this tolerance, with its sign.
    pub fn phrase(&self, error: f64) -> String {
        match self {
            Self::Share(_) => format!("{:+.2} %", error * 100.0),
            Self::Difference(_) => format!("{error:+.4}"),
        }
    }
}

impl fmt::Display for Tolerance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Share(share) => write!(f, "{} %", (share * 1e4).round() / 1e2),
            Self::Difference(difference) => write!(f, "{}", (difference * 1e4).round() / 1e4),
        }
    }
}
