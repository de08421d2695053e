//! A robot that is only looked at.

use std::{
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    thread::{Builder, JoinHandle},
    time::Duration,
};

use crate::{
    address::{Address, RobotWay},
    clock::WallClock,
    error::BridgeError,
    observation::observe,
    profile::BridgeProfile,
    ros1::Ros1,
    rosbridge::Rosbridge,
    state::{RobotState, StateReader},
    transport::Listener,
};

/// How long the thread listens before it looks whether it is still wanted.
const PERIOD: Duration = Duration::from_millis(50);

/// A robot that is only looked at. It holds a [`Listener`], which cannot publish.
#[derive(Debug)]
pub struct Shadow {
    clock: WallClock,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Debug, Default)]
struct Shared {
    latest: Mutex<Latest>,
    is_over: AtomicBool,
}

/// What is known last, and why no more will be.
#[derive(Debug, Default)]
struct Latest {
    state: RobotState,
    fault: Option<String>,
}

impl Shared {
    fn latest(&self) -> MutexGuard<'_, Latest> {
        self.latest.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Shadow {
    /// Connects to a robot and waits until it has said where all its joints are.
    ///
    /// # Errors
    /// It cannot be reached, or is silent.
    pub fn connect(address: &Address, profile: &BridgeProfile) -> Result<Self, BridgeError> {
        let clock = WallClock::start();
        let (host, port) = (&address.host, address.port);
        let listener: Box<dyn Listener> = match address.way {
            RobotWay::Ros => Box::new(Ros1::connect(host, port, clock)?),
            RobotWay::Rosbridge => Box::new(Rosbridge::connect(host, port, clock)?),
        };
        Self::over(listener, profile, clock)
    }

    /// The same over a connection, which has this clock.
    ///
    /// # Errors
    /// The robot is silent.
    pub fn over(
        mut listener: Box<dyn Listener>,
        profile: &BridgeProfile,
        clock: WallClock,
    ) -> Result<Self, BridgeError> {
        let reader = observe(&mut *listener, profile, clock)?;
        let shared = Arc::new(Shared::default());
        shared.latest().state = reader.state().clone();
        let of_thread = shared.clone();
        let thread = Builder::new().name("robot's shadow".into());
        let thread = thread.spawn(move || follow(&mut *listener, reader, &of_thread, clock));
        Ok(Self {
            clock,
            shared,
            thread: Some(thread.map_err(BridgeError::Thread)?),
        })
    }

    /// The robot's state as of its last messages.
    pub fn state(&self) -> RobotState {
        self.shared.latest().state.clone()
    }

    /// How old its joints' angles are.
    pub fn age(&self) -> Duration {
        let state = &self.shared.latest().state;
        state.age(self.clock.now()).unwrap_or(Duration::MAX)
    }

    /// Why there will be no newer state; none as long as the connection holds.
    pub fn fault(&self) -> Option<String> {
        self.shared.latest().fault.clone()
    }
}

impl Drop for Shadow {
    fn drop(&mut self) {
        self.shared.is_over.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            drop(thread.join());
        }
    }
}

fn follow(listener: &mut dyn Listener, mut reader: StateReader, shared: &Shared, clock: WallClock) {
    while !shared.is_over.load(Ordering::Relaxed) {
        match listener.poll(clock.now() + PERIOD) {
            Ok(Some(received)) => {
                reader.take(&received);
                let mut latest = shared.latest();
                latest.state = reader.state().clone();
                latest.state.nonsense += listener.nonsense();
            }
            Ok(None) => {}
            Err(error) => {
                shared.latest().fault = Some(error.to_string());
                return;
            }
        }
    }
}
