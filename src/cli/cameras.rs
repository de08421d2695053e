//! Cameras as options: `head`, `left_hand`, `above=0,-8,12` or `above=0,-8,12,0,0,1`.

use crate::{
    camera::{CameraPlace, CameraSpec},
    geometry::Pose,
};
use bevy::math::Vec3;

use super::range::NumberRange;

/// Coordinates of cameras, in units.
pub(super) const COORDINATES: NumberRange<f32> = NumberRange::decimal(-1000.0, 1000.0);
/// Angles of view from top to bottom.
pub(super) const ANGLES_OF_VIEW: NumberRange<f32> = NumberRange::decimal(1.0, 179.0).of("degrees");

/// Cameras, separated by commas.
#[derive(Clone, Debug)]
pub(super) struct Cameras(pub Vec<CameraSpec>);

/// Reads cameras.
pub(super) fn cameras(text: &str) -> Result<Cameras, String> {
    let mut cameras: Vec<CameraSpec> = Vec::new();
    let mut words = text.split(',').map(str::trim).peekable();
    while let Some(word) = words.next() {
        let camera = match word.split_once('=') {
            None => robots(word),
            Some((name, x)) => {
                let mut numbers = vec![COORDINATES.read(x)?];
                while let Some(word) = words.next_if(|word| word.parse::<f32>().is_ok()) {
                    numbers.push(COORDINATES.read(word)?);
                }
                standing(name, &numbers)?
            }
        };
        if !is_name(&camera.name) {
            return Err(format!(
                "{:?} is no name of a camera, expected a lower-case letter, then letters, digits and _",
                camera.name
            ));
        }
        if cameras.iter().any(|other| other.name == camera.name) {
            return Err(format!("there are two cameras {}", camera.name));
        }
        cameras.push(camera);
    }
    Ok(Cameras(cameras))
}

/// Reads cameras, which may be `none`.
pub(super) fn any_cameras(text: &str) -> Result<Cameras, String> {
    match text.trim() {
        "none" => Ok(Cameras(Vec::new())),
        text => cameras(text),
    }
}

/// Reads a camera as the options of the command line name it: `head`, `left_hand`, `above=0,-8,12` or `above=0,-8,12,0,0,1`.
///
/// # Errors
/// The text names no camera; the error says what was expected.
pub fn camera(text: &str) -> Result<CameraSpec, String> {
    let Cameras(mut cameras) = cameras(text)?;
    match (cameras.pop(), cameras.len()) {
        (Some(camera), 0) => Ok(camera),
        _ => Err("expected one camera".into()),
    }
}

fn is_name(name: &str) -> bool {
    let mut letters = name.chars();
    letters
        .next()
        .is_some_and(|first| first.is_ascii_lowercase())
        && letters.all(|it| it.is_ascii_lowercase() || it.is_ascii_digit() || it == '_')
}

/// A camera of the robot.
fn robots(name: &str) -> CameraSpec {
    CameraSpec {
        name: name.into(),
        viewpoint: match name {
            "head" => CameraPlace::Head,
            hand => CameraPlace::Hand(hand.into()),
        },
        size: None,
        vertical_fov: None,
    }
}

/// A camera that stands somewhere and looks at the centre of the table, or at a point.
fn standing(name: &str, numbers: &[f32]) -> Result<CameraSpec, String> {
    let (from, at) = match *numbers {
        [x, y, z] => (Vec3::new(x, y, z), Vec3::ZERO),
        [x, y, z, to_x, to_y, to_z] => (Vec3::new(x, y, z), Vec3::new(to_x, to_y, to_z)),
        _ => {
            return Err(format!(
                "camera {name}: expected x,y,z or x,y,z and the point that it looks at, found {} numbers",
                numbers.len()
            ));
        }
    };
    if from == at {
        return Err(format!("camera {name} looks at the point where it is"));
    }
    Ok(CameraSpec {
        viewpoint: CameraPlace::Standing(Pose::looking_at(from, at)),
        ..robots(name)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cameras_are_of_the_robot_or_stand_somewhere() {
        let Cameras(found) = cameras("head,left_hand, above=0,-8,12.5,0,0,1,side=9,0,3").unwrap();
        let names: Vec<_> = found.iter().map(|camera| camera.name.as_str()).collect();
        assert_eq!(names, ["head", "left_hand", "above", "side"]);
        assert_eq!(found[0].viewpoint, CameraPlace::Head);
        assert_eq!(found[1].viewpoint, CameraPlace::Hand("left_hand".into()));
        let CameraPlace::Standing(pose) = found[2].viewpoint else {
            panic!("{:?}", found[2]);
        };
        assert_eq!(pose.location, Vec3::new(0.0, -8.0, 12.5));
        for fault in [
            "",
            "head,head",
            "a=1,2",
            "a=1,2,3,4",
            "a=0,0,0",
            "a=1,2,5000",
            "Up=1,2,3",
            "a=1,x,3",
            "=1,2,3",
        ] {
            assert!(cameras(fault).is_err(), "{fault}");
        }
        assert!(camera("head,left_hand").is_err());
    }
}
