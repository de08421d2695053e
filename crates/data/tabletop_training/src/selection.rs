//! The choice of what an episode holds.

use std::path::PathBuf;

use tabletop_camera::CameraSpec;

/// The choice of what an episode holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EpisodeSelection {
    /// The state; `None` for that of what acts: the robot if one of its joints moves, otherwise the objects.
    pub state: Option<StateKind>,
    /// The action; `None` for that of what acts: the robot if one of its joints moves, otherwise the hands.
    pub action: Option<ActionKind>,
    /// The pictures.
    pub pictures: PictureSelection,
    /// Adds the program that the recording means to the other words for its task, if that is more than its steps.
    pub has_program: bool,
    /// Folders in which a recording's robot may have its meshes, besides that of the recording.
    pub allowed: Vec<PathBuf>,
}

/// The choice of pictures. Other ones than those of the recording are made by simulating it again.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PictureSelection {
    /// Frames a second, a divisor of 60; `None` for those of the recording.
    pub fps: Option<u32>,
    /// Columns and rows; `None` for those of the recording.
    pub size: Option<[u32; 2]>,
    /// The cameras, possibly none; `None` for those of the recording.
    pub cameras: Option<Vec<CameraSpec>>,
    /// Encodes them as a video, too.
    pub has_video: bool,
    /// Adds distances.
    pub has_depth: bool,
    /// Adds the numbers of objects.
    pub has_ids: bool,
}

/// The kind of state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StateKind {
    /// Positions of the robot's joints, in rad; of grippers, their opening in units.
    Robot,
    /// Poses of the objects, and places and grips of the hands.
    Objects,
    /// Positions of the robot's joints, and beside them the poses of the objects.
    Both,
}

/// The kind of action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActionKind {
    /// The motion of each hand until the next frame: along X, Y and Z in units, about them in rad, and 1 while it holds something.
    Hands,
    /// The positions that the robot's joints are ordered to have in the next frame: where they are then. Fingers are ordered to where their motion
    /// ends, and to close entirely while they hold something or close on it.
    Joints,
    /// The motion of each end effector until the next frame, as for hands, and the opening that its gripper is ordered to have
    /// in the next frame, in units.
    EndEffectors,
}

impl PictureSelection {
    /// True if the pictures of a recording with so many frames a second do.
    pub fn are_recorded(&self, fps: u32) -> bool {
        let Self {
            fps: wanted,
            size,
            cameras,
            has_video: _,
            has_depth,
            has_ids,
        } = self;
        wanted.is_none_or(|wanted| wanted == fps)
            && size.is_none()
            && cameras.is_none()
            && !has_depth
            && !has_ids
    }
}
