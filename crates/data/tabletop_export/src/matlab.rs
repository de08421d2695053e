//! MATLAB: a `.mat` file (v7.3) an episode.

use std::fmt::Display;

use hdf5_pure::mat::{MatBuilder, MatError, Options};
use tabletop_training::{CameraTrack, FrameVectors, Image, TrainingEpisode};

use crate::episode_files::{EpisodeFile, EpisodeFiles};

/// A folder with a `.mat` file an episode: numbers and pictures as arrays, names and sentences as texts, a line each.
pub type Matlab = EpisodeFiles<MatlabFile>;

/// A `.mat` file.
#[derive(Debug)]
pub struct MatlabFile;

impl EpisodeFile for MatlabFile {
    const ENDING: &'static str = ".mat";

    fn content(episode: &TrainingEpisode) -> Result<Vec<u8>, impl Display> {
        file_of(episode)
    }
}

fn file_of(episode: &TrainingEpisode) -> Result<Vec<u8>, MatError> {
    let mut file = MatBuilder::new(Options::default());
    let frames = episode.len();
    file.write_scalar_f64("fps", f64::from(episode.fps))?;
    file.write_char("task", &episode.task)?;
    let ticks: Vec<f64> = episode.ticks.iter().map(|tick| tick.0 as f64).collect();
    file.write_f64("ticks", &[frames, 1], &ticks)?;
    for (name, signal) in [
        ("state", &episode.whole_state()),
        ("action", &episode.action),
    ] {
        file.write_f32(name, &[frames, signal.names.len()], &by_columns(signal))?;
        file.write_char(&format!("{name}_names"), &signal.names.join("\n"))?;
    }
    let starts: Vec<f64> = episode
        .subtasks
        .iter()
        .map(|part| part.frame as f64 + 1.0)
        .collect();
    let parts: Vec<_> = episode
        .subtasks
        .iter()
        .map(|part| part.sentence.as_str())
        .collect();
    if !parts.is_empty() {
        file.write_f64("subtask_frames", &[starts.len(), 1], &starts)?;
        file.write_char("subtasks", &parts.join("\n"))?;
    }
    for camera in &episode.cameras {
        if let Some(first) = camera.images.first() {
            let size = [first.height as usize, first.width as usize, 3, frames];
            let name = format!("{}_image", camera.name);
            file.write_u8(&name, &size, &planes(camera))?;
            let size = [first.height as usize, first.width as usize, frames];
            if !camera.depths.is_empty() {
                let depths = camera
                    .depths
                    .iter()
                    .flat_map(|depths| columns(depths, first));
                let depths: Vec<f32> = depths.collect();
                file.write_f32(&format!("{}_depth", camera.name), &size, &depths)?;
            }
            if !camera.ids.is_empty() {
                let ids = camera.ids.iter().flat_map(|ids| columns(ids, first));
                let ids: Vec<u16> = ids.collect();
                file.write_u16(&format!("{}_ids", camera.name), &size, &ids)?;
            }
        }
    }
    file.finish()
}

/// The numbers of a signal, each for all frames after the one before.
fn by_columns(signal: &FrameVectors) -> Vec<f32> {
    let width = signal.names.len();
    (0..width)
        .flat_map(|column| signal.frames().map(move |frame| frame[column]))
        .collect()
}

/// The pictures as MATLAB has them: column by column, colour by colour, frame by frame.
fn planes(camera: &CameraTrack) -> Vec<u8> {
    let mut planes = Vec::new();
    for image in &camera.images {
        let (width, height) = (image.width as usize, image.height as usize);
        for color in 0..3 {
            for column in 0..width {
                let rows = (0..height).map(|row| image.rgb[(row * width + column) * 3 + color]);
                planes.extend(rows);
            }
        }
    }
    planes
}

/// The values of a picture's pixels, column by column.
fn columns<T: Copy>(values: &[T], picture: &Image) -> Vec<T> {
    let (width, height) = (picture.width as usize, picture.height as usize);
    let places = (0..width).flat_map(|column| (0..height).map(move |row| row * width + column));
    places.map(|place| values[place]).collect()
}
