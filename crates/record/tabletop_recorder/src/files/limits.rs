//! Limits on files that are read.

/// Bytes of a session log.
pub(crate) const MOST_SESSION_BYTES: u64 = 256 << 20;

/// Bytes of a segment's events.
pub(crate) const MOST_EVENT_BYTES: u64 = 256 << 20;

/// Bytes of states, or of joints.
pub(crate) const MOST_ROW_BYTES: u64 = 1 << 30;

/// Objects that are there at once in a recording of the original program.
pub(crate) const MOST_ORIGINAL_OBJECTS: usize = 1000;
