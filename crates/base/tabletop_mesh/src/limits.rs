//! Largest sizes of files.

/// Largest size of the STL file of an object, in bytes: 16 MiB.
pub const MAX_STL_BYTES: usize = 16 << 20;
