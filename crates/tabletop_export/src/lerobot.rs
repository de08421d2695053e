//! LeRobotDataset v3.0: Parquet files with a row a frame, and JSON around them.
//!
//! ```text
//! meta/info.json                              features, totals
//! meta/stats.json                             statistics of all frames
//! meta/tasks.parquet                          the instructions
//! meta/episodes/chunk-000/file-000.parquet    a row an episode
//! data/chunk-000/file-000.parquet             a row a frame, a row group an episode
//! videos/FEATURE/chunk-000/file-000.mp4       the pictures, if they are videos
//! ```
//!
//! Every export adds files and replaces the three first ones. They get their names together, by [`Commit`].

mod columns;
mod commit;
mod data_file;
mod dataset_videos;
mod episode_table;
mod info;
mod language;
mod place;
mod read_columns;
mod reader;
mod stats;
mod table;
mod task_table;
mod video_file;

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use tabletop_storage::{FolderLock, Storage};

use self::{
    commit::Commit,
    data_file::DataFile,
    episode_table::{EpisodeRow, VideoPart},
    info::{Info, feature_of_camera},
    place::DataPlace,
    video_file::VideoFile,
};
pub use self::{commit::PendingCommit, dataset_videos::DatasetVideos, reader::LeRobotReader};
use crate::{
    episode::{EncodedVideo, TrainingEpisode},
    error::ExportError,
    feature_stats::FeatureStats,
    format::DatasetFormat,
};

/// A LeRobot dataset (v3.0) in a folder, to which episodes are added. Its pictures are PNG files in the table of frames, so that nothing is lost;
/// those of cameras with a [video](crate::CameraTrack::video) are videos instead.
#[derive(Debug)]
pub struct LeRobot {
    folder: PathBuf,
    storage: Storage,
    commit: Commit,
    info: Option<Info>,
    tasks: Vec<String>,
    stats: BTreeMap<String, FeatureStats>,
    rows: Vec<EpisodeRow>,
    file: Option<DataFile>,
    /// The videos that get episodes, by their features, and the numbers of the next ones.
    videos: BTreeMap<String, VideoFile>,
    next_videos: BTreeMap<String, usize>,
    next_file: usize,
    has_language: bool,
    /// Nobody else writes to it meanwhile.
    _lock: Option<FolderLock>,
}

/// An episode with its statistics.
#[derive(Debug)]
pub struct PreparedEpisode {
    episode: TrainingEpisode,
    stats: BTreeMap<String, FeatureStats>,
}

impl LeRobot {
    /// Opens a dataset to add episodes, or begins a new one. The end of an export that was cut off is made up for first, or what it left is
    /// removed.
    ///
    /// # Errors
    /// The folder holds anything else, or cannot be read or written.
    pub fn open(folder: PathBuf) -> Result<Self, ExportError> {
        Self::open_in(folder, Storage::default())
    }

    /// [`open`](Self::open) in a storage of which a test lets calls fail.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn open_in(folder: PathBuf, storage: Storage) -> Result<Self, ExportError> {
        let meta = folder.join("meta");
        let is_new = !meta.exists();
        if is_new && !is_empty(&folder, &storage)? {
            return Err(ExportError::dataset(
                &folder,
                "it is neither empty nor a LeRobot dataset",
            ));
        }
        storage
            .create_folders(&meta)
            .map_err(ExportError::io(&meta))?;
        let lock = FolderLock::wait(&folder, &storage);
        let commit = Commit::begin(&folder, &storage)?;
        let info = Info::read(&folder)?;
        let (tasks, stats) = match &info {
            Some(_) => (task_table::read(&folder)?, stats::read(&folder)?),
            None => Default::default(),
        };
        Ok(Self {
            next_file: place::count(&folder, "data", "parquet"),
            has_language: info.as_ref().is_none_or(Info::has_language),
            folder,
            storage,
            commit,
            info,
            tasks,
            stats,
            rows: Vec::new(),
            file: None,
            videos: BTreeMap::new(),
            next_videos: BTreeMap::new(),
            _lock: lock,
        })
    }

    /// What an export that was cut off has left in a dataset, if it has.
    ///
    /// # Errors
    /// The folder cannot be read, or its journal is none that an export writes.
    pub fn pending(folder: &Path) -> Result<Option<PendingCommit>, ExportError> {
        Commit::pending(folder, &Storage::default())
    }

    /// Leaves out the language columns, which LeRobot reads from version 0.6 on.
    #[must_use]
    pub fn without_language(self) -> Self {
        Self {
            has_language: false,
            ..self
        }
    }

    /// The number of a task's sentence.
    fn task_number(&mut self, task: &str) -> usize {
        let known = self.tasks.iter().position(|known| known == task);
        known.unwrap_or_else(|| {
            self.tasks.push(task.to_owned());
            self.tasks.len() - 1
        })
    }

    /// The file that the next episode goes to.
    fn file_for(&mut self, episode: &TrainingEpisode) -> Result<&mut DataFile, ExportError> {
        if self.file.as_ref().is_some_and(DataFile::is_full) {
            self.close_file()?;
        }
        let file = match self.file.take() {
            Some(file) => file,
            None => {
                let place = DataPlace::of(self.next_file);
                self.next_file += 1;
                let (path, file) = self.commit.create(
                    &place.path("data", "parquet"),
                    &self.folder,
                    &self.storage,
                )?;
                DataFile::new(path, file, place, episode, self.has_language)?
            }
        };
        Ok(self.file.insert(file))
    }

    /// Adds the videos of an episode. Returns their places.
    fn add_videos(
        &mut self,
        episode: &TrainingEpisode,
    ) -> Result<BTreeMap<String, VideoPart>, ExportError> {
        let mut parts = BTreeMap::new();
        for camera in &episode.cameras {
            let Some(video) = &camera.video else {
                continue;
            };
            let feature = feature_of_camera(&camera.name);
            let open = self.videos.remove(&feature);
            let mut file = match open {
                Some(file) if file.is_full() => {
                    file.close()?;
                    self.new_video(&feature, video)?
                }
                Some(file) => file,
                None => self.new_video(&feature, video)?,
            };
            parts.insert(feature.clone(), file.add(video)?);
            self.videos.insert(feature, file);
        }
        Ok(parts)
    }

    fn new_video(&mut self, feature: &str, video: &EncodedVideo) -> Result<VideoFile, ExportError> {
        let kind = format!("videos/{feature}");
        let next = match self.next_videos.get(feature) {
            Some(next) => *next,
            None => place::count(&self.folder, &kind, "mp4"),
        };
        self.next_videos.insert(feature.to_owned(), next + 1);
        let place = DataPlace::of(next);
        let (path, file) =
            self.commit
                .create(&place.path(&kind, "mp4"), &self.folder, &self.storage)?;
        VideoFile::new(path, file, place, video)
    }

    fn close_file(&mut self) -> Result<(), ExportError> {
        match self.file.take() {
            Some(file) => file.close(),
            None => Ok(()),
        }
    }
}

