//! How long to wait for another program that writes to the same place.

use std::{fmt, time::Duration};

/// The time in which a reader's glance at a lock is over.
pub(crate) const GLANCE: Duration = Duration::from_millis(50);

/// The time for which [`Patience::Briefly`] waits.
const BRIEFLY: Duration = Duration::from_secs(2);

/// What to do where another program writes.
#[derive(Clone, Copy, Debug, Default)]
pub enum Patience {
    /// Wait for its end. This hears for whom.
    Wait(fn(&dyn fmt::Display)),
    /// Wait for two seconds, and then refuse: who has the place only for a moment is no obstacle.
    #[default]
    Briefly,
    /// Refuse.
    None,
}

impl Patience {
    pub(crate) fn limit(self) -> Duration {
        match self {
            Self::Wait(_) => Duration::MAX,
            Self::Briefly => BRIEFLY,
            Self::None => GLANCE,
        }
    }

    pub(crate) fn tell(self, news: &dyn fmt::Display) {
        match self {
            Self::Wait(tell) => tell(news),
            Self::Briefly | Self::None => {}
        }
    }
}
