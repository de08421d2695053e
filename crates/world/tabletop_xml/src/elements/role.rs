//! Roles of shapes.

/// The role of a shape.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum ObjectRole {
    /// It is an object of its own.
    Whole,
    /// It is a part of a composite.
    Part,
    /// It is a shape of a control's state, or a part of one.
    InState,
}
