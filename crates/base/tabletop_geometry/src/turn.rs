//! Rotations that are the same on every processor. Those of glam use sine and cosine of the C library, which chooses its algorithm by the
//! processor: with 64 bits the last bit may differ, with 32 bits only beyond 16 rad.

use bevy::math::{DQuat, Quat, Vec3};

/// The rotation about an axis of length 1 by any angle in radians.
pub fn turn_about(axis: Vec3, angle: f32) -> Quat {
    let (sin, cos) = libm::sincosf(angle / 2.0);
    let Vec3 { x, y, z } = axis * sin;
    Quat::from_xyzw(x, y, z, cos)
}

/// The rotation about X by an angle in radians.
pub fn turn_about_x(angle: f64) -> DQuat {
    let (sin, cos) = libm::sincos(angle / 2.0);
    DQuat::from_xyzw(sin, 0.0, 0.0, cos)
}

/// The rotation about Y by an angle in radians.
pub fn turn_about_y(angle: f64) -> DQuat {
    let (sin, cos) = libm::sincos(angle / 2.0);
    DQuat::from_xyzw(0.0, sin, 0.0, cos)
}

/// The rotation about Z by an angle in radians.
pub fn turn_about_z(angle: f64) -> DQuat {
    let (sin, cos) = libm::sincos(angle / 2.0);
    DQuat::from_xyzw(0.0, 0.0, sin, cos)
}

#[cfg(test)]
mod tests {
    use bevy::math::DVec3;

    use super::*;

    #[test]
    fn many_turns_end_where_their_rest_does() {
        let axis = Vec3::new(0.6, 0.0, 0.8);
        let [many, rest] = [std::f32::consts::TAU * 20.0 + 0.3, 0.3].map(|a| turn_about(axis, a));
        assert!(many.angle_between(rest) < 1e-3, "{many} is not {rest}");
    }

    #[test]
    fn a_quarter_turn_takes_an_axis_to_the_next() {
        let quarter = std::f64::consts::FRAC_PI_2;
        for (turn, from, to) in [
            (turn_about_x(quarter), DVec3::Y, DVec3::Z),
            (turn_about_y(quarter), DVec3::Z, DVec3::X),
            (turn_about_z(quarter), DVec3::X, DVec3::Y),
        ] {
            assert!((turn * from).distance(to) < 1e-15, "{turn}");
        }
    }
}
