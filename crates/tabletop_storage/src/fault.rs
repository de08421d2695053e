//! Failures of the file system that tests bring about.

use std::io::{self, ErrorKind};

/// The failure of calls to a [`Storage`](crate::Storage).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StorageFault {
    /// One call finds the disk full, and writes half of its bytes.
    FullOnce,
    /// From one call on, the disk is full.
    Full,
    /// One call fails for a reason that has nothing to do with it, as a broken disk has.
    Broken,
    /// The program is killed before a call: nothing later reaches the disk.
    Killed,
    /// The program is killed in a call that has written half of its bytes.
    KilledWithin,
}

impl StorageFault {
    /// All faults.
    pub const ALL: [Self; 5] = [
        Self::FullOnce,
        Self::Full,
        Self::Broken,
        Self::Killed,
        Self::KilledWithin,
    ];

    pub(crate) fn is_at(self, call: u64, failing: u64) -> bool {
        match self {
            Self::FullOnce | Self::Broken => call == failing,
            Self::Full | Self::Killed | Self::KilledWithin => call >= failing,
        }
    }

    pub(crate) fn error(self) -> io::Error {
        match self {
            Self::FullOnce | Self::Full => ErrorKind::StorageFull.into(),
            Self::Broken => io::Error::other("input/output error"),
            Self::Killed | Self::KilledWithin => io::Error::other("the program was killed"),
        }
    }

    /// True if the failing call writes half of its bytes.
    pub(crate) fn tears(self, call: u64, failing: u64) -> bool {
        match self {
            Self::FullOnce | Self::Full | Self::KilledWithin => call == failing,
            Self::Broken | Self::Killed => false,
        }
    }
}
