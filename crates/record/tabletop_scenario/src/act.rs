//! The action of each step of a scenario.

use bevy::prelude::*;
use tabletop_core::{
    ClockCommand, Hand, HandCommand, HistoryCommand, MechanismCommand, Random, RecordingCommand,
    SceneCommand, SimCommand, TICKS_PER_SECOND,
};
use tabletop_program::TaskProgram;

use crate::{
    RobotStep, Step,
    program::ProgramAction,
    rest::Stillness,
    robot::{TICKS_TO_STILL, is_still},
    seen::Seen,
    telling::HandTelling,
};

/// The state of the step that is due.
#[derive(Clone, Debug)]
pub(crate) struct StepState {
    random: Random,
    /// Number of ticks for which the step has been due.
    ticks: u64,
    /// Start of the held object's glide in this step.
    glides_from: Vec3,
    /// The program of tasks that this step carries out.
    telling: Option<Box<HandTelling>>,
    stillness: Stillness,
    /// Number of ticks in which nothing of the robot has moved.
    robot_still: u64,
}

/// The outcome of a step in a tick.
pub(crate) enum StepProgress {
    /// It is over without having taken time.
    Over,
    /// It is over with this command.
    Command(SimCommand),
    /// It goes on in the next tick, now with these commands.
    GoesOn(Vec<SimCommand>),
}

impl StepState {
    /// The state at the beginning of a scenario, with this source of random numbers.
    pub fn new(random: Random) -> Self {
        Self {
            random,
            ticks: 0,
            glides_from: Vec3::ZERO,
            telling: None,
            stillness: Stillness::default(),
            robot_still: 0,
        }
    }

    /// Takes in the result of a tick.
    pub fn observe(&mut self, seen: &Seen) {
        self.stillness.observe(seen);
        self.robot_still = match is_still(seen.robot) {
            true => self.robot_still + 1,
            false => 0,
        };
    }

    /// Keeps the step due for the next tick.
    pub const fn go_on(&mut self) {
        self.ticks += 1;
    }

    /// Makes the next step due.
    pub fn begin_next(&mut self) {
        self.telling = None;
        self.robot_still = 0;
        self.ticks = 0;
    }

    /// Acts on the step that is due.
    pub fn act(&mut self, action: &ProgramAction, seen: &Seen) -> Result<StepProgress, String> {
        match action {
            ProgramAction::SetScene(scene) => Ok(StepProgress::Command(SimCommand::Scene(
                SceneCommand::Set(scene.clone()),
            ))),
            ProgramAction::Do(step) => self.take(step, seen.selected, seen),
        }
    }

