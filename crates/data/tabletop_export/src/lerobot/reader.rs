//! LeRobot datasets, read back: episode after episode.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use arrow_array::{
    Array as _, ArrayRef, RecordBatch,
    cast::AsArray as _,
    types::{Float32Type, Int32Type},
};
use tabletop_storage::{InnerFile, InnerPath, Storage, WriterLock, WritingProgram};
use tabletop_training::{
    ActionKind, CameraTrack, FrameVectors, Image, Subtask, TrainingEpisode, ticks_of,
};

use super::{
    commit::{Commit, PendingCommit},
    dataset_videos::DatasetVideos,
    episode_rows::EpisodeRows,
    info::{ACTION, ENVIRONMENT, Info, STATE, feature_of_camera, feature_of_depth, feature_of_ids},
    place::{DataPlace, FileSeries},
    read_columns::{column, rows_of, whole_numbers},
    table_file::TableFile,
    task_table,
};
use crate::error::ExportError;

/// The beginning of the name of a camera's feature.
const CAMERA: &str = "observation.images.";

/// A LeRobot dataset (v3.0), to be read. Nothing in it is changed. Pictures in the table of frames are decoded, videos are only copied.
#[derive(Clone, Debug)]
pub struct LeRobotReader {
    folder: PathBuf,
    info: Info,
    tasks: Vec<String>,
    tables: FrameTables,
}

/// The columns of an episode that have names.
struct Names {
    state: Vec<String>,
    environment: Vec<String>,
    action: Vec<String>,
    cameras: Vec<String>,
}

impl LeRobotReader {
    /// Opens a dataset.
    ///
    /// # Errors
    /// It is none, somebody writes to it, or an export to it was cut off.
    pub fn open(folder: &Path) -> Result<Self, ExportError> {
        loop {
            let reader = Self::read(folder);
            let storage = Storage::default();
            if let Some(writer) = WriterLock::writer_in(folder, &storage) {
                return Err(ExportError::dataset(folder, in_use(&writer)));
            }
            if let Some(pending) = Commit::pending(folder, &storage)? {
                return Err(ExportError::dataset(folder, pending.problem()));
            }
            let reader = reader?;
            // Otherwise, an export has ended meanwhile.
            if Info::read(folder)?.as_ref() == Some(&reader.info) {
                return Ok(reader);
            }
        }
    }

    fn read(folder: &Path) -> Result<Self, ExportError> {
        let Some(info) = Info::read(folder)? else {
            return Err(ExportError::dataset(
                folder,
                "it is no LeRobot dataset: there is no meta/info.json",
            ));
        };
        for feature in info.videos() {
            let videos = FileSeries::videos(feature);
            videos.map_err(|error| ExportError::dataset(folder, error))?;
        }
        Ok(Self {
            tasks: task_table::read(folder)?,
            tables: FrameTables::count(folder)?,
            folder: folder.to_owned(),
            info,
        })
    }

    /// Number of its episodes, as its tables have them.
    pub const fn episodes(&self) -> usize {
        self.tables.episodes
    }

    /// Number of all frames, as its tables have them.
    pub const fn frames(&self) -> usize {
        self.tables.frames
    }

    /// What it says of itself that its tables do not show.
    pub fn contradiction(&self) -> Option<String> {
        let FrameTables {
            episodes, frames, ..
        } = self.tables;
        self.info
            .contradiction([episodes, frames, self.tasks.len()])
    }

    /// Frames a second.
    pub const fn fps(&self) -> u32 {
        self.info.fps()
    }

    /// The sentences of its tasks.
    pub fn tasks(&self) -> &[String] {
        &self.tasks
    }

    /// The names of its cameras.
    pub fn cameras(&self) -> Vec<String> {
        self.names().cameras
    }

    /// True if it has language columns.
    pub fn has_language(&self) -> bool {
        self.info.has_language()
    }

    /// Its videos; none if all pictures are in the table of frames.
    ///
    /// # Errors
    /// The table of episodes cannot be read, or does not say where the videos of each are.
    pub fn videos(&self) -> Result<DatasetVideos, ExportError> {
        let features = self.info.videos().cloned().collect();
        DatasetVideos::open(&self.folder, features, self.fps())
    }

    /// The names of the numbers of a frame's state, and of the poses beside it.
    pub fn state_names(&self) -> Vec<String> {
        let names = self.names();
        [names.state, names.environment].concat()
    }

    fn names(&self) -> Names {
        let features = self.info.features();
        let names = |feature: &str| {
            let names = features.get(feature).and_then(|it| it["names"].as_array());
            let names = names.into_iter().flatten();
            names
                .filter_map(|name| name.as_str().map(str::to_owned))
                .collect()
        };
        let cameras = features.keys().filter_map(|name| name.strip_prefix(CAMERA));
        Names {
            state: names(STATE),
            environment: names(ENVIRONMENT),
            action: names(ACTION),
            cameras: cameras.map(str::to_owned).collect(),
        }
    }

