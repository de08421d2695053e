//! The budget of an expansion: a file of a few lines can ask for 2^30 elements.

use crate::document::build::MAX_ELEMENTS;

/// Largest size of the elements' attributes after expansion: 64 MiB.
pub(crate) const MAX_TEXT: usize = 64 << 20;

/// The remaining budget of an expansion.
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
    /// Accounts for an element; true if the budget allows it.
    pub fn is_left_for_element(&mut self) -> bool {
        take(&mut self.elements, 1)
    }

    /// Accounts for bytes that are read or written; true if the budget allows them.
    pub fn is_left_for_text(&mut self, bytes: usize) -> bool {
        take(&mut self.text, bytes)
    }
}

/// Takes from the remainder; if it is too small, nothing is left.
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
