//! Poses in a dump.

use serde::Serialize;
use tabletop_geometry::Pose;

/// Location in units, rotation in degrees.
#[derive(Serialize)]
pub(super) struct PoseDump {
    location: [f32; 3],
    rotation: [f32; 3],
}

impl From<Pose> for PoseDump {
    fn from(pose: Pose) -> Self {
        Self {
            location: pose.location.to_array(),
            rotation: pose.degrees().to_array(),
        }
    }
}
