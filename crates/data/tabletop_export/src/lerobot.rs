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
mod episode_rows;
mod episode_table;
mod info;
mod language;
mod page_header;
mod place;
mod read_columns;
mod reader;
mod repair;
mod stats;
mod table;
mod table_file;
mod task_table;
mod video_file;

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use tabletop_storage::{InnerPath, Storage, WriterLock, is_taken};
use tabletop_training::{EncodedVideo, FeatureStats, TrainingEpisode};

use self::{
    commit::Commit,
    data_file::DataFile,
    episode_table::{EpisodeRow, VideoPart},
    info::{Info, feature_of_camera},
    place::{DataPlace, FileSeries},
    reader::FrameTables,
    video_file::VideoFile,
};
pub use self::{
    commit::PendingCommit, dataset_videos::DatasetVideos, reader::LeRobotReader,
    repair::LeRobotRepair,
};
use crate::{error::ExportError, format::DatasetFormat};

/// A LeRobot dataset (v3.0) in a folder, to which episodes are added. Its pictures are PNG files in the table of frames, so that nothing is lost;
/// those of cameras with a [video](tabletop_training::CameraTrack::video) are videos instead.
#[derive(Debug)]
pub struct LeRobot {
    folder: PathBuf,
    commit: Commit,
    info: Option<Info>,
    tasks: Vec<String>,
    stats: BTreeMap<String, FeatureStats>,
    rows: Vec<EpisodeRow>,
    file: Option<DataFile>,
    /// The videos that get episodes, by their features, and the numbers of the next ones.
    videos: BTreeMap<String, VideoFile>,
    next_videos: BTreeMap<String, DataPlace>,
    next_place: DataPlace,
    has_language: bool,
    /// Nobody else writes to it meanwhile.
    _lock: WriterLock,
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
    /// Another program writes there and the storage is not to wait for it; or the folder holds anything else, or cannot be read or written.
    pub fn open(folder: PathBuf, storage: &Storage) -> Result<Self, ExportError> {
        require_own(&folder, storage)?;
        storage
            .create_folders(&folder)
            .map_err(ExportError::io(&folder))?;
        let lock = WriterLock::of_folder(&folder, storage).map_err(ExportError::io(&folder))?;
        // Meanwhile, another format's export may have been there.
        require_own(&folder, storage)?;
        let meta = folder.join("meta");
        storage
            .create_folders(&meta)
            .map_err(ExportError::io(&meta))?;
        let commit = Commit::begin(&folder, storage)?;
        let info = Info::read(&folder)?;
        let tables = FrameTables::count(&folder)?;
        let tasks = match &info {
            Some(_) => task_table::read(&folder)?,
            None => Vec::new(),
        };
        let contradiction = match &info {
            Some(info) => info.contradiction([tables.episodes, tables.frames, tasks.len()]),
            None => (!tables.places.is_empty()).then(|| {
                "it has tables of frames, and no meta/info.json that says of what".to_owned()
            }),
        };
        if let Some(problem) = contradiction {
            return Err(ExportError::dataset(&folder, problem));
        }
        let stats = match &info {
            Some(info) => stats::read(&folder, info)?,
            None => BTreeMap::new(),
        };
        // The tables of episodes have places of their own if somebody else has written them.
        let taken = FileSeries::episodes().places(&folder)?;
        Ok(Self {
            next_place: DataPlace::after(tables.places.into_iter().chain(taken)),
            has_language: info.as_ref().is_some_and(Info::has_language),
            folder,
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

    /// Makes up for an export that was cut off, or removes what it left; then lets the totals and statistics be those of the tables.
    ///
    /// # Errors
    /// As [`open`](Self::open); or statistics are to be counted anew, and the tables have none of the episodes.
    pub fn repair(folder: &Path, storage: &Storage) -> Result<LeRobotRepair, ExportError> {
        LeRobotRepair::of(folder, storage)
    }

    /// Writes the parts of the tasks and other words for them into language columns. Their rows have lists of any length, so what loads such a dataset
    /// in batches needs a collate function, such as LeRobot's own from version 0.6 on.
    #[must_use]
    pub fn with_language(self) -> Self {
        Self {
            has_language: true,
            ..self
        }
    }

    /// Whether it has language columns: of this export, or of those before it.
    pub const fn has_language(&self) -> bool {
        self.has_language
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
                let place = self.next_place;
                self.next_place = DataPlace::after([place]);
                let (path, file) = self.commit.create(&place.path(&FileSeries::frames()))?;
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
                Some(file) if file.takes(video) => file,
                Some(file) => {
                    file.close()?;
                    self.new_video(&feature, video)?
                }
                None => self.new_video(&feature, video)?,
            };
            parts.insert(feature.clone(), file.add(video)?);
            self.videos.insert(feature, file);
        }
        Ok(parts)
    }

    fn new_video(&mut self, feature: &str, video: &EncodedVideo) -> Result<VideoFile, ExportError> {
        let kind = FileSeries::videos(feature);
        let kind = kind.map_err(|error| ExportError::dataset(&self.folder, error))?;
        let place = match self.next_videos.get(feature) {
            Some(next) => *next,
            None => DataPlace::after(kind.places(&self.folder)?),
        };
        self.next_videos
            .insert(feature.to_owned(), DataPlace::after([place]));
        let (path, file) = self.commit.create(&place.path(&kind))?;
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
            let path = place.path(&FileSeries::episodes());
            self.commit.add(&path, &table)?;
        }
        for (path, bytes) in [
            ("meta/tasks.parquet", task_table::write(&self.tasks)?),
            ("meta/stats.json", stats::write(&self.stats)),
            ("meta/info.json", info.write()),
        ] {
            self.commit.add(&InnerPath::fixed(path), &bytes)?;
        }
        self.commit.end()
    }
}

/// Makes sure that a folder is missing, a dataset, or has nothing but what is hidden.
fn require_own(folder: &Path, storage: &Storage) -> Result<(), ExportError> {
    if !is_taken(folder) || is_taken(&folder.join("meta")) {
        return Ok(());
    }
    let entries = storage.entries(folder).map_err(ExportError::io(folder))?;
    let is_hidden = |entry: &PathBuf| {
        let name = entry.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with('.')
    };
    // Another export may just have begun it.
    let is_meta = |entry: &PathBuf| entry.file_name().is_some_and(|name| name == "meta");
    match entries.iter().any(is_meta) || entries.iter().all(is_hidden) {
        true => Ok(()),
        false => Err(ExportError::dataset(
            folder,
            "it is neither empty nor a LeRobot dataset",
        )),
    }
}
