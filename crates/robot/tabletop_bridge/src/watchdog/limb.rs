//! The motion of a driven limb: the speeds and angles that its joints are sent, and where they should be.

use super::{progress::JointProgress, state::StopReason};
use crate::{
    limits::{limited_speed, ramped_speed, speed_towards},
    orders::RobotOrder,
    profile::{BridgeProfile, JointProfile},
    state::RobotState,
    tolerances::{FORGETTING, MOST_DEVIATION, MOST_HELD},
};

/// The motion of a driven limb.
#[derive(Clone, Debug)]
pub(super) struct LimbMotion {
    /// Its place in the profile.
    pub limb: usize,
    /// The joints' speeds of the last command, in rad/s.
    pub speeds: Vec<f64>,
    /// Where the joints should be, in rad.
    pub expected: Vec<f64>,
    /// Whether they turn as they are ordered to.
    progress: Vec<JointProgress>,
    /// The joint that does not.
    unfollowed: Option<usize>,
    /// True if the last command was of positions.
    pub is_by_positions: bool,
    /// Where it is held; no angles if it is held by no speed.
    pub held: Option<Vec<f64>>,
}

/// How joints may be turned now.
#[derive(Clone, Copy, Debug)]
pub(super) struct TurnLimits<'a> {
    /// The joints.
    pub joints: &'a [JointProfile],
    /// The share of their greatest speeds that they may have.
    pub share: f64,
    /// The time, in s, from the measured angles to the end of the command.
    pub lag: f64,
    /// The time from command to command, in s.
    pub seconds: f64,
    /// Seconds of the robot's time in one of ours.
    pub pace: f64,
    /// The share that is left of the last speeds, since what is known gets old.
    pub slowing: f64,
}

impl TurnLimits<'_> {
    /// A speed that is slowed, unless it is slower than that anyway.
    fn slowed(&self, last: f64, speed: f64) -> f64 {
        match self.slowing < 1.0 {
            true => speed.clamp(-last.abs() * self.slowing, last.abs() * self.slowing),
            false => speed,
        }
    }
}

impl LimbMotion {
    /// A limb at this place in the profile, with this many joints, that has not been moved.
    pub fn at_rest(limb: usize, joints: usize) -> Self {
        Self {
            limb,
            speeds: vec![0.0; joints],
            expected: vec![0.0; joints],
            progress: vec![JointProgress::default(); joints],
            unfollowed: None,
            is_by_positions: false,
            held: None,
        }
    }

    /// One that moves like it, of which nobody asks whether it is followed.
    pub fn ghost(&self) -> Self {
        Self {
            progress: Vec::new(),
            speeds: self.speeds.clone(),
            expected: self.expected.clone(),
            held: None,
            ..*self
        }
    }

    /// Begins where the joints are.
    pub fn begin(&mut self, measured: &[f64]) {
        self.expected = measured.to_owned();
        self.progress = measured.iter().map(|it| JointProgress::at(*it)).collect();
    }

    /// Turns the joints at wanted speeds, as far as limits let them.
    pub fn turn(&mut self, limits: TurnLimits<'_>, measured: &[f64], wanted: &[f64]) -> RobotOrder {
        if self.is_by_positions {
            self.is_by_positions = false;
            self.expected = measured.to_owned();
        }
        let TurnLimits { share, seconds, .. } = limits;
        for (place, joint) in limits.joints.iter().enumerate() {
            let last = self.speeds[place];
            let ahead = measured[place] + last * limits.lag;
            let limited = limited_speed(joint, share, ahead, wanted[place]);
            let speed = limited_speed(joint, share, ahead, ramped_speed(last, limited, seconds));
            let speed = limits.slowed(last, speed);
            // Where a joint rests is known.
            if speed != 0.0 {
                let forgotten = (measured[place] - self.expected[place]) * seconds / FORGETTING;
                self.expected[place] += speed * seconds * limits.pace + forgotten;
            }
            self.speeds[place] = speed;
        }
        self.follow(limits, measured);
        RobotOrder::Velocities {
            limb: self.limb,
            speeds: self.speeds.clone(),
        }
    }