    fn take(&mut self, step: &Step, hand: Hand, seen: &Seen) -> Result<StepProgress, String> {
        Ok(StepProgress::Command(match step {
            Step::With(hand, step) => return self.take(step, *hand, seen),
            Step::Load { file, .. } => SimCommand::Scene(SceneCommand::Load(file.clone())),
            Step::Clear => SimCommand::Scene(SceneCommand::Clear),
            Step::Make(preset) => SimCommand::Scene(SceneCommand::Make {
                preset: *preset,
                seed: self.random.bits(),
            }),
            Step::Select(hand) => SimCommand::Hand(HandCommand::Select(*hand)),
            Step::Grasp(object) => SimCommand::Hand(HandCommand::Grasp {
                hand,
                object: object.clone(),
            }),
            Step::MoveTo(location) => SimCommand::Hand(HandCommand::MoveTo {
                hand,
                location: *location,
            }),
            Step::MoveBy(offset) => SimCommand::Hand(HandCommand::MoveBy {
                hand,
                offset: *offset,
            }),
            Step::Turn { axis, degrees } => SimCommand::Hand(HandCommand::Turn {
                hand,
                axis: axis.direction(),
                degrees: *degrees,
            }),
            Step::Release => {
                seen.held_by(hand)?;
                SimCommand::Hand(HandCommand::Release(hand))
            }
            Step::Destroy => SimCommand::Hand(HandCommand::Destroy(hand)),
            Step::Trigger(control) => SimCommand::Mechanism(MechanismCommand::Trigger {
                hand,
                control: control.clone(),
                part: None,
            }),
            Step::TriggerPart(control, part) => SimCommand::Mechanism(MechanismCommand::Trigger {
                hand,
                control: control.clone(),
                part: Some(*part),
            }),
            Step::PointTo(target) => SimCommand::Mechanism(MechanismCommand::PointTo {
                hand,
                target: target.clone(),
            }),
            Step::Fasten(guest) => SimCommand::Mechanism(MechanismCommand::Fasten {
                hand,
                guest: guest.clone(),
            }),
            Step::Loosen(guest) => SimCommand::Mechanism(MechanismCommand::Loosen {
                hand,
                guest: guest.clone(),
            }),
            Step::Cut(blade) => SimCommand::Mechanism(MechanismCommand::Cut {
                hand,
                blade: blade.clone(),
            }),
            Step::Start => SimCommand::Recording(RecordingCommand::Start),
            Step::Finish => SimCommand::Recording(RecordingCommand::Finish),
            Step::Undo => SimCommand::History(HistoryCommand::Undo),
            Step::Redo => SimCommand::History(HistoryCommand::Redo),
            Step::Pause(pause) => SimCommand::Clock(ClockCommand::SetPaused(*pause)),
            Step::Glide { to, seconds } => return self.glide(*to, *seconds, hand, seen),
            Step::Robot(RobotStep::WaitUntilStill(timeout)) => {
                let moving = (self.robot_still < TICKS_TO_STILL).then_some("the robot");
                return self.wait_while(moving, *timeout, "expected the robot to be still");
            }
            Step::Robot(step) => match step.command(seen.layout)? {
                Some(command) => command,
                None => return Ok(StepProgress::Over),
            },
            Step::Do(sentences) => return self.tell(sentences, hand, seen),
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
                return Ok(StepProgress::Over);
            }
        }))
    }

    fn wait(&self, seconds: f32) -> StepProgress {
        match self.ticks < ticks(seconds) {
            true => StepProgress::GoesOn(Vec::new()),
            false => StepProgress::Over,
        }
    }

    /// Passes over this many ticks of a step in which nothing changes.
    pub(crate) fn pass_over(&mut self, ticks: u64) {
        self.stillness.pass_over(ticks);
        if self.robot_still > 0 {
            self.robot_still += ticks;
        }
        self.ticks += ticks;
    }

    /// Number of ticks left of a step that does nothing but wait.
    pub(crate) fn left_of_wait(&self, step: &Step) -> u64 {
        match step {
            Step::With(_, step) => self.left_of_wait(step),
            Step::Wait(seconds) => ticks(*seconds).saturating_sub(self.ticks),
            Step::Load { .. }
            | Step::Clear
            | Step::Make(_)
            | Step::Select(_)
            | Step::Grasp(_)
            | Step::MoveTo(_)
            | Step::MoveBy(_)
            | Step::Turn { .. }
            | Step::Glide { .. }
            | Step::Release
            | Step::Destroy
            | Step::Cut(_)
            | Step::Do(_)
            | Step::Trigger(_)
            | Step::TriggerPart(..)
            | Step::PointTo(_)
            | Step::Fasten(_)
            | Step::Loosen(_)
            | Step::Start
            | Step::Finish
            | Step::Undo
            | Step::Redo
            | Step::Pause(_)
            | Step::Robot(_)
            | Step::WaitUntilRest(_)
            | Step::WaitUntilThere(_)
            | Step::Expect(_) => 0,
        }
    }

    fn wait_while(
        &self,
        moving: Option<&str>,
        timeout: f32,
        expected: &str,
    ) -> Result<StepProgress, String> {
        match moving {
            None => Ok(StepProgress::Over),
            Some(_) if self.ticks < ticks(timeout) => Ok(StepProgress::GoesOn(Vec::new())),
            Some(id) => Err(format!(
                "{expected}, found `{id}` still moving after {timeout} s"
            )),
        }
    }

    fn tell(&mut self, sentences: &str, hand: Hand, seen: &Seen) -> Result<StepProgress, String> {
        let telling = match &mut self.telling {
            Some(telling) => telling,
            none @ None => {
                let program = sentences.parse::<TaskProgram>();
                let program = program.map_err(|fault| fault.to_string())?;
                none.insert(Box::new(HandTelling::begin(&program, hand, seen)))
            }
        };
        Ok(match telling.tick(seen)? {
            None => StepProgress::Over,
            Some(commands) => {
                let commands = commands.into_iter().map(SimCommand::Hand);
                StepProgress::GoesOn(commands.collect())
            }
        })
    }

    fn glide(
        &mut self,
        to: Vec3,
        seconds: f32,
        hand: Hand,
        seen: &Seen,
    ) -> Result<StepProgress, String> {
        if self.ticks == 0 {
            self.glides_from = seen.held_by(hand)?.pose.location;
        }
        let fraction = (self.ticks + 1) as f32 / ticks(seconds).max(1) as f32;
        let location = self.glides_from.lerp(to, fraction.min(1.0));
        let command = SimCommand::Hand(HandCommand::MoveTo { hand, location });
        Ok(match fraction < 1.0 {
            true => StepProgress::GoesOn(vec![command]),
            false => StepProgress::Command(command),
        })
    }
}

fn ticks(seconds: f32) -> u64 {
    (seconds * TICKS_PER_SECOND as f32).round() as u64
}

