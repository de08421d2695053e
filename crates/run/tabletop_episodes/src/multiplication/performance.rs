//! A task, performed again by the hand of the demonstration.

use std::f32::consts::{PI, TAU};

use bevy::prelude::*;
use tabletop_camera::Camera;
use tabletop_controller::Sight;
use tabletop_core::{
    Hand, HandCommand, Hands, ObjectIndex, SimTick, StepApp as _, WriteCommand as _,
};
use tabletop_geometry::{PlacedSolid, Pose};
use tabletop_planner::{Arranged as _, Before, PlanFailure, Solids as _, is_met, undone};
use tabletop_task::{
    Binding, Demonstration, PlaceRange, Reference, Relation, Task, TaskStep, angle_between,
};

use super::{
    operated::Operated,
    way::{CarriedWay, WayPoint},
};
use crate::still_scene::has_in_view;

/// Limits on the number of ticks between a release and the next grasp, which is otherwise as demonstrated.
const PAUSE: (u64, u64) = (15, 60);
/// Largest number of ticks for which a grasp or an operation follows another operation later, as demonstrated.
const MOST_AFTER_OPERATION: u64 = 600;
/// Number of ticks without motion after which a held object has arrived.
const STILL: u32 = 4;
/// Largest number of ticks that a hand waits for that.
const MOST_WAITING: u32 = 90;
/// Number of ticks after the last step.
const END: u64 = 60;
/// Distance from everything, seen from above, of an object that is put aside, in units.
const ASIDE: f32 = 0.4;
/// Least angle by which a hand is commanded to turn, in rad.
const LEAST_TURN: f32 = 1e-4;
/// Largest motion in a tick, in units, of an object that stays in place.
const SAME: f32 = 1e-3;

/// Lets the hand do the task with the objects that take its roles, and checks its relations at the end. What is put aside stays in view of a
/// camera, if one is given. An error names the failed step.
pub(super) fn perform(
    app: &mut App,
    shown: &Demonstration,
    task: &Task,
    operated: &[Operated],
    binding: &Binding,
    view: Option<&Camera>,
) -> Result<(), (usize, PlanFailure)> {
    let sight = Sight::of(app.world_mut());
    let mut performance = Performance {
        binding,
        before: Before::anything(&sight),
        view,
        acts: acts(shown, task)?,
        operations: operated.iter().map(|operated| (operated, None)).collect(),
        app,
    };
    while !performance.is_over() {
        performance.begin_due_acts()?;
        performance.operate();
        performance.move_hands();
        performance.app.step(1);
        performance.look()?;
    }
    performance.app.step(END);
    performance.judge(task)
}

struct Performance<'a> {
    app: &'a mut App,
    binding: &'a Binding,
    before: Before,
    /// The camera that is to see everything.
    view: Option<&'a Camera>,
    /// The steps, in the order in which their objects were grasped.
    acts: Vec<StepPerformance<'a>>,
    /// What else was done, and when it has been done again.
    operations: Vec<(&'a Operated, Option<SimTick>)>,
}

/// A step in its new performance.
struct StepPerformance<'a> {
    step: &'a TaskStep,
    carried: CarriedWay,
    progress: CarryProgress,
    /// Pose of its object before.
    from: Pose,
}

enum CarryProgress {
    Waiting,
    Carrying {
        begun: SimTick,
        hand: Hand,
        way: Vec<WayPoint>,
        next: usize,
        /// Target of the object.
        target: Pose,
        /// Pose of the object a tick ago.
        last: Pose,
        /// The ticks since which it has been still, and since which it is expected to have arrived.
        still: u32,
        waited: u32,
    },
    Done(SimTick),
}

fn acts<'a>(
    shown: &Demonstration,
    task: &'a Task,
) -> Result<Vec<StepPerformance<'a>>, (usize, PlanFailure)> {
    let mut acts = Vec::new();
    for step in &task.steps {
        let carried = CarriedWay::of(shown, step);
        let carried =
            carried.ok_or_else(|| (step.number, PlanFailure::Gone(step.object.clone())))?;
        acts.push(StepPerformance {
            step,
            carried,
            progress: CarryProgress::Waiting,
            from: Pose::IDENTITY,
        });
    }
    acts.sort_by_key(|act| act.step.grasp);
    Ok(acts)
}

