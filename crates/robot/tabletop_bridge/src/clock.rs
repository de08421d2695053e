//! The one wall clock of the workspace. A real robot does not wait, so what drives it goes by real time; the simulation never does.

use std::time::{Duration, Instant};

/// Real time since the clock was started. It never goes back.
#[derive(Clone, Copy, Debug)]
pub struct WallClock(Instant);

impl WallClock {
    /// A clock that starts now.
    pub fn start() -> Self {
        Self(Instant::now())
    }

    /// The time since the start.
    pub fn now(&self) -> Duration {
        self.0.elapsed()
    }

    /// The time that is left until a moment; zero once it has passed.
    pub fn until(&self, moment: Duration) -> Duration {
        moment.saturating_sub(self.now())
    }
}
