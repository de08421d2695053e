//! What stands between a program and a robot: it passes on what is safe, and stops the robot where something is not as it should be.
//!
//! It knows neither sockets nor clocks, and decides from what it is told.

use std::{collections::BTreeMap, fmt, time::Duration};

use crate::{
    limits::{limited_speed, ramped_speed, speed_towards},
    orders::{GripperMotion, RobotOrder},
    profile::{BridgeProfile, JointProfile},
    state::{RobotHealth, RobotState},
    target::{LimbTarget, RobotTarget},
};

/// The time from one look at the robot to the next, and from command to command.
pub const PERIOD: Duration = Duration::from_millis(10);

/// The oldest state on which a robot is driven. Joints' states come 100 times a second.
pub const OLDEST_STATE: Duration = Duration::from_millis(100);

/// The oldest target that is still followed. Programs set one 60 times a second.
pub const OLDEST_TARGET: Duration = Duration::from_millis(100);

/// How far a joint may be from where it should be, in rad.
pub const MOST_DEVIATION: f64 = 0.3;

/// The time in which the joints come to rest when something is wrong.
pub const RAMP: Duration = Duration::from_millis(100);

/// How long the robot is told to stay where it is, before commands end.
pub const HOLD: Duration = Duration::from_millis(300);

/// How fast the expectation of a joint driven by velocities forgets, in s: speeds are followed to some percent, and where they lead to is not known for
/// long. So a joint that stands still is found out if it should turn at 0.3 rad/s or more.
const FORGETTING: f64 = 1.0;

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

/// What a watchdog does.
#[derive(Clone, Debug, PartialEq)]
pub enum WatchdogState {
    /// It looks on and sends nothing.
    Watching,
    /// It passes on what the program wants.
    Armed,
    /// It brings the joints to rest.
    Ramping(StopReason),
    /// The robot stays where it is, and is no longer driven. Only a person starts it again.
    Held(StopReason),
}

/// Why a robot is no longer driven.
#[derive(Clone, Debug, PartialEq)]
pub enum StopReason {
    /// The program is done with it.
    Asked,
    /// Its joints' states are old.
    StaleState {
        /// How old they are.
        age: Duration,
    },
    /// Somebody or something has stopped it.
    EmergencyStop,
    /// Its motors are off.
    Disabled,
    /// A part of it is faulty.
    RobotError,
    /// The program has set no target for too long.
    ProgramLate {
        /// How long.
        by: Duration,
    },
    /// This program was not running for too long.
    WatchdogLate {
        /// How long.
        by: Duration,
    },
    /// A joint is not where it should be.
    Deviation {
        /// The joint.
        joint: String,
        /// How far it is from there, in rad.
        by: f64,
    },
    /// The connection is lost; the robot stops by its own time limit.
    Disconnected(String),
}

impl fmt::Display for StopReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ms = Duration::as_millis;
        match self {
            Self::Asked => f.write_str("the program is done"),
            Self::StaleState { age } => {
                write!(f, "the robot's joint states are {} ms old", ms(age))
            }
            Self::EmergencyStop => f.write_str("the robot is stopped: a person must reset it"),
            Self::Disabled => f.write_str("the robot's motors are off"),
            Self::RobotError => f.write_str("the robot reports an error"),
            Self::ProgramLate { by } => write!(f, "the program set no target for {} ms", ms(by)),
            Self::WatchdogLate { by } => write!(f, "this computer stood still for {} ms", ms(by)),
            Self::Deviation { joint, by } => {
                write!(f, "{joint} is {by:.2} rad from where it should be")
            }
            Self::Disconnected(why) => f.write_str(why),
        }
    }
}

impl StopReason {
    /// True if the robot has already stopped by itself, so that commands make no sense.
    fn is_robot_at_rest(&self) -> bool {
        match self {
            Self::EmergencyStop | Self::Disabled | Self::Disconnected(_) => true,
            Self::Asked
            | Self::StaleState { .. }
            | Self::RobotError
            | Self::ProgramLate { .. }
            | Self::WatchdogLate { .. }
            | Self::Deviation { .. } => false,
        }
    }
}

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

