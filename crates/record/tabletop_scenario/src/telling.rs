//! Programs of tasks that a hand carries out, tick by tick.

use tabletop_core::{Hand, HandCommand};
use tabletop_program::{
    HandProgress, HandStep, HandledObject, Impossible, NextAttempt, ProgramAttempts, StepAttempt,
    TaskProgram,
};

use crate::seen::Seen;

/// A program that a hand carries out.
#[derive(Clone, Debug)]
pub(crate) struct HandTelling {
    hand: Hand,
    attempts: ProgramAttempts,
    /// The step that it does.
    doing: Option<(StepAttempt, HandStep)>,
    /// Number of ticks for which it waits after a step.
    settling: u64,
}

impl HandTelling {
    pub fn begin(program: &TaskProgram, hand: Hand, seen: &Seen) -> Self {
        Self {
            hand,
            attempts: ProgramAttempts::begin(program, &seen.table_scene()),
            doing: None,
            settling: 0,
        }
    }

    /// The commands of a tick; `None` if there is nothing left to do.
    pub fn tick(&mut self, seen: &Seen) -> Result<Option<Vec<HandCommand>>, String> {
        loop {
            if self.settling > 0 {
                self.settling -= 1;
                return Ok(Some(Vec::new()));
            }
            match self.doing.take() {
                None => {
                    let scene = seen.table_scene();
                    let attempt = match self.attempts.next_on(&scene) {
                        NextAttempt::Try(attempt) => attempt,
                        NextAttempt::Done => return Ok(None),
                        NextAttempt::Impossible(reason) => return Err(reason.to_string()),
                        NextAttempt::Misplaced(StepAttempt { step, sentence, .. }) => {
                            let reason = format!("{} is not where it was put", step.object);
                            return Err(Impossible::sentence(sentence, reason).to_string());
                        }
                    };
                    let step = HandStep::begin(&scene, &attempt.step, self.hand);
                    self.doing = Some((attempt, step));
                }
                Some((attempt, mut step)) => match step.tick(self.handled(&step, seen)) {
                    HandProgress::GoesOn(commands) => {
                        self.doing = Some((attempt, step));
                        return Ok(Some(commands));
                    }
                    HandProgress::Over(Ok(())) => {
                        self.attempts.did(attempt);
                        self.settling = ProgramAttempts::SETTLING;
                    }
                    HandProgress::Over(Err(failure)) => {
                        return Err(format!("{} {failure}", attempt.sentence));
                    }
                },
            }
        }
    }

    fn handled(&self, step: &HandStep, seen: &Seen) -> HandledObject {
        let object = seen.object(step.object()).ok();
        HandledObject {
            location: object.map(|object| object.pose.location),
            is_held: object.is_some_and(|object| object.holder == Some(self.hand)),
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy::prelude::*;
    use tabletop_core::{Hand, HandCommand, SimCommand};

    use crate::{Outcome, test_stage::Stage};

    /// A world in which hands do at once what they are told.
    fn told(steps: &str) -> (Stage, Vec<Hand>) {
        let mut stage = Stage::new(steps);
        stage.poses[1].location = Vec3::new(-3.0, 0.0, 0.5);
        let mut hands = Vec::new();
        for _ in 0..2000 {
            for command in stage.tick_refused(None) {
                let SimCommand::Hand(command) = command else {
                    continue;
                };
                match command {
                    HandCommand::Grasp { hand, object } => {
                        let index = stage.specs.iter().position(|spec| spec.id == object);
                        stage.holders[index.unwrap()] = Some(hand);
                        hands.push(hand);
                    }
                    HandCommand::MoveTo { hand, location } => {
                        let held = held(&stage, hand);
                        stage.poses[held].location = location;
                    }
                    HandCommand::Release(hand) => {
                        let held = held(&stage, hand);
                        stage.holders[held] = None;
                    }
                    HandCommand::Select(_)
                    | HandCommand::MoveBy { .. }
                    | HandCommand::Turn { .. }
                    | HandCommand::Destroy(_) => {}
                }
            }
        }
        (stage, hands)
    }

    fn held(stage: &Stage, hand: Hand) -> usize {
        let mut holders = stage.holders.iter();
        holders.position(|&holder| holder == Some(hand)).unwrap()
    }

    #[test]
    fn the_selected_hand_or_a_named_one_does_what_is_said() {
        let (stage, hands) = told("Do(\"Put \\\"high\\\" on \\\"low\\\".\")");
        assert_eq!(*stage.run.outcome(), Outcome::Done);
        assert_eq!(hands, [Hand::Any]);
        let at = stage.poses[1].location;
        assert!(at.distance(Vec3::Z * 1.5) < 0.05, "{at}");
        let (stage, hands) = told("With(Left, Do(\"Put \\\"low\\\" on \\\"high\\\".\"))");
        assert_eq!(*stage.run.outcome(), Outcome::Done);
        assert_eq!(hands, [Hand::Left]);
    }

    #[test]
    fn what_cannot_be_done_fails_its_step() {
        let failure = Stage::new("Do(\"Put the red block on \\\"low\\\".\")").failure();
        assert!(failure.starts_with("s.ron:1:10: Do("), "{failure}");
        assert!(failure.contains("red block"), "{failure}");
        let failure = Stage::new("Do(\"Put \\\"high\\\" on the table.\")").failure();
        assert!(
            failure.ends_with("the hand does not hold high"),
            "{failure}"
        );
    }
}
