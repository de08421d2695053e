//! Imitation: the steps of a task, with a look at the world after each.

mod arms;
mod cleared;
mod clearing;
mod loading;
mod putting_back;
mod regrasp;
mod slider;
mod sliding;
mod step;

use cleared::Cleared;
use tabletop_controller::{Angles, Sight};
use tabletop_task::{Binding, PlaceRange, Reference, Relation, Task, TaskStep};

use crate::{
    body::RobotBody,
    failure::PlanFailure,
    goals::{Before, is_met},
    grasp::GraspSide,
    motion::wait,
    sight::Arranged as _,
    stage::{PlanningStage, Stopped},
};

/// The result of doing a task.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Imitation {
    /// Number of steps done.
    pub steps_done: usize,
    /// Number of repeated tries.
    pub corrections: usize,
    /// The number of the failed step and the reason, if the robot gave up.
    pub failure: Option<(usize, PlanFailure)>,
}

/// The robot's present step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Doing {
    /// Number of the step.
    pub step: usize,
    /// Number of earlier tries.
    pub tries: usize,
}

/// Number of tries of a step.
const TRIES: usize = 3;

/// Does a task. `seed` decides all random trials; `tell` is called with every step before it is tried.
pub fn imitate(
    stage: &mut dyn PlanningStage,
    body: &RobotBody,
    task: &Task,
    binding: &Binding,
    seed: u64,
    mut tell: impl FnMut(Doing),
) -> Imitation {
    let mut imitator = Imitator {
        body,
        task,
        binding,
        seed,
        parked: Vec::new(),
        before: Before::anything(stage.sight()),
        loaded: None,
        cleared: Vec::new(),
        outcome: Imitation::default(),
    };
    if imitator.do_all(stage, &mut tell).is_err() {
        let step = imitator.outcome.steps_done + 1;
        imitator.outcome.failure = Some((step, PlanFailure::Stopped));
    }
    imitator.outcome
}

/// The first finished step whose relations no longer hold, because a later step has undone them; `None` if all hold. Of several steps
/// with one object, only the last counts.
pub fn undone(
    task: &Task,
    binding: &Binding,
    sight: &Sight,
    before: &Before,
) -> Option<(usize, PlanFailure)> {
    let is_last = |step: &&TaskStep| !is_moved_after(task, step.number, &step.object);
    let stays = |step: &&TaskStep| {
        step.goal
            .as_ref()
            .is_some_and(|goal| goal.reference != Reference::Itself)
    };
    let mut lasting = task.steps.iter().filter(is_last).filter(stays);
    lasting.find_map(
        |step| match is_met(&lasting_part(task, step), binding, sight, before) {
            Ok(true) => None,
            Ok(false) => {
                let object = binding.object(&step.object).unwrap_or(&step.object);
                Some((step.number, PlanFailure::Misplaced(object.to_owned())))
            }
            Err(gone) => Some((step.number, gone)),
        },
    )
}

/// True if a step after this one moves an object, by itself or with another one.
fn is_moved_after(task: &Task, number: usize, object: &str) -> bool {
    let mut later = task.steps[number..].iter();
    later.any(|later| later.object == object || later.load.iter().any(|load| load.object == object))
}

/// A step without the part of its load that is moved later.
fn lasting_part(task: &Task, step: &TaskStep) -> TaskStep {
    let mut lasting = step.clone();
    lasting
        .load
        .retain(|load| !is_moved_after(task, step.number, &load.object));
    lasting
}

struct Imitator<'a> {
    body: &'a RobotBody,
    task: &'a Task,
    binding: &'a Binding,
    seed: u64,
    /// The posture in which each limb waits.
    parked: Vec<Angles>,
    before: Before,
    /// Ids of the objects that go along with the one that is moved now, and the id of that.
    loaded: Option<(String, Vec<String>)>,
    /// Objects that were moved out of the way, in this order.
    cleared: Vec<Cleared>,
    outcome: Imitation,
}

