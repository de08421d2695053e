//! Running a scenario, tick by tick.

use bevy::prelude::*;
use tabletop_core::{Hand, SimCommand, TICKS_PER_SECOND};

use crate::{
    Program, ScenarioError, Step,
    program::{Action, ProgramStep},
    rest::Stillness,
    seen::Seen,
};

/// A scenario on its way. [`ScenarioPlugin`](crate::ScenarioPlugin) runs the one that is in the world.
#[derive(Resource, Clone, Debug)]
pub struct ScenarioRun {
    program: Program,
    /// The step that is due.
    next: usize,
    /// For how many ticks it has been.
    ticks_in_step: u64,
    /// From where what is held glides in this step.
    glides_from: Vec3,
    /// The step whose command was given in the last tick.
    commanded: Option<usize>,
    ticks: u64,
    stillness: Stillness,
    outcome: Outcome,
}

/// How far a scenario has come.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Outcome {
    /// It goes on.
    #[default]
    Running,
    /// All steps are done, all that was expected was found.
    Done,
    /// It has stopped at a step.
    Failed(ScenarioError),
}

/// What comes of a step in a tick.
enum Progress {
    /// It is over without having taken time.
    Over,
    /// It is over with this command.
    Command(SimCommand),
    /// It goes on in the next tick, now with this command.
    GoesOn(Option<SimCommand>),
}

impl ScenarioRun {
    /// A run of this program from its beginning.
    pub fn new(program: Program) -> Self {
        Self {
            program,
            next: 0,
            ticks_in_step: 0,
            glides_from: Vec3::ZERO,
            commanded: None,
            ticks: 0,
            stillness: Stillness::default(),
            outcome: Outcome::Running,
        }
    }

    /// How far it has come.
    pub const fn outcome(&self) -> &Outcome {
        &self.outcome
    }

    /// Takes the steps that are due in a tick: at most one of them gives a command. `refusal` is what the last tick's
    /// command was refused for.
    pub(crate) fn tick(&mut self, seen: &Seen, refusal: Option<&str>) -> Option<SimCommand> {
        if self.outcome != Outcome::Running {
            return None;
        }
        self.stillness.observe(seen);
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
            let command = match self.act(&action, seen) {
                Err(what) => return self.fail(self.next, what),
                Ok(Progress::Over) => {
                    self.go_on();
                    continue;
                }
                Ok(Progress::Command(command)) => {
                    self.commanded = Some(self.next);
                    self.go_on();
                    Some(command)
                }
                Ok(Progress::GoesOn(command)) => {
                    self.commanded = command.as_ref().map(|_| self.next);
                    self.ticks_in_step += 1;
                    command
                }
            };
            self.ticks += 1;
            return command;
        }
    }

    fn go_on(&mut self) {
        self.next += 1;
        self.ticks_in_step = 0;
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

    fn act(&mut self, action: &Action, seen: &Seen) -> Result<Progress, String> {
        match action {
            Action::SetScene(scene) => Ok(Progress::Command(SimCommand::SetScene(scene.clone()))),
            Action::Do(step) => self.take(step, seen.selected, seen),
        }
    }

    fn take(&mut self, step: &Step, hand: Hand, seen: &Seen) -> Result<Progress, String> {
        if seen.paused && step.is_done_by_a_hand() {
            return Err("hands cannot act while the simulation is paused".to_owned());
        }
        Ok(Progress::Command(match step {
            Step::With(hand, step) => return self.take(step, *hand, seen),
            Step::Load { file, .. } => SimCommand::LoadTask(file.clone()),
            Step::Clear => SimCommand::ClearTable,
            Step::Select(hand) => SimCommand::SelectHand(*hand),
            Step::Grasp(object) => SimCommand::Grasp {
                hand,
                object: object.clone(),
            },
            Step::MoveTo(location) => SimCommand::MoveTo {
                hand,
                location: *location,
            },
            Step::MoveBy(offset) => SimCommand::MoveBy {
                hand,
                offset: *offset,
            },
            Step::Turn { axis, degrees } => SimCommand::Turn {
                hand,
                axis: axis.direction(),
                degrees: *degrees,
            },
            Step::Release => {
                seen.held_by(hand)?;
                SimCommand::Release(hand)
            }
            Step::Destroy => SimCommand::Destroy(hand),
            Step::Start => SimCommand::StartRecording,
            Step::Finish => SimCommand::FinishRecording,
            Step::Undo => SimCommand::Undo,
            Step::Redo => SimCommand::Redo,
            Step::Pause(pause) => SimCommand::SetPaused(*pause),
            Step::Glide { to, seconds } => return self.glide(*to, *seconds, hand, seen),
            Step::Wait(seconds) => return Ok(self.wait(*seconds)),
            Step::WaitUntilRest(timeout) => {
                let moving = self.stillness.moving(seen);
                return self.wait_while(moving, *timeout, "expected all at rest");
            }
            Step::WaitUntilThere(timeout) => {
                let held = seen.held_by(hand)?;
                let moving = (!self.stillness.has_arrived(held)).then_some(&*held.spec.id);
                return self.wait_while(moving, *timeout, "expected the hand to arrive");
            }
            Step::Expect(check) => {
                check.judge(seen, &self.stillness)?;
                return Ok(Progress::Over);
            }
        }))
    }

    fn wait(&self, seconds: f32) -> Progress {
        match self.ticks_in_step < ticks(seconds) {
            true => Progress::GoesOn(None),
            false => Progress::Over,
        }
    }

    fn wait_while(
        &self,
        moving: Option<&str>,
        timeout: f32,
        expected: &str,
    ) -> Result<Progress, String> {
        match moving {
            None => Ok(Progress::Over),
            Some(_) if self.ticks_in_step < ticks(timeout) => Ok(Progress::GoesOn(None)),
            Some(id) => Err(format!(
                "{expected}, found `{id}` still moving after {timeout} s"
            )),
        }
    }

    fn glide(
        &mut self,
        to: Vec3,
        seconds: f32,
        hand: Hand,
        seen: &Seen,
    ) -> Result<Progress, String> {
        if self.ticks_in_step == 0 {
            self.glides_from = seen.held_by(hand)?.pose.location;
        }
        let fraction = (self.ticks_in_step + 1) as f32 / ticks(seconds).max(1) as f32;
        let location = self.glides_from.lerp(to, fraction.min(1.0));
        let command = SimCommand::MoveTo { hand, location };
        Ok(match fraction < 1.0 {
            true => Progress::GoesOn(Some(command)),
            false => Progress::Command(command),
        })
    }
}