/// The motion of a driven limb.
#[derive(Clone, Debug)]
struct LimbMotion {
    /// Its place in the profile.
    limb: usize,
    /// The joints' speeds of the last command, in rad/s.
    speeds: Vec<f64>,
    /// Where the joints should be, in rad.
    expected: Vec<f64>,
    /// True if the last command was of positions.
    is_by_positions: bool,
    /// Where it is held.
    held: Option<Vec<f64>>,
}

impl Watchdog {
    /// A watchdog that looks on. Limbs are named by their places in the profile.
    pub fn new(profile: BridgeProfile, driven: &[usize], share: f64) -> Self {
        let limbs = driven.iter().map(|limb| {
            let joints = profile.limbs[*limb].joints.len();
            LimbMotion {
                limb: *limb,
                speeds: vec![0.0; joints],
                expected: vec![0.0; joints],
                is_by_positions: false,
                held: None,
            }
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

impl LimbMotion {
    /// Turns the joints at wanted speeds, as far as limits let them. `lag` is the time, in s, from the measured angles to the end of the command.
    fn turn(
        &mut self,
        joints: &[JointProfile],
        share: f64,
        measured: &[f64],
        wanted: &[f64],
        lag: f64,
        seconds: f64,
    ) -> RobotOrder {
        if self.is_by_positions {
            self.is_by_positions = false;
            self.expected = measured.to_owned();
        }
        for (place, joint) in joints.iter().enumerate() {
            let last = self.speeds[place];
            let ahead = measured[place] + last * lag;
            let limited = limited_speed(joint, share, ahead, wanted[place]);
            let speed = limited_speed(joint, share, ahead, ramped_speed(last, limited, seconds));
            let forgotten = (measured[place] - self.expected[place]) * seconds / FORGETTING;
            self.expected[place] += speed * seconds + forgotten;
            self.speeds[place] = speed;
        }
        RobotOrder::Velocities {
            limb: self.limb,
            speeds: self.speeds.clone(),
        }
    }

    /// Brings the joints nearer to their goals. What is sent are angles on the way, so that a joint is soon found out that does not follow.
    fn approach(
        &mut self,
        joints: &[JointProfile],
        share: f64,
        measured: &[f64],
        goals: &[f64],
        seconds: f64,
    ) -> RobotOrder {
        if !self.is_by_positions {
            self.is_by_positions = true;
            self.expected = measured.to_owned();
        }
        for (place, joint) in joints.iter().enumerate() {
            let way = goals[place] - self.expected[place];
            let limited = limited_speed(joint, share, self.expected[place], speed_towards(way));
            let speed = ramped_speed(self.speeds[place], limited, seconds);
            self.speeds[place] = limited_speed(joint, share, self.expected[place], speed);
            self.expected[place] += self.speeds[place] * seconds;
        }
        RobotOrder::Positions {
            limb: self.limb,
            angles: self.expected.clone(),
        }
    }

    fn deviation(&self, profile: &BridgeProfile, state: &RobotState) -> Option<StopReason> {
        let joints = &profile.limbs[self.limb].joints;
        let measured = angles(joints, state);
        let deviations = measured
            .iter()
            .zip(&self.expected)
            .map(|(measured, expected)| (measured - expected).abs());
        let (joint, by) = joints
            .iter()
            .zip(deviations)
            .find(|(_, by)| *by > MOST_DEVIATION)?;
        Some(StopReason::Deviation {
            joint: joint.name.clone(),
            by,
        })
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

/// The measured angles of joints, which are known once a state has an age.
fn angles(joints: &[JointProfile], state: &RobotState) -> Vec<f64> {
    let angle = |joint: &JointProfile| state.joints.get(&joint.name).map_or(0.0, |it| it.position);
    joints.iter().map(angle).collect()
}

#[cfg(test)]
mod tests;