impl Performance<'_> {
    fn is_over(&self) -> bool {
        let is_done = |act: &StepPerformance| matches!(act.progress, CarryProgress::Done(_));
        self.acts.iter().all(is_done) && self.operations.iter().all(|(_, done)| done.is_some())
    }

    fn now(&self) -> SimTick {
        *self.app.world().resource::<SimTick>()
    }

    /// True if all that was done before this tick of the demonstration has been done, and as long ago.
    fn has_operated_before(&self, tick: SimTick) -> bool {
        let now = self.now().0;
        let mut before = self.operations.iter().filter(|(one, _)| one.tick < tick);
        before.all(|(one, done)| {
            let pause = (tick.0 - one.tick.0).min(MOST_AFTER_OPERATION);
            done.is_some_and(|done| now - done.0 >= pause)
        })
    }

    /// Does what else is due.
    fn operate(&mut self) {
        let now = self.now();
        while let Some(next) = self.operations.iter().position(|(_, done)| done.is_none()) {
            let operated = self.operations[next].0;
            if !self.is_operation_due(operated) {
                return;
            }
            self.operations[next].1 = Some(now);
            let command = operated.bound(self.binding);
            self.app.world_mut().write_command(command);
        }
    }

    /// True if the steps and operations before one are as far along as they were.
    fn is_operation_due(&self, operated: &Operated) -> bool {
        let (now, tick) = (self.now().0, operated.tick);
        let mut begun = self.acts.iter().filter(|act| act.step.grasp < tick);
        self.has_operated_before(tick)
            && begun.all(|act| match &act.progress {
                CarryProgress::Waiting => false,
                CarryProgress::Carrying { way, next, .. } => {
                    let passed = tick.0 - act.step.grasp.0;
                    tick <= act.step.release
                        && way.get(*next).is_none_or(|point| point.shown > passed)
                }
                CarryProgress::Done(since) => {
                    let pause = tick.0.saturating_sub(act.step.release.0);
                    now - since.0 >= pause.min(PAUSE.1)
                }
            })
    }

    /// True if the steps grasped earlier are as far along as they were when this one's object was grasped.
    fn is_due(&self, i: usize) -> bool {
        let (now, own) = (self.now().0, self.acts[i].step);
        if !self.has_operated_before(own.grasp) {
            return false;
        }
        self.acts[..i].iter().all(|earlier| {
            let is_meanwhile = earlier.step.release > own.grasp;
            match &earlier.progress {
                CarryProgress::Waiting => false,
                CarryProgress::Carrying { begun, .. } => {
                    is_meanwhile && now - begun.0 >= own.grasp.0 - earlier.step.grasp.0
                }
                CarryProgress::Done(since) => {
                    let pause = own.grasp.0.saturating_sub(earlier.step.release.0);
                    is_meanwhile || now - since.0 >= pause.clamp(PAUSE.0, PAUSE.1)
                }
            }
        })
    }

    fn begin_due_acts(&mut self) -> Result<(), (usize, PlanFailure)> {
        for i in 0..self.acts.len() {
            if !matches!(self.acts[i].progress, CarryProgress::Waiting) || !self.is_due(i) {
                continue;
            }
            let step = self.acts[i].step;
            let begun = self.begin(i);
            begun.map_err(|failure| (step.number, failure))?;
        }
        Ok(())
    }

    fn begin(&mut self, i: usize) -> Result<(), PlanFailure> {
        let sight = Sight::of(self.app.world_mut());
        let step = self.acts[i].step;
        let id = self.bound(&step.object)?.to_owned();
        let object = sight
            .objects
            .get(&id)
            .ok_or_else(|| PlanFailure::Gone(id.clone()))?;
        let from = object.pose;
        let carried = &self.acts[i].carried;
        let reference = self.reference(step, carried, &sight, from)?;
        let obstacles = obstacles(step, &sight, &id);
        let way = carried.retargeted(&object.shape, from, reference, &obstacles);
        let hand = carried.first_hand().unwrap_or_default();
        self.app
            .world_mut()
            .write_command(HandCommand::Grasp { hand, object: id });
        let begun = self.now();
        let act = &mut self.acts[i];
        act.from = from;
        act.progress = CarryProgress::Carrying {
            begun,
            hand,
            way,
            next: 0,
            target: from,
            last: from,
            still: 0,
            waited: 0,
        };
        Ok(())
    }

    fn bound(&self, role: &str) -> Result<&str, PlanFailure> {
        let bound = self.binding.object(role);
        bound.ok_or_else(|| PlanFailure::Gone(role.to_owned()))
    }

    /// The present pose of the reference of a step's goal; `None` without a goal.
    fn reference(
        &self,
        step: &TaskStep,
        carried: &CarriedWay,
        sight: &Sight,
        from: Pose,
    ) -> Result<Option<Pose>, PlanFailure> {
        let Some(goal) = &step.goal else {
            return Ok(None);
        };
        let gone = |id: &str| PlanFailure::Gone(id.to_owned());
        let pose = match &goal.reference {
            Reference::Table if goal.place == PlaceRange::Anywhere => {
                let id = self.bound(&step.object)?;
                let aside = free_place(sight, id, carried, from, self.view);
                aside.ok_or_else(|| PlanFailure::NoRoom(id.to_owned()))?
            }
            Reference::Table => Pose::IDENTITY,
            Reference::Itself => from,
            Reference::Object { object } => {
                let id = self.bound(object)?;
                sight.objects.get(id).ok_or_else(|| gone(id))?.pose
            }
            Reference::PlaceOf { object } => {
                let id = self.bound(object)?;
                *self.before.beginning.get(id).ok_or_else(|| gone(id))?
            }
        };
        Ok(Some(pose))
    }

    fn move_hands(&mut self) {
        let now = self.now();
        for act in &mut self.acts {
            let CarryProgress::Carrying {
                hand,
                way,
                next,
                target,
                still,
                waited,
                ..
            } = &mut act.progress
            else {
                continue;
            };
            let world = self.app.world_mut();
            let Some(moment) = way.get(*next) else {
                if *still < STILL && *waited < MOST_WAITING {
                    *waited += 1;
                    continue;
                }
                let mut pending = self.operations.iter().filter(|(_, done)| done.is_none());
                if pending.any(|(one, _)| one.tick <= act.step.release) {
                    continue;
                }
                let first = act.step.relations.first();
                if first == Some(&Relation::Destroyed) {
                    world.write_command(HandCommand::Destroy(*hand));
                } else if first != Some(&Relation::Held) {
                    world.write_command(HandCommand::Release(*hand));
                }
                act.progress = CarryProgress::Done(now);
                continue;
            };
            *next += 1;
            if let Some(taken_by) = moment.taken_by.filter(|taken_by| taken_by != hand) {
                world.write_command(HandCommand::Release(*hand));
                world.write_command(HandCommand::Grasp {
                    hand: taken_by,
                    object: self
                        .binding
                        .object(&act.step.object)
                        .unwrap_or_default()
                        .to_owned(),
                });
                *hand = taken_by;
            }
            let hand = *hand;
            let (axis, angle) = (moment.pose.rotation * target.rotation.inverse()).to_axis_angle();
            // The shorter way round.
            let angle = (angle + PI).rem_euclid(TAU) - PI;
            if angle.abs() > LEAST_TURN {
                let degrees = angle.to_degrees();
                world.write_command(HandCommand::Turn {
                    hand,
                    axis,
                    degrees,
                });
                target.rotation = (Quat::from_axis_angle(axis, degrees.to_radians())
                    * target.rotation)
                    .normalize();
            }
            if moment.pose.location != target.location {
                let location = moment.pose.location;
                world.write_command(HandCommand::MoveTo { hand, location });
                target.location = location;
            }
        }
    }

    /// Reads the present poses of held objects.
    fn look(&mut self) -> Result<(), (usize, PlanFailure)> {
        let world = self.app.world();
        for act in &mut self.acts {
            let CarryProgress::Carrying {
                hand, last, still, ..
            } = &mut act.progress
            else {
                continue;
            };
            let id = self.binding.object(&act.step.object).unwrap_or_default();
            let object = world.resource::<ObjectIndex>().get(id);
            let held = world.resource::<Hands>().held_by(*hand);
            let transform = object.and_then(|object| world.get::<Transform>(object));
            let Some(transform) = transform.filter(|_| held == object) else {
                return Err((act.step.number, PlanFailure::NotHeld(id.to_owned())));
            };
            let here = Pose::from(transform);
            let is_same = here.location.distance(last.location) < SAME
                && angle_between(here.rotation, last.rotation) < SAME;
            *still = if is_same { *still + 1 } else { 0 };
            *last = here;
        }
        Ok(())
    }

    /// Checks all relations; an error names the step of one that does not hold.
    fn judge(mut self, task: &Task) -> Result<(), (usize, PlanFailure)> {
        let sight = Sight::of(self.app.world_mut());
        if let Some(undone) = undone(task, self.binding, &sight, &self.before) {
            return Err(undone);
        }
        for act in &self.acts {
            let step = act.step;
            let Some(id) = self.binding.object(&step.object) else {
                return Err((step.number, PlanFailure::Gone(step.object.clone())));
            };
            let is_last = !task.steps[step.number..]
                .iter()
                .any(|later| later.object == step.object);
            if !is_last {
                continue;
            }
            self.before.step = Some(act.from);
            let first = step.relations.first();
            let is_so = if first == Some(&Relation::Destroyed) {
                Ok(!sight.objects.contains_key(id))
            } else if matches!(first, Some(Relation::Turned { .. })) {
                is_met(step, self.binding, &sight, &self.before)
            } else {
                Ok(true)
            };
            match is_so {
                Ok(true) => {}
                Ok(false) => return Err((step.number, PlanFailure::Misplaced(id.to_owned()))),
                Err(failure) => return Err((step.number, failure)),
            }
        }
        Ok(())
    }
}

