//! A thread that listens to a robot and keeps what it heard last.

use std::{
    fmt,
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    thread::{Builder, JoinHandle},
    time::Duration,
};

use crate::{
    clock::WallClock,
    error::BridgeError,
    transport::{Listener, Received},
};

/// How long the thread listens before it looks whether it is still wanted.
const PERIOD: Duration = Duration::from_millis(50);

/// Something that is heard of a robot, such as its state, for as long as this lives.
pub(crate) struct Follower<T> {
    shared: Arc<Followed<T>>,
    thread: Option<JoinHandle<()>>,
}

struct Followed<T> {
    heard: Mutex<Heard<T>>,
    is_over: AtomicBool,
}

/// What was heard.
pub(crate) struct Heard<T> {
    pub(crate) latest: T,
    /// Messages that could not be understood.
    pub(crate) nonsense: u64,
    /// Why nothing more will be heard.
    pub(crate) fault: Option<String>,
}

impl<T> Followed<T> {
    fn heard(&self) -> MutexGuard<'_, Heard<T>> {
        self.heard.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<T> fmt::Debug for Follower<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Follower").finish_non_exhaustive()
    }
}

impl<T: Send + 'static> Follower<T> {
    /// Starts the thread, which takes each message.
    pub(crate) fn start(
        mut listener: Box<dyn Listener>,
        clock: WallClock,
        latest: T,
        mut take: impl FnMut(&mut T, Received) + Send + 'static,
    ) -> Result<Self, BridgeError> {
        let shared = Arc::new(Followed {
            heard: Mutex::new(Heard {
                latest,
                nonsense: listener.nonsense(),
                fault: None,
            }),
            is_over: AtomicBool::new(false),
        });
        let of_thread = shared.clone();
        let follow = move || {
            while !of_thread.is_over.load(Ordering::Relaxed) {
                let polled = listener.poll(clock.now() + PERIOD);
                let mut heard = of_thread.heard();
                heard.nonsense = listener.nonsense();
                match polled {
                    Ok(Some(received)) => take(&mut heard.latest, received),
                    Ok(None) => {}
                    Err(error) => {
                        heard.fault = Some(error.to_string());
                        return;
                    }
                }
            }
        };
        let thread = Builder::new().name("follows a robot".into()).spawn(follow);
        Ok(Self {
            shared,
            thread: Some(thread.map_err(BridgeError::Thread)?),
        })
    }

    /// What was heard.
    pub(crate) fn heard(&self) -> MutexGuard<'_, Heard<T>> {
        self.shared.heard()
    }
}

impl<T> Drop for Follower<T> {
    fn drop(&mut self) {
        self.shared.is_over.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            drop(thread.join());
        }
    }
}
