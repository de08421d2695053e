//! LeRobot datasets, read back: episode after episode.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use arrow::{
    array::{Array, ArrayRef, AsArray as _, RecordBatch},
    datatypes::{ArrowPrimitiveType, Float32Type, Int32Type, Int64Type},
};
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use serde_json::Value;
use tabletop_core::{SimTick, TICKS_PER_SECOND};
use tabletop_storage::{Storage, Symlinks, open_regular_file};

use super::{
    commit::{Commit, PendingCommit},
    info::{Info, feature_of_depth, feature_of_ids},
    place, task_table,
};
use crate::{
    episode::{CameraTrack, FrameVectors, Subtask, TrainingEpisode},
    error::ExportError,
    image::Image,
    selection::ActionKind,
};

/// The beginning of the name of a camera's feature.
const CAMERA: &str = "observation.images.";

/// A LeRobot dataset (v3.0) whose pictures are in the table of frames, to be read. Nothing in it is changed.
#[derive(Clone, Debug)]
pub struct LeRobotReader {
    folder: PathBuf,
    info: Info,
    tasks: Vec<String>,
    files: usize,
}

/// The columns of an episode that have names.
struct Names {
    state: Vec<String>,
    action: Vec<String>,
    cameras: Vec<String>,
}

impl LeRobotReader {
    /// Opens a dataset.
    ///
    /// # Errors
    /// It is none, an export to it was cut off, or its pictures are videos.
    pub fn open(folder: &Path) -> Result<Self, ExportError> {
        if let Some(pending) = Commit::pending(folder, &Storage::default())? {
            return Err(ExportError::dataset(folder, pending.problem()));
        }
        let Some(info) = Info::read(folder)? else {
            return Err(ExportError::dataset(
                folder,
                "it is no LeRobot dataset: there is no meta/info.json",
            ));
        };
        let is_video = |feature: &Value| feature["dtype"] == "video";
        if let Some((name, _)) = info.features().iter().find(|(_, it)| is_video(it)) {
            let problem = format!("its {name} are videos, which are not read back");
            return Err(ExportError::dataset(folder, problem));
        }
        Ok(Self {
            tasks: task_table::read(folder)?,
            files: place::count(folder, "data", "parquet"),
            folder: folder.to_owned(),
            info,
        })
    }

    /// Number of its episodes, as it says.
    pub const fn episodes(&self) -> usize {
        self.info.total_episodes
    }

    /// Number of all frames, as it says.
    pub const fn frames(&self) -> usize {
        self.info.total_frames
    }

