//! How much work templates may make: a file of a few lines can ask for 2^30 elements.

use crate::document::build::MAX_ELEMENTS;

/// How many bytes of attributes the elements of a task can have with everything put in: 64 MiB.
pub(crate) const MAX_TEXT: usize = 64 << 20;

/// What is left of the work that a task may make.
#[derive(Debug)]
pub(crate) struct ExpansionBudget {
    elements: usize,
    text: usize,
}

impl Default for ExpansionBudget {
    fn default() -> Self {
        Self {
            elements: MAX_ELEMENTS,
            text: MAX_TEXT,
        }
    }
}

impl ExpansionBudget {
    /// Accounts for an element, and says whether there may be one.
    pub fn is_left_for_element(&mut self) -> bool {
        take(&mut self.elements, 1)
    }

    /// Accounts for bytes that are read or written, and says whether there may be so many.
    pub fn is_left_for_text(&mut self, bytes: usize) -> bool {
        take(&mut self.text, bytes)
    }
}

/// Takes from what is left; if it is too little, nothing is left.
fn take(left: &mut usize, amount: usize) -> bool {
    let rest = left.checked_sub(amount);
    *left = rest.unwrap_or(0);
    rest.is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn effort_ends() {
        let mut effort = ExpansionBudget::default();
        assert!(effort.is_left_for_text(MAX_TEXT) && !effort.is_left_for_text(1));
        assert!((0..MAX_ELEMENTS).all(|_| effort.is_left_for_element()));
        assert!(!effort.is_left_for_element());
    }
}
