//! Paths that strangers' files may name besides those around them.

use std::path::PathBuf;

use clap::Args;

#[derive(Args)]
pub(super) struct AllowedPaths {
    /// Let files name others in this folder and below, too; without it, only those around them. Can be given again
    #[arg(long = "allow-path", value_name = "DIR")]
    pub folders: Vec<PathBuf>,
}
