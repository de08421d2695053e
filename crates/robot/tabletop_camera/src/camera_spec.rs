//! Descriptions of cameras.

use tabletop_geometry::Pose;

/// A camera by its place and its pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraSpec {
    /// Its name.
    pub name: String,
    /// Its place.
    pub viewpoint: CameraPlace,
    /// Columns and rows of its pictures; `None` for its own.
    pub size: Option<[u32; 2]>,
    /// The angle between the lower and the upper edge, in rad; `None` for its own, which is π/3 for a camera that stands somewhere.
    pub vertical_fov: Option<f32>,
}

/// The place of a camera.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraPlace {
    /// The robot's head.
    Head,
    /// The robot's hand: the name of its camera, with or without `_camera` at its end.
    Hand(String),
    /// A pose in the table's frame, in units. The camera looks along its own -Z, with its Y up.
    Standing(Pose),
}

impl CameraSpec {
    /// The head camera, with pictures of this size.
    pub fn head(width: u32, height: u32) -> Self {
        Self {
            name: "head".into(),
            viewpoint: CameraPlace::Head,
            size: Some([width, height]),
            vertical_fov: None,
        }
    }
}
