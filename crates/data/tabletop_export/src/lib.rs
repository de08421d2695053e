//! Recordings as datasets of other tools.
//!
//! A [`DatasetFormat`] writes [training episodes](tabletop_training::TrainingEpisode), and [`export`] reads them from recordings on all cores, in
//! constant memory.
//!
//! ```no_run
//! use std::path::PathBuf;
//! use tabletop_export::{LeRobot, export};
//! use tabletop_storage::Storage;
//! use tabletop_training::EpisodeSelection;
//!
//! let dataset = LeRobot::open("dataset".into(), &Storage::default())?;
//! let recordings = [PathBuf::from("demo")];
//! let summary = export(&recordings, &EpisodeSelection::default(), dataset, 2, |_| {})?;
//! println!("{} frames", summary.frames);
//! # Ok::<_, tabletop_export::ExportError>(())
//! ```

mod episode_files;
mod error;
mod format;
mod foxglove;
mod foxglove_messages;
mod lerobot;
mod matlab;
mod protobuf;
mod rlds;
mod robomimic;
mod robomimic_reader;
mod signal_message;

pub use episode_files::{EpisodeFile, EpisodeFiles};
pub use error::ExportError;
pub use format::{DatasetFormat, ExportSummary, export};
pub use foxglove::{Mcap, McapFile};
pub use lerobot::{DatasetVideos, LeRobot, LeRobotReader, LeRobotRepair, PendingCommit};
pub use matlab::{Matlab, MatlabFile};
pub use rlds::{EpisodeRecord, Rlds};
pub use robomimic::Robomimic;
pub use robomimic_reader::read_robomimic;
