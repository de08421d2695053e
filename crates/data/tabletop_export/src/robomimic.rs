//! robomimic: an HDF5 file with a group a demonstration.

use std::{
    f64::consts::TAU,
    path::{Path, PathBuf},
    sync::Arc,
};

use hdf5_pure::{AttrValue, Error, File, FileBuilder};
use serde_json::json;
use tabletop_storage::{Storage, WriterLock, is_taken};
use tabletop_training::{ActionKind, TrainingEpisode};

use crate::{error::ExportError, format::DatasetFormat};

/// Every so many demonstrations, one is for validation.
const VALIDATION: usize = 10;

/// The speed of a hand that an action of 1 stands for, in units/s: a free hand that crosses the table in 0.15 s.
const FASTEST: f64 = 160.0;

/// The opening of a gripper that an action of 1 stands for, in units.
const WIDEST: f64 = 2.0;

/// The compression of pictures.
const DEFLATE: u32 = 4;

/// An HDF5 file as robomimic reads it, to which demonstrations are added. Each is complete on the disk before the next one begins.
pub struct Robomimic {
    path: PathBuf,
    file: File,
    demonstrations: usize,
    frames: usize,
    /// What all demonstrations have in common, once there is one.
    env_args: Option<String>,
    /// Nobody else writes to it meanwhile.
    _lock: WriterLock,
}

impl Robomimic {
    /// Opens a file to add demonstrations, or makes a new one.
    ///
    /// # Errors
    /// Another program writes to it and the storage is not to wait for that; or it is no such file, or cannot be read or written.
    pub fn open(path: PathBuf, storage: &Storage) -> Result<Self, ExportError> {
        let lock = WriterLock::of_place(&path, storage);
        let lock = lock.map_err(ExportError::io(&path))?;
        if !is_taken(&path) {
            let bytes = empty_file().map_err(|error| failed(&path, error))?;
            let written = storage.write_new(&path, &bytes);
            written.map_err(ExportError::io(&path))?;
        }
        let file = File::open_rw(&path).map_err(|error| failed(&path, error))?;
        let data = file.group("data").map_err(|error| failed(&path, error))?;
        let attributes = data.attrs().map_err(|error| failed(&path, error))?;
        let total = attributes.get("total").and_then(AttrValue::as_i64);
        let total = total.ok_or_else(|| ExportError::dataset(&path, "data has no total"))?;
        let demonstrations = data.groups().map_err(|error| failed(&path, error))?.len();
        let frames = frames_in(&file, demonstrations).map_err(|error| failed(&path, error))?;
        if u64::try_from(total).ok() != Some(frames) {
            let problem =
                format!("its total is {total}, and its demonstrations have {frames} frames");
            return Err(ExportError::dataset(&path, problem));
        }
        let env_args = attributes.get("env_args").and_then(AttrValue::as_str);
        let env_args = env_args.filter(|_| demonstrations > 0);
        Ok(Self {
            env_args: env_args.map(str::to_owned),
            path,
            file,
            demonstrations,
            frames: frames as usize,
            _lock: lock,
        })
    }

    fn add(&self, episode: &TrainingEpisode, name: &str, env_args: &str) -> Result<(), Error> {
        let frames = episode.len() as u64;
        let root = self.file.root();
        let meta = json!({ "lang": episode.task }).to_string();
        root.create_group_with(name, |group| {
            group.set_attr("num_samples", AttrValue::I64(frames as i64));
            group.set_attr("ep_meta", AttrValue::VarLenString(meta));
        })?;
        let scale = scale(episode);
        let action = |(i, value): (usize, &f32)| f64::from(*value) / scale[i % scale.len()];
        let actions: Vec<f64> = episode
            .action
            .values
            .iter()
            .enumerate()
            .map(action)
            .collect();
        let width = episode.action.names.len() as u64;
        root.create_dataset(&format!("{name}/actions"), |set| {
            set.with_f64_data(&actions).with_shape(&[frames, width]);
        })?;
        let state = episode.whole_state();
        let states: Vec<f64> = state.values.iter().copied().map(f64::from).collect();
        let width = state.names.len() as u64;
        root.create_dataset(&format!("{name}/states"), |set| {
            set.with_f64_data(&states).with_shape(&[frames, width]);
        })?;
        let last = |frame: u64| i64::from(frame + 1 == frames);
        let done: Vec<i64> = (0..frames).map(last).collect();
        let rewards: Vec<f64> = done.iter().map(|done| *done as f64).collect();
        root.create_dataset(&format!("{name}/dones"), |set| {
            set.with_i64_data(&done);
        })?;
        root.create_dataset(&format!("{name}/rewards"), |set| {
            set.with_f64_data(&rewards);
        })?;
        let shown: Vec<_> = (0..episode.len()).collect();
        let next = shown.iter().map(|frame| (frame + 1).min(episode.len() - 1));
        self.add_observations(episode, &format!("{name}/obs"), &shown)?;
        // In the end nothing follows.
        self.add_observations(
            episode,
            &format!("{name}/next_obs"),
            &next.collect::<Vec<_>>(),
        )?;
        let data = self.file.group("data")?;
        let total = (self.frames + episode.len()) as i64;
        data.set_attr("total", AttrValue::I64(total))?;
        data.set_attr("env_args", AttrValue::VarLenString(env_args.to_owned()))?;
        self.file.commit()
    }

