//! What the grippers are sent.

use std::{collections::BTreeMap, time::Duration};

use super::state::StopReason;
use crate::{
    orders::{GripperMotion, RobotOrder},
    state::{GripperReading, RobotState},
    target::RobotTarget,
    tolerances::{OLDEST_REPORT, REPETITION},
};

/// The least change of an opening, from 0 to 1, and the least time between two, that a gripper is sent.
const STEP: f64 = 0.01;
const PERIOD: Duration = Duration::from_millis(50);

/// What the grippers were sent last, by the places of their limbs.
#[derive(Debug, Default)]
pub(super) struct GripperOrders(BTreeMap<usize, SentOpening>);

/// What a gripper was sent.
#[derive(Clone, Copy, Debug)]
struct SentOpening {
    opening: f64,
    sequence: u32,
    at: Duration,
}

impl GripperOrders {
    /// The order that brings the gripper of a limb to an opening, if it needs one now.
    pub fn order(
        &mut self,
        now: Duration,
        limb: usize,
        reading: &GripperReading,
        opening: f64,
    ) -> Option<RobotOrder> {
        let opening = opening.clamp(0.0, 1.0);
        let heard = reading.sequence.unwrap_or_default();
        let sequence = match self.0.get(&limb) {
            Some(last) if (last.opening - opening).abs() < STEP => {
                let is_unheard = reading.sequence != Some(last.sequence);
                (is_unheard && now.saturating_sub(last.at) >= REPETITION).then_some(last.sequence)
            }
            Some(last) => {
                let is_due = now.saturating_sub(last.at) >= PERIOD;
                is_due.then(|| last.sequence.max(heard).wrapping_add(1))
            }
            None => Some(heard.wrapping_add(1)),
        }?;
        self.0.insert(
            limb,
            SentOpening {
                opening,
                sequence,
                at: now,
            },
        );
        Some(RobotOrder::MoveGripper {
            limb,
            id: reading.id,
            motion: GripperMotion::Open(opening),
            sequence,
        })
    }
}

/// Why a gripper that is to move cannot.
pub(super) fn fault(now: Duration, state: &RobotState, target: &RobotTarget) -> Option<StopReason> {
    target.grippers.keys().find_map(|limb| {
        let reading = state.grippers.get(limb)?;
        let age = reading.age(now);
        let limb = limb.clone();
        match (reading.has_error, age > OLDEST_REPORT) {
            (true, _) => Some(StopReason::GripperError { limb }),
            (false, true) => Some(StopReason::SilentGripper { limb, age }),
            (false, false) => None,
        }
    })
}
