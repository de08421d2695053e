//! Cameras in the robot's hands, or elsewhere on its links, and their pictures.

use std::sync::Arc;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};
use tabletop_geometry::Pose;

use crate::{Picture, SimTick, picture::fault_of_view};

/// A camera that a link of the robot carries, as its hands do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HandCamera {
    /// Its name, which the files of its pictures have: lower-case letters, digits and `_`.
    pub name: String,
    /// The link that carries it, by its name in the URDF.
    pub link: String,
    /// Its pose in the link's frame, lengths in units: it looks along its own -Z, with its Y up.
    pub mount: Pose,
    /// Angle between the lower and upper edges of the picture in radians, above 0 and below π.
    pub vertical_fov: f32,
    /// Columns of the picture.
    pub width: u32,
    /// Rows of the picture.
    pub height: u32,
}

/// The hand cameras that the robot has, as its description says.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct HandCameras(pub Arc<[HandCamera]>);

/// The last pictures of hand cameras. They are taken at the end of a tick, with that of the head camera, for whoever
/// [asks](Self::ask).
#[derive(Resource, Clone, Debug, Default)]
pub struct HandImages {
    /// The cameras that are asked for pictures.
    asked: Option<Arc<[HandCamera]>>,
    /// Their poses; `None` for one whose link the robot lacks.
    pub poses: Vec<Option<Pose>>,
    /// The tick at whose end the pictures were taken.
    pub tick: SimTick,
    /// The pictures, in the order of the cameras; one without pose has no pixels.
    pub pictures: Vec<Picture>,
    /// The entities behind the numbers in [`Picture::objects`], as in [`SensorImage`](crate::SensorImage::shown).
    pub shown: Vec<Entity>,
}

impl HandCamera {
    /// Largest number of hand cameras.
    pub const MOST: usize = 8;
    /// Most letters of a name.
    const LONGEST_NAME: usize = 64;
    /// Suffixes of other files of a frame, after its number.
    const TAKEN: [&str; 3] = ["depth", "ids", "png"];

    /// The fault of settings that make no sense.
    pub fn fault(&self) -> Option<String> {
        let name = self.name.as_bytes();
        let is_name = (1..=Self::LONGEST_NAME).contains(&name.len())
            && name[0].is_ascii_lowercase()
            && (name.iter())
                .all(|it| it.is_ascii_lowercase() || it.is_ascii_digit() || *it == b'_')
            && !Self::TAKEN.contains(&self.name.as_str());
        if !is_name {
            return Some(format!(
                "{:?} is no name of a camera, expected a lower-case letter, then at most {} of these, digits and _; not {}",
                self.name,
                Self::LONGEST_NAME - 1,
                Self::TAKEN.join(", ")
            ));
        }
        let Pose { location, rotation } = self.mount;
        let is_somewhere = location.is_finite() && (rotation.length_squared() - 1.0).abs() < 0.01;
        let fault = match is_somewhere {
            true => fault_of_view(self.width, self.height, self.vertical_fov),
            false => Some("it is nowhere: a number is not finite, or its rotation is none".into()),
        };
        fault.map(|fault| format!("{}: {fault}", self.name))
    }

    /// The first fault of several cameras: too many, one with a fault, or two of one name.
    pub fn fault_of(cameras: &[Self]) -> Option<String> {
        if cameras.len() > Self::MOST {
            let found = cameras.len();
            return Some(format!("{found} cameras, expected at most {}", Self::MOST));
        }
        cameras.iter().enumerate().find_map(|(i, camera)| {
            let is_second = cameras[..i].iter().any(|other| other.name == camera.name);
            match is_second {
                true => Some(format!("there are two cameras {}", camera.name)),
                false => camera.fault(),
            }
        })
    }
}

impl HandImages {
    /// Asks these cameras for pictures of this tick. While the simulation stands still, the request waits, unless the head camera's picture
    /// is [insisted](crate::PictureDemand::insist) on.
    pub fn ask(&mut self, cameras: &Arc<[HandCamera]>) {
        self.asked = Some(Arc::clone(cameras));
    }

    /// The cameras that are asked for pictures.
    pub fn asked(&self) -> &[HandCamera] {
        self.asked.as_deref().unwrap_or_default()
    }

    /// Takes the request back.
    pub fn take(&mut self) -> Option<Arc<[HandCamera]>> {
        self.asked.take()
    }

    /// Run condition: a camera is asked for a picture.
    pub fn is_asked(images: Res<Self>) -> bool {
        images.asked.is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(name: &str) -> HandCamera {
        HandCamera {
            name: name.into(),
            link: "hand".into(),
            mount: Pose::IDENTITY,
            vertical_fov: 1.0,
            width: 200,
            height: 125,
        }
    }

    #[test]
    fn cameras_that_cannot_be_have_faults() {
        let [left, right] = ["left_hand_camera", "camera2"].map(camera);
        assert_eq!(HandCamera::fault_of(&[left.clone(), right.clone()]), None);
        for name in [
            "",
            "2",
            "Left",
            "a.b",
            "../a",
            "depth",
            "ids",
            "png",
            "_a",
            &"a".repeat(65),
        ] {
            let fault = camera(name).fault().unwrap();
            assert!(fault.contains("is no name of a camera"), "{fault}");
        }
        let wide = HandCamera {
            width: 10_000,
            ..left.clone()
        };
        let blind = HandCamera {
            vertical_fov: f32::NAN,
            ..left.clone()
        };
        let lost = HandCamera {
            mount: Pose::at(Vec3::NAN),
            ..left.clone()
        };
        for (cameras, expected) in [
            (vec![wide], "left_hand_camera: 10000x125 is no size"),
            (vec![blind], "left_hand_camera: an angle of view of NaN"),
            (vec![lost], "left_hand_camera: it is nowhere"),
            (
                vec![left.clone(), right, left.clone()],
                "there are two cameras left_hand_camera",
            ),
            (vec![left; 9], "9 cameras, expected at most 8"),
        ] {
            let fault = HandCamera::fault_of(&cameras).unwrap();
            assert!(fault.contains(expected), "{fault}");
        }
    }
}
