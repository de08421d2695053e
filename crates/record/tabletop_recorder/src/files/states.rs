//! The pose and the speed of every object at the end of every tick.

use tabletop_core::SimTick;
use tabletop_geometry::{Pose, Twist};

/// An object's state at the end of a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ObjectState {
    pub(crate) pose: Pose,
    pub(crate) twist: Twist,
}

impl ObjectState {
    /// True if two states are the same in every bit.
    pub(crate) fn is_same(self, other: Self) -> bool {
        self.numbers().map(f32::to_bits) == other.numbers().map(f32::to_bits)
    }

    fn numbers(self) -> [f32; 13] {
        let Self { pose, twist } = self;
        let [x, y, z] = pose.location.to_array();
        let [qx, qy, qz, qw] = pose.rotation.to_array();
        let [vx, vy, vz] = twist.linear.to_array();
        let [wx, wy, wz] = twist.angular.to_array();
        [x, y, z, qx, qy, qz, qw, vx, vy, vz, wx, wy, wz]
    }
}

/// The names of the columns.
pub(crate) fn header() -> Vec<String> {
    "tick,id,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz"
        .split(',')
        .map(str::to_owned)
        .collect()
}

/// A row: location in units, orientation as a unit quaternion, velocities in units/s and rad/s, with the digits that read
/// back to the same bits.
pub(crate) fn row(tick: SimTick, id: &str, state: ObjectState) -> Vec<String> {
    let numbers = state.numbers().map(|number| format!("{number:?}"));
    [tick.0.to_string(), id.to_owned()]
        .into_iter()
        .chain(numbers)
        .collect()
}

#[cfg(test)]
mod tests {
    use bevy::math::{Quat, Vec3};

    use super::*;

    #[test]
    fn a_row_has_a_value_for_each_column_and_reads_back() {
        let pose = Pose::new(
            Vec3::new(0.1, -1.234_567_9e-12, 16_777_216.0),
            Quat::from_rotation_z(0.3),
        );
        let twist = Twist {
            linear: Vec3::new(-1e-20, 3.0, 0.3),
            angular: Vec3::NEG_Z,
        };
        let row = row(SimTick(12), "it", ObjectState { pose, twist });
        assert_eq!(row.len(), header().len());
        assert_eq!(row[..2], ["12", "it"]);
        let numbers: Vec<f32> = row[2..].iter().map(|text| text.parse().unwrap()).collect();
        assert_eq!(
            numbers,
            [
                &pose.location.to_array()[..],
                &pose.rotation.to_array(),
                &twist.linear.to_array(),
                &twist.angular.to_array(),
            ]
            .concat()
        );
    }
}
