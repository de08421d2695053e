//! Tipping: an object comes to lie on another of its sides.

use std::f32::consts::FRAC_PI_4;

use bevy::math::Vec3;
use serde::{Deserialize, Serialize};
use tabletop_core::Shape;
use tabletop_geometry::{PlacedSolid, Pose};

use crate::symmetry::{Symmetry, Turns};

/// The way in which an object comes to lie on another of its sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tipping {
    /// Something long lay, and stands.
    StoodUp,
    /// Something long stood, and lies.
    LaidDown,
    /// Its top is below.
    TurnedOver,
    /// It lies on another side.
    OntoAnotherSide,
}

/// How much longer something long is than it is wide.
const LONG: f32 = 1.3;

impl Tipping {
    /// How an object of this shape is tipped from one pose to another; `None` if what is above still is, or looks the same.
    pub(crate) fn of(shape: &Shape, from: Pose, to: Pose) -> Option<Self> {
        let above = |pose: Pose| pose.rotation.inverse() * Vec3::Z;
        let was_above = above(from);
        let symmetry = Symmetry::of(shape);
        if matches!(symmetry.turns, Turns::Any) {
            // A ball has no sides.
            return None;
        }
        let alike = symmetry.variants(to);
        if alike
            .iter()
            .any(|pose| above(*pose).angle_between(was_above) < FRAC_PI_4)
        {
            return None;
        }
        let stands = |axis: Vec3, pose: Pose| (pose.rotation * axis).z.abs() > 0.7;
        let has_turned_over = alike.iter().any(|pose| above(*pose).dot(was_above) < -0.7);
        Some(match long_axis(shape) {
            Some(axis) if stands(axis, to) && !stands(axis, from) => Self::StoodUp,
            Some(axis) if stands(axis, from) && !stands(axis, to) => Self::LaidDown,
            _ if has_turned_over => Self::TurnedOver,
            _ => Self::OntoAnotherSide,
        })
    }
}

/// The axis along which a shape is longest, if it is long.
fn long_axis(shape: &Shape) -> Option<Vec3> {
    let solids: Vec<_> = shape
        .drawn()
        .iter()
        .map(|solid| PlacedSolid::of(solid, Pose::IDENTITY))
        .collect();
    let length = |axis: Vec3| {
        let [low, high] = PlacedSolid::extent(&solids, axis);
        high - low
    };
    let mut axes = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| (length(axis), axis));
    axes.sort_by(|a, b| b.0.total_cmp(&a.0));
    let [(longest, axis), (second, _), _] = axes;
    (longest > LONG * second).then_some(axis)
}

#[cfg(test)]
mod tests {
    use tabletop_geometry::Rgb;

    use super::*;

    fn tipped(shape: &Shape, degrees: Vec3) -> Option<Tipping> {
        Tipping::of(shape, Pose::IDENTITY, Pose::from_degrees(Vec3::X, degrees))
    }

    #[test]
    fn long_objects_stand_or_lie() {
        let color = Rgb::RED;
        let bar = Shape::Block {
            span: Vec3::new(3.0, 1.0, 1.0),
            color,
        };
        let can = Shape::Cylinder {
            radius: 0.5,
            yspan: 2.0,
            color,
        };
        let stands = Pose::from_degrees(Vec3::ZERO, Vec3::X * 90.0);
        assert_eq!(tipped(&bar, Vec3::Y * 90.0), Some(Tipping::StoodUp));
        assert_eq!(tipped(&bar, Vec3::X * 90.0), None);
        assert_eq!(tipped(&bar, Vec3::Z * 90.0), None);
        assert_eq!(
            Tipping::of(&can, stands, Pose::IDENTITY),
            Some(Tipping::LaidDown)
        );
        assert_eq!(tipped(&can, Vec3::X * 90.0), Some(Tipping::StoodUp));
    }

    #[test]
    fn a_box_shows_where_its_top_is() {
        let container = Shape::Box {
            span: Vec3::new(1.5, 1.2, 1.0),
            thickness: 0.1,
            color: Rgb::RED,
        };
        let cube = Shape::Block {
            span: Vec3::ONE,
            color: Rgb::RED,
        };
        let ball = Shape::Sphere {
            radius: 0.5,
            color: Rgb::RED,
        };
        for (degrees, expected) in [
            (Vec3::X * 180.0, Some(Tipping::TurnedOver)),
            (Vec3::Y * 90.0, Some(Tipping::OntoAnotherSide)),
            (Vec3::Z * 90.0, None),
            (Vec3::X * 10.0, None),
        ] {
            assert_eq!(tipped(&container, degrees), expected, "{degrees}");
            assert_eq!(tipped(&cube, degrees), None, "{degrees}");
            assert_eq!(tipped(&ball, degrees), None, "{degrees}");
        }
    }
}
