//! Training episodes: recordings as learners read them, in frames at equal intervals, each with a state, an action and pictures, and the task
//! in sentences.
//!
//! ```no_run
//! use std::path::Path;
//! use tabletop_training::{EpisodeSelection, TrainingEpisode};
//!
//! let episode = TrainingEpisode::read(Path::new("demo"), &EpisodeSelection::default())?;
//! println!("{}: {} frames", episode.task, episode.len());
//! # Ok::<_, tabletop_training::EpisodeError>(())
//! ```

mod action;
mod camera_track;
mod episode;
mod error;
mod feature_stats;
mod grip_track;
mod hand_track;
mod image;
mod reading;
mod selection;

pub use episode::{
    CameraTrack, EncodedVideo, FrameVectors, ObjectTrack, Subtask, TrainingEpisode, ticks_of,
};
pub use error::EpisodeError;
pub use feature_stats::{FeatureStats, QUANTILES};
pub use image::{Image, gray_png};
pub use selection::{ActionKind, EpisodeSelection, PictureSelection, StateKind};
