//! Decisions and cameras as numbers of the wire (`docs/policies.md`).

use bevy::math::{Quat, Vec3};
use tabletop_camera::Camera;
use tabletop_core::Light;
use tabletop_geometry::Pose;
use tabletop_wire::{Dtype, MappedActions, WireMap, WireValue};

use crate::{
    label::Yaw,
    policy::{Decision, ObjectPlace},
};

/// The names of the numbers of a decision.
const NAMES: [&str; MappedActions::OF_PLACES] = [
    "pick_x",
    "pick_y",
    "pick_z",
    "pick_yaw",
    "pick_fold",
    "place_x",
    "place_y",
    "place_z",
    "place_yaw",
    "place_fold",
    "done",
];

/// What a server says of actions that are decisions.
pub(crate) fn action_metadata() -> WireMap {
    let shape = [1, NAMES.len() as i64].map(WireValue::Integer).to_vec();
    let names = NAMES.map(WireValue::from).to_vec();
    let parts = [
        ("shape", WireValue::List(shape)),
        ("dtype", Dtype::F32.name().into()),
        ("names", WireValue::List(names)),
    ];
    WireMap::from(parts.map(|(key, value)| (key.to_owned(), value)))
}

/// Numbers of a camera.
pub(crate) const OF_CAMERA: usize = 9;

/// How far the length of a rotation may be from 1.
const LENGTH_TOLERANCE: f32 = 0.01;

/// A decision as numbers.
pub(crate) fn numbers_of(decision: &Decision) -> [f32; MappedActions::OF_PLACES] {
    let Decision::Move { pick, place } = decision else {
        let mut done = [0.0; MappedActions::OF_PLACES];
        done[MappedActions::OF_PLACES - 1] = 1.0;
        return done;
    };
    let five = |it: &ObjectPlace| {
        let [x, y, z] = it.location.to_array();
        let yaw = it.yaw.unwrap_or(Yaw {
            angle: 0.0,
            fold: 0,
        });
        [x, y, z, yaw.angle, yaw.fold as f32]
    };
    let ([a, b, c, d, e], [f, g, h, i, j]) = (five(pick), five(place));
    [a, b, c, d, e, f, g, h, i, j, 0.0]
}

/// The decision that numbers are, each finite.
pub(crate) fn decision_of(numbers: &[f64]) -> Decision {
    let place = |first: usize| {
        let number = |i: usize| numbers.get(first + i).copied().unwrap_or_default() as f32;
        let fold = number(4).round();
        ObjectPlace {
            location: Vec3::new(number(0), number(1), number(2)),
            yaw: (fold >= 1.0).then(|| Yaw {
                angle: number(3),
                fold: fold as usize,
            }),
        }
    };
    match numbers.last().is_some_and(|done| *done >= 0.5) {
        true => Decision::Done,
        false => Decision::Move {
            pick: place(0),
            place: place(5),
        },
    }
}

/// A camera as numbers; the size of its pictures is that of the picture.
pub(crate) fn camera_numbers(camera: &Camera) -> [f32; OF_CAMERA] {
    let [x, y, z] = camera.pose.location.to_array();
    let [i, j, k, w] = camera.pose.rotation.to_array();
    let is_square = f32::from(u8::from(camera.square_fov));
    [x, y, z, i, j, k, w, camera.vertical_fov, is_square]
}

/// The camera that numbers are, with pictures of this size; an error says what makes no sense.
pub(crate) fn camera_of(numbers: &[f64], [width, height]: [u32; 2]) -> Result<Camera, String> {
    let numbers: Vec<f32> = numbers.iter().map(|number| *number as f32).collect();
    let [x, y, z, i, j, k, w, vertical_fov, is_square] = numbers[..] else {
        return Err(format!("{} numbers, expected {OF_CAMERA}", numbers.len()));
    };
    let rotation = Quat::from_xyzw(i, j, k, w);
    if numbers.iter().any(|number| !number.is_finite()) {
        return Err("a number is not finite".into());
    }
    if (rotation.length() - 1.0).abs() > LENGTH_TOLERANCE {
        return Err(format!(
            "the length of its rotation is {}, expected 1",
            rotation.length()
        ));
    }
    Ok(Camera {
        pose: Pose::new(Vec3::new(x, y, z), rotation),
        vertical_fov,
        square_fov: is_square >= 0.5,
        width,
        height,
        antialiasing: true,
        light: Light::default(),
    })
}

#[cfg(test)]
mod tests {
    use tabletop_core::{HeadCamera, Table};

    use super::*;

    fn back(decision: &Decision) -> Decision {
        decision_of(&numbers_of(decision).map(f64::from))
    }

    #[test]
    fn decisions_come_back_to_the_bit() {
        let place = |x: f32, yaw| ObjectPlace {
            location: Vec3::new(x, 1.0 / 3.0, -0.1),
            yaw,
        };
        let decision = Decision::Move {
            pick: place(
                0.1,
                Some(Yaw {
                    angle: -0.7,
                    fold: 4,
                }),
            ),
            place: place(-7.3, None),
        };
        assert_eq!(back(&decision), decision);
        assert_eq!(back(&Decision::Done), Decision::Done);
    }

    #[test]
    fn cameras_come_back_to_the_bit() {
        let camera = Camera::of_head(&HeadCamera::default(), &Table::default());
        let numbers = camera_numbers(&camera).map(f64::from);
        let size = [camera.width, camera.height];
        assert_eq!(camera_of(&numbers, size), Ok(camera));
        for (place, number, fault) in [
            (0, f64::NAN, "a number is not finite"),
            (6, 3.0, "the length of its rotation"),
        ] {
            let mut wrong = numbers;
            wrong[place] = number;
            let refusal = camera_of(&wrong, size).unwrap_err();
            assert!(refusal.starts_with(fault), "{refusal}");
        }
        assert_eq!(camera_of(&[], size).unwrap_err(), "0 numbers, expected 9");
    }
}
