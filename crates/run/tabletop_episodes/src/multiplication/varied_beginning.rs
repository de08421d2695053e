//! Beginnings of demonstrations that are made from another.

use tabletop_camera::Camera;
use tabletop_core::{CameraCarrier, HeadCamera, Light, ObjectSpec, SceneSpec};
use tabletop_geometry::Pose;
use tabletop_task::Binding;

use crate::still_scene::StillScene;

/// The beginning of a demonstration that is made from another.
#[derive(Clone, Debug)]
pub struct VariedBeginning {
    /// The scene.
    pub scene: SceneSpec,
    /// The objects of the scene, with their poses.
    pub objects: Vec<ObjectSpec>,
    /// The objects that take the roles of the task.
    pub binding: Binding,
    /// The pose of the head camera, if it is not on the robot's head.
    pub mount: Option<Pose>,
    /// The light in its pictures.
    pub light: Light,
    /// What carries the head camera.
    pub(super) carrier: CameraCarrier,
    /// The seed of the robot's search for paths.
    pub(super) seed: u64,
}

impl VariedBeginning {
    /// The head camera.
    pub fn camera(&self) -> Camera {
        let head = HeadCamera {
            carrier: self.carrier,
            mount: self.mount,
            light: self.light,
            ..HeadCamera::default()
        };
        Camera::of_head(&head, &self.scene.table)
    }

    /// The objects before the head camera.
    pub fn still_scene(&self) -> StillScene {
        StillScene::new(self.camera(), &self.scene.table, self.objects.clone())
    }
}
