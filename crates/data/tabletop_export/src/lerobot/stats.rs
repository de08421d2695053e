//! Statistics of features, as LeRobot normalises by them.

use std::{collections::BTreeMap, path::Path, sync::Arc};

use serde_json::{Map, Value, json};
use tabletop_storage::{InnerFile, InnerPath};
use tabletop_training::{
    CameraTrack, FeatureStats, FrameVectors, Image, QUANTILES, TrainingEpisode,
};

use super::info::{Info, feature_of_camera, signals_of};
use crate::error::ExportError;

pub(super) const PATH: &str = "meta/stats.json";
const MOST_BYTES: u64 = 64 * 1024 * 1024;

/// Number of a picture's colours.
const COLORS: u64 = 3;

/// Least and largest number of pictures that are looked at of an episode, and the exponent of its length between them.
const SAMPLES: (usize, usize, f64) = (100, 10_000, 0.75);

/// Sides from which on pictures are thinned out, and about the side that remains, in pixels.
const LARGE: (u32, u32) = (300, 150);

/// Statistics, as LeRobot writes them.
fn to_json(stats: &FeatureStats) -> Value {
    let shaped = |values: &[f64]| match stats.is_of_pictures {
        true => values.iter().map(|value| json!([[value]])).collect(),
        false => json!(values),
    };
    let mut all = Map::new();
    for (name, values) in [
        ("min", &stats.min),
        ("max", &stats.max),
        ("mean", &stats.mean),
        ("std", &stats.std),
    ] {
        all.insert(name.into(), shaped(values));
    }
    all.insert("count".into(), json!([stats.count]));
    for (values, (name, _)) in stats.quantiles.iter().zip(QUANTILES) {
        all.insert(name.into(), shaped(values));
    }
    Value::Object(all)
}

/// Statistics, as LeRobot writes them; `None` if one is missing.
fn from_json(value: &Value) -> Option<FeatureStats> {
    let numbers = |name: &str| -> Option<Vec<f64>> {
        let values = value.get(name)?.as_array()?;
        let number = |value: &Value| match value.as_array() {
            Some(inner) => inner.first()?.as_array()?.first()?.as_f64(),
            None => value.as_f64(),
        };
        values.iter().map(number).collect()
    };
    let [q01, q10, q50, q90, q99] = QUANTILES.map(|(name, _)| numbers(name));
    let min = value.get("min")?.as_array()?;
    Some(FeatureStats {
        is_of_pictures: min.first().is_some_and(Value::is_array),
        min: numbers("min")?,
        max: numbers("max")?,
        mean: numbers("mean")?,
        std: numbers("std")?,
        count: value.get("count")?.as_array()?.first()?.as_u64()?,
        quantiles: [q01?, q10?, q50?, q90?, q99?],
    })
}

/// The statistics of an episode's states, actions and pictures.
pub(super) fn of_episode(episode: &TrainingEpisode) -> BTreeMap<String, FeatureStats> {
    let signals = signals_of(episode).map(|(name, signal)| (name.to_owned(), of_signal(signal)));
    let mut all: BTreeMap<_, _> = signals.collect();
    for camera in &episode.cameras {
        all.insert(feature_of_camera(&camera.name), of_pictures(camera));
    }
    all
}

/// The statistics of the numbers that count frames, episodes and tasks: those of the episode, its first frame in the dataset, and its task.
pub(super) fn of_counters(
    episode: &TrainingEpisode,
    [number, first_frame, task_number]: [usize; 3],
) -> impl Iterator<Item = (String, FeatureStats)> {
    let frames = episode.len();
    let counter = |of: &dyn Fn(usize) -> f64| FeatureStats::of(vec![(0..frames).map(of).collect()]);
    [
        (
            "timestamp",
            counter(&|frame| f64::from(frame as f32 / episode.fps as f32)),
        ),
        ("frame_index", counter(&|frame| frame as f64)),
        ("episode_index", counter(&|_| number as f64)),
        ("index", counter(&|frame| (first_frame + frame) as f64)),
        ("task_index", counter(&|_| task_number as f64)),
    ]
    .map(|(name, stats)| (name.to_owned(), stats))
    .into_iter()
}

fn of_signal(signal: &FrameVectors) -> FeatureStats {
    let mut components = vec![Vec::new(); signal.names.len()];
    for frame in signal.frames() {
        for (samples, value) in components.iter_mut().zip(frame) {
            samples.push(f64::from(*value));
        }
    }
    FeatureStats::of(components)
}

