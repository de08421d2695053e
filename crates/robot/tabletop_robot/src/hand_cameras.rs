//! The places of the cameras in the robot's hands.

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{HandCamera, HandImages, Robot, Table};
use tabletop_geometry::Pose;

use crate::articulation::{
    link_entities::positions,
    tree::{Articulation, Posture, in_units},
};

/// The robot that carries hand cameras.
#[derive(SystemParam)]
pub struct HandCameraCarrier<'w, 's> {
    articulation: Res<'w, Articulation>,
    tables: Query<'w, 's, &'static Table>,
    robot: Res<'w, Robot>,
}

impl HandCameraCarrier<'_, '_> {
    /// The present poses of these cameras, in the table's frame and in units; `None` for one whose link the robot lacks.
    pub fn poses(&self, cameras: &[HandCamera]) -> Vec<Option<Pose>> {
        let table = self.tables.iter().next().copied().unwrap_or_default();
        let base = self.articulation.layout.base.pose(&table);
        let posture = self.articulation.posture(&positions(&self.robot), base);
        let place = |link| link_pose(&self.articulation, &posture, link);
        let poses = cameras.iter();
        poses
            .map(|camera| Some(place(&camera.link)? * camera.mount))
            .collect()
    }
}

/// Places the hand cameras that are asked for pictures where the joints have brought them.
pub(crate) fn place_hand_cameras(carrier: HandCameraCarrier, mut images: ResMut<HandImages>) {
    images.poses = carrier.poses(images.asked());
}

/// Pose of a link in a posture, in units; `None` if the robot has no link of this name.
fn link_pose(articulation: &Articulation, posture: &Posture, link: &str) -> Option<Pose> {
    let link = articulation.model().find_link(link).ok()?;
    Some(posture.base() * in_units(posture.frames()[link]))
}

#[cfg(test)]
mod tests {
    use tabletop_core::RobotLayout;

    use super::*;
    use crate::description::Description;

    #[test]
    fn they_look_down_past_the_fingers_whichever_frame_the_description_has() {
        let Description { model, layout, .. } = Description::baxter().unwrap();
        let home = positions(&Robot::at_home(&layout));
        let articulation = Articulation::new(model, layout).unwrap();
        let posture = articulation.posture(&home, Pose::IDENTITY);
        let cameras = &RobotLayout::baxter().hand_cameras;
        assert_eq!(cameras.len(), 2);
        for (camera, end_effector) in cameras.iter().zip(posture.end_effectors()) {
            let poses = camera.frame.iter().map(|frame| {
                let camera = camera.on(frame);
                link_pose(&articulation, &posture, &camera.link).unwrap() * camera.mount
            });
            let poses: Vec<_> = poses.collect();
            for pose in &poses {
                assert!(
                    pose.location.distance(poses[0].location) < 1e-3,
                    "{poses:?}"
                );
                assert!(pose.rotation.angle_between(poses[0].rotation) < 1e-3);
                assert!((pose.rotation * Vec3::NEG_Z).z < -0.99);
                let ahead = pose.inverse() * end_effector.location;
                assert!(ahead.z < -0.5 && ahead.y > 0.3, "{ahead}");
            }
        }
    }
}
