//! Many environments, stepped over threads.

use std::{
    collections::BTreeSet,
    sync::{Arc, Mutex, PoisonError, mpsc},
    thread,
    time::Duration,
};

use crate::{
    environment::{EnvironmentOptions, TaskEnvironment},
    error::EnvironmentError,
    observation::ObservationSpace,
    slot::{Autoreset, Slot, SlotOrder},
    task::EnvironmentTask,
};

/// The time between two questions whether to go on waiting.
const PATIENCE: Duration = Duration::from_millis(50);

/// Environments of one task, each with its own world. The results do not depend on the number of threads.
///
/// ```
/// use tabletop_environment::{Autoreset, EnvironmentOptions, EnvironmentTask, VectorEnvironment};
///
/// let task = EnvironmentTask::of_scenario("scenarios/stack_two_blocks.ron".as_ref(), false, &[])?;
/// let options = EnvironmentOptions::default();
/// let mut vector = VectorEnvironment::new(&task, &options, 3, 2, Autoreset::NextStep)?;
/// vector.reset(&[Some(1), Some(2), Some(3)], || true)?;
/// let actions = vec![0.1; 3 * vector.action_len()];
/// vector.step(&actions, || true)?;
/// assert_eq!(vector.results().rewards.len(), 3);
/// # Ok::<_, tabletop_environment::EnvironmentError>(())
/// ```
pub struct VectorEnvironment {
    /// Those that are not on their way.
    slots: Vec<Option<Box<Slot>>>,
    jobs: Option<mpsc::Sender<Job>>,
    done: mpsc::Receiver<Box<Slot>>,
    workers: Vec<thread::JoinHandle<()>>,
    results: VectorResults,
    away: usize,
    action_len: usize,
}

/// The results of all environments, a row each, in arrays that stay where they are.
#[derive(Clone, Debug, Default)]
pub struct VectorResults {
    /// The states.
    pub states: Vec<f32>,
    /// The pictures, row by row from the top, red, green and blue of each pixel.
    pub rgb: Vec<u8>,
    /// The depths of the pictures' pixels, in units.
    pub depth: Vec<f32>,
    /// The rewards.
    pub rewards: Vec<f32>,
    /// Whether each is at its goal.
    pub successes: Vec<bool>,
    /// Whether each was cut off.
    pub truncations: Vec<bool>,
    /// What is not yet as it should be in each, in words.
    pub failures: Vec<Vec<String>>,
    /// The sentences that say what is to be done in each; empty if it is not said.
    pub instructions: Vec<String>,
    /// With [`Autoreset::SameStep`], the last observations of the episodes that have ended in this step, as in `states`, `rgb`, `depth`,
    /// `failures` and `instructions`; else empty.
    pub last: LastObservations,
}

/// The last observations of episodes.
#[derive(Clone, Debug, Default)]
pub struct LastObservations {
    /// The states.
    pub states: Vec<f32>,
    /// The pictures.
    pub rgb: Vec<u8>,
    /// The depths.
    pub depth: Vec<f32>,
    /// What was not as it should be.
    pub failures: Vec<Vec<String>>,
    /// What was to be done.
    pub instructions: Vec<String>,
}

struct Job {
    slot: Box<Slot>,
    order: SlotOrder,
}

impl VectorEnvironment {
    /// So many environments of a task over so many threads; 0 for one a core.
    ///
    /// # Errors
    /// As [`TaskEnvironment::new`].
    pub fn new(
        task: &EnvironmentTask,
        options: &EnvironmentOptions,
        count: usize,
        threads: usize,
        autoreset: Autoreset,
    ) -> Result<Self, EnvironmentError> {
        let robot = TaskEnvironment::shared_robot(options)?;
        let slots = (0..count).map(|number| {
            let mut options = options.clone();
            let record = options.record.take();
            options.record = record.map(|folder| folder.join(format!("{number:04}")));
            let environment = TaskEnvironment::with_robot(task.clone(), &options, robot.clone())?;
            let slot = Slot::new(number, environment, autoreset);
            Ok(Some(Box::new(slot)))
        });
        let slots = slots.collect::<Result<Vec<_>, EnvironmentError>>()?;
        let first = slots.first().and_then(Option::as_ref);
        let action_len = first.map_or(0, |slot| slot.action.len());
        let threads = match threads {
            0 => thread::available_parallelism().map_or(1, usize::from),
            threads => threads,
        };
        let (jobs, queue) = mpsc::channel::<Job>();
        let (finished, done) = mpsc::channel();
        let queue = Arc::new(Mutex::new(queue));
        let workers = (0..threads.min(count).max(1)).map(|_| {
            let (queue, finished) = (Arc::clone(&queue), finished.clone());
            thread::spawn(move || {
                loop {
                    let next = queue.lock().unwrap_or_else(PoisonError::into_inner).recv();
                    let Ok(Job { mut slot, order }) = next else {
                        return;
                    };
                    slot.obey(&order);
                    if finished.send(slot).is_err() {
                        return;
                    }
                }
            })
        });
        let workers = workers.collect();
        let mut vector = Self {
            results: VectorResults {
                rewards: vec![0.0; count],
                successes: vec![false; count],
                truncations: vec![false; count],
                failures: vec![Vec::new(); count],
                instructions: vec![String::new(); count],
                ..VectorResults::default()
            },
            slots,
            jobs: Some(jobs),
            done,
            workers,
            away: 0,
            action_len,
        };
        vector.prepare_results(options, autoreset);
        Ok(vector)
    }

