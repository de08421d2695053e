//! Failures of the file system that tests bring about.

use std::{
    fmt,
    io::{self, ErrorKind},
    sync::atomic::{AtomicU64, Ordering},
    time::Duration,
};

/// Decides what becomes of the calls of a [`Storage`](crate::Storage) to the file system.
pub trait Fate: fmt::Debug + Send + Sync {
    /// The failure of the next call, if it is to fail.
    fn of_call(&self) -> Option<CallFailure>;

    /// Lets this time pass.
    fn pause(&self, time: Duration) {
        std::thread::sleep(time);
    }
}

/// The failure of a call.
#[derive(Debug)]
pub struct CallFailure {
    /// What the caller is told.
    pub error: io::Error,
    /// True if half of the bytes that it was to write are written before.
    pub tears: bool,
}

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

    /// What it does to a call, if it comes about in call `failing`.
    pub fn of_call(self, call: u64, failing: u64) -> Option<CallFailure> {
        let is_struck = match self {
            Self::FullOnce | Self::Broken => call == failing,
            Self::Full | Self::Killed | Self::KilledWithin => call >= failing,
        };
        is_struck.then(|| CallFailure {
            error: self.error(),
            tears: call == failing && self.tears(),
        })
    }

    fn error(self) -> io::Error {
        match self {
            Self::FullOnce | Self::Full => ErrorKind::StorageFull.into(),
            Self::Broken => io::Error::other("input/output error"),
            Self::Killed | Self::KilledWithin => io::Error::other("the program was killed"),
        }
    }

    /// True if the first failing call writes half of its bytes.
    const fn tears(self) -> bool {
        match self {
            Self::FullOnce | Self::Full | Self::KilledWithin => true,
            Self::Broken | Self::Killed => false,
        }
    }
}

/// One fault, from one call on.
#[derive(Debug)]
pub(crate) struct FaultAt {
    fault: StorageFault,
    failing: u64,
    calls: AtomicU64,
}

impl FaultAt {
    pub(crate) const fn new(fault: StorageFault, failing: u64) -> Self {
        Self {
            fault,
            failing,
            calls: AtomicU64::new(0),
        }
    }
}

impl Fate for FaultAt {
    fn of_call(&self) -> Option<CallFailure> {
        let call = self.calls.fetch_add(1, Ordering::Relaxed);
        self.fault.of_call(call, self.failing)
    }
}
