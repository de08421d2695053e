//! The parts of a mapping.

use serde::Deserialize;

use super::columns::{ActionColumn, StateColumn};
use crate::fit::{PictureFit, PixelLayout};

/// What a policy sees of the robot and its table, and what its actions do.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PolicyMapping {
    /// The name of the robot that it is made for; none for any.
    #[serde(default)]
    pub robot: Option<String>,
    /// The pictures.
    #[serde(default)]
    pub images: Vec<MappedImage>,
    /// The arrays of numbers.
    #[serde(default)]
    pub states: Vec<MappedState>,
    /// The key of the task in words; none if it is not told.
    #[serde(default)]
    pub prompt: Option<String>,
    /// The key of a text with all objects, as they were at first, and where they are now; none if they are not told.
    #[serde(default)]
    pub objects: Option<String>,
    /// The actions.
    pub actions: MappedActions,
}

/// A picture of an observation, `uint8`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MappedImage {
    /// Its key.
    pub key: String,
    /// Its camera.
    pub camera: MappedCamera,
    /// Columns and rows; none for the head camera's own.
    #[serde(default)]
    pub size: Option<(u32, u32)>,
    /// Columns to rows of what the camera shows, in the middle of a black picture of that size; none for all of it.
    #[serde(default)]
    pub aspect: Option<(u32, u32)>,
    /// Whether left and right are exchanged.
    #[serde(default)]
    pub mirrored: bool,
    /// The order of its numbers.
    #[serde(default)]
    pub layout: PixelLayout,
    /// The key of nine numbers of the camera: its location, in units of the table's frame; its rotation, a quaternion x, y, z, w; its vertical angle of view in
    /// rad; and 1 if its horizontal one is the same, else 0. None if they are not told.
    #[serde(default)]
    pub numbers: Option<String>,
}

/// A camera of a picture.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum MappedCamera {
    /// The robot's head camera.
    Head,
    /// A camera in the robot's hand, by its name, with or without `_camera` at its end.
    Hand(String),
    /// A camera that stands somewhere.
    Standing {
        /// Where, in units of the table's frame.
        at: (f32, f32, f32),
        /// The point in the middle of its pictures, in the same frame.
        looks_at: (f32, f32, f32),
        /// Its vertical angle of view, in rad.
        fov: f32,
    },
    /// A camera fixed to a limb's end effector, looking along its fingers.
    OnLimb {
        /// The limb.
        limb: String,
        /// Where, in units of the end effector's frame: x along the opening, z away from the fingertips.
        at: (f32, f32, f32),
        /// The angle, in rad, by which it looks towards the frame's y.
        #[serde(default)]
        tilt: f32,
        /// Its vertical angle of view, in rad.
        fov: f32,
    },
}

/// An array of an observation, `float32`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MappedState {
    /// Its key.
    pub key: String,
    /// Its numbers.
    pub columns: Vec<StateColumn>,
}

/// What the numbers of an action do.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum MappedActions {
    /// They move joints and end effectors.
    Columns {
        /// Actions a second, from 1 to 60.
        rate: u32,
        /// Actions of a chunk that are carried out before the policy is asked again.
        horizon: usize,
        /// The meaning of each number.
        columns: Vec<ActionColumn>,
    },
    /// They say which object is to be put where, as the policies of `tabletop learn` do: the location, in units of the table's frame, of the origin of what is
    /// to be taken, its yaw in rad, and the number of turns after which it looks the same, 0 for what is round; the same of where it is to be put; and 1 if
    /// the task is done, else 0.
    Places,
}

impl MappedActions {
    /// Numbers of an action that says what is to be put where.
    pub const OF_PLACES: usize = 11;

    /// Numbers of an action.
    pub const fn columns(&self) -> usize {
        match self {
            Self::Columns { columns, .. } => columns.len(),
            Self::Places => Self::OF_PLACES,
        }
    }
}

impl MappedImage {
    /// The longest side of a picture.
    pub const LONGEST_SIDE: u32 = 2048;

    /// How it is drawn, by a camera whose own pictures have this size.
    pub fn fit(&self, own: [u32; 2]) -> PictureFit {
        let size = self.size.map_or(own, <[u32; 2]>::from);
        PictureFit::new(size, self.aspect.map(<[u32; 2]>::from))
    }
}

impl PolicyMapping {
    /// The keys of its observations.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        let images = self.images.iter().flat_map(|image| {
            [Some(image.key.as_str()), image.numbers.as_deref()]
                .into_iter()
                .flatten()
        });
        let states = self.states.iter().map(|state| state.key.as_str());
        let told = [self.prompt.as_deref(), self.objects.as_deref()];
        images.chain(states).chain(told.into_iter().flatten())
    }
}
