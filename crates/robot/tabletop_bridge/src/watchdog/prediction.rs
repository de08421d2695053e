//! Where the limbs will be if a target is followed.

use std::{
    collections::{BTreeMap, BTreeSet},
    time::Duration,
};

use super::{
    PERIOD, Watchdog,
    limb::{LimbMotion, TurnLimits, angles},
};
use crate::{
    profile::LimbProfile,
    state::RobotState,
    target::{LimbTarget, RobotTarget},
    tolerances::{LONGEST_MOVE, NEW, OLDEST_TARGET, RAMP, RESPONSE},
};

/// The least speed of a joint, in rad/s, that is a motion.
const MOTION: f64 = 1e-4;

/// The postures through which the limbs will go if a target is followed until it is too old, and they are then brought to rest. Those of position targets
/// lead to their goals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PredictedMotion {
    /// The angles of each limb's joints, in rad, by the limb's name, from moment to moment; the first ones are those that were measured. All limbs have
    /// as many.
    pub limbs: BTreeMap<String, Vec<Vec<f64>>>,
    /// The limbs that are driven. Others go on as they were measured.
    pub driven: BTreeSet<String>,
}

impl PredictedMotion {
    /// The number of moments.
    pub fn moments(&self) -> usize {
        self.limbs.values().map(Vec::len).max().unwrap_or(0)
    }

    /// The angles of a limb at a moment; none if it is not of the robot.
    pub fn angles(&self, limb: &str, moment: usize) -> Option<&[f64]> {
        let angles = self.limbs.get(limb)?.get(moment)?;
        Some(angles)
    }
}

impl Watchdog {
    /// What would become of the limbs with a target, in the place of another one. The whole way to a position is looked at when it is new.
    pub fn predict(
        &self,
        now: Duration,
        state: &RobotState,
        target: &RobotTarget,
        before: &RobotTarget,
    ) -> PredictedMotion {
        let age = state.age(now).unwrap_or_default();
        let lag = (age + PERIOD + RESPONSE).as_secs_f64();
        let mut limbs: BTreeMap<_, _> = self
            .limbs
            .iter()
            .map(|motion| {
                let limb = &self.profile.limbs[motion.limb];
                let measured = angles(&limb.joints, state);
                let [target, before] = [target, before].map(|it| it.limbs.get(&limb.name));
                let is_new = target != before;
                let way = way(motion, limb, self.share, measured, target, is_new, lag);
                (limb.name.clone(), way)
            })
            .collect();
        let moments = limbs.values().map(Vec::len).max().unwrap_or(1);
        for limb in &self.profile.limbs {
            let others = || drifting(limb, state, moments);
            let way = limbs.entry(limb.name.clone()).or_insert_with(others);
            if let Some(last) = way.last().cloned() {
                way.resize(moments, last);
            }
        }
        let driven = self.limbs.iter().map(|motion| motion.limb);
        let driven = driven.map(|limb| self.profile.limbs[limb].name.clone());
        PredictedMotion {
            limbs,
            driven: driven.collect(),
        }
    }
}

/// The way of a limb that is driven.
fn way(
    motion: &LimbMotion,
    limb: &LimbProfile,
    share: f64,
    measured: Vec<f64>,
    target: Option<&LimbTarget>,
    is_new: bool,
    lag: f64,
) -> Vec<Vec<f64>> {
    let limits = TurnLimits {
        joints: &limb.joints,
        share,
        lag: 0.0,
        seconds: PERIOD.as_secs_f64(),
        pace: 1.0,
        slowing: 1.0,
    };
    let mut ghost = motion.ghost();
    // Where it was sent is known better than where it was measured.
    let measured = match ghost.is_by_positions {
        true => ghost.expected.clone(),
        false => measured,
    };
    let mut angles = measured.clone();
    // What it was told before, it does until it is told this.
    turn(&mut angles, &ghost.speeds, lag);
    let mut way = vec![measured, angles.clone()];
    // As far as an old target leads, before it is too old.
    let followed = periods(NEW + (OLDEST_TARGET - NEW) / 2);
    let goals = match target {
        Some(LimbTarget::Positions(goals)) if limb.positions.is_some() => Some(goals),
        Some(LimbTarget::Positions(_) | LimbTarget::Velocities(_)) | None => None,
    };
    let wanted = match target {
        Some(LimbTarget::Velocities(speeds)) => Some(speeds),
        Some(LimbTarget::Positions(_)) | None => None,
    };
    if goals.is_some() {
        way.truncate(1);
    }
    for period in 0..followed + periods(LONGEST_MOVE) {
        let is_followed = period < followed || (is_new && goals.is_some());
        if let Some(goals) = goals.filter(|_| is_followed) {
            ghost.approach(limits, &angles, goals);
            angles.clone_from(&ghost.expected);
        } else {
            match wanted.filter(|_| is_followed) {
                Some(wanted) => ghost.turn(limits, &angles, wanted),
                None => ghost.rest(limits, &angles),
            };
            turn(&mut angles, &ghost.speeds, limits.seconds);
        }
        way.push(angles.clone());
        let may_end = goals.is_some() || period >= followed;
        if may_end && is_still(&ghost.speeds) {
            break;
        }
    }
    way
}

/// The way of a limb that somebody else moves, if anybody does.
fn drifting(limb: &LimbProfile, state: &RobotState, moments: usize) -> Vec<Vec<f64>> {
    let mut angles = angles(&limb.joints, state);
    let speed = |name: &String| state.joints.get(name)?.velocity;
    let joints = limb.joints.iter();
    let speeds: Vec<_> = joints
        .map(|joint| speed(&joint.name).unwrap_or(0.0))
        .collect();
    let mut way = vec![angles.clone()];
    for _ in 1..moments.min(periods(OLDEST_TARGET + RAMP)) {
        turn(&mut angles, &speeds, PERIOD.as_secs_f64());
        way.push(angles.clone());
    }
    way
}

fn turn(angles: &mut [f64], speeds: &[f64], seconds: f64) {
    for (angle, speed) in angles.iter_mut().zip(speeds) {
        *angle += speed * seconds;
    }
}

fn is_still(speeds: &[f64]) -> bool {
    speeds.iter().all(|speed| speed.abs() < MOTION)
}

fn periods(time: Duration) -> usize {
    usize::try_from(time.as_nanos().div_ceil(PERIOD.as_nanos())).unwrap_or(usize::MAX)
}
