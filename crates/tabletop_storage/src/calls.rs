//! The calls to the file system, counted, of which tests let some fail.

use std::{
    io,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
};

use crate::fault::StorageFault;

/// The calls of a storage and its files.
#[derive(Clone, Debug, Default)]
pub(crate) struct Calls {
    count: Arc<AtomicU64>,
    bytes: Arc<AtomicU64>,
    failpoint: Option<(StorageFault, u64)>,
}

impl Calls {
    pub(crate) fn with_fault(fault: StorageFault, call: u64) -> Self {
        Self {
            failpoint: Some((fault, call)),
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

    /// Counts a call, and lets it fail if it is to. `tear` then writes half of its bytes.
    pub(crate) fn call(&self, tear: impl FnOnce()) -> io::Result<()> {
        let call = self.count.fetch_add(1, Ordering::Relaxed);
        let Some((fault, failing)) = self.failpoint else {
            return Ok(());
        };
        if !fault.is_at(call, failing) {
            return Ok(());
        }
        if fault.tears(call, failing) {
            tear();
        }
        Err(fault.error())
    }

    pub(crate) fn may(&self) -> io::Result<()> {
        self.call(|| {})
    }

    /// If a call is to fail, no power is lost.
    pub(crate) const fn wait_for_disk(&self) -> bool {
        self.failpoint.is_none()
    }
}
