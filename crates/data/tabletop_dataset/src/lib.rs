//! Folders of recordings and exported datasets: imported from other programs, described, checked, repaired, merged and split.
//!
//! Nothing here changes what it reads: results are new folders, which appear whole. Only [`repair()`] changes a dataset, and only ends what an
//! export to it has begun.

mod card;
mod check;
mod composition;
mod error;
mod folder;
mod import;
mod limits;
mod new_folder;
mod repair;
mod statistics;
mod summary;
mod trim;

pub use card::write_card;
pub use check::{CheckOptions, Finding, check};
pub use composition::{DatasetPart, divide, merge};
pub use error::DatasetError;
pub use folder::{DatasetContent, DatasetFolder, recordings_in};
pub use import::{ActSource, Import, import_recording, record_watched};
pub use repair::{Repair, repair};
pub use statistics::{NumberStatistics, statistics};
pub use summary::{DatasetSummary, summarize};
pub use trim::{Trim, trim};
