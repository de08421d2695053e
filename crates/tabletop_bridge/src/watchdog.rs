//! What stands between a program and a robot: it passes on what is safe, and stops the robot where something is not as it should be.
//!
//! It knows neither sockets nor clocks, and decides from what it is told.

mod limb;
mod state;

use std::{collections::BTreeMap, time::Duration};

pub use limb::MOST_DEVIATION;
use limb::{LimbMotion, angles};
pub use state::{StopReason, WatchdogState};

use crate::{
    limits::limited_speed,
    orders::{GripperMotion, RobotOrder},
    profile::BridgeProfile,
    state::{RobotHealth, RobotState},
    target::{LimbTarget, RobotTarget},
};

/// The time from one look at the robot to the next, and from command to command.
pub const PERIOD: Duration = Duration::from_millis(10);

/// The oldest state on which a robot is driven. Joints' states come 100 times a second.
pub const OLDEST_STATE: Duration = Duration::from_millis(100);

/// The oldest target that is still followed. Programs set one 60 times a second.
pub const OLDEST_TARGET: Duration = Duration::from_millis(100);

/// The time in which the joints come to rest when something is wrong.
pub const RAMP: Duration = Duration::from_millis(100);

/// How long the robot is told to stay where it is, before commands end.
pub const HOLD: Duration = Duration::from_millis(300);

/// The distance of a joint, in rad, from the angle that it was sent to at which it counts as there.
const THERE: f64 = 1e-3;

/// The least change of an opening, from 0 to 1, and the least time between two, that a gripper is sent.
const GRIPPER_STEP: f64 = 0.01;
const GRIPPER_PERIOD: Duration = Duration::from_millis(50);

/// The time after which something is sent again that need not have arrived: a topic has no receiver until the two have found each other.
pub(crate) const REPETITION: Duration = Duration::from_millis(500);

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
    /// What grippers and head were sent last, and when.
    openings: BTreeMap<usize, SentOpening>,
    head: Option<(f64, Duration)>,
}

