//! Statistics of features, as LeRobot normalises by them.

use std::{collections::BTreeMap, path::Path, sync::Arc};

use serde_json::{Map, Value, json};
use tabletop_storage::{Symlinks, read_regular_file};

use super::info::feature_of_camera;
use crate::{
    episode::{CameraTrack, FrameVectors, TrainingEpisode},
    error::ExportError,
    image::Image,
};

const PATH: &str = "meta/stats.json";
const MOST_BYTES: u64 = 64 * 1024 * 1024;

/// The quantiles, by their names.
pub(super) const QUANTILES: [(&str, f64); 5] = [
    ("q01", 0.01),
    ("q10", 0.10),
    ("q50", 0.50),
    ("q90", 0.90),
    ("q99", 0.99),
];

/// Least and largest number of pictures that are looked at of an episode, and the exponent of its length between them.
const SAMPLES: (usize, usize, f64) = (100, 10_000, 0.75);

/// Sides from which on pictures are thinned out, and about the side that remains, in pixels.
const LARGE: (u32, u32) = (300, 150);

/// Statistics of a feature, by its components.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct FeatureStats {
    pub min: Vec<f64>,
    pub max: Vec<f64>,
    pub mean: Vec<f64>,
    pub std: Vec<f64>,
    /// Number of samples: of frames, or of pictures looked at.
    pub count: u64,
    /// In the order of [`QUANTILES`].
    pub quantiles: [Vec<f64>; 5],
    /// True for the three colours of pictures, from 0 to 1, of shape (3, 1, 1).
    pub is_of_pictures: bool,
}

impl FeatureStats {
    /// Number of lists around each number besides the outermost.
    pub const fn inner_lists(&self) -> usize {
        if self.is_of_pictures { 2 } else { 0 }
    }

    /// Statistics of components, each with all its samples.
    fn of(mut components: Vec<Vec<f64>>) -> Self {
        let mut all = Self {
            count: components.first().map_or(0, Vec::len) as u64,
            ..Self::default()
        };
        for samples in &mut components {
            let count = samples.len().max(1) as f64;
            let mean = samples.iter().sum::<f64>() / count;
            let squares = samples.iter().map(|sample| (sample - mean).powi(2));
            all.mean.push(mean);
            all.std.push((squares.sum::<f64>() / count).sqrt());
            samples.sort_by(f64::total_cmp);
            all.min.push(samples.first().copied().unwrap_or(0.0));
            all.max.push(samples.last().copied().unwrap_or(0.0));
            for (quantiles, (_, part)) in all.quantiles.iter_mut().zip(QUANTILES) {
                quantiles.push(quantile(samples, part));
            }
        }
        all
    }

    /// The statistics of these samples and others. Quantiles become bounds: the lower ones the lowest, the upper ones the highest.
    pub fn merge(&mut self, other: &Self) {
        let (ours, theirs) = (self.count as f64, other.count as f64);
        let all = (ours + theirs).max(1.0);
        for i in 0..self.mean.len().min(other.mean.len()) {
            let mean = (self.mean[i] * ours + other.mean[i] * theirs) / all;
            let spread = |mean_of: f64, std: f64| std.powi(2) + (mean_of - mean).powi(2);
            let variance = (spread(self.mean[i], self.std[i]) * ours
                + spread(other.mean[i], other.std[i]) * theirs)
                / all;
            self.min[i] = self.min[i].min(other.min[i]);
            self.max[i] = self.max[i].max(other.max[i]);
            for (place, (_, part)) in QUANTILES.iter().enumerate() {
                let (one, two) = (self.quantiles[place][i], other.quantiles[place][i]);
                self.quantiles[place][i] = match part.total_cmp(&0.5) {
                    std::cmp::Ordering::Less => one.min(two),
                    std::cmp::Ordering::Greater => one.max(two),
                    std::cmp::Ordering::Equal => (one * ours + two * theirs) / all,
                };
            }
            self.mean[i] = mean;
            self.std[i] = variance.sqrt();
        }
        self.count += other.count;
    }

