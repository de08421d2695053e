//! Work that takes longer than a frame and is done beside the frames.

use std::{
    sync::mpsc::{Receiver, TryRecvError, channel},
    thread,
};

use bevy::platform::cell::SyncCell;

/// Work on a thread of its own. If it is dropped, nobody hears of its result.
pub(super) struct BackgroundWork<T>(SyncCell<Receiver<Result<T, String>>>);

impl<T: Send + 'static> BackgroundWork<T> {
    pub fn begin(work: impl FnOnce() -> Result<T, String> + Send + 'static) -> Self {
        let (sender, result) = channel();
        let not_begun = sender.clone();
        let work = move || drop(sender.send(work()));
        if let Err(error) = thread::Builder::new().spawn(work) {
            drop(not_begun.send(Err(error.to_string())));
        }
        Self(SyncCell::new(result))
    }

    /// The result, or the reason why there is none; `None` while the work goes on.
    pub fn result(&mut self) -> Option<Result<T, String>> {
        match self.0.get().try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err("its thread has ended".into())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wait_for<T: Send + 'static>(mut work: BackgroundWork<T>) -> Result<T, String> {
        loop {
            if let Some(result) = work.result() {
                return result;
            }
            thread::yield_now();
        }
    }

    #[test]
    fn a_result_comes_and_so_does_the_end_of_work_that_panics() {
        assert_eq!(wait_for(BackgroundWork::begin(|| Ok(7))), Ok(7));
        let failed = BackgroundWork::<u8>::begin(|| Err("no space".into()));
        assert_eq!(wait_for(failed), Err("no space".into()));
        let ended = BackgroundWork::<u8>::begin(|| panic!("a test may panic"));
        assert_eq!(wait_for(ended), Err("its thread has ended".into()));
    }
}
