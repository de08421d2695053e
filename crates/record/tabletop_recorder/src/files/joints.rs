//! The position, speed and torque of every joint of the robot at the end of every tick.

use tabletop_core::{JointState, RobotLayout, SimTick};

/// The names of the columns.
pub(crate) fn header() -> Vec<String> {
    ["tick", "joint", "position", "velocity", "torque"]
        .map(str::to_owned)
        .into()
}

/// A row for each joint that differs in any bit from the tick before: position in rad, or units for a gripper, velocity per
/// s, torque in N m, with the digits that read back to the same bits.
pub(crate) fn rows(
    tick: SimTick,
    layout: &RobotLayout,
    before: Option<&[JointState]>,
    now: &[JointState],
) -> Vec<Vec<String>> {
    layout
        .joints
        .iter()
        .zip(now)
        .enumerate()
        .filter(|(i, (_, now))| {
            let before = before.and_then(|before| before.get(*i));
            before.is_none_or(|before| bits(*before) != bits(**now))
        })
        .map(|(_, (joint, now))| {
            let numbers = numbers(*now).map(|number| format!("{number:?}"));
            [tick.0.to_string(), joint.name.to_string()]
                .into_iter()
                .chain(numbers)
                .collect()
        })
        .collect()
}

const fn numbers(state: JointState) -> [f64; 3] {
    [state.position, state.velocity, state.torque]
}

fn bits(state: JointState) -> [u64; 3] {
    numbers(state).map(f64::to_bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joints_are_reported_once_and_then_when_they_change() {
        let baxter = RobotLayout::baxter();
        let rows = |tick, before: Option<&[JointState]>, now: &[JointState]| {
            rows(tick, baxter, before, now)
        };
        let still = [JointState::default(); 17];
        let mut moved = still;
        moved[3].position = 0.1;
        assert_eq!(rows(SimTick(3), None, &still).len(), 17);
        assert!(rows(SimTick(4), Some(&still), &still).is_empty());
        assert_eq!(
            rows(SimTick(5), Some(&still), &moved),
            [["5", "left_e1", "0.1", "0.0", "0.0"].map(str::to_owned)]
        );
    }
}
