//! Training: a policy and how it learns.

use std::{
    ops::ControlFlow,
    path::Path,
    thread,
    time::{Duration, Instant},
};

use tabletop_camera::Rasterizer;
use tabletop_storage::Storage;

use crate::{
    adam::Adam,
    curriculum::Curriculum,
    error::PolicyError,
    policy::{Policy, read_file},
    tensor_file::{Tensor, TensorFile},
};

/// The training of a policy. Where it has come to is a file; the same curriculum and options lead to the same bits, whatever the number of threads and however
/// often it was interrupted.
#[derive(Clone, Debug)]
pub struct Training {
    policy: Policy,
    adam: Adam,
    /// The mean loss of each batch.
    losses: Vec<f32>,
    samples: u64,
    /// That of curriculum and options.
    fingerprint: String,
}

/// How far a training has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrainingProgress {
    /// Number of samples it has learned from, of all.
    pub samples: [u64; 2],
    /// The mean loss of the last batches.
    pub loss: f32,
    /// Samples a second.
    pub rate: f64,
    /// The time that is left at this rate.
    pub left: Duration,
}

/// Samples from which a step is computed.
const BATCH: usize = 4;
/// Length of the longest steps.
const LENGTH: f32 = 1e-3;
/// Batches until steps are at their longest.
const WARMUP: f32 = 100.0;
/// Batches between two saves, and over which the reported loss is averaged: some ten seconds.
const SAVED_AFTER: usize = 100;

const MEANS: &str = "training.means";
const SQUARES: &str = "training.squares";
const LOSSES: &str = "training.losses";
const CURRICULUM: &str = "curriculum";

impl Training {
    /// A training that begins, with this many samples.
    pub fn new(curriculum: &Curriculum, samples: u64, seed: u64) -> Self {
        let policy = Policy::new(curriculum.levels().to_vec(), seed);
        Self {
            adam: Adam::new(policy.parameters.len()),
            policy,
            losses: Vec::new(),
            samples,
            fingerprint: format!(
                "{samples} samples, seed {seed}: {}",
                curriculum.fingerprint()
            ),
        }
    }

    /// The training of a file goes on, or a new one begins if there is none.
    ///
    /// # Errors
    /// The file cannot be read, or is of another training.
    pub fn resume(
        path: &Path,
        curriculum: &Curriculum,
        samples: u64,
        seed: u64,
    ) -> Result<Self, PolicyError> {
        let mut training = Self::new(curriculum, samples, seed);
        if !path.exists() {
            return Ok(training);
        }
        let mut file = read_file(path)?;
        if file.metadata.get(CURRICULUM) != Some(&training.fingerprint) {
            let path = path.to_owned();
            return Err(PolicyError::OtherCurriculum { path });
        }
        training.policy = Policy::of_file(&file).map_err(PolicyError::damaged(path))?;
        let parameters = training.policy.parameters.len();
        let mut take = |name: &str| file.tensors.remove(name).unwrap_or_default().numbers;
        training.losses = take(LOSSES);
        (training.adam.means, training.adam.squares) = (take(MEANS), take(SQUARES));
        let is_whole = [&training.adam.means, &training.adam.squares]
            .into_iter()
            .all(|moments| moments.len() == parameters);
        match is_whole || training.is_finished() {
            true => Ok(training),
            false => Err(PolicyError::damaged(path)(format!(
                "{MEANS:?} and {SQUARES:?} have not {parameters} numbers each"
            ))),
        }
    }

    /// The policy as it is now.
    pub fn policy(&self) -> &Policy {
        &self.policy
    }

    /// The mean loss of each batch so far.
    pub fn losses(&self) -> &[f32] {
        &self.losses
    }

    /// True if it has learned from all samples.
    pub fn is_finished(&self) -> bool {
        self.losses.len() >= self.batches()
    }

    fn batches(&self) -> usize {
        self.samples.div_ceil(BATCH as u64) as usize
    }

    /// Learns until the end, or until `report`, which is called after each batch, breaks. Saves the training in the file every few seconds and when it stops.
    ///
    /// # Errors
    /// The file cannot be written, or the curriculum cannot go on.
    pub fn run(
        &mut self,
        curriculum: &Curriculum,
        threads: usize,
        path: &Path,
        mut report: impl FnMut(&TrainingProgress) -> ControlFlow<()>,
    ) -> Result<(), PolicyError> {
        let mut rasterizers = vec![Rasterizer::alone(); threads.clamp(1, BATCH)];
        let (start, first) = (Instant::now(), self.losses.len());
        while !self.is_finished() {
            self.learn(curriculum, &mut rasterizers)?;
            let now = self.losses.len();
            let seconds = start.elapsed().as_secs_f64() / (now - first) as f64;
            let recent = &self.losses[now.saturating_sub(SAVED_AFTER)..];
            let progress = TrainingProgress {
                samples: [(now * BATCH) as u64, (self.batches() * BATCH) as u64],
                loss: recent.iter().sum::<f32>() / recent.len() as f32,
                rate: BATCH as f64 / seconds,
                left: Duration::from_secs_f64(seconds * (self.batches() - now) as f64),
            };
            let is_stopped = report(&progress).is_break();
            if is_stopped || self.is_finished() || now.is_multiple_of(SAVED_AFTER) {
                let bytes = self.to_file().to_bytes();
                let saved = Storage::default().replace(path, &bytes);
                saved.map_err(PolicyError::io(path))?;
            }
            if is_stopped {
                break;
            }
        }
        Ok(())
    }