    /// Hands over its episodes, one after the other. Objects are not in a dataset, so they have none.
    ///
    /// # Errors
    /// A file cannot be read, or holds something else than an episode a row group; what it says of itself is not so; or `visit` fails.
    pub fn visit<E: From<ExportError>>(
        &self,
        mut visit: impl FnMut(TrainingEpisode) -> Result<(), E>,
    ) -> Result<(), E> {
        if let Some(problem) = self.contradiction() {
            return Err(ExportError::dataset(&self.folder, problem).into());
        }
        let mut videos = self.videos()?;
        self.visit_tables(|number, mut episode| {
            for camera in &mut episode.cameras {
                let feature = feature_of_camera(&camera.name);
                camera.video = videos.copy(&feature, number, episode.ticks.len())?;
            }
            // What is no part of the episode would be lost with every copy.
            let fits = self.info.check(&episode, self.has_language());
            fits.map_err(|problem| ExportError::dataset(&episode.folder, problem))?;
            visit(episode)
        })
    }

    /// Hands over the numbers of its episodes and the episodes, without their videos.
    ///
    /// # Errors
    /// As [`visit`](Self::visit).
    pub fn visit_tables<E: From<ExportError>>(
        &self,
        mut visit: impl FnMut(usize, TrainingEpisode) -> Result<(), E>,
    ) -> Result<(), E> {
        let names = self.names();
        let mut visited = 0;
        for &place in &self.tables.places {
            let table = frame_table(&self.folder, place)?;
            for rows in EpisodeRows::of(&table)? {
                let rows = rows?;
                let fault = |problem: String| ExportError::dataset(table.path(), problem);
                let (number, episode) = self
                    .episode(&rows, &names)
                    .map_err(|problem| fault(format!("episode {visited}: {problem}")))?;
                if number != visited {
                    let problem = format!("it holds episode {number}, expected episode {visited}");
                    return Err(fault(problem).into());
                }
                visit(number, episode)?;
                visited += 1;
            }
        }
        Ok(())
    }

    fn episode(
        &self,
        batch: &RecordBatch,
        names: &Names,
    ) -> Result<(usize, TrainingEpisode), String> {
        let numbers = whole_numbers(batch, "episode_index")?;
        let number = *numbers.first().ok_or("it has no frame")?;
        let number = usize::try_from(number).map_err(|_| "its episode has a number below 0")?;
        let task = *whole_numbers(batch, "task_index")?
            .first()
            .ok_or("it has no frame")?;
        let task = usize::try_from(task).ok().and_then(|it| self.tasks.get(it));
        let frames = batch.num_rows();
        let cameras = names.cameras.iter().map(|camera| {
            let feature = feature_of_camera(camera);
            let images = match self.info.videos().any(|video| *video == feature) {
                true => Vec::new(),
                false => images(column(batch, &feature)?, self.info.shape(&feature))?,
            };
            let name = camera.clone();
            let depths = rows_of::<Float32Type>(batch, &feature_of_depth(camera))?;
            let ids = rows_of::<Int32Type>(batch, &feature_of_ids(camera))?;
            let pixels = self.info.shape(&feature).and_then(|shape| match shape[..] {
                [rows, columns, _] => usize::try_from(rows.checked_mul(columns)?).ok(),
                _ => None,
            });
            let lengths = depths.iter().map(Vec::len).chain(ids.iter().map(Vec::len));
            if lengths.into_iter().any(|length| Some(length) != pixels) {
                return Err(format!(
                    "the depths or ids of {camera} are not those of its pixels"
                ));
            }
            let ids = ids.into_iter().map(|ids| {
                let ids = ids.iter().map(|&id| u16::try_from(id).unwrap_or(u16::MAX));
                Arc::new(ids.collect())
            });
            Ok(CameraTrack {
                name,
                images,
                depths: depths.into_iter().map(Arc::new).collect(),
                video: None,
                ids: ids.collect(),
            })
        });
        let (paraphrases, subtasks) = self.language(batch)?;
        if let Some(part) = subtasks.iter().find(|part| part.frame >= frames) {
            let frame = part.frame;
            return Err(format!(
                "a part of its task begins in frame {frame} of {frames}"
            ));
        }
        let is_hand = |name: &String| name.ends_with("_hand.grip");
        let episode = TrainingEpisode {
            folder: InnerPath::numbered("episode ", number as u64, "").below(&self.folder),
            fps: self.fps(),
            ticks: ticks_of(frames, self.fps()).collect(),
            state: vectors(batch, STATE, &names.state)?,
            environment: match names.environment.is_empty() {
                true => FrameVectors::default(),
                false => vectors(batch, ENVIRONMENT, &names.environment)?,
            },
            action: vectors(batch, ACTION, &names.action)?,
            action_kind: match names.action.iter().any(is_hand) {
                true => ActionKind::Hands,
                false => ActionKind::Joints,
            },
            objects: Vec::new(),
            cameras: cameras.collect::<Result<_, String>>()?,
            task: task
                .ok_or("it has a task that meta/tasks.parquet lacks")?
                .clone(),
            paraphrases,
            subtasks,
        };
        Ok((number, episode))
    }

