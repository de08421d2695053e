//! The mount of the head camera.

use std::f64::consts::FRAC_PI_2;
use tabletop_geometry::{Pose, turn_about_x, turn_about_z};

use crate::{CameraCarrier, HeadCamera, Table};

impl HeadCamera {
    /// Its pose before this table. The camera looks along its own -Z with its Y up.
    pub fn pose(&self, table: &Table) -> Pose {
        self.mount
            .unwrap_or_else(|| head_pose(&self.carrier, self.pan, table))
    }
}

/// The pose of the head camera when the neck is turned by `pan` radians, positive to the robot's left. The robot stands
/// before the middle of the table's near edge and looks along Y; the camera looks along its own -Z with its Y up.
///
/// At a table of `yspan` 12 it is (0, -7.1168, 11.5921), looking along (0, 0.5584, -0.8296), as in the original program.
fn head_pose(carrier: &CameraCarrier, pan: f32, table: &Table) -> Pose {
    let CameraCarrier { base, camera } = carrier;
    let turned = turn_about_z(f64::from(pan)).as_quat();
    let tilted = turn_about_x(FRAC_PI_2 - camera.tilt).as_quat();
    Pose::new(base.pose(table).location + camera.neck, turned) * Pose::new(camera.at, tilted)
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;

    use super::*;

    #[test]
    fn it_is_where_the_original_program_has_it() {
        for (pan, location, direction) in [
            (
                0.0,
                Vec3::new(0.0, -7.1168, 11.5921),
                Vec3::new(0.0, 0.5584, -0.8296),
            ),
            (
                0.5,
                Vec3::new(-0.61553, -7.27397, 11.5921),
                Vec3::new(-0.26733, 0.49027, -0.82956),
            ),
        ] {
            let pose = head_pose(&CameraCarrier::default(), pan, &Table::default());
            assert!(
                (pose.location - location).length() < 1e-4,
                "{}",
                pose.location
            );
            let looks_along = pose.rotation * Vec3::NEG_Z;
            assert!((looks_along - direction).length() < 6e-4, "{looks_along}");
            assert!((pose.rotation * Vec3::X).z.abs() < 1e-6, "it is not level");
        }
    }

    #[test]
    fn it_keeps_its_distance_from_a_table_of_another_size() {
        let wide = Table {
            xspan: 8.0,
            yspan: 20.0,
        };
        let moved = head_pose(&CameraCarrier::default(), 0.0, &wide).location
            - head_pose(&CameraCarrier::default(), 0.0, &Table::default()).location;
        assert!((moved - Vec3::new(0.0, -4.0, 0.0)).length() < 1e-5);
    }
}
