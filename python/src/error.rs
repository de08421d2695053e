//! Errors as exceptions.

use pyo3::{create_exception, exceptions::PyRuntimeError, prelude::*};
use tabletop::environment::EnvironmentError;

create_exception!(
    tabletop,
    Error,
    PyRuntimeError,
    "An error of the simulator, in the words of its command line."
);

/// The exception of an error.
pub fn raise(error: EnvironmentError) -> PyErr {
    Error::new_err(error.to_string())
}

/// The exception of any other error.
pub fn refuse(error: impl ToString) -> PyErr {
    Error::new_err(error.to_string())
}