    /// Brings the joints nearer to their goals. What is sent are angles on the way, so that a joint is soon found out that does not follow.
    pub fn approach(
        &mut self,
        limits: TurnLimits<'_>,
        measured: &[f64],
        goals: &[f64],
    ) -> RobotOrder {
        if !self.is_by_positions {
            self.is_by_positions = true;
            self.expected = measured.to_owned();
        }
        let TurnLimits { share, seconds, .. } = limits;
        for (place, joint) in limits.joints.iter().enumerate() {
            let way = goals[place] - self.expected[place];
            let limited = limited_speed(joint, share, self.expected[place], speed_towards(way));
            let speed = ramped_speed(self.speeds[place], limited, seconds);
            let speed = limited_speed(joint, share, self.expected[place], speed);
            self.speeds[place] = limits.slowed(self.speeds[place], speed);
            self.expected[place] += self.speeds[place] * seconds * limits.pace;
        }
        self.follow(limits, measured);
        RobotOrder::Positions {
            limb: self.limb,
            angles: self.expected.clone(),
        }
    }

    /// Slows the joints evenly by a factor. Limits are kept from where the joints are.
    pub fn slow(
        &mut self,
        limits: TurnLimits<'_>,
        measured: Option<&[f64]>,
        factor: f64,
    ) -> RobotOrder {
        for (place, joint) in limits.joints.iter().enumerate() {
            let angle = measured.map_or(self.expected[place], |measured| measured[place]);
            let slower = self.speeds[place] * factor;
            self.speeds[place] = limited_speed(joint, limits.share, angle, slower);
            self.expected[place] += self.speeds[place] * limits.seconds * limits.pace;
        }
        RobotOrder::Velocities {
            limb: self.limb,
            speeds: self.speeds.clone(),
        }
    }

    /// Stays where it is: where it was measured at the end of the ramp, if that is where it should be, else by no speed.
    pub fn hold(&mut self, measured: Option<&[f64]>) -> RobotOrder {
        self.speeds.fill(0.0);
        let expected = &self.expected;
        let held = self.held.get_or_insert_with(|| {
            let is_believed = |measured: &&[f64]| {
                let ways = measured.iter().zip(expected);
                ways.into_iter()
                    .all(|(it, own)| (it - own).abs() < MOST_HELD)
            };
            measured.filter(is_believed).unwrap_or_default().to_owned()
        });
        match held.is_empty() {
            true => RobotOrder::Velocities {
                limb: self.limb,
                speeds: self.speeds.clone(),
            },
            false => RobotOrder::Positions {
                limb: self.limb,
                angles: held.clone(),
            },
        }
    }

    fn follow(&mut self, limits: TurnLimits<'_>, measured: &[f64]) {
        let seconds = limits.seconds * limits.pace;
        let joints = self.progress.iter_mut().zip(measured).zip(&self.speeds);
        for (place, ((progress, angle), speed)) in joints.enumerate() {
            if !progress.is_followed(*angle, *speed, seconds) {
                self.unfollowed.get_or_insert(place);
            }
        }
    }

    /// Comes to rest in the way in which it is driven: to change that would lose what the arm is behind.
    pub fn rest(&mut self, limits: TurnLimits<'_>, measured: &[f64]) -> RobotOrder {
        if !self.is_by_positions {
            let none = vec![0.0; measured.len()];
            return self.turn(limits, measured, &none);
        }
        for (place, joint) in limits.joints.iter().enumerate() {
            let slower = ramped_speed(self.speeds[place], 0.0, limits.seconds);
            let speed = limited_speed(joint, limits.share, self.expected[place], slower);
            self.speeds[place] = limits.slowed(self.speeds[place], speed);
            self.expected[place] += self.speeds[place] * limits.seconds * limits.pace;
        }
        self.follow(limits, measured);
        RobotOrder::Positions {
            limb: self.limb,
            angles: self.expected.clone(),
        }
    }

    /// The robot has stopped it by itself, since no commands came.
    pub fn note_stop(&mut self) {
        self.speeds.fill(0.0);
        self.is_by_positions = false;
    }

    /// The joint that is not where it should be, or does not turn as it should.
    pub fn deviation(&self, profile: &BridgeProfile, state: &RobotState) -> Option<StopReason> {
        let joints = &profile.limbs[self.limb].joints;
        let measured = angles(joints, state);
        let name = |place: usize| joints[place].name.clone();
        if let Some(place) = self.unfollowed {
            return Some(StopReason::Unfollowed { joint: name(place) });
        }
        let mut deviations = measured.iter().zip(&self.expected).enumerate();
        deviations.find_map(|(place, (measured, expected))| {
            let by = (measured - expected).abs();
            (by > MOST_DEVIATION).then(|| StopReason::Deviation {
                joint: name(place),
                by,
            })
        })
    }
}

/// The measured angles of joints, which are known once a state has an age.
pub(super) fn angles(joints: &[JointProfile], state: &RobotState) -> Vec<f64> {
    let angle = |joint: &JointProfile| state.joints.get(&joint.name).map_or(0.0, |it| it.position);
    joints.iter().map(angle).collect()
}
