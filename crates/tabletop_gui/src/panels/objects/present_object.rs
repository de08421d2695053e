//! An object on the table.

use tabletop_core::ObjectSpec;

/// An object as it is on the table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PresentObject {
    /// Its description, with its present pose.
    pub spec: ObjectSpec,
    /// The hand or gripper that holds it.
    pub holder: Option<String>,
}