/// The statistics of the three colours over the pixels of evenly spaced pictures; of pictures that are known only as a video, those that came with it.
fn of_pictures(camera: &CameraTrack) -> FeatureStats {
    if let Some(colors) = camera.video.as_ref().and_then(|video| video.colors.clone()) {
        return colors;
    }
    let frames = camera.images.len();
    let (least, most, power) = SAMPLES;
    let wanted = ((frames as f64).powf(power) as usize).min(most);
    let samples = wanted.max(least.min(frames));
    let mut histograms = [[0_u64; 256]; 3];
    let mut last: Option<(&Arc<Image>, [[u64; 256]; 3])> = None;
    for sample in 0..samples {
        let step = frames.saturating_sub(1) as f64 / samples.saturating_sub(1).max(1) as f64;
        let image = &camera.images[(sample as f64 * step).round() as usize];
        // Frames in which nothing changes share a picture.
        let counted = match last {
            Some((known, counted)) if Arc::ptr_eq(known, image) => counted,
            _ => colors_of(image),
        };
        for (all, of_image) in histograms.iter_mut().zip(&counted) {
            for (all, more) in all.iter_mut().zip(of_image) {
                *all += more;
            }
        }
        last = Some((image, counted));
    }
    let mut stats = FeatureStats {
        count: samples as u64,
        is_of_pictures: true,
        ..FeatureStats::default()
    };
    for histogram in &histograms {
        stats.add_histogram(histogram);
    }
    stats
}

/// How often each value of each colour is in a picture, of a large one in some of its pixels.
fn colors_of(image: &Image) -> [[u64; 256]; 3] {
    let (width, height) = (image.width, image.height);
    let (large, small) = LARGE;
    let step = match width.max(height) < large {
        true => 1,
        false => (width.max(height) / small).max(1) as usize,
    };
    let mut histograms = [[0; 256]; 3];
    let rows = image.rgb.chunks_exact(width as usize * 3).step_by(step);
    for row in rows {
        for pixel in row.chunks_exact(3).step_by(step) {
            for (histogram, value) in histograms.iter_mut().zip(pixel) {
                histogram[usize::from(*value)] += 1;
            }
        }
    }
    histograms
}

/// The text of `meta/stats.json`.
pub(super) fn write(stats: &BTreeMap<String, FeatureStats>) -> Vec<u8> {
    let all: Map<_, _> = stats
        .iter()
        .map(|(feature, stats)| (feature.clone(), to_json(stats)))
        .collect();
    serde_json::to_vec_pretty(&all).unwrap_or_default()
}

/// The statistics of a dataset with these features.
pub(super) fn read(
    folder: &Path,
    info: &Info,
) -> Result<BTreeMap<String, FeatureStats>, ExportError> {
    let file = InnerFile::new(folder, InnerPath::fixed(PATH));
    let path = file.path();
    let bytes = file.read(MOST_BYTES).map_err(ExportError::io(&path))?;
    let all: Map<String, Value> =
        serde_json::from_slice(&bytes).map_err(|error| ExportError::dataset(&path, error))?;
    all.into_iter()
        .map(|(feature, value)| {
            let stats = from_json(&value);
            let stats = stats.ok_or_else(|| {
                ExportError::dataset(&path, format!("the statistics of {feature} are incomplete"))
            })?;
            let components = info
                .shape(&feature)
                .map(|sides| match stats.is_of_pictures {
                    true => COLORS,
                    false => sides.into_iter().fold(1, u64::saturating_mul),
                });
            let is_of_each = components.is_none_or(|it| stats.components() == Some(it));
            // A video that was cut keeps the statistics of all its pictures.
            let is_counted = stats.is_of_pictures || stats.count <= info.total_frames as u64;
            match is_of_each && is_counted {
                true => Ok((feature, stats)),
                false => Err(ExportError::dataset(
                    &path,
                    format!("the statistics of {feature} are not those of each of its numbers in its frames"),
                )),
            }
        })
        .collect()
}

/// True if every statistic of numbers is of so many frames. Of pictures, only some are looked at.
pub(super) fn count_frames(stats: &BTreeMap<String, FeatureStats>, frames: usize) -> bool {
    let mut of_numbers = stats.values().filter(|stats| !stats.is_of_pictures);
    of_numbers.all(|stats| stats.count == frames as u64)
}
