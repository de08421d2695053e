//! What stands between a program and a robot: it passes on what is safe, and stops the robot where something is not as it should be.
//!
//! It knows neither sockets nor clocks, and decides from what it is told.

mod gripper;
mod limb;
mod prediction;
mod progress;
mod state;

use std::time::Duration;

use gripper::GripperOrders;
use limb::{LimbMotion, TurnLimits, angles};
pub use prediction::PredictedMotion;
pub use state::{StopReason, WatchdogState};

use crate::{
    orders::RobotOrder,
    profile::{BridgeProfile, LimbProfile},
    state::{RobotHealth, RobotState},
    target::{LimbTarget, RobotTarget},
    tolerances::{HOLD, NEW, OLDEST_REPORT, OLDEST_STATE, OLDEST_TARGET, RAMP, REPETITION},
};

/// The time from one look at the robot to the next, and from command to command.
pub const PERIOD: Duration = Duration::from_millis(10);

/// The distance of a joint, in rad, from the angle that it was sent to at which it counts as there.
const THERE: f64 = 1e-3;

/// The least change of the head's angle, in rad, and the least time between two, that the robot is sent.
const HEAD_STEP: f64 = 0.005;
const HEAD_PERIOD: Duration = Duration::from_millis(100);

/// See the module.
#[derive(Debug)]
pub struct Watchdog {
    profile: BridgeProfile,
    /// The share of the joints' greatest speeds that they may have.
    share: f64,
    state: WatchdogState,
    /// When it came to this state.
    since: Duration,
    /// When it last looked; none if it was never armed.
    last_tick: Option<Duration>,
    limbs: Vec<LimbMotion>,
    /// How new what is known was, from 1 to 0.
    freshness: f64,
    grippers: GripperOrders,
    /// The angle that the head was sent last, and when.
    head: Option<(f64, Duration)>,
}

impl Watchdog {
    /// A watchdog that looks on. Limbs are named by their places in the profile.
    pub fn new(profile: BridgeProfile, driven: &[usize], share: f64) -> Self {
        let limbs = driven.iter().map(|limb| {
            let joints = profile.limbs[*limb].joints.len();
            LimbMotion::at_rest(*limb, joints)
        });
        Self {
            limbs: limbs.collect(),
            profile,
            share: share.clamp(0.0, 1.0),
            state: WatchdogState::Watching,
            since: Duration::ZERO,
            last_tick: None,
            freshness: 1.0,
            grippers: GripperOrders::default(),
            head: None,
        }
    }

    /// What it does.
    pub fn state(&self) -> &WatchdogState {
        &self.state
    }

    /// True once the robot is held and has been told so for long enough: nothing is sent any more. One that was never driven is told nothing.
    pub fn is_done(&self, now: Duration) -> bool {
        match &self.state {
            WatchdogState::Held(reason) => {
                let was_driven = self.last_tick.is_some();
                !was_driven || reason.is_robot_at_rest() || now.saturating_sub(self.since) > HOLD
            }
            WatchdogState::Watching | WatchdogState::Armed | WatchdogState::Ramping(_) => false,
        }
    }

    /// Begins to drive the robot, which stays where it is until there is a target.
    ///
    /// # Errors
    /// It is being driven or was stopped, or the robot cannot be driven now.
    pub fn arm(
        &mut self,
        now: Duration,
        state: &RobotState,
    ) -> Result<Vec<RobotOrder>, StopReason> {
        match &self.state {
            WatchdogState::Watching => {}
            WatchdogState::Armed => return Ok(Vec::new()),
            WatchdogState::Ramping(reason) | WatchdogState::Held(reason) => {
                return Err(reason.clone());
            }
        }
        if let Some(reason) = unfit(now, state) {
            return Err(reason);
        }
        let mut orders = Vec::new();
        for motion in &mut self.limbs {
            let limb = &self.profile.limbs[motion.limb];
            motion.begin(&angles(&limb.joints, state));
            if let Some(limit) = &limb.time_limit {
                let seconds = limit.driven;
                orders.push(RobotOrder::LimitTime {
                    limb: motion.limb,
                    seconds,
                });
            }
            if limb.speed_ratio.is_some() {
                let ratio = self.share;
                orders.push(RobotOrder::LimitSpeed {
                    limb: motion.limb,
                    ratio,
                });
            }
        }
        self.last_tick = Some(now);
        self.enter(WatchdogState::Armed, now);
        Ok(orders)
    }

