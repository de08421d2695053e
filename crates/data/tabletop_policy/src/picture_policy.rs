//! Policies that decide by what the head camera sees, whoever made them.

use tabletop_camera::Camera;
use tabletop_controller::Sight;
use tabletop_core::Picture;

use crate::{
    error::PolicyError,
    known_table::ToldTask,
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

    /// The same of a policy that may be told the task, and where everything is. Most decide by the picture alone.
    ///
    /// # Errors
    /// It comes to no decision.
    fn decide_told(
        &self,
        picture: &Picture,
        camera: &Camera,
        _told: &ToldTask,
        _sight: &Sight,
    ) -> Result<Decision, PolicyError> {
        self.decide(picture, camera)
    }
}

impl PicturePolicy for Policy {
    fn picture_size(&self) -> Option<[u32; 2]> {
        None
    }

    fn decide(&self, picture: &Picture, camera: &Camera) -> Result<Decision, PolicyError> {
        Ok(Self::decide(self, picture, camera))
    }
}
