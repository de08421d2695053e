//! Policies: from a picture to what is to be done next.

use std::path::Path;

use bevy::math::Vec3;
use tabletop_camera::Camera;
use tabletop_core::Picture;
use tabletop_storage::{Symlinks, read_regular_file};

use crate::{
    error::PolicyError,
    label::{HeatMark, Label, LabelPlanes, MOST_LEVELS, Yaw},
    planes::Planes,
    table_view::{PLANES, point_before, view_of},
    tensor_file::{Tensor, TensorFile},
    unet::UNet,
};

/// A policy: a network that knows one task.
#[derive(Clone, Debug)]
pub struct Policy {
    pub(crate) net: UNet,
    pub(crate) planes: LabelPlanes,
    pub(crate) parameters: Vec<f32>,
    /// The heights at which objects are taken and put, in units.
    levels: Vec<f32>,
}

/// What is to be done next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Decision {
    /// To take the object whose origin is at one place to another.
    Move {
        /// Where it is.
        pick: ObjectPlace,
        /// Where it shall be.
        place: ObjectPlace,
    },
    /// Nothing: the task is done.
    Done,
}

/// A place of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectPlace {
    /// The location of its origin, in the table's frame.
    pub location: Vec3,
    /// Its orientation; `None` for what is round.
    pub yaw: Option<Yaw>,
}

impl Decision {
    /// The angle, in rad counterclockwise from above, by which the object is to be turned on its way: the least after which it looks as it should.
    pub fn turn(&self) -> f32 {
        let Self::Move { pick, place } = self else {
            return 0.0;
        };
        let both = pick.yaw.zip(place.yaw);
        both.map_or(0.0, |(now, wanted)| now.turn_to(wanted))
    }
}

/// The first word of the format in a file, and its version.
const FORMAT: &str = "tabletop-policy 2";
/// The most bytes of a policy's file.
const MOST_BYTES: u64 = 1 << 26;

impl Policy {
    /// A policy that knows nothing yet.
    pub(crate) fn new(levels: Vec<f32>, seed: u64) -> Self {
        let mut policy = Self::untrained(levels);
        policy.parameters = policy.net.drawn(seed);
        policy
    }

    fn untrained(levels: Vec<f32>) -> Self {
        let planes = LabelPlanes {
            levels: levels.len(),
        };
        Self {
            net: UNet::new(PLANES, planes.planes()),
            planes,
            parameters: Vec::new(),
            levels,
        }
    }

    /// Reads a policy's file.
    ///
    /// # Errors
    /// It cannot be read, or is none.
    pub fn read(path: &Path) -> Result<Self, PolicyError> {
        let file = read_file(path)?;
        Self::of_file(&file).map_err(PolicyError::damaged(path))
    }

    /// What is to be done next, after a picture that this camera took.
    pub fn decide(&self, picture: &Picture, camera: &Camera) -> Decision {
        let eye = camera.pose.location;
        let place_of = |mark: HeatMark| ObjectPlace {
            location: point_before(eye, mark.at, self.levels[mark.level]),
            yaw: mark.heading.yaw(),
        };
        match self.label(view_of(picture, camera)) {
            Label::Move { pick, place } => Decision::Move {
                pick: place_of(pick),
                place: place_of(place),
            },
            Label::Done => Decision::Done,
        }
    }

    fn label(&self, view: Planes) -> Label {
        self.planes.label(&self.net.forward(&self.parameters, view))
    }

    pub(crate) fn to_file(&self) -> TensorFile {
        let mut file = TensorFile::default();
        file.metadata.insert("format".into(), FORMAT.into());
        let levels = serde_json::json!(self.levels).to_string();
        file.metadata.insert("levels".into(), levels);
        for convolution in self.net.convolutions() {
            for (name, shape, range) in convolution.tensors() {
                let numbers = self.parameters[range].to_vec();
                file.tensors.insert(name, Tensor { shape, numbers });
            }
        }
        file
    }

    pub(crate) fn of_file(file: &TensorFile) -> Result<Self, String> {
        let text = |name: &str| file.metadata.get(name).map_or("", String::as_str);
        if text("format") != FORMAT {
            return Err(format!(
                "its format is {:?}, expected {FORMAT:?}",
                text("format")
            ));
        }
        let levels: Vec<f32> = serde_json::from_str(text("levels"))
            .map_err(|error| format!("__metadata__, levels: {error}"))?;
        if !(1..=MOST_LEVELS).contains(&levels.len()) {
            return Err(format!(
                "__metadata__, levels: {} heights, expected 1 to {MOST_LEVELS}",
                levels.len()
            ));
        }
        let mut policy = Self::untrained(levels);
        let mut parameters = vec![0.0; policy.net.parameters()];
        for convolution in policy.net.convolutions() {
            for (name, shape, range) in convolution.tensors() {
                let tensor = file.tensors.get(&name);
                let tensor = tensor.ok_or_else(|| format!("it lacks {name:?}"))?;
                if tensor.shape != shape {
                    let found = &tensor.shape;
                    return Err(format!(
                        "{name:?}: its shape is {found:?}, expected {shape:?}"
                    ));
                }
                if !tensor.numbers.iter().all(|number| number.is_finite()) {
                    return Err(format!("{name:?}: a number is not finite"));
                }
                parameters[range].copy_from_slice(&tensor.numbers);
            }
        }
        policy.parameters = parameters;
        Ok(policy)
    }
}

/// The tensors of a file.
pub(crate) fn read_file(path: &Path) -> Result<TensorFile, PolicyError> {
    let bytes = read_regular_file(path, MOST_BYTES, Symlinks::Followed);
    let bytes = bytes.map_err(PolicyError::io(path))?;
    TensorFile::parse(&bytes).map_err(PolicyError::damaged(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_back_or_its_fault_is_located() {
        let policy = Policy::new(vec![0.5, 1.5], 3);
        let mut file = policy.to_file();
        let read = Policy::of_file(&file).unwrap();
        assert_eq!(read.parameters, policy.parameters);
        assert_eq!(read.levels, policy.levels);
        file.tensors.get_mut("up.1.bias").unwrap().numbers[3] = f32::NAN;
        let fault = Policy::of_file(&file).unwrap_err();
        assert_eq!(fault, "\"up.1.bias\": a number is not finite");
        file.tensors.remove("head.weight");
        file.metadata.insert("levels".into(), "[]".into());
        let fault = Policy::of_file(&file).unwrap_err();
        assert_eq!(fault, "__metadata__, levels: 0 heights, expected 1 to 9");
    }
}
