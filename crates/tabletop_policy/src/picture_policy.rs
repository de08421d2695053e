//! Policies that decide by what the head camera sees, whoever made them.

use tabletop_camera::Camera;
use tabletop_core::Picture;

use crate::{
    error::PolicyError,
    policy::{Decision, Policy},
};

/// A policy that decides by a picture what is to be done next.
pub trait PicturePolicy: Send + Sync {
    /// Columns and rows of the pictures from which it decides; `None` for any.
    fn picture_size(&self) -> Option<[u32; 2]>;

    /// What is to be done next, after a picture that this camera took.
    ///
    /// # Errors
    /// It comes to no decision.
    fn decide(&self, picture: &Picture, camera: &Camera) -> Result<Decision, PolicyError>;
}

impl PicturePolicy for Policy {
    fn picture_size(&self) -> Option<[u32; 2]> {
        None
    }

    fn decide(&self, picture: &Picture, camera: &Camera) -> Result<Decision, PolicyError> {
        Ok(Self::decide(self, picture, camera))
    }
}
