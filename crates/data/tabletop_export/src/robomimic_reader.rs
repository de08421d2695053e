//! robomimic's files, read back.

use std::{path::Path, sync::Arc};

use hdf5_pure::{AttrValue, Error, File};
use serde_json::Value;
use tabletop_core::{SimTick, TICKS_PER_SECOND};
use tabletop_storage::{InnerFile, InnerPath};
use tabletop_training::{ActionKind, CameraTrack, FrameVectors, Image, TrainingEpisode};

use crate::error::ExportError;

/// Largest size of a file, in bytes: it is read as a whole.
const MOST_BYTES: u64 = 1 << 32;

/// The episodes of a file that [`Robomimic`](crate::Robomimic) has written, in their order. The file holds neither objects nor parts of the
/// task, so they have none.
///
/// # Errors
/// It cannot be read, or holds something else.
pub fn read_robomimic(path: &Path) -> Result<Vec<TrainingEpisode>, ExportError> {
    let bytes = InnerFile::at(path).and_then(|file| file.read(MOST_BYTES));
    let bytes = bytes.map_err(ExportError::io(path))?;
    let file = File::from_bytes(bytes).map_err(|error| failed(path, error))?;
    let data = file.group("data").map_err(|error| failed(path, error))?;
    let attributes = data.attrs().map_err(|error| failed(path, error))?;
    let environment = attributes.get("env_args").and_then(AttrValue::as_str);
    let environment =
        environment.ok_or_else(|| ExportError::dataset(path, "it has no env_args"))?;
    let environment: Value =
        serde_json::from_str(environment).map_err(|error| ExportError::dataset(path, error))?;
    let meaning = ColumnMeaning::of(&environment["env_kwargs"]);
    let meaning = meaning.ok_or_else(|| ExportError::dataset(path, "env_args has no names"))?;
    let groups = data.groups().map_err(|error| failed(path, error))?;
    let episodes = (0..groups.len()).map(|number| {
        let name = format!("data/demo_{number}");
        let episode = meaning.episode(&file, &name);
        episode
            .map_err(|error| failed(path, error))
            .map(|episode| TrainingEpisode {
                folder: InnerPath::numbered("demo_", number as u64, "").below(path),
                ..episode
            })
    });
    episodes.collect()
}

/// The meaning of the numbers of a file.
struct ColumnMeaning {
    fps: u32,
    state: Vec<String>,
    action: Vec<String>,
    scale: Vec<f64>,
}

impl ColumnMeaning {
    fn of(arguments: &Value) -> Option<Self> {
        let names = |name: &str| {
            let names = arguments[name].as_array()?.iter();
            names
                .map(|name| Some(name.as_str()?.to_owned()))
                .collect::<Option<Vec<_>>>()
        };
        let scale = arguments["action_scale"].as_array()?.iter();
        Some(Self {
            fps: u32::try_from(arguments["fps"].as_u64()?).ok()?.max(1),
            state: names("state_names")?,
            action: names("action_names")?,
            scale: scale.map(Value::as_f64).collect::<Option<Vec<_>>>()?,
        })
    }

    fn episode(&self, file: &File, name: &str) -> Result<TrainingEpisode, Error> {
        let group = file.group(name)?;
        let attributes = group.attrs()?;
        let meta = attributes.get("ep_meta").and_then(AttrValue::as_str);
        let meta: Value = meta
            .and_then(|it| serde_json::from_str(it).ok())
            .unwrap_or_default();
        let actions = file.dataset(&format!("{name}/actions"))?.read_f64()?;
        let scale = self.scale.iter().cycle();
        let actions = actions.iter().zip(scale);
        let observed = file.group(&format!("{name}/obs"))?;
        let mut cameras = Vec::new();
        let names = observed.datasets()?;
        for observation in &names {
            if let Some(camera) = observation.strip_suffix("_image") {
                let set = file.dataset(&format!("{name}/obs/{observation}"))?;
                let images = images(&set.shape()?, &set.read_u8()?);
                let channel = |channel: &str| {
                    let name = format!("{name}/obs/{camera}_{channel}");
                    let is_there = names.contains(&format!("{camera}_{channel}"));
                    is_there.then(|| file.dataset(&name)).transpose()
                };
                let depths = match channel("depth")? {
                    Some(set) => in_frames(&set.read_f32()?, images.len()),
                    None => Vec::new(),
                };
                let ids = match channel("ids")? {
                    Some(set) => in_frames(&set.read_u16()?, images.len()),
                    None => Vec::new(),
                };
                cameras.push(CameraTrack {
                    name: camera.to_owned(),
                    images,
                    depths,
                    video: None,
                    ids,
                });
            }
        }
        let state = file.dataset(&format!("{name}/obs/state"))?.read_f32()?;
        let frames = state.len() / self.state.len().max(1);
        let ticks_per_frame = u64::from(TICKS_PER_SECOND / self.fps);
        Ok(TrainingEpisode {
            folder: name.into(),
            fps: self.fps,
            ticks: (0..frames as u64)
                .map(|frame| SimTick(frame * ticks_per_frame))
                .collect(),
            state: FrameVectors {
                names: self.state.clone(),
                values: state,
            },
            environment: FrameVectors::default(),
            action: FrameVectors {
                names: self.action.clone(),
                values: actions
                    .map(|(action, scale)| (action * scale) as f32)
                    .collect(),
            },
            action_kind: match self.scale.len() {
                1 => ActionKind::Joints,
                _ => ActionKind::Hands,
            },
            objects: Vec::new(),
            cameras,
            task: meta["lang"].as_str().unwrap_or_default().to_owned(),
            paraphrases: Vec::new(),
            subtasks: Vec::new(),
        })
    }
}

/// The pictures in an array of frames, rows, columns and colours.
fn images(shape: &[u64], pixels: &[u8]) -> Vec<Arc<Image>> {
    let [_, height, width, 3] = *shape else {
        return Vec::new();
    };
    let size = height.saturating_mul(width).saturating_mul(3).max(1) as usize;
    let images = pixels.chunks_exact(size).map(|rgb| {
        Arc::new(Image {
            width: width as u32,
            height: height as u32,
            rgb: rgb.to_vec(),
            png: Vec::new(),
        })
    });
    images.collect()
}

/// The values of each frame.
fn in_frames<T: Clone>(values: &[T], frames: usize) -> Vec<Arc<Vec<T>>> {
    let size = (values.len() / frames.max(1)).max(1);
    let frames = values.chunks_exact(size);
    frames.map(|frame| Arc::new(frame.to_vec())).collect()
}

fn failed(path: &Path, error: Error) -> ExportError {
    if let Error::Io(error) = error {
        return ExportError::io(path)(error);
    }
    ExportError::dataset(path, error)
}
