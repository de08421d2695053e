//! Where every object was at the end of every tick.

use tabletop_core::{Pose, SimTick};

/// The names of the columns.
pub(crate) fn header() -> Vec<String> {
    ["tick", "id", "x", "y", "z", "qx", "qy", "qz", "qw"]
        .map(str::to_owned)
        .to_vec()
}

/// A row: location in units and orientation as a unit quaternion, with the digits that read back to the same bits.
pub(crate) fn row(tick: SimTick, id: &str, pose: Pose) -> Vec<String> {
    let mut row = vec![tick.0.to_string(), id.to_owned()];
    let numbers = pose.location.to_array().into_iter();
    row.extend(
        numbers
            .chain(pose.rotation.to_array())
            .map(|number| format!("{number:?}")),
    );
    row
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
        let row = row(SimTick(12), "it", pose);
        assert_eq!(row.len(), header().len());
        assert_eq!(row[..2], ["12", "it"]);
        let numbers: Vec<f32> = row[2..].iter().map(|text| text.parse().unwrap()).collect();
        assert_eq!(
            numbers,
            [&pose.location.to_array()[..], &pose.rotation.to_array()[..]].concat()
        );
    }
}
