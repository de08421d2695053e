//! The places of the cameras in the robot's hands.

use bevy::prelude::*;
use tabletop_core::{HandImages, Robot};

use crate::motion::view::RobotView;

/// Places the hand cameras that are asked for pictures where the joints have brought them.
pub(crate) fn place_hand_cameras(
    known: RobotView,
    robot: Res<Robot>,
    mut images: ResMut<HandImages>,
) {
    let posture = known.posture(&robot, None);
    let place = |link| known.articulation.link_pose(&posture, link);
    let poses = images
        .asked()
        .iter()
        .map(|camera| Some(place(&camera.link)? * camera.mount));
    images.poses = poses.collect();
}