    /// Frames a second.
    pub fn fps(&self) -> u32 {
        u32::try_from(self.info.fps()).unwrap_or(u32::MAX).max(1)
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

    /// The names of the numbers of a frame's state.
    pub fn state_names(&self) -> Vec<String> {
        self.names().state
    }

    fn names(&self) -> Names {
        let features = self.info.features();
        let names = |feature: &str| {
            let names = features[feature]["names"].as_array();
            let names = names.into_iter().flatten();
            names
                .filter_map(|name| name.as_str().map(str::to_owned))
                .collect()
        };
        let cameras = features.keys().filter_map(|name| name.strip_prefix(CAMERA));
        Names {
            state: match features.contains_key("observation.state") {
                true => names("observation.state"),
                false => Vec::new(),
            },
            action: match features.contains_key("action") {
                true => names("action"),
                false => Vec::new(),
            },
            cameras: cameras.map(str::to_owned).collect(),
        }
    }

    /// Hands over its episodes, one after the other. Objects are not in a dataset, so they have none.
    ///
    /// # Errors
    /// A file cannot be read, or holds something else than an episode a row group; or `visit` fails.
    pub fn visit<E: From<ExportError>>(
        &self,
        mut visit: impl FnMut(TrainingEpisode) -> Result<(), E>,
    ) -> Result<(), E> {
        let names = self.names();
        for number in 0..self.files {
            let path = self
                .folder
                .join(place::DataPlace::of(number).path("data", "parquet"));
            let open = || {
                let file = open_regular_file(&path, Symlinks::Followed);
                let file = file.map_err(ExportError::io(&path))?;
                ParquetRecordBatchReaderBuilder::try_new(file)
                    .map_err(|error| ExportError::dataset(&path, error))
            };
            for group in 0..open()?.metadata().num_row_groups() {
                let reader = open()?;
                let rows = reader.metadata().row_group(group).num_rows();
                let rows = usize::try_from(rows).unwrap_or(0).max(1);
                let batches = reader.with_row_groups(vec![group]).with_batch_size(rows);
                let batches = batches
                    .build()
                    .and_then(|batches| batches.collect::<Result<Vec<_>, _>>().map_err(Into::into));
                let batches = batches.map_err(|error| ExportError::dataset(&path, error))?;
                for batch in &batches {
                    let episode = self.episode(batch, &names);
                    let episode = episode.map_err(|problem| {
                        ExportError::dataset(&path, format!("row group {group}: {problem}"))
                    })?;
                    visit(episode)?;
                }
            }
        }
        Ok(())
    }

    fn episode(&self, batch: &RecordBatch, names: &Names) -> Result<TrainingEpisode, String> {
        let numbers = whole_numbers(batch, "episode_index")?;
        let number = *numbers.first().ok_or("it has no frame")?;
        if numbers.iter().any(|other| *other != number) {
            return Err("it has frames of several episodes".into());
        }
        let task = *whole_numbers(batch, "task_index")?
            .first()
            .ok_or("it has no frame")?;
        let task = usize::try_from(task).ok().and_then(|it| self.tasks.get(it));
        let frames = batch.num_rows();
        let cameras = names.cameras.iter().map(|camera| {
            let images = images(column(batch, &format!("{CAMERA}{camera}"))?)?;
            let name = camera.clone();
            let depths = rows_of::<Float32Type>(batch, &feature_of_depth(camera))?;
            let ids = rows_of::<Int32Type>(batch, &feature_of_ids(camera))?;
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
        let ticks_per_frame = u64::from(TICKS_PER_SECOND) / u64::from(self.fps());
        let (paraphrases, subtasks) = self.language(batch)?;
        let is_hand = |name: &String| name.ends_with("_hand.grip");
        Ok(TrainingEpisode {
            folder: self.folder.join(format!("episode {number}")),
            fps: self.fps(),
            ticks: (0..frames as u64)
                .map(|frame| SimTick(frame * ticks_per_frame))
                .collect(),
            state: vectors(batch, "observation.state", &names.state)?,
            action: vectors(batch, "action", &names.action)?,
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
        })
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

fn column<'b>(batch: &'b RecordBatch, name: &str) -> Result<&'b ArrayRef, String> {
    let column = batch.column_by_name(name);
    column.ok_or_else(|| format!("there is no column {name}"))
}

fn whole_numbers<'b>(batch: &'b RecordBatch, name: &str) -> Result<&'b [i64], String> {
    let numbers = column(batch, name)?.as_primitive_opt::<Int64Type>();
    let numbers = numbers.ok_or_else(|| format!("{name} has other than whole numbers"))?;
    Ok(numbers.values())
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

/// The numbers in each row of a column, whatever lists they are in; none if there is no such column.
fn rows_of<N: ArrowPrimitiveType>(
    batch: &RecordBatch,
    name: &str,
) -> Result<Vec<Vec<N::Native>>, String> {
    let Some(column) = batch.column_by_name(name) else {
        return Ok(Vec::new());
    };
    let rows = (0..column.len()).map(|row| {
        let mut values = column.slice(row, 1);
        loop {
            let inner = match (values.as_fixed_size_list_opt(), values.as_list_opt::<i32>()) {
                (Some(list), _) => {
                    let width = list.value_length() as usize;
                    let first = list.value_offset_at(0);
                    list.values().slice(first, list.len() * width)
                }
                (None, Some(list)) => {
                    let offsets = list.value_offsets();
                    let (first, last) = (offsets[0] as usize, offsets[list.len()] as usize);
                    list.values().slice(first, last - first)
                }
                (None, None) => break,
            };
            values = inner;
        }
        let numbers = values.as_primitive_opt::<N>();
        let numbers = numbers.ok_or_else(|| format!("{name} has other numbers"))?;
        Ok(numbers.values().to_vec())
    });
    rows.collect()
}

/// The pictures of a column. Frames with the same picture share one.
fn images(column: &ArrayRef) -> Result<Vec<Arc<Image>>, String> {
    let files = column
        .as_struct_opt()
        .and_then(|it| it.column_by_name("bytes"));
    let files = files.and_then(|it| it.as_binary_opt::<i32>());
    let files = files.ok_or("a column of pictures has no files")?;
    let mut images = Vec::<Arc<Image>>::new();
    for file in files.iter().flatten() {
        let image = match images.last() {
            Some(last) if last.png == file => Arc::clone(last),
            Some(_) | None => Arc::new(Image {
                png: file.to_vec(),
                ..Image::decode(file)?
            }),
        };
        images.push(image);
    }
    match images.len() == column.len() {
        true => Ok(images),
        false => Err("a frame has no picture".into()),
    }
}

impl PendingCommit {
    fn problem(self) -> String {
        format!("{self}; run `tabletop dataset repair` on it first")
    }
}