    /// Other words for the task, and its parts.
    fn language(&self, batch: &RecordBatch) -> Result<(Vec<String>, Vec<Subtask>), String> {
        let (mut paraphrases, mut subtasks) = (Vec::new(), Vec::new());
        if !self.has_language() {
            return Ok((paraphrases, subtasks));
        }
        let rows = column(batch, "language_persistent")?.as_list_opt::<i32>();
        let rows = rows.ok_or("language_persistent is no list")?.value(0);
        let rows = rows
            .as_struct_opt()
            .ok_or("language_persistent has no rows")?;
        let texts = |name: &str| {
            let texts = rows.column_by_name(name)?.as_string_opt::<i32>()?;
            Some(
                texts
                    .iter()
                    .map(|it| it.unwrap_or_default().to_owned())
                    .collect::<Vec<_>>(),
            )
        };
        let times = rows
            .column_by_name("timestamp")
            .and_then(|it| it.as_primitive_opt::<Float32Type>());
        let (Some(styles), Some(contents), Some(times)) = (texts("style"), texts("content"), times)
        else {
            return Err("language_persistent lacks style, content or timestamp".into());
        };
        for (row, (style, sentence)) in styles.iter().zip(contents).enumerate() {
            match style.as_str() {
                "task_aug" => paraphrases.push(sentence),
                "subtask" => subtasks.push(Subtask {
                    frame: (times.value(row) * self.fps() as f32).round() as usize,
                    sentence,
                }),
                _ => {}
            }
        }
        Ok((paraphrases, subtasks))
    }
}

fn vectors(batch: &RecordBatch, name: &str, names: &[String]) -> Result<FrameVectors, String> {
    let mut vectors = FrameVectors::new(names.to_vec());
    if names.is_empty() {
        return Ok(vectors);
    }
    let column = column(batch, name)?;
    for row in 0..column.len() {
        let value = match (column.as_fixed_size_list_opt(), column.as_list_opt::<i32>()) {
            (Some(list), _) => list.value(row),
            (None, Some(list)) => list.value(row),
            (None, None) => return Err(format!("{name} has no vectors")),
        };
        let numbers = value.as_primitive_opt::<Float32Type>();
        let numbers = numbers.ok_or_else(|| format!("{name} has other than numbers of 32 bits"))?;
        if numbers.len() != names.len() {
            let (found, expected) = (numbers.len(), names.len());
            return Err(format!("{name} has {found} numbers, expected {expected}"));
        }
        vectors.values.extend(numbers.values().iter());
    }
    Ok(vectors)
}

/// The pictures of a column, of these rows, columns and colours. Frames with the same picture share one.
fn images(column: &ArrayRef, shape: Option<Vec<u64>>) -> Result<Vec<Arc<Image>>, String> {
    let files = column
        .as_struct_opt()
        .and_then(|it| it.column_by_name("bytes"));
    let files = files.and_then(|it| it.as_binary_opt::<i32>());
    let files = files.ok_or("a column of pictures has no files")?;
    let mut images = Vec::<Arc<Image>>::new();
    for file in files.iter().flatten() {
        let image = match images.last() {
            Some(last) if last.png == file => Arc::clone(last),
            Some(_) | None => {
                let image = Image::decode(file)?;
                let found = [u64::from(image.height), u64::from(image.width), 3];
                if shape.as_ref().is_some_and(|shape| *shape != found) {
                    return Err(format!(
                        "a picture has the shape {found:?}, expected {shape:?}"
                    ));
                }
                Arc::new(Image {
                    png: file.to_vec(),
                    ..image
                })
            }
        };
        images.push(image);
    }
    match images.len() == column.len() {
        true => Ok(images),
        false => Err("a frame has no picture".into()),
    }
}

fn in_use(writer: &WritingProgram) -> String {
    format!("{writer}; read it when that has ended")
}

/// The tables of frames, as far as their heads and their numbers of episodes tell.
#[derive(Clone, Debug)]
pub(super) struct FrameTables {
    /// Their places.
    pub places: Vec<DataPlace>,
    /// Number of episodes.
    pub episodes: usize,
    /// Number of frames.
    pub frames: usize,
}

impl FrameTables {
    /// Those of a dataset.
    pub fn count(folder: &Path) -> Result<Self, ExportError> {
        let mut all = Self {
            places: FileSeries::frames().places(folder)?,
            episodes: 0,
            frames: 0,
        };
        for &place in &all.places {
            let numbers = frame_table(folder, place)?.whole_numbers("episode_index")?;
            let numbers = numbers.concat();
            all.episodes += numbers.chunk_by(|one, next| one == next).count();
            all.frames += numbers.len();
        }
        Ok(all)
    }
}

/// The table of frames at a place.
fn frame_table(folder: &Path, place: DataPlace) -> Result<TableFile, ExportError> {
    TableFile::open(&InnerFile::new(folder, place.path(&FileSeries::frames())))
}

impl PendingCommit {
    fn problem(self) -> String {
        format!("{self}; run `tabletop dataset repair` on it first")
    }
}
