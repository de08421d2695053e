//! A robot that is only looked at.

use std::time::Duration;

use crate::{
    address::{Address, RobotWay},
    clock::WallClock,
    error::BridgeError,
    follower::Follower,
    observation::observe,
    profile::BridgeProfile,
    ros1::Ros1,
    rosbridge::Rosbridge,
    state::{RobotState, StateReader},
    tolerances::OLDEST_REPORT,
    transport::Listener,
    watchdog::StopReason,
};

/// A robot that is only looked at. It holds a [`Listener`], which cannot publish.
#[derive(Debug)]
pub struct Shadow {
    clock: WallClock,
    follower: Follower<StateReader>,
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
        let follower = Follower::start(listener, clock, reader, |reader, received| {
            reader.take(&received)
        })?;
        Ok(Self { clock, follower })
    }

    /// The robot's state as of its last messages.
    pub fn state(&self) -> RobotState {
        let heard = self.follower.heard();
        let mut state = heard.latest.state().clone();
        state.nonsense += heard.nonsense;
        state
    }

    /// How old its joints' angles are.
    pub fn age(&self) -> Duration {
        let heard = self.follower.heard();
        let age = heard.latest.state().age(self.clock.now());
        age.unwrap_or(Duration::MAX)
    }

    /// Why its state can no longer be believed; none as long as it can: the connection is lost, a joint jumped, or no state has come for a second.
    pub fn fault(&self) -> Option<String> {
        let heard = self.follower.heard();
        let state = heard.latest.state();
        let age = state.age(self.clock.now()).unwrap_or(Duration::MAX);
        let jump = state.jump.clone().map(StopReason::Jump);
        let stale = (age > OLDEST_REPORT).then_some(StopReason::StaleState { age });
        let untrue = jump.or(stale).map(|reason| reason.to_string());
        heard.fault.clone().or(untrue)
    }
}
