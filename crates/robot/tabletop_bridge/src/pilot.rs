//! What drives a robot, without a connection and without a clock: it is told what the robot says, what the program wants and what time it is, and says
//! what the robot is to be sent.

use std::{collections::BTreeMap, mem, time::Duration};

use serde_json::Value as Json;

use crate::{
    error::BridgeError,
    guard::Guard,
    options::BridgeOptions,
    orders::{RobotOrder, message},
    profile::BridgeProfile,
    state::RobotState,
    target::{RobotTarget, TargetError},
    tolerances::LONGEST_DEAFNESS,
    watchdog::{PredictedMotion, StopReason, Watchdog, WatchdogState},
};

/// See the module. A [`Bridge`](crate::Bridge) is one with a connection, a thread and a clock.
#[derive(Debug)]
pub struct Pilot {
    profile: BridgeProfile,
    /// The places of the limbs that are driven.
    driven: Vec<usize>,
    allow_moves: bool,
    watchdog: Watchdog,
    state: RobotState,
    target: RobotTarget,
    set_at: Duration,
    /// Orders of the program that wait to be sent.
    waiting: Vec<RobotOrder>,
    /// The topics of commands to which nobody listens, and since when.
    deaf_since: BTreeMap<String, Duration>,
}

impl Pilot {
    /// A pilot that sends nothing before it is [armed](Self::arm).
    ///
    /// # Errors
    /// The robot has no such limb, or the speed is no share of the greatest one.
    pub fn new(profile: &BridgeProfile, options: &BridgeOptions) -> Result<Self, BridgeError> {
        if !(options.speed > 0.0 && options.speed <= 1.0) {
            return Err(BridgeError::Speed(options.speed));
        }
        let driven = profile.places(&options.limbs);
        let driven = driven.map_err(|limb| BridgeError::no_limb(profile, limb))?;
        Ok(Self {
            watchdog: Watchdog::new(profile.clone(), &driven, options.speed),
            profile: profile.clone(),
            driven,
            allow_moves: options.allow_moves,
            state: RobotState::default(),
            target: RobotTarget::default(),
            set_at: Duration::ZERO,
            waiting: Vec::new(),
            deaf_since: BTreeMap::new(),
        })
    }

    /// The robot's interface.
    pub fn profile(&self) -> &BridgeProfile {
        &self.profile
    }

    /// The places of the limbs that are driven.
    pub(crate) fn driven(&self) -> &[usize] {
        &self.driven
    }

    /// The robot's state as of its last messages.
    pub fn state(&self) -> &RobotState {
        &self.state
    }

    /// What the watchdog does.
    pub fn watchdog(&self) -> &WatchdogState {
        self.watchdog.state()
    }

    /// True once the robot rests and is held, and nothing is sent any more.
    pub fn is_done(&self, now: Duration) -> bool {
        self.watchdog.is_done(now)
    }

    /// When the last target was set.
    pub(crate) fn set_at(&self) -> Duration {
        self.set_at
    }

    /// The robot has said this of itself.
    pub fn hear(&mut self, state: &RobotState) {
        self.state.clone_from(state);
    }

    /// So many listen to the commands on a topic.
    pub fn note_listeners(&mut self, now: Duration, topic: &str, count: usize) {
        if count > 0 {
            self.deaf_since.remove(topic);
            return;
        }
        let since = *self.deaf_since.entry(topic.to_owned()).or_insert(now);
        if *self.watchdog() == WatchdogState::Armed && now.saturating_sub(since) > LONGEST_DEAFNESS
        {
            let topic = topic.to_owned();
            self.stop(StopReason::Unheard { topic }, now);
        }
    }

    /// Begins to drive the robot, which stays where it is until there is a target. From now on targets must be set again and again.
    ///
    /// # Errors
    /// It cannot be driven now, or was stopped.
    pub fn arm(&mut self, now: Duration) -> Result<(), BridgeError> {
        let armed = match self.deaf_since.keys().next() {
            Some(topic) if *self.watchdog() == WatchdogState::Watching => {
                let topic = topic.clone();
                Err(StopReason::Unheard { topic })
            }
            Some(_) | None => self.watchdog.arm(now, &self.state),
        };
        let orders = armed.map_err(|reason| BridgeError::NotReady {
            robot: self.profile.robot.clone(),
            reason,
        })?;
        self.waiting.extend(orders);
        Ok(())
    }

    /// Says what the robot is to do from now on, for [`OLDEST_TARGET`](crate::OLDEST_TARGET) at most.
    ///
    /// # Errors
    /// The robot cannot do it, the guard vetoes it (then the joints rest), or the robot is not driven (any more).
    pub fn aim(
        &mut self,
        now: Duration,
        target: RobotTarget,
        guard: Option<&mut dyn Guard>,
    ) -> Result<(), TargetError> {
        let motion = self.consider(now, &target)?;
        let veto = guard.and_then(|guard| guard.veto(&self.state, &motion));
        self.settle(now, target, veto)
    }

    /// The motion to which a target would lead.
    pub(crate) fn consider(
        &self,
        now: Duration,
        target: &RobotTarget,
    ) -> Result<PredictedMotion, TargetError> {
        match self.watchdog.state() {
            WatchdogState::Armed => {}
            WatchdogState::Watching => {
                return Err(TargetError::NotDriven("it is not armed".into()));
            }
            WatchdogState::Ramping(reason) | WatchdogState::Held(reason) => {
                return Err(TargetError::NotDriven(reason.to_string()));
            }
        }
        target.check(&self.profile, &self.driven, &self.state, self.allow_moves)?;
        let before = &self.target;
        Ok(self.watchdog.predict(now, &self.state, target, before))
    }

    /// Sets a target, or none if somebody has vetoed it.
    pub(crate) fn settle(
        &mut self,
        now: Duration,
        target: RobotTarget,
        veto: Option<String>,
    ) -> Result<(), TargetError> {
        self.set_at = now;
        match veto {
            None => {
                self.target = target;
                Ok(())
            }
            Some(why) => {
                self.target = RobotTarget::default();
                Err(TargetError::Vetoed(why))
            }
        }
    }

    /// Brings the robot to rest, unless that has already begun.
    pub fn stop(&mut self, reason: StopReason, now: Duration) {
        self.watchdog.stop(reason, now);
    }

    /// The messages that the robot is to be sent now, each with its topic.
    pub fn tick(&mut self, now: Duration) -> Vec<(String, Json)> {
        let mut orders = mem::take(&mut self.waiting);
        let Self {
            watchdog,
            state,
            target,
            set_at,
            ..
        } = self;
        orders.extend(watchdog.tick(now, state, target, *set_at));
        let messages = orders.iter();
        messages
            .filter_map(|order| message(&self.profile, order))
            .collect()
    }
}
