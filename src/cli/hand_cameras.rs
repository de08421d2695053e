//! The option that records the pictures of hand cameras.

use crate::{recorder::HandPictures, robot::RobotPlugin};
use clap::Args;

use super::Failure;

#[derive(Args, Clone, Copy)]
pub(super) struct HandCameraOption {
    /// Record the pictures of the cameras in the robot's hands, too
    #[arg(long)]
    pub hand_cameras: bool,
}

impl HandCameraOption {
    /// The pictures to record of this robot.
    ///
    /// # Errors
    /// It has no such camera.
    pub fn of(self, robot: &RobotPlugin) -> Result<HandPictures, Failure> {
        let layout = robot.layout();
        match self.hand_cameras {
            false => Ok(HandPictures::None),
            true if layout.hand_cameras.is_empty() => Err(Failure::input(format!(
                "the robot {} has no hand cameras; its robot.ron would name them under hand_cameras",
                layout.name
            ))),
            true => Ok(HandPictures::OfAll),
        }
    }
}