    /// Adds what is seen in these frames.
    fn add_observations(
        &self,
        episode: &TrainingEpisode,
        name: &str,
        shown: &[usize],
    ) -> Result<(), Error> {
        let root = self.file.root();
        root.create_group(name)?;
        let frames = shown.len() as u64;
        let state = episode.whole_state();
        let width = state.names.len();
        let states = shown
            .iter()
            .flat_map(|frame| &state.values[frame * width..][..width]);
        let states: Vec<_> = states.copied().collect();
        root.create_dataset(&format!("{name}/state"), |set| {
            set.with_f32_data(&states)
                .with_shape(&[frames, width as u64]);
        })?;
        for camera in &episode.cameras {
            let Some(first) = camera.images.first() else {
                continue;
            };
            let (height, width) = (u64::from(first.height), u64::from(first.width));
            let images = shown.iter().map(|&frame| &camera.images[frame]);
            let pixels: Vec<_> = images.flat_map(|image| &image.rgb).copied().collect();
            root.create_dataset(&format!("{name}/{}_image", camera.name), |set| {
                set.with_u8_data(&pixels)
                    .with_shape(&[frames, height, width, 3])
                    .with_chunks(&[1, height, width, 3])
                    .with_deflate(DEFLATE);
            })?;
            let shape = [frames, height, width, 1];
            let chunks = [1, height, width, 1];
            if let Some(depths) = shown_of(&camera.depths, shown) {
                root.create_dataset(&format!("{name}/{}_depth", camera.name), |set| {
                    set.with_f32_data(&depths)
                        .with_shape(&shape)
                        .with_chunks(&chunks)
                        .with_deflate(DEFLATE);
                })?;
            }
            if let Some(ids) = shown_of(&camera.ids, shown) {
                root.create_dataset(&format!("{name}/{}_ids", camera.name), |set| {
                    set.with_u16_data(&ids)
                        .with_shape(&shape)
                        .with_chunks(&chunks)
                        .with_deflate(DEFLATE);
                })?;
            }
        }
        Ok(())
    }

    /// Divides the demonstrations into those to train with and those to validate with.
    fn write_masks(&self) -> Result<(), Error> {
        let root = self.file.root();
        for (name, is_for_validation) in [("train", false), ("valid", true)] {
            let names: Vec<_> = (0..self.demonstrations)
                .filter(|number| is_to_validate(*number, self.demonstrations) == is_for_validation)
                .map(|number| format!("demo_{number}"))
                .collect();
            let mask = format!("mask/{name}");
            if self.file.dataset(&mask).is_ok() {
                root.delete(&mask)?;
            }
            let names: Vec<_> = names.iter().map(String::as_str).collect();
            if names.is_empty() {
                continue;
            }
            let mut refused = None;
            root.create_dataset(&mask, |set| {
                refused = set.with_ascii_strings(&names).map(drop).err();
            })?;
            if let Some(refused) = refused {
                return Err(refused.into());
            }
        }
        self.file.commit()
    }
}

impl DatasetFormat for Robomimic {
    type Prepared = TrainingEpisode;

