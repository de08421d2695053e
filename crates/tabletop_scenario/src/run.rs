//! Running a scenario, tick by tick.

use bevy::prelude::*;
use tabletop_core::{SimCommand, TICKS_PER_SECOND};

use crate::{
    Program, ScenarioError, Step,
    act::{StepProgress, StepState},
    program::{ProgramAction, ProgramStep},
    seen::Seen,
};

/// A scenario in progress. [`ScenarioPlugin`](crate::ScenarioPlugin) runs the one in the world.
#[derive(Resource, Clone, Debug)]
pub struct ScenarioRun {
    program: Program,
    /// The step that is due.
    next: usize,
    state: StepState,
    /// The step whose command was given in the last tick.
    commanded: Option<usize>,
    ticks: u64,
    outcome: Outcome,
}

/// The progress of a scenario.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Outcome {
    /// It goes on.
    #[default]
    Running,
    /// All steps are done, all checks have passed.
    Done,
    /// It has stopped at a step.
    Failed(ScenarioError),
}

impl ScenarioRun {
    /// A run of this program from its beginning.
    pub fn new(program: Program) -> Self {
        Self {
            state: StepState::new(program.random.clone()),
            program,
            next: 0,
            commanded: None,
            ticks: 0,
            outcome: Outcome::Running,
        }
    }

    /// Its progress.
    pub const fn outcome(&self) -> &Outcome {
        &self.outcome
    }

    /// Number of steps done, including the one that loads the `setup`.
    pub const fn steps_done(&self) -> usize {
        self.next
    }

    /// The number of checks among them.
    pub fn checks_passed(&self) -> usize {
        let done = self.program.steps.iter().take(self.next);
        done.filter(|step| matches!(step.action, ProgramAction::Do(Step::Expect(_))))
            .count()
    }

    /// Takes the steps that are due in a tick: at most one of them gives a command. `refusal` is the reason why the last tick's
    /// command was refused.
    pub(crate) fn tick(&mut self, seen: &Seen, refusal: Option<&str>) -> Option<SimCommand> {
        if self.outcome != Outcome::Running {
            return None;
        }
        self.state.observe(seen);
        if let (Some(step), Some(reason)) = (self.commanded.take(), refusal) {
            return self.fail(step, format!("refused: {reason}"));
        }
        loop {
            let Some(ProgramStep { action, .. }) = self.program.steps.get(self.next) else {
                self.outcome = Outcome::Done;
                return None;
            };
            if self.ticks >= self.program.limit {
                let seconds = self.program.limit as f32 / TICKS_PER_SECOND as f32;
                return self.fail(self.next, format!("the limit of {seconds} s is over"));
            }
            let action = action.clone();
            let command = match self.state.act(&action, seen) {
                Err(what) => return self.fail(self.next, what),
                Ok(StepProgress::Over) => {
                    self.go_on();
                    continue;
                }
                Ok(StepProgress::Command(command)) => {
                    self.commanded = Some(self.next);
                    self.go_on();
                    Some(command)
                }
                Ok(StepProgress::GoesOn(command)) => {
                    self.commanded = command.as_ref().map(|_| self.next);
                    self.state.go_on();
                    command
                }
            };
            self.ticks += 1;
            return command;
        }
    }

    /// Fails for a reason that concerns all steps.
    pub(crate) fn give_up(&mut self, reason: String) {
        if let (Outcome::Running, Some(last)) =
            (&self.outcome, self.program.steps.len().checked_sub(1))
        {
            let step = self.commanded.take().unwrap_or(self.next);
            self.fail(step.min(last), reason);
        }
    }

    /// Number of ticks for which it waits unconditionally; `None` if it has ended.
    pub(crate) fn waits_for(&self) -> Option<u64> {
        if self.outcome != Outcome::Running {
            return None;
        }
        let step = self.program.steps.get(self.next);
        let waits = step.map_or(0, |step| match &step.action {
            ProgramAction::Do(step) => self.state.left_of_wait(step),
            ProgramAction::SetScene(_) => 0,
        });
        let left = self.program.limit.saturating_sub(self.ticks);
        Some(match self.commanded {
            Some(_) => 0,
            None => waits.min(left),
        })
    }

    /// Passes over this many of the ticks that it [waits for](Self::waits_for), in which nothing changes.
    pub(crate) fn pass_over(&mut self, ticks: u64) {
        if self.outcome != Outcome::Running {
            return;
        }
        self.state.pass_over(ticks);
        self.ticks += ticks;
    }

    fn go_on(&mut self) {
        self.next += 1;
        self.state.begin_next();
    }

    fn fail(&mut self, step: usize, what: String) -> Option<SimCommand> {
        let ProgramStep { at, text, .. } = &self.program.steps[step];
        self.outcome = Outcome::Failed(ScenarioError::Failed {
            at: at.clone(),
            step: text.clone(),
            what,
        });
        None
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::{Hand, HandCommand};

    use super::*;
    use crate::test_stage::Stage;

    #[test]
    fn a_tick_gives_one_command_of_the_selected_or_the_named_hand() {
        let mut stage = Stage::new(
            "Select(Left), Grasp(\"low\"), With(Right, MoveBy((0, 0, 1))), Turn(axis: Y, degrees: 5)",
        );
        stage.selected = Hand::Left;
        let given: Vec<_> = std::iter::from_fn(|| stage.tick()).collect();
        assert_eq!(
            given,
            [
                SimCommand::Hand(HandCommand::Select(Hand::Left)),
                SimCommand::Hand(HandCommand::Grasp {
                    hand: Hand::Left,
                    object: "low".into()
                }),
                SimCommand::Hand(HandCommand::MoveBy {
                    hand: Hand::Right,
                    offset: Vec3::Z
                }),
                SimCommand::Hand(HandCommand::Turn {
                    hand: Hand::Left,
                    axis: Vec3::Y,
                    degrees: 5.0
                }),
            ]
        );
        assert_eq!(*stage.run.outcome(), Outcome::Done);
    }

    #[test]
    fn a_fault_of_the_whole_scenario_fails_the_step_that_is_due() {
        let mut stage = Stage::new("Wait(9), Clear");
        stage.tick();
        stage.run.give_up("the disk is full".into());
        assert_eq!(stage.tick(), None);
        assert_eq!(stage.failure(), "s.ron:1:10: Wait(9): the disk is full");
        let mut nothing = Stage::new("");
        nothing.run.give_up("the disk is full".into());
        nothing.tick();
        assert_eq!(*nothing.run.outcome(), Outcome::Done);
    }

    #[test]
    fn a_refused_command_fails_at_its_step() {
        let mut stage = Stage::new("Clear, Grasp(\"x\"), Wait(9)");
        stage.tick();
        stage.tick();
        stage.tick_refused(Some("no such object"));
        assert_eq!(
            stage.failure(),
            "s.ron:1:17: Grasp(\"x\"): refused: no such object"
        );
    }

    #[test]
    fn finished_steps_and_checks_are_counted() {
        let mut stage =
            Stage::new("Clear, Expect(Gone(\"x\")), Clear, Expect(Exists(\"x\")), Clear");
        stage.failure();
        assert_eq!((stage.run.steps_done(), stage.run.checks_passed()), (3, 1));
    }

    #[test]
    fn a_step_beyond_the_time_limit_fails() {
        let mut stage = Stage::new("Wait(5), Clear");
        stage.run.program.limit = 60;
        assert_eq!(
            stage.failure(),
            "s.ron:1:10: Wait(5): the limit of 1 s is over"
        );
    }
}
