//! Recordings as datasets of other tools.
//!
//! An [`TrainingEpisode`] is a recording as a learner reads it: frames at equal intervals, each with a state, an action and pictures, and the task in
//! sentences. A [`DatasetFormat`] writes episodes, and [`export`] makes them of recordings on all cores, in constant memory.
//!
//! ```no_run
//! use std::path::PathBuf;
//! use tabletop_export::{LeRobot, EpisodeSelection, export};
//! use tabletop_storage::Storage;
//!
//! let dataset = LeRobot::open("dataset".into(), &Storage::default())?;
//! let recordings = [PathBuf::from("demo")];
//! let summary = export(&recordings, &EpisodeSelection::default(), dataset, 2, |_| {})?;
//! println!("{} frames", summary.frames);
//! # Ok::<_, tabletop_export::ExportError>(())
//! ```

mod action;
mod camera_track;
mod episode;
mod episode_files;
mod error;
mod feature_stats;
mod format;
mod foxglove;
mod foxglove_messages;
mod grip_track;
mod hand_track;
mod image;
mod lerobot;
mod matlab;
mod protobuf;
mod reading;
mod rlds;
mod robomimic;
mod robomimic_reader;
mod selection;
mod signal_message;

pub use episode::{CameraTrack, EncodedVideo, FrameVectors, ObjectTrack, Subtask, TrainingEpisode};
pub use episode_files::{EpisodeFile, EpisodeFiles};
pub use error::ExportError;
pub use format::{DatasetFormat, ExportSummary, export};
pub use foxglove::{Mcap, McapFile};
pub use image::Image;
pub use lerobot::{DatasetVideos, LeRobot, LeRobotReader, LeRobotRepair, PendingCommit};
pub use matlab::{Matlab, MatlabFile};
pub use rlds::{EpisodeRecord, Rlds};
pub use robomimic::Robomimic;
pub use robomimic_reader::read_robomimic;
pub use selection::{ActionKind, EpisodeSelection, PictureSelection, StateKind};
