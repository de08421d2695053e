//! Figures of a robot that several worlds share.

use std::sync::{Arc, OnceLock};

use tabletop_core::Figure;

/// The figures of a robot's bodies, made when it is shown for the first time in any of the worlds that have clones of its description.
#[derive(Clone, Debug, Default)]
pub(crate) struct SharedFigures(Arc<OnceLock<Vec<Option<Figure>>>>);

impl SharedFigures {
    /// The figures, made if they are not there yet.
    pub fn get_or_make(&self, make: impl FnOnce() -> Vec<Option<Figure>>) -> &[Option<Figure>] {
        self.0.get_or_init(make)
    }
}