/// What a gripper was sent.
#[derive(Clone, Copy, Debug)]
struct SentOpening {
    opening: f64,
    sequence: u32,
    at: Duration,
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
            openings: BTreeMap::new(),
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
            motion.expected = angles(&limb.joints, state);
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
        } else if let Some(reason @ (StopReason::EmergencyStop | StopReason::Disabled)) =
            unfit(now, state)
        {
            self.stop(reason, now);
        }
        let seconds = passed.min(OLDEST_TARGET).as_secs_f64();
        match self.state.clone() {
            WatchdogState::Watching => Vec::new(),
            WatchdogState::Armed => self.drive(now, seconds, state, target),
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
        self.limbs
            .iter()
            .find_map(|motion| motion.deviation(&self.profile, state))
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

    fn drive(
        &mut self,
        now: Duration,
        seconds: f64,
        state: &RobotState,
        target: &RobotTarget,
    ) -> Vec<RobotOrder> {
        let lag = state.age(now).unwrap_or_default().as_secs_f64() + seconds;
        let mut orders = Vec::new();
        for motion in &mut self.limbs {
            let limb = &self.profile.limbs[motion.limb];
            let measured = angles(&limb.joints, state);
            let order = match target.limbs.get(&limb.name) {
                Some(LimbTarget::Positions(goals)) if limb.positions.is_some() => {
                    motion.approach(&limb.joints, self.share, &measured, goals, seconds)
                }
                Some(LimbTarget::Velocities(speeds)) => {
                    motion.turn(&limb.joints, self.share, &measured, speeds, lag, seconds)
                }
                Some(LimbTarget::Positions(_)) | None => {
                    let rest = vec![0.0; limb.joints.len()];
                    motion.turn(&limb.joints, self.share, &measured, &rest, lag, seconds)
                }
            };
            orders.push(order);
        }
        orders.extend(self.grippers(now, state, target));
        orders.extend(self.head(now, target));
        orders
    }

    fn grippers(
        &mut self,
        now: Duration,
        state: &RobotState,
        target: &RobotTarget,
    ) -> Vec<RobotOrder> {
        let mut orders = Vec::new();
        for motion in &self.limbs {
            let (limb, name) = (motion.limb, &self.profile.limbs[motion.limb].name);
            let (Some(opening), Some(reading)) =
                (target.grippers.get(name), state.grippers.get(name))
            else {
                continue;
            };
            let opening = opening.clamp(0.0, 1.0);
            let heard = reading.sequence.unwrap_or_default();
            let sequence = match self.openings.get(&limb) {
                Some(last) if (last.opening - opening).abs() < GRIPPER_STEP => {
                    let is_unheard = reading.sequence != Some(last.sequence);
                    (is_unheard && now.saturating_sub(last.at) >= REPETITION)
                        .then_some(last.sequence)
                }
                Some(last) => {
                    let is_due = now.saturating_sub(last.at) >= GRIPPER_PERIOD;
                    is_due.then(|| last.sequence.max(heard).wrapping_add(1))
                }
                None => Some(heard.wrapping_add(1)),
            };
            let Some(sequence) = sequence else {
                continue;
            };
            let at = now;
            self.openings.insert(
                limb,
                SentOpening {
                    opening,
                    sequence,
                    at,
                },
            );
            orders.push(RobotOrder::MoveGripper {
                limb,
                id: reading.id,
                motion: GripperMotion::Open(opening),
                sequence,
            });
        }
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
        let age = state.age(now);
        let mut orders = Vec::new();
        for motion in &mut self.limbs {
            let limb = &self.profile.limbs[motion.limb];
            let measured = match age {
                Some(age) if age <= OLDEST_STATE => angles(&limb.joints, state),
                Some(_) | None => motion.expected.clone(),
            };
            for (joint, (speed, measured)) in limb
                .joints
                .iter()
                .zip(motion.speeds.iter_mut().zip(&measured))
            {
                *speed = limited_speed(joint, self.share, *measured, *speed * slowing);
            }
            for (expected, speed) in motion.expected.iter_mut().zip(&motion.speeds) {
                *expected += speed * seconds;
            }
            let speeds = motion.speeds.clone();
            orders.push(RobotOrder::Velocities {
                limb: motion.limb,
                speeds,
            });
        }
        orders
    }

    /// The robot stays where it is: where it was measured at the end of the ramp. If that is not known, or if it is driven by velocities alone, its
    /// speeds are zero.
    fn hold(&mut self, now: Duration, state: &RobotState) -> Vec<RobotOrder> {
        let is_fresh = state.age(now).is_some_and(|age| age <= OLDEST_STATE);
        let mut orders = Vec::new();
        for motion in &mut self.limbs {
            let limb = &self.profile.limbs[motion.limb];
            motion.speeds.fill(0.0);
            if motion.held.is_none() {
                if let Some(limit) = &limb.time_limit {
                    orders.push(RobotOrder::LimitTime {
                        limb: motion.limb,
                        seconds: limit.idle,
                    });
                }
                motion.held = match is_fresh && limb.positions.is_some() {
                    true => Some(angles(&limb.joints, state)),
                    false => Some(Vec::new()),
                };
            }
            orders.push(match &motion.held {
                Some(angles) if !angles.is_empty() => RobotOrder::Positions {
                    limb: motion.limb,
                    angles: angles.clone(),
                },
                Some(_) | None => RobotOrder::Velocities {
                    limb: motion.limb,
                    speeds: motion.speeds.clone(),
                },
            });
        }
        orders
    }
}

/// Why a robot that says this of itself cannot be driven.
pub(crate) fn unfit(now: Duration, state: &RobotState) -> Option<StopReason> {
    match state.health {
        Some(RobotHealth::EmergencyStop) => return Some(StopReason::EmergencyStop),
        Some(RobotHealth::Disabled) | None => return Some(StopReason::Disabled),
        Some(RobotHealth::Error) => return Some(StopReason::RobotError),
        Some(RobotHealth::Enabled) => {}
    }
    let age = state.age(now).unwrap_or(Duration::MAX);
    (age > OLDEST_STATE).then_some(StopReason::StaleState { age })
}

#[cfg(test)]
mod tests;