    fn to_json(&self) -> Value {
        let shaped = |values: &[f64]| match self.is_of_pictures {
            true => values.iter().map(|value| json!([[value]])).collect(),
            false => json!(values),
        };
        let mut all = Map::new();
        for (name, values) in [
            ("min", &self.min),
            ("max", &self.max),
            ("mean", &self.mean),
            ("std", &self.std),
        ] {
            all.insert(name.into(), shaped(values));
        }
        all.insert("count".into(), json!([self.count]));
        for (values, (name, _)) in self.quantiles.iter().zip(QUANTILES) {
            all.insert(name.into(), shaped(values));
        }
        Value::Object(all)
    }

    fn from_json(value: &Value) -> Option<Self> {
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
        Some(Self {
            is_of_pictures: min.first().is_some_and(Value::is_array),
            min: numbers("min")?,
            max: numbers("max")?,
            mean: numbers("mean")?,
            std: numbers("std")?,
            count: value.get("count")?.as_array()?.first()?.as_u64()?,
            quantiles: [q01?, q10?, q50?, q90?, q99?],
        })
    }
}

/// The quantile of sorted samples, between the two nearest.
fn quantile(sorted: &[f64], part: f64) -> f64 {
    let place = part * sorted.len().saturating_sub(1) as f64;
    let [below, above] = [place.floor(), place.ceil()].map(|place| {
        let sample = sorted.get(place as usize);
        sample.copied().unwrap_or(0.0)
    });
    below + (above - below) * place.fract()
}

/// The statistics of an episode's states, actions and pictures.
pub(super) fn of_episode(episode: &TrainingEpisode) -> BTreeMap<String, FeatureStats> {
    let mut all = BTreeMap::from([
        ("observation.state".to_owned(), of_signal(&episode.state)),
        ("action".to_owned(), of_signal(&episode.action)),
    ]);
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

/// The statistics of the three colours over the pixels of evenly spaced pictures.
fn of_pictures(camera: &CameraTrack) -> FeatureStats {
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

impl FeatureStats {
    /// Adds a component of which it is known how often each of 256 values occurs, from 0 to 1.
    fn add_histogram(&mut self, histogram: &[u64; 256]) {
        let scaled = |value: usize| value as f64 / 255.0;
        let count = histogram.iter().sum::<u64>().max(1) as f64;
        let weighted = |of: &dyn Fn(f64) -> f64| {
            let values = histogram.iter().enumerate();
            let sum: f64 = values
                .map(|(value, times)| of(scaled(value)) * *times as f64)
                .sum();
            sum / count
        };
        let mean = weighted(&|value| value);
        let occurring = || (0..256).filter(|value| histogram[*value] > 0);
        self.mean.push(mean);
        self.std
            .push(weighted(&|value| (value - mean).powi(2)).sqrt());
        self.min.push(scaled(occurring().next().unwrap_or(0)));
        self.max.push(scaled(occurring().next_back().unwrap_or(0)));
        for (quantiles, (_, part)) in self.quantiles.iter_mut().zip(QUANTILES) {
            let mut left = part * count;
            let value = (0..256).find(|value| {
                left -= histogram[*value] as f64;
                left <= 0.0
            });
            quantiles.push(scaled(value.unwrap_or(255)));
        }
    }
}

/// The text of `meta/stats.json`.
pub(super) fn write(stats: &BTreeMap<String, FeatureStats>) -> Vec<u8> {
    let all: Map<_, _> = stats
        .iter()
        .map(|(feature, stats)| (feature.clone(), stats.to_json()))
        .collect();
    serde_json::to_vec_pretty(&all).unwrap_or_default()
}

/// The statistics of a dataset.
pub(super) fn read(folder: &Path) -> Result<BTreeMap<String, FeatureStats>, ExportError> {
    let path = folder.join(PATH);
    let bytes = read_regular_file(&path, MOST_BYTES, Symlinks::Followed);
    let bytes = bytes.map_err(ExportError::io(&path))?;
    let all: Map<String, Value> =
        serde_json::from_slice(&bytes).map_err(|error| ExportError::dataset(&path, error))?;
    all.into_iter()
        .map(|(feature, value)| {
            let stats = FeatureStats::from_json(&value);
            let stats = stats.ok_or_else(|| {
                ExportError::dataset(&path, format!("the statistics of {feature} are incomplete"))
            })?;
            Ok((feature, stats))
        })
        .collect()
}
