//! What the user wants with recordings.

use std::path::PathBuf;

use tabletop_user::ShelfOrder;

/// A wish of the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Request {
    /// Keep and look for recordings in this folder.
    Choose(PathBuf),
    Open(PathBuf),
    Order(ShelfOrder),
}
