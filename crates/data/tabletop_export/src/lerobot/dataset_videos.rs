//! The videos of a dataset, of which whole episodes are copied.

use std::{
    collections::{BTreeMap, btree_map::Entry},
    fs::File,
    ops::Range,
    path::{Path, PathBuf},
};

use tabletop_film::Mp4Reader;
use tabletop_storage::InnerFile;
use tabletop_training::EncodedVideo;

use super::{
    episode_table::{self, ShownVideos},
    place::{DataPlace, FileSeries},
};
use crate::error::ExportError;

/// The videos of a dataset.
#[derive(Debug)]
pub struct DatasetVideos {
    folder: PathBuf,
    features: Vec<String>,
    fps: u32,
    episodes: BTreeMap<usize, ShownVideos>,
    /// The last video of each feature that was opened.
    open: BTreeMap<String, (DataPlace, Mp4Reader<File>)>,
}

impl DatasetVideos {
    /// Those of these features.
    pub(super) fn open(
        folder: &Path,
        features: Vec<String>,
        fps: u32,
    ) -> Result<Self, ExportError> {
        let episodes = match features.is_empty() {
            true => BTreeMap::new(),
            false => episode_table::read_videos(folder, &features)?,
        };
        Ok(Self {
            folder: folder.to_owned(),
            features,
            fps,
            episodes,
            open: BTreeMap::new(),
        })
    }

    /// The video of a feature's pictures of an episode with so many frames; `None` if the feature is no video.
    pub(super) fn copy(
        &mut self,
        feature: &str,
        episode: usize,
        frames: usize,
    ) -> Result<Option<EncodedVideo>, ExportError> {
        if !self.features.iter().any(|video| video == feature) {
            return Ok(None);
        }
        let (place, shown) = self.part(feature, episode, frames)?;
        let colors = self.episodes.get(&episode).and_then(|it| it.get(feature));
        let colors = colors.map(|(_, colors)| colors.clone());
        let (path, video) = self.video(feature, place)?;
        let packets = video.packets(shown);
        Ok(Some(EncodedVideo {
            track: video.track(),
            coding: video.coding().clone(),
            packets: packets.map_err(|error| ExportError::dataset(path, error))?,
            colors,
        }))
    }

    /// What is wrong with the videos of an episode with so many frames.
    pub fn faults(&mut self, episode: usize, frames: usize) -> Vec<ExportError> {
        let features = self.features.clone();
        let parts = features.iter();
        parts
            .filter_map(|feature| self.part(feature, episode, frames).err())
            .collect()
    }

    /// What is wrong with the videos besides: frames of none or of several episodes.
    pub fn strays(&mut self) -> Vec<ExportError> {
        let mut faults = Vec::new();
        for feature in self.features.clone() {
            let mut shown = BTreeMap::<DataPlace, Vec<Range<usize>>>::new();
            for videos in self.episodes.values() {
                if let Some((part, _)) = videos.get(&feature) {
                    let frames = part.times.map(|time| self.frame_at(time));
                    let of_file = shown.entry(part.place).or_default();
                    of_file.push(frames[0]..frames[1]);
                }
            }
            for (place, mut shown) in shown {
                shown.sort_by_key(|frames| frames.start);
                // Who checks the episodes hears of a video that cannot be read.
                let Ok((path, video)) = self.video(&feature, place) else {
                    continue;
                };
                let ends = std::iter::once(0).chain(shown.iter().map(|frames| frames.end));
                let starts = shown.iter().map(|frames| frames.start);
                let all = video.frames();
                if ends.ne(starts.chain([all])) {
                    let problem = format!(
                        "its {all} frames are not those of its episodes, one after the other"
                    );
                    faults.push(ExportError::dataset(path, problem));
                }
            }
        }
        faults
    }

    /// The place of an episode's video, and its frames there.
    fn part(
        &mut self,
        feature: &str,
        episode: usize,
        frames: usize,
    ) -> Result<(DataPlace, Range<usize>), ExportError> {
        let videos = self.episodes.get(&episode).and_then(|it| it.get(feature));
        let Some((part, _)) = videos else {
            let problem = format!("it does not say where {feature} of episode {episode} is");
            return Err(ExportError::dataset(
                self.folder.join("meta/episodes"),
                problem,
            ));
        };
        let (place, [from, to]) = (part.place, part.times);
        let shown = self.frame_at(from)..self.frame_at(to);
        let fps = self.fps;
        let (path, video) = self.video(feature, place)?;
        let problem = if shown.len() != frames {
            format!(
                "episode {episode}, from {from} to {to} s, has {frames} frames, and {} pictures",
                shown.len()
            )
        } else if video.track().fps != fps {
            format!(
                "it has {} frames a second, the dataset {fps}",
                video.track().fps
            )
        } else if shown.end > video.frames() {
            format!(
                "episode {episode} ends at {to} s, after its {} frames",
                video.frames()
            )
        } else if !video.is_key(shown.start) {
            format!("episode {episode} begins at {from} s, where no frame can be decoded by itself")
        } else {
            return Ok((place, shown));
        };
        Err(ExportError::dataset(path, problem))
    }

    /// The number of the frame at this time, in s.
    fn frame_at(&self, time: f64) -> usize {
        (time * f64::from(self.fps)).round() as usize
    }

    /// The video of a feature at a place.
    fn video(
        &mut self,
        feature: &str,
        place: DataPlace,
    ) -> Result<(PathBuf, &mut Mp4Reader<File>), ExportError> {
        let videos = FileSeries::videos(feature);
        let videos = videos.map_err(|error| ExportError::dataset(&self.folder, error))?;
        let file = InnerFile::new(&self.folder, place.path(&videos));
        let path = file.path();
        let read = || {
            let file = file.open().map_err(ExportError::io(&path))?;
            let video = Mp4Reader::open(file);
            let video = video.map_err(|error| ExportError::dataset(&path, error))?;
            Ok::<_, ExportError>((place, video))
        };
        let open = match self.open.entry(feature.to_owned()) {
            Entry::Occupied(open) if open.get().0 == place => open.into_mut(),
            Entry::Occupied(mut open) => {
                open.insert(read()?);
                open.into_mut()
            }
            Entry::Vacant(open) => open.insert(read()?),
        };
        Ok((path, &mut open.1))
    }
}
