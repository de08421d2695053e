//! Headings of objects, as a network gives them.

use bevy::math::Quat;
use tabletop_geometry::Pose;
use tabletop_task::{Symmetry, Turns};

use crate::label::Heading;

/// The largest part across of the axis of a turn that is about the vertical.
const UPRIGHT: f32 = 0.02;

/// The heading of an object with this symmetry.
pub(crate) fn heading(symmetry: &Symmetry, pose: Pose) -> Heading {
    let yaw_of = |rotation: Quat| 2.0 * libm::atan2f(rotation.z, rotation.w);
    let yaws: Vec<f32> = match &symmetry.turns {
        Turns::Finite(turns) => {
            let alike = turns.iter().map(|turn| pose.rotation * *turn);
            let is_upright = |rotation: &Quat| {
                let turn = *rotation * pose.rotation.inverse();
                turn.x.abs().max(turn.y.abs()) < UPRIGHT
            };
            alike.filter(is_upright).map(yaw_of).collect()
        }
        Turns::About { axis, ends_alike } => {
            let axis = pose.rotation * *axis;
            let is_upright = axis.truncate().length() < UPRIGHT;
            let ends = [axis, -axis];
            let ends = match (is_upright, ends_alike) {
                (true, _) => &ends[..0],
                (false, false) => &ends[..1],
                (false, true) => &ends[..],
            };
            ends.iter().map(|end| libm::atan2f(end.y, end.x)).collect()
        }
        Turns::Any => Vec::new(),
    };
    Heading::of(&yaws)
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;
    use tabletop_core::Shape;
    use tabletop_geometry::Rgb;

    use super::*;
    use crate::label::Yaw;

    fn yaw(span: Vec3, degrees: Vec3) -> Option<Yaw> {
        let color = Rgb::RED;
        let symmetry = Symmetry::of(&Shape::Block { span, color });
        heading(&symmetry, Pose::from_degrees(Vec3::ZERO, degrees)).yaw()
    }

    #[test]
    fn a_heading_has_the_fold_of_the_object_as_it_stands() {
        let brick = Vec3::new(2.0, 1.0, 1.0);
        for (span, turn, fold) in [
            (Vec3::ONE, Vec3::ZERO, 4),
            (Vec3::ONE, Vec3::X * 90.0, 4),
            (brick, Vec3::ZERO, 2),
            (brick, Vec3::Y * 90.0, 4),
        ] {
            let found = yaw(span, turn + Vec3::Z * 20.0).unwrap();
            assert_eq!(found.fold, fold, "{span} {turn}");
            let period = std::f32::consts::TAU / fold as f32;
            let rest = (found.angle - 20_f32.to_radians()).rem_euclid(period / 2.0);
            assert!(
                rest.min(period / 2.0 - rest) < 1e-3,
                "{span} {turn}: {found:?}"
            );
        }
        let color = Rgb::RED;
        let ball = Symmetry::of(&Shape::Sphere { radius: 1.0, color });
        assert_eq!(heading(&ball, Pose::IDENTITY).yaw(), None);
    }
}