    /// Learns from a batch, a part of it on each thread.
    fn learn(
        &mut self,
        curriculum: &Curriculum,
        rasterizers: &mut [Rasterizer],
    ) -> Result<(), PolicyError> {
        let policy = &self.policy;
        let first = (self.losses.len() * BATCH) as u64;
        let threads = rasterizers.len();
        let parts: Result<Vec<_>, PolicyError> = thread::scope(|scope| {
            let workers = rasterizers
                .iter_mut()
                .enumerate()
                .map(|(thread, rasterizer)| {
                    scope.spawn(move || {
                        let own = (thread..BATCH).step_by(threads);
                        own.map(|i| {
                            Ok((
                                i,
                                gradient(policy, curriculum, first + i as u64, rasterizer)?,
                            ))
                        })
                        .collect::<Result<Vec<_>, PolicyError>>()
                    })
                });
            let workers: Vec<_> = workers.collect();
            let joined = workers.into_iter().map(|worker| {
                let joined = worker.join();
                joined.unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            });
            joined.collect()
        });
        let mut parts: Vec<_> = parts?.into_iter().flatten().collect();
        parts.sort_by_key(|(i, _)| *i);
        let (losses, gradients): (Vec<f32>, _) = parts.into_iter().map(|(_, part)| part).unzip();
        let mut gradient = sum(gradients);
        for part in &mut gradient {
            *part /= BATCH as f32;
        }
        let length = LENGTH * self.part_of_length();
        let number = self.losses.len() + 1;
        (self.adam).step(&mut self.policy.parameters, &gradient, number, length);
        self.losses.push(losses.iter().sum::<f32>() / BATCH as f32);
        Ok(())
    }

    /// Steps grow at first, and shrink along a cosine until the end.
    fn part_of_length(&self) -> f32 {
        let number = (self.losses.len() + 1) as f32;
        let angle = std::f32::consts::PI * number / (self.batches() + 1) as f32;
        (number / WARMUP).min(1.0) * (1.0 + libm::cosf(angle)) / 2.0
    }

    /// The policy; while the training goes on, also all that it needs for that.
    fn to_file(&self) -> TensorFile {
        let mut file = self.policy.to_file();
        file.metadata
            .insert(CURRICULUM.into(), self.fingerprint.clone());
        let mut put = |name: &str, numbers: &[f32]| {
            let (shape, numbers) = (vec![numbers.len()], numbers.to_vec());
            file.tensors.insert(name.into(), Tensor { shape, numbers });
        };
        put(LOSSES, &self.losses);
        if !self.is_finished() {
            put(MEANS, &self.adam.means);
            put(SQUARES, &self.adam.squares);
        }
        file
    }
}

/// The loss of a sample, and its gradient.
fn gradient(
    policy: &Policy,
    curriculum: &Curriculum,
    number: u64,
    rasterizer: &mut Rasterizer,
) -> Result<(f32, Vec<f32>), PolicyError> {
    let sample = curriculum.sample(number, rasterizer)?;
    let Policy {
        net,
        planes,
        parameters,
        ..
    } = policy;
    let response = net.forward(parameters, sample.view);
    let (loss, of_planes, of_whole) = planes.loss(&response, &sample.label);
    let gradient = net.backward(parameters, &response, &of_planes, of_whole);
    Ok((loss, gradient))
}

/// The sum of lists, by halves, so that it does not depend on who computed them.
fn sum(mut lists: Vec<Vec<f32>>) -> Vec<f32> {
    while lists.len() > 1 {
        let others = lists.split_off(lists.len().div_ceil(2));
        for (list, other) in lists.iter_mut().zip(others) {
            for (sum, number) in list.iter_mut().zip(other) {
                *sum += number;
            }
        }
    }
    lists.pop().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use tabletop_episodes::multiplication::{Multiplication, Variation};
    use tabletop_recorder::RecordingReader;
    use tabletop_storage::TemporaryFolder;

    use super::*;
    use crate::test_recording::record;

    fn trained(curriculum: &Curriculum, threads: usize, file: &Path, interrupted: bool) -> Vec<u8> {
        loop {
            let mut training = Training::resume(file, curriculum, 24, 5).unwrap();
            let stop = |_: &TrainingProgress| match interrupted {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            };
            training.run(curriculum, threads, file, stop).unwrap();
            if training.is_finished() {
                return fs::read(file).unwrap();
            }
        }
    }

    #[test]
    fn threads_and_interruptions_change_no_bit() {
        let folder = TemporaryFolder::new("training").unwrap();
        let demo = folder.path().join("demo");
        record(&demo);
        let recording = RecordingReader::open(&demo).unwrap();
        let variation = Variation {
            light: 0.3,
            camera: 0.2,
            distractors: 2,
            ..Variation::default()
        };
        let multiplication = Multiplication::of(&recording, None, variation, 1).unwrap();
        let curriculum = Curriculum::new(&multiplication, 100).unwrap();
        assert_eq!(curriculum.levels().len(), 2);
        let file = |name: &str| folder.path().join(name);
        let plain = trained(&curriculum, 1, &file("plain"), false);
        assert!(trained(&curriculum, 3, &file("threads"), false) == plain);
        assert!(trained(&curriculum, 2, &file("interrupted"), true) == plain);
        assert!(Policy::read(&file("plain")).is_ok());
        let other = Training::resume(&file("plain"), &curriculum, 25, 5).unwrap_err();
        assert!(
            matches!(other, PolicyError::OtherCurriculum { .. }),
            "{other}"
        );
    }
}