#[cfg(test)]
mod tests {
    use tabletop_core::RobotCommand;

    use super::*;
    use crate::{Outcome, test_stage::Stage};

    /// The steps that give each kind of command.
    const STEPS: [&str; 24] = [
        "Start",
        "Finish",
        "Pause(true)",
        "Load(file: \"a.xml\")",
        "Clear",
        "Make(BigBlock)",
        "Undo",
        "Redo",
        "Select(Left)",
        "Grasp(\"low\")",
        "MoveTo((0, 0, 1))",
        "MoveBy((0, 0, 1))",
        "Turn(axis: Z, degrees: 5)",
        "Release",
        "Destroy",
        "Trigger(\"low\")",
        "PointTo(\"low\")",
        "Fasten(\"low\")",
        "Loosen(\"low\")",
        "Cut(\"low\")",
        "Robot(Show)",
        "Robot(Close(Left))",
        "Robot(ReachTo(arm: Left, at: (0, 0, 1)))",
        "Robot(Face(Asleep))",
    ];

    /// The one of [`STEPS`] that gives such a command; `None` for commands that only the program and scripts give.
    fn step_of(command: &SimCommand) -> Option<&'static str> {
        let place = match command {
            SimCommand::Recording(RecordingCommand::Start) => 0,
            SimCommand::Recording(RecordingCommand::Finish) => 1,
            SimCommand::Clock(ClockCommand::SetPaused(_)) => 2,
            // A scenario reads its files before it runs.
            SimCommand::Scene(SceneCommand::Load(_)) => return None,
            // Who edits a scene does not demonstrate.
            SimCommand::Scene(SceneCommand::Edit(_)) => return None,
            SimCommand::Scene(SceneCommand::Set(_)) => 3,
            SimCommand::Scene(SceneCommand::Clear) => 4,
            SimCommand::Scene(SceneCommand::Make { .. }) => 5,
            SimCommand::History(HistoryCommand::Undo) => 6,
            SimCommand::History(HistoryCommand::Redo) => 7,
            SimCommand::Hand(HandCommand::Select(_)) => 8,
            SimCommand::Hand(HandCommand::Grasp { .. }) => 9,
            SimCommand::Hand(HandCommand::MoveTo { .. }) => 10,
            SimCommand::Hand(HandCommand::MoveBy { .. }) => 11,
            SimCommand::Hand(HandCommand::Turn { .. }) => 12,
            SimCommand::Hand(HandCommand::Release(_)) => 13,
            SimCommand::Hand(HandCommand::Destroy(_)) => 14,
            SimCommand::Mechanism(MechanismCommand::Trigger { .. }) => 15,
            SimCommand::Mechanism(MechanismCommand::PointTo { .. }) => 16,
            SimCommand::Mechanism(MechanismCommand::Fasten { .. }) => 17,
            SimCommand::Mechanism(MechanismCommand::Loosen { .. }) => 18,
            SimCommand::Robot(RobotCommand::Show(_)) => 20,
            SimCommand::Robot(RobotCommand::Drive(_)) => 21,
            SimCommand::Robot(RobotCommand::ReachTo { .. }) => 22,
            SimCommand::Robot(RobotCommand::ShowFace(_)) => 23,
            SimCommand::Mechanism(MechanismCommand::Cut { .. }) => 19,
            SimCommand::Robot(RobotCommand::ShowMarkers(_) | RobotCommand::Mirror(_)) => {
                return None;
            }
        };
        Some(STEPS[place])
    }

    #[test]
    fn every_command_of_a_user_is_a_step() {
        for step in STEPS {
            let mut stage = Stage::new(step);
            stage.holders[0] = Some(Hand::Any);
            let command = stage.tick();
            assert_eq!(
                command.as_ref().and_then(step_of),
                Some(step),
                "{command:?}"
            );
        }
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
    fn nothing_comes_to_rest_while_paused() {
        let mut stage = Stage::new("WaitUntilRest(1)");
        stage.paused = true;
        assert!(stage.failure().contains("still moving"));
    }

    #[test]
    fn a_glide_goes_evenly_and_ends_where_it_is_sent() {
        let mut stage = Stage::new("Glide(to: (6, 0, 0.5), seconds: 0.1)");
        stage.holders[0] = Some(Hand::Any);
        let way: Vec<_> = std::iter::from_fn(|| stage.tick())
            .map(|command| {
                let SimCommand::Hand(HandCommand::MoveTo { location, .. }) = command else {
                    panic!("{command:?}");
                };
                location.x
            })
            .collect();
        assert_eq!(way.len(), 6);
        for (index, x) in way.into_iter().enumerate() {
            assert!((x - (index + 1) as f32).abs() < 1e-5);
        }
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
}