    /// Brings the robot to rest, unless that has already begun.
    pub fn stop(&mut self, reason: StopReason, now: Duration) {
        match &self.state {
            WatchdogState::Watching => self.enter(WatchdogState::Held(reason), now),
            WatchdogState::Armed if reason.is_robot_at_rest() => {
                self.enter(WatchdogState::Held(reason), now);
            }
            WatchdogState::Armed => self.enter(WatchdogState::Ramping(reason), now),
            WatchdogState::Ramping(_) if reason.is_robot_at_rest() => {
                self.enter(WatchdogState::Held(reason), now);
            }
            // A robot that has stopped by itself is sent nothing, not even to be held.
            WatchdogState::Held(first)
                if reason.is_robot_at_rest() && !first.is_robot_at_rest() =>
            {
                self.state = WatchdogState::Held(reason);
            }
            WatchdogState::Ramping(_) | WatchdogState::Held(_) => {}
        }
    }

    /// What the robot is sent now, if this is what it says of itself, and what the program wanted at some moment.
    pub fn tick(
        &mut self,
        now: Duration,
        state: &RobotState,
        target: &RobotTarget,
        set_at: Duration,
    ) -> Vec<RobotOrder> {
        let Some(last) = self.last_tick else {
            return Vec::new();
        };
        self.last_tick = Some(now);
        let passed = now.saturating_sub(last);
        if self.state == WatchdogState::Armed {
            if let Some(reason) = self.fault(now, passed, state, target, set_at) {
                self.stop(reason, now);
            }
            self.note_rest(passed);
        } else if let Some(reason @ (StopReason::EmergencyStop | StopReason::Disabled)) =
            unfit(now, state)
        {
            self.stop(reason, now);
        }
        let seconds = passed.min(OLDEST_TARGET).as_secs_f64();
        match self.state.clone() {
            WatchdogState::Watching => Vec::new(),
            WatchdogState::Armed => self.drive(now, seconds, state, target, set_at),
            WatchdogState::Ramping(reason) => {
                let since = now.saturating_sub(self.since);
                if since < RAMP {
                    return self.ramp(now, seconds, RAMP - since, state);
                }
                self.enter(WatchdogState::Held(reason), now);
                self.hold(now, state)
            }
            WatchdogState::Held(_) if self.is_done(now) => Vec::new(),
            WatchdogState::Held(_) => self.hold(now, state),
        }
    }

    fn enter(&mut self, state: WatchdogState, now: Duration) {
        self.state = state;
        self.since = now;
    }

    /// What is not as it should be.
    fn fault(
        &self,
        now: Duration,
        passed: Duration,
        state: &RobotState,
        target: &RobotTarget,
        set_at: Duration,
    ) -> Option<StopReason> {
        if passed > OLDEST_TARGET {
            return Some(StopReason::WatchdogLate { by: passed });
        }
        if let Some(reason) = unfit(now, state) {
            return Some(reason);
        }
        // A robot that rests may wait for its program.
        let by = now.saturating_sub(set_at.max(self.since));
        if by > OLDEST_TARGET && self.is_moved_by(target) {
            return Some(StopReason::ProgramLate { by });
        }
        let deviation = self
            .limbs
            .iter()
            .find_map(|motion| motion.deviation(&self.profile, state));
        deviation.or_else(|| gripper::fault(now, state, target))
    }

    /// True if a target moves a limb that is driven, or brings it to angles where it has not been sent yet.
    fn is_moved_by(&self, target: &RobotTarget) -> bool {
        self.limbs.iter().any(|motion| {
            let name = &self.profile.limbs[motion.limb].name;
            match target.limbs.get(name) {
                Some(LimbTarget::Velocities(speeds)) => speeds.iter().any(|speed| *speed != 0.0),
                Some(LimbTarget::Positions(goals)) => {
                    let ways = goals.iter().zip(&motion.expected);
                    ways.into_iter()
                        .any(|(goal, now)| (goal - now).abs() > THERE)
                }
                None => false,
            }
        })
    }

    /// The share that is left of the last speeds, since what is known of the robot, and what the program wants, gets old: so a joint is slow when it is too
    /// old.
    fn slowing(&mut self, now: Duration, state: &RobotState, set_at: Duration) -> f64 {
        let age = state.age(now).unwrap_or(OLDEST_STATE);
        let age = age.max(now.saturating_sub(set_at.max(self.since)));
        let left = OLDEST_STATE.saturating_sub(age).as_secs_f64();
        let freshness = (left / (OLDEST_STATE - NEW).as_secs_f64()).min(1.0);
        let slowing = match freshness < self.freshness {
            true => freshness / self.freshness,
            false => 1.0,
        };
        self.freshness = freshness.max(f64::MIN_POSITIVE);
        slowing
    }

    /// After such a time without commands, a robot with a time limit has stopped by itself.
    fn note_rest(&mut self, passed: Duration) {
        for motion in &mut self.limbs {
            let limit = self.profile.limbs[motion.limb].time_limit.as_ref();
            if limit.is_some_and(|limit| passed.as_secs_f64() > limit.driven) {
                motion.note_stop();
            }
        }
    }

