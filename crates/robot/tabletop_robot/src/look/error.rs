//! Errors of looks.

use std::{io, path::PathBuf};

use thiserror::Error;

/// The reason why the look of a link is unknown.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LookError {
    /// The file that the robot's description names does not exist.
    #[error("{file}: there is no such file; it was looked for as {}", list(.searched))]
    Missing {
        /// The file, as the description names it.
        file: String,
        /// The places that were searched.
        searched: Vec<PathBuf>,
    },
    /// The file is where a recording's description may not name any.
    #[error("{}: it is outside of the recording; `--allow-path DIR` lets it name files in DIR", .path.display())]
    Outside {
        /// The file.
        path: PathBuf,
    },
    /// A file cannot be read, or its content is no mesh.
    #[error("{}: {source}", .path.display())]
    Mesh {
        /// The file.
        path: PathBuf,
        /// Its fault.
        source: io::Error,
    },
    /// A file of shapes has a mistake.
    #[error("{file}: {source}")]
    Shape {
        /// The file.
        file: String,
        /// The mistake and its place.
        source: serde_json::Error,
    },
    /// A mesh has no triangles, or numbers that cannot be drawn.
    #[error("{}: it contains nothing that can be drawn", .path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
}

fn list(paths: &[PathBuf]) -> String {
    if paths.is_empty() {
        return "no file, because the description of the robot is not in a file".into();
    }
    let names: Vec<_> = paths
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    names.join(", ")
}