fn ticks(seconds: f32) -> u64 {
    (seconds * TICKS_PER_SECOND as f32).round() as u64
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use tabletop_core::{ObjectSpec, Pose, Rgb, SceneSpec, Shape, Table};

    use super::*;
    use crate::{Scenario, seen::SeenObject};

    /// A world that holds still unless a test moves it.
    struct Stage {
        run: ScenarioRun,
        specs: Vec<ObjectSpec>,
        poses: Vec<Pose>,
        holders: Vec<Option<Hand>>,
        selected: Hand,
        paused: bool,
    }

    impl Stage {
        fn new(steps: &str) -> Self {
            let text = format!("(steps: [{steps}])");
            let load = |_: &Path| Ok(SceneSpec::default());
            let program = Scenario::parse("s.ron", &text)
                .and_then(|scenario| Program::new(&scenario, load, 0));
            let program = match program {
                Ok(program) => program,
                Err(error) => panic!("{error}"),
            };
            let block = |id: &str| ObjectSpec {
                id: id.into(),
                pose: Pose::IDENTITY,
                mass: 1.0,
                shape: Shape::Block {
                    span: Vec3::ONE,
                    color: Rgb::GRAY,
                },
                descriptions: Vec::new(),
            };
            Self {
                run: ScenarioRun::new(program),
                specs: vec![block("low"), block("high")],
                poses: vec![Pose::at(Vec3::Z * 0.5), Pose::at(Vec3::Z * 1.5)],
                holders: vec![None, None],
                selected: Hand::Any,
                paused: false,
            }
        }

        fn tick_refused(&mut self, refusal: Option<&str>) -> Option<SimCommand> {
            let mut world = World::new();
            let objects = self
                .specs
                .iter()
                .enumerate()
                .map(|(index, spec)| SeenObject {
                    entity: world.spawn_empty().id(),
                    spec,
                    pose: self.poses[index],
                    holder: self.holders[index],
                });
            let seen = Seen {
                objects: objects.collect(),
                table: Some(Table::default()),
                selected: self.selected,
                paused: self.paused,
            };
            self.run.tick(&seen, refusal)
        }

        fn tick(&mut self) -> Option<SimCommand> {
            self.tick_refused(None)
        }

        /// Ticks until it is over, and how many that were.
        fn finish(&mut self) -> u64 {
            (0..10_000)
                .find(|_| {
                    self.tick();
                    *self.run.outcome() != Outcome::Running
                })
                .unwrap_or(10_000)
        }

        fn failure(&mut self) -> String {
            self.finish();
            match self.run.outcome() {
                Outcome::Failed(error) => error.to_string(),
                other => format!("{other:?}"),
            }
        }
    }

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
                SimCommand::SelectHand(Hand::Left),
                SimCommand::Grasp {
                    hand: Hand::Left,
                    object: "low".into()
                },
                SimCommand::MoveBy {
                    hand: Hand::Right,
                    offset: Vec3::Z
                },
                SimCommand::Turn {
                    hand: Hand::Left,
                    axis: Vec3::Y,
                    degrees: 5.0
                },
            ]
        );
        assert_eq!(*stage.run.outcome(), Outcome::Done);
    }

    #[test]
    fn waits_take_their_time_also_while_paused() {
        assert_eq!(Stage::new("Wait(0)").finish(), 0);
        let mut stage = Stage::new("Wait(0.5), Wait(1)");
        stage.paused = true;
        assert_eq!(stage.finish(), 90);
    }

    #[test]
    fn rest_is_half_a_second_without_motion() {
        let mut stage = Stage::new("WaitUntilRest(2)");
        for tick in 0..20 {
            stage.poses[0].location.x = tick as f32;
            stage.tick();
        }
        assert_eq!(stage.finish(), 29);
        assert_eq!(*stage.run.outcome(), Outcome::Done);

        let mut stage = Stage::new("WaitUntilRest(1)");
        let mut ticks = 0;
        while *stage.run.outcome() == Outcome::Running {
            stage.poses[1].location.x += 0.006;
            stage.tick();
            ticks += 1;
        }
        assert_eq!(ticks, 61);
        assert_eq!(
            stage.failure(),
            "s.ron:1:10: WaitUntilRest(1): expected all at rest, found `high` still moving after 1 s"
        );
    }

    #[test]
    fn hands_do_not_act_while_paused() {
        let mut stage = Stage::new("Clear, With(Left, Grasp(\"low\"))");
        stage.paused = true;
        assert!(stage.failure().contains("while the simulation is paused"));
    }

    #[test]
    fn nothing_comes_to_rest_while_paused() {
        let mut stage = Stage::new("WaitUntilRest(1)");
        stage.paused = true;
        assert!(stage.failure().contains("still moving"));
    }

    #[test]
    fn a_glide_goes_evenly_and_ends_where_it_is_told() {
        let mut stage = Stage::new("Glide(to: (6, 0, 0.5), seconds: 0.1)");
        stage.holders[0] = Some(Hand::Any);
        let way: Vec<_> = std::iter::from_fn(|| stage.tick())
            .map(|command| match command {
                SimCommand::MoveTo { location, .. } => location.x,
                other => panic!("{other:?}"),
            })
            .collect();
        assert_eq!(way.len(), 6);
        for (index, x) in way.into_iter().enumerate() {
            assert!((x - (index + 1) as f32).abs() < 1e-5);
        }
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
    fn a_hand_needs_something_to_carry() {
        for step in [
            "Release",
            "WaitUntilThere(1)",
            "Glide(to: (0, 0, 0), seconds: 1)",
        ] {
            let failure = Stage::new(step).failure();
            assert!(failure.contains("found nothing"), "{failure}");
        }
    }

    #[test]
    fn what_takes_too_long_fails() {
        let mut stage = Stage::new("Wait(5), Clear");
        stage.run.program.limit = 60;
        assert_eq!(
            stage.failure(),
            "s.ron:1:10: Wait(5): the limit of 1 s is over"
        );
    }

    #[test]
    fn checks_find_what_is_there() {
        let all = "WaitUntilRest(1), Expect(Location(object: \"low\", at: (0, 0, 0.5))), \
            Expect(Rotation(object: \"low\", degrees: (0, 0, 1))), \
            Expect(OnTopOf(object: \"high\", of: \"low\")), Expect(OnTable(object: \"low\")), \
            Expect(Inside(object: \"low\", of: \"low\")), Expect(AllAtRest), Expect(AtRest(\"low\")), \
            Expect(Exists(\"low\")), Expect(Gone(\"x\")), Expect(Free(\"low\")), \
            Expect(HeldBy(object: \"high\", hand: Both))";
        let mut stage = Stage::new(all);
        stage.holders[1] = Some(Hand::Both);
        assert_eq!(stage.failure(), "Done");
    }

    #[test]
    fn checks_say_what_they_expected_and_found() {
        for (check, words) in [
            (
                "Location(object: \"low\", at: (1, 0, 0.5))",
                "expected `low` within 0.05 of (1.000, 0.000, 0.500), found it at (0.000, 0.000, 0.500), 1.000 away",
            ),
            (
                "Rotation(object: \"low\", degrees: (0, 0, 3))",
                "3.0 degrees away",
            ),
            ("OnTopOf(object: \"low\", of: \"high\")", "2.000 too low"),
            ("OnTable(object: \"high\")", "1.000 above"),
            ("Inside(object: \"high\", of: \"low\")", "1.000 outside"),
            ("AllAtRest", "expected all at rest, found `low` moving"),
            ("AtRest(\"high\")", "found it moving"),
            ("Exists(\"x\")", "expected an object `x`, found none"),
            ("Gone(\"low\")", "expected no `low`, found it"),
            (
                "Free(\"high\")",
                "expected `high` in no hand, found it in LeftHand",
            ),
            (
                "HeldBy(object: \"low\", hand: Right)",
                "expected `low` in RightHand, found it in no hand",
            ),
        ] {
            let mut stage = Stage::new(&format!("Expect({check})"));
            stage.holders[1] = Some(Hand::Left);
            let failure = stage.failure();
            let text = format!("s.ron:1:10: Expect({check}): ");
            assert!(failure.starts_with(&text), "{failure}");
            assert!(failure.contains(words), "{failure}");
        }
    }
}
