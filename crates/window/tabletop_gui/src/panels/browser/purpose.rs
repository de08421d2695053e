//! The purposes for which a file is chosen.

use std::path::PathBuf;

use crate::files::FileRequest;

/// The purpose for which a file is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Opening a task file or a recording.
    Open,
    /// Saving a task file.
    Save,
    /// Saving a video of a recording.
    Video,
    /// Saving a picture of the view, of so many columns and rows.
    Picture([u32; 2]),
    /// Saving a table of curves.
    Table,
    /// Saving a picture of a plot.
    Plot,
}

impl Purpose {
    /// The name that is proposed.
    pub const fn file_name(self) -> &'static str {
        match self {
            Self::Open => "",
            Self::Save => "task.xml",
            Self::Video => "demo.mp4",
            Self::Picture(_) => "view.png",
            Self::Table => "curves.csv",
            Self::Plot => "plot.png",
        }
    }

    /// The request about the file that the user has chosen.
    pub fn request(self, path: PathBuf) -> FileRequest {
        match self {
            Self::Open => FileRequest::Open(path),
            Self::Save => FileRequest::Save(path),
            Self::Video => FileRequest::SaveVideo(path),
            Self::Picture(size) => FileRequest::SavePicture(path, size),
            Self::Table => FileRequest::SaveTable(path),
            Self::Plot => FileRequest::SavePlot(path),
        }
    }

    /// The title of a dialog.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Open => "Open a task file or a recording",
            Self::Save => "Save as a task file",
            Self::Video => "Save a video (.mp4, .gif) or a contact sheet (.png)",
            Self::Picture(_) => "Save a picture of the view",
            Self::Table => "Save the curves as a table (.csv)",
            Self::Plot => "Save a picture of the plot (.png)",
        }
    }
}
