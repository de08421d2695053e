//! Where every joint of the robot was at the end of every tick, how fast, and how hard its motor pulled.

use tabletop_core::{JointState, RobotJoint, SimTick};

/// The robot's joints, by [`RobotJoint::index`].
pub(crate) type Joints = [JointState; RobotJoint::ALL.len()];

/// The names of the columns.
pub(crate) fn header() -> Vec<String> {
    ["tick", "joint", "position", "velocity", "torque"]
        .map(str::to_owned)
        .into()
}

/// A row for each joint that differs in any bit from the tick before: position in rad, or units for a gripper, velocity per
/// s, torque in N m, with the digits that read back to the same bits.
pub(crate) fn rows(tick: SimTick, before: Option<&Joints>, now: &Joints) -> Vec<Vec<String>> {
    RobotJoint::ALL
        .into_iter()
        .filter(|joint| {
            let i = joint.index();
            before.is_none_or(|before| bits(before[i]) != bits(now[i]))
        })
        .map(|joint| {
            let numbers = numbers(now[joint.index()]).map(|number| format!("{number:?}"));
            [tick.0.to_string(), joint.name().to_owned()]
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
    fn joints_are_told_once_and_then_when_they_change() {
        let still = [JointState::default(); 17];
        let mut moved = still;
        moved[RobotJoint::LeftE1.index()].position = 0.1;
        assert_eq!(rows(SimTick(3), None, &still).len(), 17);
        assert!(rows(SimTick(4), Some(&still), &still).is_empty());
        assert_eq!(
            rows(SimTick(5), Some(&still), &moved),
            [["5", "left_e1", "0.1", "0.0", "0.0"].map(str::to_owned)]
        );
    }
}
