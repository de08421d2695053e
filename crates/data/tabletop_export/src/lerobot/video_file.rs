//! `videos/FEATURE/chunk-XXX/file-XXX.mp4`: the pictures of a camera, one episode after the other.

use std::path::PathBuf;

use tabletop_film::{Mp4Writer, VideoCoding};
use tabletop_storage::StoredFile;
use tabletop_training::EncodedVideo;

use super::{
    episode_table::VideoPart,
    place::{DataPlace, MOST_VIDEO_BYTES},
};
use crate::error::ExportError;

/// A video that gets episodes.
#[derive(Debug)]
pub(super) struct VideoFile {
    path: PathBuf,
    place: DataPlace,
    file: StoredFile,
    mp4: Mp4Writer,
    coding: VideoCoding,
    fps: u32,
}

impl VideoFile {
    /// A video like this one.
    pub fn new(
        path: PathBuf,
        mut file: StoredFile,
        place: DataPlace,
        video: &EncodedVideo,
    ) -> Result<Self, ExportError> {
        let (mp4, bytes) = Mp4Writer::begin(video.track, video.coding.clone())?;
        file.append(&bytes).map_err(ExportError::io(&path))?;
        Ok(Self {
            path,
            place,
            file,
            mp4,
            coding: video.coding.clone(),
            fps: video.track.fps,
        })
    }

    /// True if an episode belongs to this file: it is not full, and the frames are encoded in the same way.
    pub fn takes(&self, video: &EncodedVideo) -> bool {
        self.mp4.bytes() < MOST_VIDEO_BYTES && self.coding == video.coding
    }

    /// Adds an episode.
    pub fn add(&mut self, video: &EncodedVideo) -> Result<VideoPart, ExportError> {
        let fps = f64::from(self.fps);
        let seconds = |frames: usize| frames as f64 / fps;
        let from = seconds(self.mp4.frames());
        let bytes = self.mp4.add(&video.packets)?;
        self.write(&bytes)?;
        Ok(VideoPart {
            place: self.place,
            times: [from, seconds(self.mp4.frames())],
        })
    }

    /// Makes it whole, on the disk.
    pub fn close(mut self) -> Result<(), ExportError> {
        let bytes = self.mp4.end()?;
        self.write(&bytes)?;
        self.file.sync().map_err(ExportError::io(&self.path))
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), ExportError> {
        self.file.append(bytes).map_err(ExportError::io(&self.path))
    }
}