/// The obstacles of a hand on its way with an object: neither things that it carries along, nor the object's slide.
fn obstacles(step: &TaskStep, sight: &Sight, id: &str) -> Vec<PlacedSolid> {
    if matches!(step.relations.first(), Some(Relation::Slid { .. })) {
        return Vec::new();
    }
    let carried = sight.stack_above(id);
    let is_obstacle = |other: &String| other != id && !carried.contains(other);
    let others = sight.objects.iter().filter(|(other, _)| is_obstacle(other));
    others.flat_map(|(_, other)| other.solids()).collect()
}

/// The table's frame for an object that is put aside at a free place: as far from its present place as demonstrated, or near there, and in
/// view of the camera.
fn free_place(
    sight: &Sight,
    id: &str,
    carried: &CarriedWay,
    from: Pose,
    view: Option<&Camera>,
) -> Option<Pose> {
    const AROUND: u16 = 12;
    const RINGS: u16 = 12;
    let object = sight.objects.get(id)?;
    let others: Vec<_> = sight
        .objects
        .iter()
        .filter(|(other, _)| *other != id)
        .flat_map(|(_, other)| other.solids())
        .collect();
    let half = Vec3::new(sight.table.xspan, sight.table.yspan, 0.0) / 2.0;
    let with_object = from * carried.first().inverse();
    let offsets = (0..RINGS).flat_map(|ring| {
        (0..AROUND).map(move |i| {
            let angle = TAU * f32::from(i) / f32::from(AROUND);
            Vec3::new(angle.cos(), angle.sin(), 0.0) * f32::from(ring) * 0.5
        })
    });
    let mut frames = offsets.map(|offset| Pose {
        location: with_object.location + offset,
        ..with_object
    });
    frames.find(|frame| {
        let place = *frame * carried.last();
        let is_seen = view.is_none_or(|view| has_in_view(view, &object.shape, place));
        let solids = object.solids_at(place);
        let mut solids = solids.iter();
        is_seen
            && solids.all(|solid| {
                let reach = |way: Vec3| solid.farthest(way).dot(way);
                let is_on_table = [Vec3::X, Vec3::Y]
                    .into_iter()
                    .all(|way| reach(way).max(reach(-way)) < half.dot(way));
                is_on_table
                    && others
                        .iter()
                        .all(|other| solid.gap_from_above(other) > ASIDE)
            })
    })
}
