//! Motion of an arm and its gripper, tick by tick.

use tabletop_controller::{Angles, Sight};
use tabletop_core::{FINGER_SPEED, TICK_SECONDS};

use crate::{
    body::RobotBody,
    failure::PlanFailure,
    stage::{LimbOrder, PlanningStage, Stopped},
};

/// Number of ticks without progress after which an arm counts as stopped.
const PATIENCE: u32 = 20;
/// Largest number of ticks for a motion of fingers.
const FINGER_TICKS: u32 = 200;

/// Lets time pass without motion.
pub(crate) fn wait(stage: &mut dyn PlanningStage, ticks: u32) -> Result<(), Stopped> {
    let still = vec![LimbOrder::default(); stage.sight().limbs.len()];
    for _ in 0..ticks {
        stage.tick(&still)?;
    }
    Ok(())
}

/// Moves an arm along a path, its end effector no faster than `speed`, in units/s.
pub(crate) fn follow(
    stage: &mut dyn PlanningStage,
    body: &RobotBody,
    limb: usize,
    path: &[Angles],
    speed: f64,
    object: &str,
) -> Result<(), PlanFailure> {
    let step = f64::from(TICK_SECONDS);
    let following = stage.following();
    let start = stage.sight().limbs[limb].angles;
    // The time, in s, at which each posture is to be reached.
    let mut schedule = vec![(0.0, start)];
    for next in path {
        let (time, last) = schedule[schedule.len() - 1];
        let speeds = body.limbs[limb].speeds;
        let turns = (0..speeds.len()).map(|i| (next[i] - last[i]).abs() / speeds[i].max(0.1));
        let [here, there] = [&last, next].map(|angles| body.end_effector(limb, angles).location);
        let way = f64::from(here.distance(there)) / speed;
        schedule.push((time + turns.fold(way, f64::max).max(1e-6), *next));
    }
    let end = schedule[schedule.len() - 1].0;
    let mut time = 0.0_f64;
    let mut stopped = 0;
    let mut orders = vec![LimbOrder::default(); stage.sight().limbs.len()];
    loop {
        let angles = stage.sight().limbs[limb].angles;
        time = (time + step).min(end);
        let wanted = at(&schedule, time);
        orders[limb].joints = std::array::from_fn(|i| (wanted[i] - angles[i]) / step);
        stage.tick(&orders)?;
        let reached = stage.sight().limbs[limb].angles;
        let lag = (0..reached.len()).map(|i| (reached[i] - wanted[i]).abs());
        let most = match time >= end {
            true => following.in_the_end,
            false => following.under_way,
        };
        if lag.fold(0.0, f64::max) > most {
            stopped += 1;
            time = (time - step).max(0.0);
            if stopped > PATIENCE {
                return Err(blocked(stage.sight(), limb, object));
            }
        } else {
            stopped = 0;
            if time >= end {
                wait(stage, 1)?;
                return Ok(());
            }
        }
    }
}

fn blocked(sight: &Sight, limb: usize, object: &str) -> PlanFailure {
    let by = sight.limbs[limb].blocked_by.clone();
    PlanFailure::Blocked {
        object: object.to_owned(),
        by: by.unwrap_or_else(|| "something that is pushed".into()),
    }
}

fn at(schedule: &[(f64, Angles)], time: f64) -> Angles {
    let next = schedule
        .partition_point(|(then, _)| *then < time)
        .min(schedule.len() - 1);
    let (after, to) = schedule[next];
    let (before, from) = schedule[next.saturating_sub(1)];
    if after <= before {
        return to;
    }
    let part = (time - before) / (after - before);
    std::array::from_fn(|i| from[i] + (to[i] - from[i]) * part)
}

/// Opens or closes a gripper until it is at its opening, holds something, or is stopped.
pub(crate) fn grip(
    stage: &mut dyn PlanningStage,
    limb: usize,
    opening: f64,
) -> Result<(), Stopped> {
    let patience = stage.following().finger_patience;
    let mut still = 0;
    let mut orders = vec![LimbOrder::default(); stage.sight().limbs.len()];
    for _ in 0..FINGER_TICKS {
        let before = stage.sight().limbs[limb].opening;
        let left = opening - before;
        if left.abs() < 1e-4 {
            break;
        }
        orders[limb].opening = (left / f64::from(TICK_SECONDS)).clamp(-FINGER_SPEED, FINGER_SPEED);
        stage.tick(&orders)?;
        let after = &stage.sight().limbs[limb];
        if left < 0.0 && !after.holds.is_empty() {
            break;
        }
        still = if (after.opening - before).abs() < 1e-5 {
            still + 1
        } else {
            0
        };
        if still > patience {
            break;
        }
    }
    wait(stage, 1)
}