impl Imitator<'_> {
    fn do_all(
        &mut self,
        stage: &mut dyn PlanningStage,
        tell: &mut dyn FnMut(Doing),
    ) -> Result<(), Stopped> {
        let sees_all = stage.look().is_empty();
        if sees_all && self.gives_up(stage.sight()) {
            return Ok(());
        }
        self.park_all(stage)?;
        self.look(stage)?;
        if !sees_all && self.gives_up(stage.sight()) {
            return Ok(());
        }
        self.before = Before::anything(stage.sight());
        for i in 0..self.task.steps.len() {
            let step = &self.task.steps[i];
            let object = self.binding.object(&step.object);
            self.before.step = object.and_then(|id| Some(stage.sight().objects.get(id)?.pose));
            let mut failure = None;
            for tries in 0..TRIES {
                tell(Doing {
                    step: step.number,
                    tries,
                });
                self.outcome.corrections += usize::from(tries > 0);
                self.look(stage)?;
                let place = |sight: &Sight| Some(sight.objects.get(object?)?.pose);
                let before = place(stage.sight());
                failure = self.do_step(stage, i).err();
                if failure == Some(PlanFailure::Stopped) {
                    return Err(Stopped);
                }
                wait(stage, 10)?;
                self.look(stage)?;
                let is_met = is_met(step, self.binding, stage.sight(), &self.before);
                match (is_met, &failure) {
                    (Ok(true), None) => break,
                    (Ok(true), Some(_))
                        if step
                            .goal
                            .as_ref()
                            .is_some_and(|goal| goal.place != PlaceRange::Anywhere) =>
                    {
                        failure = None;
                        break;
                    }
                    (Ok(false), None) => {
                        let object = self.binding.object(&step.object).unwrap_or(&step.object);
                        failure = Some(PlanFailure::Misplaced(object.to_owned()));
                    }
                    (Err(gone), _) => failure = Some(gone),
                    (Ok(_), Some(_)) => {}
                }
                let is_untouched = match (before, place(stage.sight())) {
                    (Some(before), Some(now)) => before.location.distance(now.location) < 0.01,
                    (None, None) => true,
                    (Some(_), None) | (None, Some(_)) => false,
                };
                if is_untouched && failure.as_ref().is_some_and(PlanFailure::is_final) {
                    break;
                }
                // Where the real object is, nobody knows.
                if matches!(failure, Some(PlanFailure::EmptyHand { .. })) {
                    break;
                }
                self.seed = self.seed.wrapping_add(1);
            }
            if let Some(failure) = failure {
                self.outcome.failure = Some((step.number, failure));
                break;
            }
            self.outcome.steps_done += 1;
        }
        if self.outcome.failure.is_none() {
            self.put_all_back(stage)?;
            self.outcome.failure = self.redo_undone(stage)?;
        }
        let is_held = |step: &TaskStep| step.relations.first() == Some(&Relation::Held);
        if !self.task.steps.iter().any(is_held) {
            for limb in 0..self.body.limbs.len() {
                self.try_to_park(stage, limb)?;
            }
        }
        wait(stage, 30)
    }

    /// Does steps again that later ones have undone. Returns the failure of one that is still undone in the end.
    fn redo_undone(
        &mut self,
        stage: &mut dyn PlanningStage,
    ) -> Result<Option<(usize, PlanFailure)>, Stopped> {
        for _ in 0..TRIES {
            self.look(stage)?;
            let undone = undone(self.task, self.binding, stage.sight(), &self.before);
            let Some((number, PlanFailure::Misplaced(_))) = undone else {
                return Ok(undone);
            };
            self.outcome.corrections += 1;
            if self.do_step(stage, number - 1) == Err(PlanFailure::Stopped) {
                return Err(Stopped);
            }
            wait(stage, 10)?;
        }
        self.look(stage)?;
        Ok(undone(self.task, self.binding, stage.sight(), &self.before))
    }

    /// Looks at the table. If an arm may hide something, the free arms go to their waiting places first.
    fn look(&self, stage: &mut dyn PlanningStage) -> Result<(), Stopped> {
        if stage.look().is_empty() {
            return Ok(());
        }
        for limb in 0..self.parked.len() {
            if stage.sight().limbs[limb].holds.is_empty() {
                self.try_to_park(stage, limb)?;
            }
        }
        stage.look();
        Ok(())
    }

    /// True if it gives up at once, since no arm takes an object of the task where it stands.
    fn gives_up(&mut self, sight: &Sight) -> bool {
        self.outcome.failure = self.unreached(sight);
        self.outcome.failure.is_some()
    }

    /// The first step whose object no arm can take where it stands in the beginning. Objects on, in or around others may be elsewhere by then.
    fn unreached(&self, sight: &Sight) -> Option<(usize, PlanFailure)> {
        let arrangement = sight.arrangement();
        let mut begun = Vec::new();
        self.task.steps.iter().find_map(|step| {
            let id = self.binding.object(&step.object)?;
            let is_begun = begun.contains(&id);
            begun.push(id);
            let carriers = [
                arrangement.supports(id),
                arrangement.containers(id),
                arrangement.posts(id),
            ];
            if is_begun || !carriers.concat().is_empty() {
                return None;
            }
            let limbs = 0..self.body.limbs.len();
            let reach = |limb| self.transfer(limb, id, GraspSide::Any).reach(sight);
            let failures: Option<Vec<_>> = limbs.map(|limb| reach(limb).err()).collect();
            let failure = failures?.into_iter().next()?;
            Some((step.number, failure))
        })
    }
}