    fn prepare(episode: TrainingEpisode) -> Result<TrainingEpisode, ExportError> {
        let scale = scale(&episode);
        let values = episode.action.values.iter().enumerate();
        let mut beyond =
            values.filter(|(i, value)| f64::from(value.abs()) > scale[i % scale.len()]);
        match beyond.next() {
            Some((i, value)) => Err(ExportError::Unfit {
                problem: format!(
                    "its action {} is {value}, but robomimic has none beyond {}",
                    episode.action.names[i % episode.action.names.len()],
                    scale[i % scale.len()]
                ),
                recording: episode.folder,
            }),
            None => Ok(episode),
        }
    }

    fn write(&mut self, episode: TrainingEpisode) -> Result<usize, ExportError> {
        let env_args = env_args(&episode);
        if self.env_args.get_or_insert_with(|| env_args.clone()) != &env_args {
            return Err(ExportError::Unfit {
                recording: episode.folder,
                problem: "its states, actions or frames a second are not those of the file".into(),
            });
        }
        let name = format!("data/demo_{}", self.demonstrations);
        self.add(&episode, &name, &env_args)
            .map_err(|error| failed(&self.path, error))?;
        self.demonstrations += 1;
        self.frames += episode.len();
        Ok(episode.len())
    }

    fn finish(self) -> Result<(), ExportError> {
        let path = self.path.clone();
        self.write_masks()
            .and_then(|()| self.file.close())
            .map_err(|error| failed(&path, error))
    }
}

/// Whether a demonstration of so many is for validation: every tenth, and of fewer than ten the last one. A single one is to train with.
const fn is_to_validate(number: usize, of: usize) -> bool {
    match of {
        0..=1 => false,
        2..VALIDATION => number + 1 == of,
        _ => number % VALIDATION == VALIDATION - 1,
    }
}

/// The values of pixels in these frames, if the camera has them.
fn shown_of<T: Copy>(values: &[Arc<Vec<T>>], shown: &[usize]) -> Option<Vec<T>> {
    let values_of = |&frame: &usize| values[frame].iter().copied();
    (!values.is_empty()).then(|| shown.iter().flat_map(values_of).collect())
}

/// Number of frames of so many demonstrations, which are numbered from 0 on.
fn frames_in(file: &File, demonstrations: usize) -> Result<u64, Error> {
    let frames = (0..demonstrations).map(|number| {
        let actions = file.dataset(&format!("data/demo_{number}/actions"))?;
        Ok(actions.shape()?.first().copied().unwrap_or(0))
    });
    frames.sum()
}

fn empty_file() -> Result<Vec<u8>, Error> {
    let mut file = FileBuilder::new();
    let mut data = file.create_group("data");
    data.set_attr("total", AttrValue::I64(0));
    data.set_attr("env_args", AttrValue::VarLenString("{}".into()));
    file.add_group(data.finish());
    let mask = file.create_group("mask");
    file.add_group(mask.finish());
    file.finish()
}

/// What a robomimic action of 1 stands for: of each of the hands' and end effectors' numbers, or of every joint.
fn scale(episode: &TrainingEpisode) -> Vec<f64> {
    let of_part = |name: &String| match name.rsplit_once('.') {
        Some((_, "dx" | "dy" | "dz")) => FASTEST / f64::from(episode.fps),
        Some((_, "drx" | "dry" | "drz")) => TAU / 2.0,
        Some((_, "opening")) => WIDEST,
        _ => 1.0,
    };
    match episode.action_kind {
        ActionKind::Hands | ActionKind::EndEffectors => {
            episode.action.names.iter().map(of_part).collect()
        }
        ActionKind::Joints => vec![TAU],
    }
}

/// The description of the environment, and of the meaning of states and actions.
fn env_args(episode: &TrainingEpisode) -> String {
    json!({
        "env_name": "tabletop",
        "type": 2,
        "env_kwargs": {
            "fps": episode.fps,
            "state_names": episode.whole_state().names,
            "action_names": episode.action.names,
            "action_scale": scale(episode),
        },
    })
    .to_string()
}

fn failed(path: &Path, error: Error) -> ExportError {
    if let Error::Io(error) = error {
        return ExportError::io(path)(error);
    }
    ExportError::dataset(path, error)
}
