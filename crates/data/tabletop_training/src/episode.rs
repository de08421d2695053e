//! Episodes: recordings as learners read them.

use std::{path::PathBuf, sync::Arc};

use tabletop_core::{ObjectSpec, SimTick, TICKS_PER_SECOND};
use tabletop_film::{VideoCoding, VideoPacket, VideoTrack};
use tabletop_geometry::Pose;

use crate::{feature_stats::FeatureStats, image::Image, selection::ActionKind};

/// A recording as a learner reads it.
#[derive(Clone, Debug)]
pub struct TrainingEpisode {
    /// The folder of the recording.
    pub folder: PathBuf,
    /// Frames a second.
    pub fps: u32,
    /// The ticks whose ends the frames show.
    pub ticks: Vec<SimTick>,
    /// The state at each frame: of the robot's joints, or of the objects.
    pub state: FrameVectors,
    /// The poses of the objects at each frame, beside a state that has them not; no numbers if they were not asked for.
    pub environment: FrameVectors,
    /// The action from each frame to the next.
    pub action: FrameVectors,
    /// The kind of action.
    pub action_kind: ActionKind,
    /// The objects with their poses.
    pub objects: Vec<ObjectTrack>,
    /// The cameras with their pictures.
    pub cameras: Vec<CameraTrack>,
    /// The task, in a sentence a step.
    pub task: String,
    /// Other words for the task.
    pub paraphrases: Vec<String>,
    /// The parts of the task, each with the frame that it begins at.
    pub subtasks: Vec<Subtask>,
}

/// Numbers for each frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameVectors {
    /// The names of a frame's numbers.
    pub names: Vec<String>,
    /// The numbers, frame by frame.
    pub values: Vec<f32>,
}

/// An object, and its pose at each frame.
#[derive(Clone, Debug)]
pub struct ObjectTrack {
    /// The object.
    pub spec: ObjectSpec,
    /// Its poses, in the table's frame; `None` while it is not there.
    pub poses: Vec<Option<Pose>>,
}

/// The pictures of a camera, one for each frame.
#[derive(Clone, Debug)]
pub struct CameraTrack {
    /// The camera's name: `head`, or that of a hand camera.
    pub name: String,
    /// The pictures; none if they are known only as a video. Frames in which nothing has changed share one.
    pub images: Vec<Arc<Image>>,
    /// Distances of each pixel along the axis of view in m, 0 where nothing is: one for each picture, or none at all.
    pub depths: Vec<Arc<Vec<f32>>>,
    /// The same pictures as a video, if one was asked for.
    pub video: Option<EncodedVideo>,
    /// The thing at each pixel's centre: 0 nothing, 1 the table, n + 1 the n-th object, 65535 anything else. One for each picture, or none at
    /// all.
    pub ids: Vec<Arc<Vec<u16>>>,
}

/// Pictures as a video: AV1, of which the first frame and some others can be decoded by themselves.
#[derive(Clone, Debug)]
pub struct EncodedVideo {
    /// Its size and rate.
    pub track: VideoTrack,
    /// How its frames are encoded.
    pub coding: VideoCoding,
    /// Its frames.
    pub packets: Vec<VideoPacket>,
    /// The statistics of its colours, if they are known only from before it was encoded.
    pub colors: Option<FeatureStats>,
}

/// A part of a task.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Subtask {
    /// The frame at which it begins.
    pub frame: usize,
    /// What is done, without a full stop: `pick up the red block`.
    pub sentence: String,
}

/// The ticks whose ends so many frames show, at so many a second.
pub fn ticks_of(frames: usize, fps: u32) -> impl Iterator<Item = SimTick> {
    let (second, fps) = (u64::from(TICKS_PER_SECOND), u64::from(fps.max(1)));
    (0..frames as u64).map(move |frame| SimTick(frame * second / fps))
}

impl TrainingEpisode {
    /// Number of frames.
    pub fn len(&self) -> usize {
        self.ticks.len()
    }

    /// True if there is no frame.
    pub fn is_empty(&self) -> bool {
        self.ticks.is_empty()
    }

    /// The state and, after it, the poses of the objects, at each frame.
    pub fn whole_state(&self) -> FrameVectors {
        self.state.beside(&self.environment)
    }
}

impl CameraTrack {
    /// Rows and columns of a picture.
    pub fn size(&self) -> [u32; 2] {
        let of_image = self.images.first().map(|image| [image.height, image.width]);
        let of_video = || {
            let video = self.video.as_ref()?;
            Some([video.track.height, video.track.width])
        };
        of_image.or_else(of_video).unwrap_or_default()
    }
}

impl FrameVectors {
    /// A signal of these numbers a frame, without frames.
    pub fn new(names: Vec<String>) -> Self {
        Self {
            names,
            values: Vec::new(),
        }
    }

    /// The numbers of each frame.
    pub fn frames(&self) -> impl ExactSizeIterator<Item = &[f32]> {
        self.values.chunks_exact(self.names.len().max(1))
    }

    /// This signal and another one, frame by frame one after the other. One without numbers has no frames, either.
    pub fn beside(&self, other: &Self) -> Self {
        match (self.names.is_empty(), other.names.is_empty()) {
            (_, true) => return self.clone(),
            (true, false) => return other.clone(),
            (false, false) => {}
        }
        let names = self.names.iter().chain(&other.names).cloned().collect();
        let frames = self.frames().zip(other.frames());
        let values = frames.flat_map(|(one, other)| one.iter().chain(other));
        Self {
            names,
            values: values.copied().collect(),
        }
    }
}
