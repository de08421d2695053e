//! Boxes.

use bevy::math::Vec3;
use serde::Deserialize;
use tabletop_geometry::quat_from_degrees;

use super::{axis::LinkAxis, detail::Detail, extrusion::Extrusion, hull::Hull};

/// A cuboid. Lengths in m.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Cuboid {
    pub center: Vec3,
    /// Its extents along its own axes.
    pub size: Vec3,
    /// Degrees by which it is turned about the fixed x, then y, then z axis.
    #[serde(default)]
    pub rotation: Vec3,
}

impl Cuboid {
    /// Its surface.
    pub fn hull(&self) -> Hull {
        let half = self.size / 2.0;
        let plate = Extrusion {
            axis: LinkAxis::Z,
            from: -half.z,
            to: half.z,
            outline: [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|(u, v)| [u * half.x, v * half.y])
                .to_vec(),
        };
        let rotation = quat_from_degrees(self.rotation);
        plate
            .hull(Detail::Fine)
            .mapped(|point| rotation * point + self.center)
    }
}
