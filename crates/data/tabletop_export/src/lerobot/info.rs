//! `meta/info.json`: the features of a dataset and its totals.

use std::{io::ErrorKind, ops::RangeInclusive, path::Path};

use serde_json::{Map, Value, json};
use tabletop_core::TICKS_PER_SECOND;
use tabletop_storage::{InnerFile, InnerPath};
use tabletop_training::{CameraTrack, EncodedVideo, FrameVectors, TrainingEpisode};

use super::place::{FILES_PER_CHUNK, MOST_FILE_BYTES};
use crate::error::ExportError;

const MOST_BYTES: u64 = 64 * 1024 * 1024;

/// Frames a second: no more than ticks.
const RATES: RangeInclusive<u32> = 1..=TICKS_PER_SECOND;

const LANGUAGE: [&str; 2] = ["language_persistent", "language_events"];

/// The features of a dataset and its totals.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Info {
    /// The file as it was read, with everything that others have written into it.
    rest: Map<String, Value>,
    features: Map<String, Value>,
    fps: u32,
    pub total_episodes: usize,
    pub total_frames: usize,
    pub total_tasks: usize,
}

impl Info {
    /// Its path in a dataset.
    pub const PATH: &str = "meta/info.json";

    /// The features of an episode.
    pub fn of(episode: &TrainingEpisode, has_language: bool) -> Self {
        let mut rest = Map::new();
        rest.insert("codebase_version".into(), json!("v3.0"));
        Self {
            rest,
            features: features_of(episode, has_language),
            fps: episode.fps,
            total_episodes: 0,
            total_frames: 0,
            total_tasks: 0,
        }
    }

    /// That of a dataset, if there is one.
    pub fn read(folder: &Path) -> Result<Option<Self>, ExportError> {
        let file = InnerFile::new(folder, InnerPath::fixed(Self::PATH));
        let path = file.path();
        let bytes = match file.read(MOST_BYTES) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(ExportError::io(&path)(error)),
        };
        let rest: Map<String, Value> =
            serde_json::from_slice(&bytes).map_err(|error| ExportError::dataset(&path, error))?;
        if rest.get("codebase_version") != Some(&json!("v3.0")) {
            return Err(ExportError::dataset(
                &path,
                "expected a dataset of version v3.0",
            ));
        }
        let number = |name: &str| {
            let number = rest.get(name).and_then(Value::as_u64);
            number.ok_or_else(|| ExportError::dataset(&path, format!("it has no number {name}")))
        };
        let fps = number("fps")?;
        let rate = u32::try_from(fps).ok().filter(|fps| RATES.contains(fps));
        let fps = rate.ok_or_else(|| {
            let (least, most) = RATES.into_inner();
            let problem = format!("its fps is {fps}, expected {least} to {most}");
            ExportError::dataset(&path, problem)
        })?;
        let features = rest.get("features").and_then(Value::as_object).cloned();
        Ok(Some(Self {
            features: features.ok_or_else(|| ExportError::dataset(&path, "it has no features"))?,
            fps,
            total_episodes: number("total_episodes")? as usize,
            total_frames: number("total_frames")? as usize,
            total_tasks: number("total_tasks")? as usize,
            rest,
        }))
    }

    /// Its features, by their names.
    pub const fn features(&self) -> &Map<String, Value> {
        &self.features
    }

    /// The features that are videos.
    pub fn videos(&self) -> impl Iterator<Item = &String> {
        let features = self.features.iter();
        features.filter_map(|(name, feature)| (feature["dtype"] == "video").then_some(name))
    }

    /// Frames a second.
    pub const fn fps(&self) -> u32 {
        self.fps
    }

    /// The sides of a feature's numbers, such as rows, columns and colours, if they are said.
    pub fn shape(&self, feature: &str) -> Option<Vec<u64>> {
        let sides = self.features.get(feature)?.get("shape")?.as_array()?;
        sides.iter().map(Value::as_u64).collect()
    }

    /// What it says of the dataset that is not so, if it does: there are so many episodes, frames and tasks.
    pub fn contradiction(&self, [episodes, frames, tasks]: [usize; 3]) -> Option<String> {
        let said = [self.total_episodes, self.total_frames, self.total_tasks];
        (said != [episodes, frames, tasks]).then(|| {
            format!(
                "{} says {} episodes with {} frames of {} tasks, and the tables hold {episodes} with {frames} of {tasks}",
                Self::PATH, said[0], said[1], said[2]
            )
        })
    }

    /// True if the dataset has language columns.
    pub fn has_language(&self) -> bool {
        self.features.contains_key(LANGUAGE[0])
    }

    /// The reason why an episode does not fit, if it does not.
    pub fn check(&self, episode: &TrainingEpisode, has_language: bool) -> Result<(), String> {
        if episode.is_empty() {
            return Err("it has no frame".into());
        }
        if episode.fps != self.fps {
            return Err(format!(
                "it has {} frames a second, the dataset has {}",
                episode.fps, self.fps
            ));
        }
        let features = features_of(episode, has_language);
        for (name, feature) in &features {
            match self.features.get(name) {
                Some(known) if says_all_of(known, feature) => {}
                Some(known) => {
                    return Err(format!(
                        "its {name} is {}, that of the dataset {}",
                        described(feature),
                        described(known)
                    ));
                }
                None => return Err(format!("it has {name}, which the dataset has not")),
            }
        }
        match self
            .features
            .keys()
            .find(|name| !features.contains_key(*name))
        {
            Some(name) => Err(format!("it lacks {name}, which the dataset has")),
            None => Ok(()),
        }
    }

    /// The text of the file.
    pub fn write(&self) -> Vec<u8> {
        let video_path = self
            .videos()
            .next()
            .map(|_| "videos/{video_key}/chunk-{chunk_index:03d}/file-{file_index:03d}.mp4");
        let defaults = json!({
            "codebase_version": "v3.0",
            "fps": self.fps,
            "features": self.features,
            "total_episodes": self.total_episodes,
            "total_frames": self.total_frames,
            "total_tasks": self.total_tasks,
            "chunks_size": FILES_PER_CHUNK,
            "data_files_size_in_mb": MOST_FILE_BYTES / 1_000_000,
            "video_files_size_in_mb": 200,
            "data_path": "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet",
            "video_path": video_path,
            "robot_type": "tabletop",
            "splits": { "train": format!("0:{}", self.total_episodes) },
        });
        let mut all = self.rest.clone();
        if let Value::Object(defaults) = defaults {
            for (key, value) in defaults {
                let is_fixed = matches!(key.as_str(), "robot_type" | "video_path" | "chunks_size");
                if !(is_fixed && all.contains_key(&key)) {
                    all.insert(key, value);
                }
            }
        }
        let mut text = serde_json::to_vec_pretty(&all).unwrap_or_default();
        text.push(b'\n');
        text
    }
}