    fn drive(
        &mut self,
        now: Duration,
        seconds: f64,
        state: &RobotState,
        target: &RobotTarget,
        set_at: Duration,
    ) -> Vec<RobotOrder> {
        let slowing = self.slowing(now, state, set_at);
        let lag = state.age(now).unwrap_or_default().as_secs_f64() + seconds;
        let mut orders = Vec::new();
        for motion in &mut self.limbs {
            let limb = &self.profile.limbs[motion.limb];
            let measured = angles(&limb.joints, state);
            let limits = TurnLimits {
                slowing,
                ..limits(limb, self.share, state, lag, seconds)
            };
            let order = match target.limbs.get(&limb.name) {
                Some(LimbTarget::Positions(goals)) if limb.positions.is_some() => {
                    motion.approach(limits, &measured, goals)
                }
                Some(LimbTarget::Velocities(speeds)) => motion.turn(limits, &measured, speeds),
                Some(LimbTarget::Positions(_)) | None => motion.rest(limits, &measured),
            };
            orders.push(order);
            let opening = target.grippers.get(&limb.name);
            let reading = state.grippers.get(&limb.name);
            if let (Some(opening), Some(reading)) = (opening, reading) {
                let grippers = &mut self.grippers;
                orders.extend(grippers.order(now, motion.limb, reading, *opening));
            }
        }
        orders.extend(self.head(now, target));
        orders
    }

    fn head(&mut self, now: Duration, target: &RobotTarget) -> Option<RobotOrder> {
        let (least, largest) = self.profile.head.as_ref()?.joint.limits;
        let angle = target.head?.clamp(least, largest);
        let is_new = self.head.is_none_or(|(last, at)| {
            let since = now.saturating_sub(at);
            let is_other = (last - angle).abs() >= HEAD_STEP && since >= HEAD_PERIOD;
            is_other || since >= REPETITION
        });
        is_new.then(|| {
            self.head = Some((angle, now));
            RobotOrder::TurnHead(angle)
        })
    }

    /// Evenly slower, so that all joints rest when what is left of the ramp is over.
    fn ramp(
        &mut self,
        now: Duration,
        seconds: f64,
        left: Duration,
        state: &RobotState,
    ) -> Vec<RobotOrder> {
        let slowing = (1.0 - seconds / (left.as_secs_f64() + seconds)).max(0.0);
        let profile = &self.profile;
        let share = self.share;
        let slow = self.limbs.iter_mut().map(|motion| {
            let limb = &profile.limbs[motion.limb];
            let measured = believed(now, limb, state);
            let limits = limits(limb, share, state, 0.0, seconds);
            motion.slow(limits, measured.as_deref(), slowing)
        });
        slow.collect()
    }

    /// The robot stays where it is.
    fn hold(&mut self, now: Duration, state: &RobotState) -> Vec<RobotOrder> {
        let mut orders = Vec::new();
        for motion in &mut self.limbs {
            let limb = &self.profile.limbs[motion.limb];
            if motion.held.is_none()
                && let Some(limit) = &limb.time_limit
            {
                orders.push(RobotOrder::LimitTime {
                    limb: motion.limb,
                    seconds: limit.idle,
                });
            }
            let measured = believed(now, limb, state).filter(|_| limb.positions.is_some());
            orders.push(motion.hold(measured.as_deref()));
        }
        orders
    }
}

fn limits<'a>(
    limb: &'a LimbProfile,
    share: f64,
    state: &RobotState,
    lag: f64,
    seconds: f64,
) -> TurnLimits<'a> {
    TurnLimits {
        joints: &limb.joints,
        share,
        lag,
        seconds,
        pace: state.pace,
        slowing: 1.0,
    }
}

/// Where a limb was measured, if that is new and can be believed.
fn believed(now: Duration, limb: &LimbProfile, state: &RobotState) -> Option<Vec<f64>> {
    let is_fresh = state.age(now).is_some_and(|age| age <= OLDEST_STATE);
    (is_fresh && state.jump.is_none()).then(|| angles(&limb.joints, state))
}

/// Why a robot that says this of itself cannot be driven.
pub(crate) fn unfit(now: Duration, state: &RobotState) -> Option<StopReason> {
    match state.health {
        Some(RobotHealth::EmergencyStop) => return Some(StopReason::EmergencyStop),
        Some(RobotHealth::Disabled) | None => return Some(StopReason::Disabled),
        Some(RobotHealth::Error) => return Some(StopReason::RobotError),
        Some(RobotHealth::Enabled) => {}
    }
    if let Some(jump) = &state.jump {
        return Some(StopReason::Jump(jump.clone()));
    }
    let age = state.age(now).unwrap_or(Duration::MAX);
    if age > OLDEST_STATE {
        return Some(StopReason::StaleState { age });
    }
    let age = state.health_age(now).unwrap_or(Duration::MAX);
    (age > OLDEST_REPORT).then_some(StopReason::SilentHealth { age })
}

#[cfg(test)]
mod tests;
