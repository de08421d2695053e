//! The version of the files.

/// Version of the format that is written here.
pub(crate) const FORMAT: u32 = 4;
