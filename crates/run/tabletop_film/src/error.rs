//! Errors of films.

use tabletop_camera::StudioError;
use tabletop_recorder::RecorderError;
use tabletop_replay::ReplayError;
use thiserror::Error;

/// The error of a film.
#[derive(Debug, Error)]
pub enum FilmError {
    /// The recording cannot be read.
    #[error(transparent)]
    Recording(#[from] RecorderError),
    /// The recording cannot be simulated again.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// A camera has no picture.
    #[error(transparent)]
    Camera(#[from] StudioError),
    /// The format has no pictures of this size.
    #[error("{format} cannot have pictures of {width}x{height}; {expected}")]
    Size {
        /// The format.
        format: &'static str,
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// The sizes that it can have.
        expected: &'static str,
    },
    /// A file is no video that this program makes.
    #[error("it is no video as this program makes them: {0}")]
    Foreign(String),
    /// A video cannot be read.
    #[error(transparent)]
    Unreadable(#[from] std::io::Error),
    /// The pictures cannot be drawn or encoded.
    #[error("the pictures cannot be made: {0}")]
    Failed(String),
}
