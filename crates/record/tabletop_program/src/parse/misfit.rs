//! What does not fit in a text.

/// What does not fit in a text, and what would.
pub(crate) struct Misfit {
    /// The place among the tokens.
    pub at: usize,
    /// What would fit, as an error names it.
    pub expected: Vec<String>,
    /// The words that would fit.
    pub words: Vec<String>,
}
