//! Folders of recordings and exported datasets: imported from other programs.
//!
//! Nothing here changes what it reads: results are new folders, which appear whole.

mod error;
mod import;

pub use error::DatasetError;
pub use import::{ActSource, Import, import_recording};
