//! Running a scenario, tick by tick.

use bevy::prelude::*;
use tabletop_core::{SimCommand, TICKS_PER_SECOND};

use crate::{
    Program, ScenarioError, Step,
    act::{StepProgress, StepState},
    program::{ProgramAction, ProgramStep},
    rest::TICKS_TO_LAST,
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
    /// The checks of placement since the last act, which must go on to hold.
    lasting: Vec<usize>,
    /// Number of ticks since the last step.
    lasted: u64,
    /// Whether checks of placement must last after the last step.
    ends: bool,
    /// Whether the state after the last tick was taken in when the program before ended.
    has_observed: bool,
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
            lasting: Vec::new(),
            lasted: 0,
            ends: true,
            has_observed: false,
            outcome: Outcome::Running,
        }
    }

    /// A run that [goes on](Self::go_on_with) with one program after the other, with random numbers of this seed.
    pub(crate) fn without_end(seed: u64) -> Self {
        Self {
            ends: false,
            ..Self::new(Program::empty(seed))
        }
    }

    /// Begins with another program, in the present state.
    pub(crate) fn go_on_with(&mut self, program: Program) {
        self.state.begin_next();
        self.program = program;
        self.has_observed = self.outcome != Outcome::Running;
        self.next = 0;
        self.commanded = None;
        self.ticks = 0;
        self.outcome = Outcome::Running;
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

    /// Takes the steps that are due in a tick: at most one of them gives commands. `refusal` is the reason why one of the last tick's
    /// was refused.
    pub(crate) fn tick(&mut self, seen: &Seen, refusal: Option<&str>) -> Vec<SimCommand> {
        if self.outcome != Outcome::Running {
            return Vec::new();
        }
        if !std::mem::take(&mut self.has_observed) {
            self.state.observe(seen);
        }
        if let (Some(step), Some(reason)) = (self.commanded.take(), refusal) {
            return self.fail(step, format!("refused: {reason}"));
        }
        loop {
            let Some(ProgramStep { action, .. }) = self.program.steps.get(self.next) else {
                self.last(seen);
                return Vec::new();
            };
            if self.ticks >= self.program.limit {
                let seconds = self.program.limit as f32 / TICKS_PER_SECOND as f32;
                return self.fail(self.next, format!("the limit of {seconds} s is over"));
            }
            let action = action.clone();
            let commands = match self.state.act(&action, seen) {
                Err(what) => return self.fail(self.next, what),
                Ok(StepProgress::Over) => {
                    if let ProgramAction::Do(Step::Expect(check)) = &action
                        && self.ends
                        && check.is_of_placement()
                    {
                        self.lasting.push(self.next);
                    }
                    self.go_on();
                    continue;
                }
                Ok(StepProgress::Command(command)) => {
                    self.commanded = Some(self.next);
                    self.go_on();
                    vec![command]
                }
                Ok(StepProgress::GoesOn(commands)) => {
                    self.commanded = (!commands.is_empty()).then_some(self.next);
                    self.state.go_on();
                    commands
                }
            };
            self.ticks += 1;
            if commands.iter().any(acts) {
                self.lasting.clear();
            }
            return commands;
        }
    }

    /// Lets time pass after the last step until the checks of placement have lasted.
    fn last(&mut self, seen: &Seen) {
        if !self.lasting.is_empty() && self.lasted < TICKS_TO_LAST {
            self.lasted += 1;
            return;
        }
        for step in std::mem::take(&mut self.lasting) {
            let judged = self.state.act(&self.program.steps[step].action, seen);
            if let Err(what) = judged {
                let seconds = TICKS_TO_LAST / u64::from(TICKS_PER_SECOND);
                self.next = step;
                self.fail(step, format!("{what}, {seconds} s after the last step"));
                return;
            }
        }
        self.outcome = Outcome::Done;
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
        if self.commanded.is_some() {
            return Some(0);
        }
        let left = self.program.limit.saturating_sub(self.ticks);
        let step = self.program.steps.get(self.next);
        Some(match step.map(|step| &step.action) {
            Some(ProgramAction::Do(step)) => self.state.left_of_wait(step).min(left),
            Some(ProgramAction::SetScene(_)) => 0,
            None if self.lasting.is_empty() => 0,
            None => TICKS_TO_LAST - self.lasted,
        })
    }

    /// Passes over this many of the ticks that it [waits for](Self::waits_for), in which nothing changes.
    pub(crate) fn pass_over(&mut self, ticks: u64) {
        if self.outcome != Outcome::Running {
            return;
        }
        self.state.pass_over(ticks);
        match self.next < self.program.steps.len() {
            true => self.ticks += ticks,
            false => self.lasted += ticks,
        }
    }

    fn go_on(&mut self) {
        self.next += 1;
        self.state.begin_next();
    }

    fn fail(&mut self, step: usize, what: String) -> Vec<SimCommand> {
        let ProgramStep { at, text, .. } = &self.program.steps[step];
        self.outcome = Outcome::Failed(ScenarioError::Failed {
            at: at.clone(),
            step: text.clone(),
            what,
        });
        Vec::new()
    }
}

/// Whether a command may change where things are.
const fn acts(command: &SimCommand) -> bool {
    match command {
        SimCommand::Recording(_) | SimCommand::Clock(_) => false,
        SimCommand::Scene(_)
        | SimCommand::History(_)
        | SimCommand::Hand(_)
        | SimCommand::Mechanism(_)
        | SimCommand::Robot(_) => true,
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
    fn a_placement_must_last_after_the_last_step() {
        let steps = "WaitUntilRest(1), Expect(OnTopOf(object: \"high\", of: \"low\")), Finish";
        let mut stage = Stage::new(steps);
        assert!(stage.finish() > TICKS_TO_LAST);
        assert_eq!(*stage.run.outcome(), Outcome::Done);

        let mut stage = Stage::new(steps);
        while stage.run.steps_done() < 3 {
            stage.tick();
        }
        stage.tick();
        stage.poses[1].location.z = 0.5;
        let failure = stage.failure();
        assert!(
            failure.starts_with("s.ron:1:28: Expect(OnTopOf(object: \"high\", of: \"low\")): "),
            "{failure}"
        );
        assert!(
            failure.ends_with("1.000 too low, 3 s after the last step"),
            "{failure}"
        );
        assert_eq!(stage.run.checks_passed(), 0);
    }

    #[test]
    fn a_placement_need_not_last_once_something_acts() {
        let mut stage = Stage::new(
            "WaitUntilRest(1), Expect(OnTable(object: \"low\")), Clear, Expect(Exists(\"low\"))",
        );
        stage.finish();
        assert_eq!(*stage.run.outcome(), Outcome::Done);
        assert_eq!(stage.run.lasted, 0);
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