impl DatasetFormat for LeRobot {
    type Prepared = PreparedEpisode;

    fn prepare(episode: TrainingEpisode) -> Result<PreparedEpisode, ExportError> {
        let stats = stats::of_episode(&episode);
        Ok(PreparedEpisode { episode, stats })
    }

    fn write(&mut self, prepared: PreparedEpisode) -> Result<usize, ExportError> {
        let PreparedEpisode { episode, mut stats } = prepared;
        let unfit = |problem: String| ExportError::Unfit {
            recording: episode.folder.clone(),
            problem,
        };
        let mut info = match &self.info {
            Some(info) => info.clone(),
            None => Info::of(&episode, self.has_language),
        };
        info.check(&episode, self.has_language).map_err(unfit)?;
        let task = self.task_number(&episode.task);
        let row = EpisodeRow {
            number: info.total_episodes,
            task: episode.task.clone(),
            task_number: task,
            frames: episode.len(),
            first_frame: info.total_frames,
            ..EpisodeRow::default()
        };
        let file = self.file_for(&episode)?;
        file.write(&episode, &row)?;
        let place = file.place();
        let videos = self.add_videos(&episode)?;
        stats.extend(stats::of_counters(
            &episode,
            [row.number, row.first_frame, row.task_number],
        ));
        for (feature, new) in &stats {
            match self.stats.get_mut(feature) {
                Some(all) => all.merge(new),
                None => drop(self.stats.insert(feature.clone(), new.clone())),
            }
        }
        info.total_episodes += 1;
        info.total_frames += episode.len();
        self.info = Some(info);
        self.rows.push(EpisodeRow {
            place,
            videos,
            stats,
            ..row
        });
        Ok(episode.len())
    }

    fn finish(mut self) -> Result<(), ExportError> {
        self.close_file()?;
        for (_, video) in std::mem::take(&mut self.videos) {
            video.close()?;
        }
        let Some(mut info) = self.info.take() else {
            return Ok(());
        };
        info.total_tasks = self.tasks.len();
        if let Some(first) = self.rows.first() {
            let place = first.place;
            let table = episode_table::write(&self.rows, place)?;
            let path = place.path("meta/episodes", "parquet");
            self.commit
                .add(&path, &table, &self.folder, &self.storage)?;
        }
        for (path, bytes) in [
            ("meta/tasks.parquet", task_table::write(&self.tasks)?),
            ("meta/stats.json", stats::write(&self.stats)),
            ("meta/info.json", info.write()),
        ] {
            self.commit
                .add(Path::new(path), &bytes, &self.folder, &self.storage)?;
        }
        self.commit.end(&self.folder, &self.storage)
    }
}

/// True if a folder is missing or holds nothing.
fn is_empty(folder: &Path, storage: &Storage) -> Result<bool, ExportError> {
    match folder.exists() {
        false => Ok(true),
        true => {
            let entries = storage.entries(folder).map_err(ExportError::io(folder))?;
            Ok(entries.is_empty())
        }
    }
}
