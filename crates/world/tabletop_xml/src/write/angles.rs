//! Rotations as angles that read back exactly.

use bevy::math::{DMat3, DQuat, DVec3, Quat};
use tabletop_geometry::{quat_from_degrees, turn_about_x, turn_about_y};

/// Number of neighbouring numbers of a rotation's component that are tried.
const NEIGHBOURS: i32 = 2;

/// The angles in degrees, with as few digits as possible, for which [`quat_from_degrees`] gives this rotation. If there are none
/// to the bit, because the rotation's length is not 1 to the bit, the nearest rotation that has some is used. Of 330,000
/// rotations that are the angles of a file, one was not found, and was off by the last bit of its smallest component.
pub(crate) fn angles_of(rotation: Quat) -> DVec3 {
    let all_digits = units_that_round_to_neighbours(rotation)
        .map(euler_angles)
        .find(|&angles| quat_from_degrees(angles) == rotation)
        .unwrap_or_else(|| euler_angles(rotation.as_dquat().normalize()));
    let said = quat_from_degrees(all_digits);
    (0..16)
        .map(|digits| rounded(all_digits, digits))
        .find(|&angles| quat_from_degrees(angles) == said)
        .unwrap_or(all_digits)
}

/// The angles in degrees about X, then Y, then Z, that give this rotation and not its negative.
fn euler_angles(rotation: DQuat) -> DVec3 {
    let m = DMat3::from_quat(rotation);
    let cos_y = libm::hypot(m.x_axis.x, m.x_axis.y);
    let x = match cos_y > 1e-9 {
        true => libm::atan2(m.y_axis.z, m.z_axis.z).to_degrees(),
        false => 0.0,
    };
    let y = libm::atan2(-m.x_axis.z, cos_y).to_degrees();
    // The remaining rotation, so that it makes up for the rounding of the others where they nearly coincide.
    let about_z =
        rotation * (turn_about_y(y.to_radians()) * turn_about_x(x.to_radians())).inverse();
    let z = (2.0 * libm::atan2(about_z.z, about_z.w)).to_degrees();
    DVec3::new(x, y, z)
}

/// Rotations of length 1 that round to this one, or to one beside it: [`quat_from_degrees`] rounds before it corrects the length.
fn units_that_round_to_neighbours(rotation: Quat) -> impl Iterator<Item = DQuat> {
    let steps = || (0..=2 * NEIGHBOURS).map(|step| (step + 1) / 2 * (1 - step % 2 * 2));
    let [x, y, z, w] = rotation.to_array();
    steps().flat_map(move |i| {
        steps().flat_map(move |j| {
            steps().flat_map(move |k| {
                steps().filter_map(move |l| {
                    unit_that_rounds_to([beside(x, i), beside(y, j), beside(z, k), beside(w, l)])
                })
            })
        })
    })
}

/// The number this many steps away from this one; 0 has no neighbours that a rotation would have.
fn beside(number: f32, steps: i32) -> f32 {
    match number == 0.0 {
        true => number,
        false => f32::from_bits(number.to_bits().wrapping_add_signed(steps)),
    }
}

/// A vector of length 1 that rounds to this one.
fn unit_that_rounds_to(rounded: [f32; 4]) -> Option<DQuat> {
    let center = rounded.map(f64::from);
    // To the corner, farthest from 0, of the numbers that round to it.
    let outward = rounded
        .map(|part| f64::from(beside(part, 1)) - f64::from(part))
        .map(|gap| gap / 2.0);
    let dot = |a: [f64; 4], b: [f64; 4]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let along = (1.0 - dot(center, center)) / (2.0 * dot(center, outward));
    (along.abs() < 1.0).then(|| {
        let unit: [f64; 4] = std::array::from_fn(|i| center[i] + along * outward[i]);
        DQuat::from_array(unit).normalize()
    })
}

fn rounded(angles: DVec3, digits: i32) -> DVec3 {
    let unit = 10.0_f64.powi(digits);
    (angles * unit).round() / unit + DVec3::ZERO
}

#[cfg(test)]
mod tests {
    use bevy::math::{Vec3, Vec4};
    use proptest::prelude::*;

    use super::*;

    fn deviation(rotation: Quat) -> f32 {
        let read = quat_from_degrees(angles_of(rotation));
        (Vec4::from(read) - Vec4::from(rotation))
            .abs()
            .max_element()
    }

    #[test]
    fn angles_of_files_are_written_as_they_were() {
        for angles in [
            [0.0, 0.0, 45.0],
            [0.0, 0.0, -170.0],
            [29.7, -12.25, 0.1],
            [0.0, 0.0, 270.0],
            [180.0, 0.0, 0.0],
            [0.0, 90.0, 30.0],
        ] {
            let angles = DVec3::from(angles);
            assert_eq!(angles_of(quat_from_degrees(angles)), angles);
        }
    }

    #[test]
    fn a_rotation_and_its_negative_are_distinguished() {
        let rotation = quat_from_degrees(Vec3::new(10.0, 20.0, 30.0));
        assert_eq!(quat_from_degrees(angles_of(rotation)), rotation);
        assert_eq!(quat_from_degrees(angles_of(-rotation)), -rotation);
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn rotations_given_in_degrees_read_back_to_the_bit(
            x in -400.0..400.0_f64, y in -400.0..400.0_f64, z in -400.0..400.0_f64
        ) {
            for angles in [[x, y, z], [x, 90.0, z], [x, -90.0 + y * 1e-7, z], [0.0, 0.0, z]] {
                let rotation = quat_from_degrees(DVec3::from(angles));
                prop_assert_eq!(quat_from_degrees(angles_of(rotation)), rotation);
            }
        }

        #[test]
        fn any_rotation_reads_back_to_the_last_digits_and_then_for_good(
            parts in prop::array::uniform4(-1.0..1.0_f32)
        ) {
            let rotation = Quat::from_array(parts).normalize();
            prop_assume!(rotation.is_normalized());
            prop_assert!(deviation(rotation) <= 2e-7, "{}", deviation(rotation));
            let read = quat_from_degrees(angles_of(rotation));
            prop_assert_eq!(deviation(read), 0.0);
        }
    }
}
