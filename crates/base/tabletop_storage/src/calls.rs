//! The calls to the file system, counted, of which tests let some fail.

use std::{
    io,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
    thread,
    time::Duration,
};

use crate::fault::Fate;

/// The calls of a storage and its files.
#[derive(Clone, Debug, Default)]
pub(crate) struct Calls {
    count: Arc<AtomicU64>,
    bytes: Arc<AtomicU64>,
    syncs: Arc<AtomicU64>,
    fate: Option<Arc<dyn Fate>>,
}

impl Calls {
    pub(crate) fn with_fate(fate: Arc<dyn Fate>) -> Self {
        Self {
            fate: Some(fate),
            ..Self::default()
        }
    }

    pub(crate) fn count(&self) -> u64 {
        self.count.load(Ordering::Relaxed)
    }

    /// The number of bytes that were written.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes.load(Ordering::Relaxed)
    }

    pub(crate) fn count_bytes(&self, count: usize) {
        self.bytes.fetch_add(count as u64, Ordering::Relaxed);
    }

    /// The number of waits for the disk.
    pub(crate) fn syncs(&self) -> u64 {
        self.syncs.load(Ordering::Relaxed)
    }

    /// Counts a call, and lets it fail if it is to. `tear` then writes half of its bytes.
    pub(crate) fn call(&self, tear: impl FnOnce()) -> io::Result<()> {
        self.count.fetch_add(1, Ordering::Relaxed);
        match self.fate.as_ref().and_then(|fate| fate.of_call()) {
            None => Ok(()),
            Some(failure) => {
                if failure.tears {
                    tear();
                }
                Err(failure.error)
            }
        }
    }

    pub(crate) fn may(&self) -> io::Result<()> {
        self.call(|| {})
    }

    /// Lets others go on for a while.
    pub(crate) fn pause(&self, time: Duration) {
        match &self.fate {
            Some(fate) => fate.pause(time),
            None => thread::sleep(time),
        }
    }

    /// Waits for the disk by this call, unless a call is to fail: then no power is lost.
    pub(crate) fn sync(&self, wait: impl FnOnce() -> io::Result<()>) -> io::Result<()> {
        self.may()?;
        self.syncs.fetch_add(1, Ordering::Relaxed);
        match self.fate {
            None => wait(),
            Some(_) => Ok(()),
        }
    }
}
