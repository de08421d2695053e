//! An environment among many, on its way between the caller and the threads.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::{
    environment::{TaskEnvironment, Transition},
    error::EnvironmentError,
    observation::ObservationSpace,
};

/// When an environment whose episode has ended begins the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Autoreset {
    /// In the next step, which ignores its action and has no reward.
    NextStep,
    /// In the same step; the last observation of the old episode is kept beside the first of the new one.
    SameStep,
    /// Never: the program resets it, and no step is made before.
    Disabled,
}

pub(crate) enum SlotOrder {
    Reset(Option<u64>),
    Step,
}

/// An environment, on its way between the caller and the workers.
pub(crate) struct Slot {
    pub number: usize,
    pub environment: TaskEnvironment,
    pub autoreset: Autoreset,
    pub action: Vec<f32>,
    pub observation: Observed,
    pub last: Option<Observed>,
    pub transition: Transition,
    /// Whether its episode has ended.
    pub is_over: bool,
    pub result: Result<(), EnvironmentError>,
}

#[derive(Default)]
pub(crate) struct Observed {
    pub state: Vec<f32>,
    pub rgb: Vec<u8>,
    pub depth: Vec<f32>,
    pub failures: Vec<String>,
    /// What is to be done; empty if it is not said.
    pub instruction: String,
}

impl Observed {
    fn take(&mut self, environment: &mut TaskEnvironment) -> Result<(), EnvironmentError> {
        let observation = environment.options().observation;
        self.state.resize(environment.state_layout().numbers(), 0.0);
        environment.observe_state(&mut self.state);
        self.failures = environment.failures();
        self.instruction = environment.instruction().unwrap_or_default().to_owned();
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
    /// An environment of this number, at home.
    pub fn new(number: usize, environment: TaskEnvironment, autoreset: Autoreset) -> Self {
        Self {
            number,
            action: vec![0.0; environment.action_len()],
            environment,
            autoreset,
            observation: Observed::default(),
            last: None,
            transition: Transition::default(),
            is_over: false,
            result: Ok(()),
        }
    }

    fn reset(&mut self, seed: Option<u64>) -> Result<(), EnvironmentError> {
        self.environment.reset(seed)?;
        self.is_over = false;
        self.transition = Transition::default();
        self.last = None;
        self.observation.take(&mut self.environment)
    }

    /// Whether it can be stepped with this action.
    pub fn check(&self, action: &[f32]) -> Result<(), EnvironmentError> {
        match self.autoreset {
            Autoreset::Disabled if self.is_over => {
                Err(EnvironmentError::NoEpisode("its episode is over"))
            }
            Autoreset::NextStep if self.is_over => Ok(()),
            Autoreset::NextStep | Autoreset::SameStep | Autoreset::Disabled => {
                self.environment.check_action(action)
            }
        }
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

    /// Carries out an order; how that went is its result.
    pub fn obey(&mut self, order: &SlotOrder) {
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