    fn prepare_results(&mut self, options: &EnvironmentOptions, autoreset: Autoreset) {
        let count = self.slots.len();
        let first = self.slots.first().and_then(Option::as_ref);
        let of_state = first.map_or(0, |slot| slot.environment.state_layout().numbers());
        let [width, height] = options.camera.size.unwrap_or_default();
        let pixels = match options.observation.has_picture() {
            true => (width * height) as usize,
            false => 0,
        };
        let depths = match options.observation {
            ObservationSpace::Rgbd => pixels,
            ObservationSpace::State | ObservationSpace::Rgb => 0,
        };
        let results = &mut self.results;
        results.states.resize(count * of_state, 0.0);
        results.rgb.resize(count * pixels * 3, 0);
        results.depth.resize(count * depths, 0.0);
        if autoreset == Autoreset::SameStep {
            results.last = LastObservations {
                states: results.states.clone(),
                rgb: results.rgb.clone(),
                depth: results.depth.clone(),
                failures: results.failures.clone(),
                instructions: results.instructions.clone(),
            };
        }
    }

    /// The number of environments.
    pub const fn len(&self) -> usize {
        self.slots.len()
    }

    /// True if there are none.
    pub const fn is_empty(&self) -> bool {
        self.slots.is_empty()
    }

    /// Number of the numbers of one environment's action.
    pub const fn action_len(&self) -> usize {
        self.action_len
    }

    /// The latest results.
    pub const fn results(&self) -> &VectorResults {
        &self.results
    }

    /// Begins an episode in each, with these seeds. `goes_on` is asked every 50 ms whether to go on waiting.
    ///
    /// # Errors
    /// An error of an environment, or [`EnvironmentError::Interrupted`].
    pub fn reset(
        &mut self,
        seeds: &[Option<u64>],
        goes_on: impl FnMut() -> bool,
    ) -> Result<(), EnvironmentError> {
        let seeds =
            (0..self.slots.len()).map(|number| (number, seeds.get(number).copied().flatten()));
        let seeds: Vec<_> = seeds.collect();
        self.reset_some(&seeds, goes_on)
    }

    /// Begins an episode in these environments, each with its seed. The others stay as they are.
    ///
    /// # Errors
    /// As [`reset`](Self::reset), or there is no such environment.
    pub fn reset_some(
        &mut self,
        seeds: &[(usize, Option<u64>)],
        goes_on: impl FnMut() -> bool,
    ) -> Result<(), EnvironmentError> {
        self.check_home()?;
        let numbers: Vec<_> = seeds.iter().map(|&(number, _)| number).collect();
        self.check_can_be_given(&numbers)?;
        for &(number, seed) in seeds {
            self.give(number, SlotOrder::Reset(seed))?;
        }
        self.receive(seeds.len(), goes_on).map(drop)
    }

    /// Steps each with its row of the actions.
    ///
    /// # Errors
    /// As [`reset`](Self::reset), or the actions have the wrong length.
    pub fn step(
        &mut self,
        actions: &[f32],
        goes_on: impl FnMut() -> bool,
    ) -> Result<(), EnvironmentError> {
        self.check_home()?;
        let all: Vec<_> = (0..self.slots.len()).collect();
        self.send(&all, actions)?;
        self.receive(all.len(), goes_on).map(drop)
    }

    /// Lets these environments, each with its row of the actions, be stepped. The others stay as they are.
    ///
    /// # Errors
    /// As [`TaskEnvironment::check_action`], one of these is stepped already, or its episode is over and it does not reset itself. Then none is
    /// stepped.
    pub fn send(&mut self, numbers: &[usize], actions: &[f32]) -> Result<(), EnvironmentError> {
        let expected = self.action_len * numbers.len();
        if actions.len() != expected {
            return Err(EnvironmentError::Action {
                found: actions.len(),
                expected,
            });
        }
        self.check_can_be_given(numbers)?;
        let length = self.action_len.max(1);
        let rows = || numbers.iter().zip(actions.chunks(length));
        for (&number, action) in rows() {
            let checked = self.at_home(number)?.check(action);
            checked.map_err(|error| EnvironmentError::OfMany {
                number,
                error: Box::new(error),
            })?;
        }
        for (&number, action) in rows() {
            self.at_home(number)?.action.copy_from_slice(action);
            self.give(number, SlotOrder::Step)?;
        }
        Ok(())
    }