/// The features of an episode, in the order of their columns.
fn features_of(episode: &TrainingEpisode, has_language: bool) -> Map<String, Value> {
    let mut features = Map::new();
    for (name, signal) in signals_of(episode) {
        features.insert(
            name.into(),
            json!({ "dtype": "float32", "shape": [signal.names.len()], "names": signal.names }),
        );
    }
    for camera in &episode.cameras {
        let size = camera.size();
        let mut feature = json!({
            "dtype": "image",
            "shape": [size[0], size[1], 3],
            "names": ["height", "width", "channels"],
        });
        if let Some(EncodedVideo { track, .. }) = &camera.video {
            feature["dtype"] = json!("video");
            feature["info"] = json!({
                "video.height": track.height, "video.width": track.width, "video.codec": "av1",
                "video.pix_fmt": "yuv420p", "video.is_depth_map": false, "video.fps": track.fps,
                "video.channels": 3, "has_audio": false,
            });
        }
        features.insert(feature_of_camera(&camera.name), feature);
    }
    for camera in &episode.cameras {
        let size = camera.size();
        for (name, dtype) in raw_features(camera) {
            let feature = json!({ "dtype": dtype, "shape": size, "names": ["height", "width"] });
            features.insert(name, feature);
        }
    }
    for name in LANGUAGE.into_iter().filter(|_| has_language) {
        let language = json!({ "dtype": "language", "shape": [1], "names": null });
        features.insert(name.into(), language);
    }
    for (name, dtype) in [
        ("timestamp", "float32"),
        ("frame_index", "int64"),
        ("episode_index", "int64"),
        ("index", "int64"),
        ("task_index", "int64"),
    ] {
        let counter = json!({ "dtype": dtype, "shape": [1], "names": null });
        features.insert(name.into(), counter);
    }
    features
}

/// The feature of a frame's state.
pub(super) const STATE: &str = "observation.state";
/// The feature of the poses of the objects beside it.
pub(super) const ENVIRONMENT: &str = "observation.environment_state";
/// The feature of the action from a frame to the next.
pub(super) const ACTION: &str = "action";

/// The features of an episode that are numbers for each frame.
pub(super) fn signals_of(
    episode: &TrainingEpisode,
) -> impl Iterator<Item = (&'static str, &FrameVectors)> {
    let signals = [
        (STATE, &episode.state),
        (ENVIRONMENT, &episode.environment),
        (ACTION, &episode.action),
    ];
    let is_there =
        |(name, signal): &(&str, &FrameVectors)| *name != ENVIRONMENT || !signal.names.is_empty();
    signals.into_iter().filter(is_there)
}

/// The feature of a camera's pictures.
pub(super) fn feature_of_camera(camera: &str) -> String {
    format!("observation.images.{camera}")
}

/// The features of a camera's pixels besides their colours, each with the type of its numbers.
fn raw_features(camera: &CameraTrack) -> Vec<(String, &'static str)> {
    let depth = (!camera.depths.is_empty()).then(|| (feature_of_depth(&camera.name), "float32"));
    let ids = (!camera.ids.is_empty()).then(|| (feature_of_ids(&camera.name), "int32"));
    depth.into_iter().chain(ids).collect()
}

/// The feature of a camera's distances.
pub(super) fn feature_of_depth(camera: &str) -> String {
    format!("observation.depth.{camera}")
}

/// The feature of the things that a camera's pixels show.
pub(super) fn feature_of_ids(camera: &str) -> String {
    format!("observation.ids.{camera}")
}

/// True if what is known of a feature says all that this one does. LeRobot's tools add how videos were encoded.
fn says_all_of(known: &Value, feature: &Value) -> bool {
    match (known, feature) {
        (Value::Object(known), Value::Object(feature)) => feature.iter().all(|(name, value)| {
            let known = known.get(name);
            known.is_some_and(|known| says_all_of(known, value))
        }),
        _ => known == feature,
    }
}

/// A feature in a few words.
fn described(feature: &Value) -> String {
    let names = feature["names"].as_array().filter(|names| names.len() > 3);
    match names {
        Some(names) => {
            let first: Vec<_> = names.iter().take(3).filter_map(Value::as_str).collect();
            format!("{} numbers ({}, …)", names.len(), first.join(", "))
        }
        None => format!("{} of {}", feature["dtype"], feature["shape"]),
    }
}
