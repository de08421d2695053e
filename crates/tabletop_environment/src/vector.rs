//! Many environments, stepped over threads.

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{Arc, Mutex, PoisonError, mpsc},
    thread,
    time::Duration,
};

use crate::{
    environment::{EnvironmentOptions, TaskEnvironment, Transition},
    error::EnvironmentError,
    observation::ObservationSpace,
    task::EnvironmentTask,
};

/// The time between two questions whether to go on waiting.
const PATIENCE: Duration = Duration::from_millis(50);

/// When an environment whose episode has ended begins the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Autoreset {
    /// In the next step, which ignores its action and has no reward.
    NextStep,
    /// In the same step; the last observation of the old episode is kept beside the first of the new one.
    SameStep,
    /// Never: the program resets.
    Disabled,
}

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
    /// With [`Autoreset::SameStep`], the last observations of the episodes that have ended in this step, as in `states`, `rgb` and `depth`; else
    /// empty.
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
}

struct Job {
    slot: Box<Slot>,
    order: SlotOrder,
}

enum SlotOrder {
    Reset(Option<u64>),
    Step,
}

/// An environment, on its way between the caller and the workers.
struct Slot {
    number: usize,
    environment: TaskEnvironment,
    autoreset: Autoreset,
    action: Vec<f32>,
    observation: Observed,
    last: Option<Observed>,
    transition: Transition,
    /// Whether its episode has ended.
    is_over: bool,
    result: Result<(), EnvironmentError>,
}

#[derive(Default)]
struct Observed {
    state: Vec<f32>,
    rgb: Vec<u8>,
    depth: Vec<f32>,
}

impl Observed {
    fn take(&mut self, environment: &mut TaskEnvironment) -> Result<(), EnvironmentError> {
        let observation = environment.options().observation;
        self.state.resize(environment.state_layout().numbers(), 0.0);
        environment.observe_state(&mut self.state);
        if observation.has_picture() {
            let picture = environment.picture()?;
            self.rgb.clone_from(&picture.rgb);
            if observation == ObservationSpace::Rgbd {
                self.depth.clone_from(&picture.depth);
            }
        }
        Ok(())
    }
}

impl Slot {
    fn reset(&mut self, seed: Option<u64>) -> Result<(), EnvironmentError> {
        self.environment.reset(seed)?;
        self.is_over = false;
        self.transition = Transition::default();
        self.last = None;
        self.observation.take(&mut self.environment)
    }

    fn step(&mut self) -> Result<(), EnvironmentError> {
        self.last = None;
        if self.is_over && self.autoreset == Autoreset::NextStep {
            return self.reset(None);
        }
        self.transition = self.environment.step(&self.action)?;
        self.is_over = self.transition.is_success || self.transition.is_truncated;
        self.observation.take(&mut self.environment)?;
        if self.is_over && self.autoreset == Autoreset::SameStep {
            let transition = self.transition;
            let last = std::mem::take(&mut self.observation);
            self.reset(None)?;
            self.transition = transition;
            self.last = Some(last);
        }
        Ok(())
    }

    fn obey(&mut self, order: &SlotOrder) {
        let done = catch_unwind(AssertUnwindSafe(|| match order {
            SlotOrder::Reset(seed) => self.reset(*seed),
            SlotOrder::Step => self.step(),
        }));
        self.result = done.unwrap_or_else(|_| {
            Err(EnvironmentError::World(
                "the simulator has a fault: an environment has panicked".into(),
            ))
        });
    }
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
            let environment = TaskEnvironment::with_robot(task.clone(), options, robot.clone())?;
            Ok(Some(Box::new(Slot {
                number,
                action: vec![0.0; environment.action_len()],
                environment,
                autoreset,
                observation: Observed::default(),
                last: None,
                transition: Transition::default(),
                is_over: false,
                result: Ok(()),
            })))
        });
        let slots = slots.collect::<Result<Vec<_>, EnvironmentError>>()?;
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
                ..VectorResults::default()
            },
            slots,
            jobs: Some(jobs),
            done,
            workers,
            away: 0,
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
    pub fn action_len(&self) -> usize {
        let first = self.slots.first().and_then(Option::as_ref);
        first.map_or(0, |slot| slot.environment.action_len())
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
        self.check_home()?;
        for number in 0..self.slots.len() {
            self.give(
                number,
                SlotOrder::Reset(seeds.get(number).copied().flatten()),
            )?;
        }
        self.receive(self.slots.len(), goes_on).map(drop)
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
    /// The actions have the wrong length, or one of these is stepped already.
    pub fn send(&mut self, numbers: &[usize], actions: &[f32]) -> Result<(), EnvironmentError> {
        let length = actions.len() / numbers.len().max(1);
        let is_wrong = |number: &&usize| {
            let slot = self.slots.get(**number).and_then(Option::as_ref);
            slot.is_none_or(|slot| slot.action.len() != length)
        };
        if length * numbers.len() != actions.len() {
            return Err(EnvironmentError::Action {
                found: actions.len(),
                expected: self.action_len() * numbers.len(),
            });
        }
        if let Some(number) = numbers.iter().find(is_wrong) {
            return Err(match self.slots.get(*number) {
                Some(Some(slot)) => EnvironmentError::Action {
                    found: length,
                    expected: slot.action.len(),
                },
                Some(None) => EnvironmentError::Option(format!(
                    "environment {number} is stepped already; receive it first"
                )),
                None => EnvironmentError::Option(format!(
                    "there is no environment {number}, only {}",
                    self.slots.len()
                )),
            });
        }
        for (&number, action) in numbers.iter().zip(actions.chunks(length.max(1))) {
            if let Some(slot) = &mut self.slots[number] {
                slot.action.copy_from_slice(action);
            }
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
        if let Some(last) = &slot.last {
            put(&mut self.last.states, number, &last.state);
            put(&mut self.last.rgb, number, &last.rgb);
            put(&mut self.last.depth, number, &last.depth);
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
