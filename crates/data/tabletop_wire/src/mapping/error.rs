//! Faults of a mapping.

use ron::error::Error as RonError;
use thiserror::Error;

/// The greatest number of typing errors between a name and the one that is meant.
const MOST_ERRORS: usize = 3;

/// A mapping that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{place}: {fault}")]
pub struct MappingError {
    place: String,
    fault: String,
}

impl MappingError {
    pub(super) fn new(place: impl Into<String>, fault: impl Into<String>) -> Self {
        Self {
            place: place.into(),
            fault: fault.into(),
        }
    }
}

/// The words for a fault of the format.
pub(super) fn fault_of(error: &RonError) -> String {
    let RonError::NoSuchStructField {
        expected, found, ..
    } = error
    else {
        return error.to_string();
    };
    format!(
        "there is no field {found:?}{}",
        instead(found, expected.iter().copied())
    )
}

/// The known name that is nearest to another one, or all of them if none is near.
pub(super) fn instead<'n>(name: &str, known: impl Iterator<Item = &'n str>) -> String {
    let known: Vec<_> = known.collect();
    let distances = known
        .iter()
        .map(|known| (strsim::osa_distance(name, known), known));
    let nearest = distances.min_by_key(|(distance, _)| *distance);
    match nearest {
        Some((distance, known)) if distance <= MOST_ERRORS.min(known.len() / 2) => {
            format!("; did you mean {known:?}?")
        }
        Some(_) => format!(", only {}", known.join(", ")),
        None => String::new(),
    }
}

/// The field of a column, counted from 1.
pub(super) fn at_column(field: &str, number: usize) -> String {
    format!("{field}, column {}", number + 1)
}
