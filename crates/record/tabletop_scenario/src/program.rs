//! Programs: scenarios together with the files that they name.

use std::path::Path;

use tabletop_core::{Random, SceneSpec, TICKS_PER_SECOND, seen_from};

use crate::{
    Check, LocatedStep, Scenario, ScenarioError, SourceLocation, Step, place::place_all,
    reach::ScenarioReach,
};

/// Time limit of a scenario unless another is given, in seconds.
const DEFAULT_LIMIT_SECONDS: u64 = 600;

/// A scenario that is ready to run: its task files are read, and its random places are chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// Number of ticks after which it fails if it is not done.
    pub limit: u64,
    pub(crate) steps: Vec<ProgramStep>,
    /// The random numbers of its run.
    pub(crate) random: Random,
}

/// A step that needs no files.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ProgramStep {
    pub at: SourceLocation,
    pub text: String,
    pub action: ProgramAction,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ProgramAction {
    /// Put this scene on the table.
    SetScene(Box<SceneSpec>),
    /// Do any other step.
    Do(Step),
}

impl Program {
    /// Prepares a scenario: `load` reads a task file, and the seed decides the places of objects, and the look of presets.
    ///
    /// # Errors
    ///
    /// All errors of `load`, and all objects that cannot be placed, with the places of the steps.
    pub fn new(
        scenario: &Scenario,
        mut load: impl FnMut(&Path) -> Result<SceneSpec, String>,
        seed: u64,
    ) -> Result<Self, ScenarioError> {
        let folder = scenario.path.parent().unwrap_or(Path::new(""));
        let reach = ScenarioReach::of(folder, &scenario.allowed);
        let mut random = Random::new(seed);
        let steps = scenario.setup.iter().chain(&scenario.steps);
        let steps = steps.map(|LocatedStep { at, text, step }| {
            let action = if let Step::Load { file, place } = step {
                let file = seen_from(folder, file);
                reach
                    .check(&file)
                    .and_then(|()| load(&file))
                    .and_then(|mut scene| {
                        place_all(&mut scene, place, &mut random)?;
                        Ok(ProgramAction::SetScene(Box::new(scene)))
                    })
                    .map_err(|what| ScenarioError::Setup {
                        at: at.clone(),
                        step: text.clone(),
                        what,
                    })?
            } else {
                ProgramAction::Do(step.clone())
            };
            Ok(ProgramStep {
                at: at.clone(),
                text: text.clone(),
                action,
            })
        });
        let steps = ScenarioError::of_all(steps)?;
        Ok(Self {
            limit: DEFAULT_LIMIT_SECONDS * u64::from(TICKS_PER_SECOND),
            steps,
            random,
        })
    }

    /// A program without steps.
    pub(crate) const fn empty(seed: u64) -> Self {
        Self {
            limit: DEFAULT_LIMIT_SECONDS * TICKS_PER_SECOND as u64,
            steps: Vec::new(),
            random: Random::new(seed),
        }
    }

    /// The scene that its first step puts on the table, if it does.
    pub fn scene(&self) -> Option<&SceneSpec> {
        match &self.steps.first()?.action {
            ProgramAction::SetScene(scene) => Some(scene),
            ProgramAction::Do(_) => None,
        }
    }

    /// The checks after its last act: its goal.
    pub fn goal(&self) -> Vec<Check> {
        let mut goal = Vec::new();
        for step in &self.steps {
            match &step.action {
                ProgramAction::Do(Step::Expect(check)) => goal.push(check.clone()),
                ProgramAction::Do(step) if step.is_idle() => {}
                ProgramAction::SetScene(_) | ProgramAction::Do(_) => goal.clear(),
            }
        }
        goal
    }

    /// True if it only prepares: no step lets time pass for something to happen, as `Wait` and `Glide` do.
    pub fn only_prepares(&self) -> bool {
        self.steps.iter().all(|step| match &step.action {
            ProgramAction::SetScene(_) => true,
            ProgramAction::Do(step) => !step.waits(),
        })
    }
}