    /// Waits for so many environments, those that are ready first, and puts their results into [the arrays](Self::results). Returns their
    /// numbers.
    ///
    /// # Errors
    /// As [`reset`](Self::reset), or fewer are on their way.
    pub fn receive(
        &mut self,
        count: usize,
        mut goes_on: impl FnMut() -> bool,
    ) -> Result<Vec<usize>, EnvironmentError> {
        if count > self.away {
            return Err(EnvironmentError::Option(format!(
                "{} environments are stepped, so {count} cannot be received; send actions first",
                self.away
            )));
        }
        let mut numbers = Vec::with_capacity(count);
        let mut result = Ok(());
        while numbers.len() < count {
            match self.done.recv_timeout(PATIENCE) {
                Ok(mut slot) => {
                    self.away -= 1;
                    let own = std::mem::replace(&mut slot.result, Ok(()));
                    result = result.and(own);
                    numbers.push(slot.number);
                    self.results.take(&slot);
                    let number = slot.number;
                    self.slots[number] = Some(slot);
                }
                Err(mpsc::RecvTimeoutError::Timeout) if goes_on() => {}
                Err(mpsc::RecvTimeoutError::Timeout) => return Err(EnvironmentError::Interrupted),
                Err(mpsc::RecvTimeoutError::Disconnected) => {
                    return Err(EnvironmentError::World("its threads are gone".into()));
                }
            }
        }
        result.map(|()| numbers)
    }

    /// An environment that is not on its way.
    pub fn environment(&mut self, number: usize) -> Option<&mut TaskEnvironment> {
        let slot = self.slots.get_mut(number)?.as_mut()?;
        Some(&mut slot.environment)
    }

    /// Ends the recordings of the episodes, of those that are not on their way.
    ///
    /// # Errors
    /// As [`TaskEnvironment::finish_recording`]: the first; the others are ended, too.
    pub fn finish_recordings(&mut self) -> Result<(), EnvironmentError> {
        let slots = self.slots.iter_mut().flatten();
        let ended = slots.map(|slot| slot.environment.finish_recording());
        ended.fold(Ok(()), Result::and)
    }

    fn check_can_be_given(&mut self, numbers: &[usize]) -> Result<(), EnvironmentError> {
        let mut given = BTreeSet::new();
        for &number in numbers {
            self.at_home(number)?;
            if !given.insert(number) {
                return Err(EnvironmentError::Option(format!(
                    "environment {number} is named twice"
                )));
            }
        }
        Ok(())
    }

    fn at_home(&mut self, number: usize) -> Result<&mut Slot, EnvironmentError> {
        let count = self.slots.len();
        match self.slots.get_mut(number) {
            Some(Some(slot)) => Ok(slot),
            Some(None) => Err(EnvironmentError::Option(format!(
                "environment {number} is stepped already; receive it first"
            ))),
            None => Err(EnvironmentError::Option(format!(
                "there is no environment {number}, only {count}"
            ))),
        }
    }

    fn give(&mut self, number: usize, order: SlotOrder) -> Result<(), EnvironmentError> {
        let slot = self.slots[number].take();
        let job = slot.map(|slot| Job { slot, order });
        let given = job.zip(self.jobs.as_ref());
        let given = given.map(|(job, jobs)| jobs.send(job).is_ok());
        match given {
            Some(true) => {
                self.away += 1;
                Ok(())
            }
            Some(false) | None => Err(EnvironmentError::World("its threads are gone".into())),
        }
    }

    fn check_home(&mut self) -> Result<(), EnvironmentError> {
        match self.away {
            0 => Ok(()),
            away => Err(EnvironmentError::Option(format!(
                "{away} environments are stepped; receive them first"
            ))),
        }
    }
}

impl VectorResults {
    fn take(&mut self, slot: &Slot) {
        let number = slot.number;
        let seen = &slot.observation;
        put(&mut self.states, number, &seen.state);
        put(&mut self.rgb, number, &seen.rgb);
        put(&mut self.depth, number, &seen.depth);
        self.failures[number].clone_from(&seen.failures);
        self.instructions[number].clone_from(&seen.instruction);
        if let Some(last) = &slot.last {
            put(&mut self.last.states, number, &last.state);
            put(&mut self.last.rgb, number, &last.rgb);
            put(&mut self.last.depth, number, &last.depth);
            self.last.failures[number].clone_from(&last.failures);
            self.last.instructions[number].clone_from(&last.instruction);
        }
        self.rewards[number] = slot.transition.reward;
        self.successes[number] = slot.transition.is_success;
        self.truncations[number] = slot.transition.is_truncated;
    }
}

/// Copies a row.
fn put<T: Copy>(rows: &mut [T], number: usize, row: &[T]) {
    let start = number * row.len();
    if let Some(place) = rows.get_mut(start..start + row.len()) {
        place.copy_from_slice(row);
    }
}

impl Drop for VectorEnvironment {
    fn drop(&mut self) {
        self.jobs = None;
        for worker in self.workers.drain(..) {
            worker.join().ok();
        }
    }
}
