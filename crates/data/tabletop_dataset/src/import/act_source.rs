//! Where acts of hands are known from.

/// Where the acts of the hands of an imported recording come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActSource {
    /// Its events tell them.
    Recorded,
    /// They are inferred from the poses, since no event names a hand.
    Inferred,
}

impl ActSource {
    /// Its name in a recording's header.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Recorded => "recorded",
            Self::Inferred => "inferred",
        }
    }
}
