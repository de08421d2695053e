//! Why something has no looks.

use std::{io, path::PathBuf};

use thiserror::Error;

/// Why it is not known what a link looks like.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LookError {
    /// The file that the description of the robot names is not there.
    #[error("{file}: there is no such file; it was looked for in {}", list(.searched))]
    Missing {
        /// The file, as the description names it.
        file: String,
        /// Where it was looked for.
        searched: Vec<PathBuf>,
    },
    /// A file cannot be read, or its content is no mesh.
    #[error("{}: {source}", .path.display())]
    Mesh {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: io::Error,
    },
    /// A file of shapes has a mistake.
    #[error("{file}: {source}")]
    Shape {
        /// The file.
        file: String,
        /// Where and what the mistake is.
        source: serde_json::Error,
    },
    /// A mesh has no triangles, or numbers that cannot be drawn.
    #[error("{}: there is nothing in it that can be drawn", .path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
}

fn list(paths: &[PathBuf]) -> String {
    if paths.is_empty() {
        return "no folder, because the description of the robot is not in a file".into();
    }
    let names: Vec<_> = paths
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    names.join(", ")
}
