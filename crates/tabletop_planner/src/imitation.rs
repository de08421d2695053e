//! Imitation: the steps of a task, with a look at the world after each.

use bevy::math::Vec3;
use tabletop_core::{JointKind, Pose};
use tabletop_task::{Binding, PlaceRange, PlacedSolid, Reference, Relation, Task, TaskStep};

use crate::{
    body::{Angles, RobotBody},
    clearance::Clearance,
    failure::PlanFailure,
    free_spot::free_spots,
    goals::{Before, Candidate, bound, candidates, inside, is_met},
    grasp::GraspSide,
    motion::{follow, wait},
    sight::{SeenObject, Sight},
    stage::{PlanningStage, Stopped},
    transfer::Transfer,
    transit::{WaySearch, transit},
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
/// What is nearer than this leaves no room for fingers, in units.
const FINGER_ROOM: f32 = 0.7;
/// How many things are moved out of the way for a step.
const MOST_CLEARED: usize = 4;
/// PlaceRange where limbs wait, out of each other's way: beside the table's front corners, in units.
const PARKED: Vec3 = Vec3::new(7.0, -6.0, 4.5);

/// Does a task. Whatever is tried by chance is decided by `seed`; `tell` hears of every step before it is tried.
pub fn imitate(
    stage: &mut dyn PlanningStage,
    body: &RobotBody,
    task: &Task,
    binding: &Binding,
    seed: u64,
    mut tell: impl FnMut(Doing),
) -> Imitation {
    let beginning = stage
        .sight()
        .objects
        .iter()
        .map(|(id, object)| (id.clone(), object.pose));
    let mut imitator = Imitator {
        body,
        task,
        binding,
        seed,
        parked: Vec::new(),
        before: Before {
            beginning: beginning.collect(),
            step: None,
        },
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
    let is_last = |step: &&TaskStep| {
        let mut later = task.steps[step.number..].iter();
        !later.any(|later| later.object == step.object)
    };
    let stays = |step: &&TaskStep| {
        step.goal
            .as_ref()
            .is_some_and(|goal| goal.reference != Reference::Itself)
    };
    let mut lasting = task.steps.iter().filter(is_last).filter(stays);
    lasting.find_map(|step| match is_met(step, binding, sight, before) {
        Ok(true) => None,
        Ok(false) => {
            let object = binding.object(&step.object).unwrap_or(&step.object);
            Some((step.number, PlanFailure::Misplaced(object.to_owned())))
        }
        Err(gone) => Some((step.number, gone)),
    })
}

/// Goals of the task's objects, as far as they are known before the robot begins: the number of the step, the object,
/// and its pose.
pub fn goal_poses(task: &Task, binding: &Binding, sight: &Sight) -> Vec<(usize, String, Pose)> {
    let mut sight = sight.clone();
    let poses = sight.objects.iter();
    let mut before = Before {
        beginning: poses
            .map(|(id, object)| (id.clone(), object.pose))
            .collect(),
        step: None,
    };
    let mut goals = Vec::new();
    for step in &task.steps {
        let Some(id) = binding.object(&step.object) else {
            continue;
        };
        before.step = sight.objects.get(id).map(|object| object.pose);
        let Ok(found) = candidates(step, binding, &sight, &before) else {
            continue;
        };
        if let (Some(goal), Some(object)) = (found.first(), sight.objects.get_mut(id)) {
            object.pose = goal.pose;
            goals.push((step.number, id.to_owned(), goal.pose));
        }
    }
    goals
}

struct Imitator<'a> {
    body: &'a RobotBody,
    task: &'a Task,
    binding: &'a Binding,
    seed: u64,
    /// The posture in which each limb waits.
    parked: Vec<Angles>,
    before: Before,
    outcome: Imitation,
}

impl Imitator<'_> {
    fn do_all(
        &mut self,
        stage: &mut dyn PlanningStage,
        tell: &mut dyn FnMut(Doing),
    ) -> Result<(), Stopped> {
        self.park_all(stage)?;
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
                failure = self.do_step(stage, i).err();
                if failure == Some(PlanFailure::Stopped) {
                    return Err(Stopped);
                }
                wait(stage, 10)?;
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
                self.seed = self.seed.wrapping_add(1);
            }
            if let Some(failure) = failure {
                self.outcome.failure = Some((step.number, failure));
                break;
            }
            self.outcome.steps_done += 1;
        }
        if self.outcome.failure.is_none() {
            self.outcome.failure = undone(self.task, self.binding, stage.sight(), &self.before);
        }
        let is_held = |step: &TaskStep| step.relations.first() == Some(&Relation::Held);
        if !self.task.steps.iter().any(is_held) {
            for limb in 0..self.body.limbs.len() {
                self.try_to_park(stage, limb)?;
            }
        }
        wait(stage, 30)
    }

    fn do_step(&self, stage: &mut dyn PlanningStage, i: usize) -> Result<(), PlanFailure> {
        let step = &self.task.steps[i];
        let id = bound(self.binding, &step.object)?;
        let sight = stage.sight().clone();
        let object = sight
            .objects
            .get(id)
            .ok_or_else(|| PlanFailure::Gone(id.to_owned()))?;
        for above in sight.above(id) {
            self.clear(stage, &above, i)?;
        }
        match step.relations.first() {
            Some(Relation::Slid { object: holder, .. }) => {
                let holder = bound(self.binding, holder)?;
                let by = slide(&sight, step, id, holder)
                    .ok_or_else(|| PlanFailure::Gone(holder.to_owned()))?;
                self.by_some_limb(stage, id, object.pose.location, |transfer, stage| {
                    transfer.slide(stage, by)
                })
            }
            Some(Relation::Held) => {
                self.by_some_limb(stage, id, object.pose.location, |transfer, stage| {
                    transfer.pick_up(stage)
                })
            }
            Some(Relation::Destroyed) => self.clear(stage, id, i),
            Some(Relation::Aside) => {
                let near = step
                    .goal
                    .as_ref()
                    .map_or(Vec3::ZERO, |goal| goal.pose.location);
                self.put_aside(stage, id, near, i)
            }
            Some(
                Relation::OnTable
                | Relation::On { .. }
                | Relation::Inside { .. }
                | Relation::Around { .. }
                | Relation::Beside { .. }
                | Relation::AlignedWith { .. }
                | Relation::InPlaceOf { .. }
                | Relation::Turned { .. },
            )
            | None => {
                for _ in 0..MOST_CLEARED {
                    let Some(occupant) = self.occupant(stage.sight(), step, id)? else {
                        break;
                    };
                    self.clear(stage, &occupant, i)?;
                }
                let mut outcome = self.put(stage, step, id, i);
                for _ in 0..MOST_CLEARED {
                    if !matches!(outcome, Err(PlanFailure::NoWay(_))) {
                        break;
                    }
                    let Some(neighbour) = self.neighbour(stage.sight(), step, id)? else {
                        break;
                    };
                    self.clear(stage, &neighbour, i)?;
                    outcome = self.put(stage, step, id, i);
                }
                self.or_from_beside(stage, outcome, |stage| {
                    let goals = self.goals(stage, step)?;
                    let at = goals.first().map_or(Vec3::ZERO, |goal| goal.pose.location);
                    self.by_some_limb_from(stage, GraspSide::Beside, id, at, |transfer, stage| {
                        transfer.carry_out(stage, &goals)
                    })
                })
            }
        }
    }

    /// Puts an object where a step wants it. If no limb reaches both ends, it goes by way of a place that two limbs reach.
    fn put(
        &self,
        stage: &mut dyn PlanningStage,
        step: &TaskStep,
        id: &str,
        i: usize,
    ) -> Result<(), PlanFailure> {
        let goals = |stage: &mut dyn PlanningStage| self.goals(stage, step);
        let at = goals(stage)?
            .first()
            .map_or(Vec3::ZERO, |goal| goal.pose.location);
        let straight = {
            let goals = goals(stage)?;
            self.by_some_limb_from(stage, GraspSide::Above, id, at, |transfer, stage| {
                transfer.carry_out(stage, &goals)
            })
        };
        let Err(failure @ (PlanFailure::OutOfReach(_) | PlanFailure::NoWay(_))) = straight else {
            return straight;
        };
        let sight = stage.sight().clone();
        let is_held = sight.limbs.iter().any(|limb| !limb.holds.is_empty());
        let Some(object) = sight.objects.get(id).filter(|_| !is_held) else {
            return Err(failure);
        };
        let all: Vec<_> = (0..self.body.limbs.len()).collect();
        let near = object.pose.location.midpoint(at);
        let kept = self.kept(&sight, i);
        let spots = free_spots(self.body, &sight, id, near, &all, &kept);
        let spots: Vec<_> = spots
            .into_iter()
            .flat_map(|pose| {
                // The orientations in which it may be grasped there.
                [0.0_f32, 0.8, -0.8, 1.6].map(|turn| Candidate {
                    pose: Pose::new(
                        pose.location,
                        bevy::math::Quat::from_rotation_z(turn) * pose.rotation,
                    ),
                    cost: turn.abs() * 0.2,
                })
            })
            .collect();
        if spots.is_empty() {
            return Err(failure);
        }
        self.by_some_limb_from(stage, GraspSide::Above, id, near, |transfer, stage| {
            transfer.carry_out(stage, &spots)
        })?;
        let goals = goals(stage)?;
        self.by_some_limb_from(stage, GraspSide::Above, id, at, |transfer, stage| {
            transfer.carry_out(stage, &goals)
        })
    }

    fn goals(
        &self,
        stage: &dyn PlanningStage,
        step: &TaskStep,
    ) -> Result<Vec<Candidate>, PlanFailure> {
        let sight = stage.sight();
        let goals = candidates(step, self.binding, sight, &self.before)?;
        let is_inside = step
            .goal
            .as_ref()
            .is_some_and(|goal| goal.place == PlaceRange::Inside);
        Ok(match is_inside {
            true => goals
                .iter()
                .flat_map(|goal| inside(goal.pose, 0.3))
                .collect(),
            false => goals,
        })
    }

    /// Lets a limb do it that takes the object from above; if none can, from beside.
    fn by_some_limb(
        &self,
        stage: &mut dyn PlanningStage,
        id: &str,
        towards: Vec3,
        act: impl Fn(&Transfer, &mut dyn PlanningStage) -> Result<(), PlanFailure>,
    ) -> Result<(), PlanFailure> {
        let from_above = self.by_some_limb_from(stage, GraspSide::Above, id, towards, &act);
        self.or_from_beside(stage, from_above, |stage| {
            self.by_some_limb_from(stage, GraspSide::Beside, id, towards, &act)
        })
    }

    /// What has become of something, or, if it cannot be done from above, of the same from beside.
    fn or_from_beside(
        &self,
        stage: &mut dyn PlanningStage,
        from_above: Result<(), PlanFailure>,
        from_beside: impl FnOnce(&mut dyn PlanningStage) -> Result<(), PlanFailure>,
    ) -> Result<(), PlanFailure> {
        let cannot_be_done = |outcome: &Result<(), PlanFailure>| {
            matches!(
                outcome,
                Err(PlanFailure::OutOfReach(_) | PlanFailure::NoWay(_) | PlanFailure::NoGrasp(_))
            )
        };
        let is_held = |stage: &dyn PlanningStage| {
            let mut limbs = stage.sight().limbs.iter();
            limbs.any(|limb| !limb.holds.is_empty())
        };
        if !cannot_be_done(&from_above) || is_held(stage) {
            return from_above;
        }
        let outcome = from_beside(stage);
        match cannot_be_done(&outcome) {
            true => from_above,
            false => outcome,
        }
    }

    /// Lets the limb do it that is on the side of both ends; if it cannot, the others. They wait meanwhile.
    fn by_some_limb_from(
        &self,
        stage: &mut dyn PlanningStage,
        side: GraspSide,
        id: &str,
        towards: Vec3,
        act: impl Fn(&Transfer, &mut dyn PlanningStage) -> Result<(), PlanFailure>,
    ) -> Result<(), PlanFailure> {
        let sight = stage.sight().clone();
        let object = sight
            .objects
            .get(id)
            .ok_or_else(|| PlanFailure::Gone(id.to_owned()))?;
        let middle = object.pose.location.midpoint(towards);
        let mut limbs: Vec<_> = (0..self.body.limbs.len()).collect();
        let distance = |limb: &usize| {
            let parked = self.body.end_effector(*limb, &self.parked[*limb]);
            parked.location.distance(middle)
        };
        limbs.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        let mut failure = PlanFailure::OutOfReach(id.to_owned());
        for limb in limbs {
            for other in (0..self.body.limbs.len()).filter(|&other| other != limb) {
                self.try_to_park(stage, other)?;
            }
            let transfer = Transfer {
                body: self.body,
                limb,
                object: id,
                side,
                seed: self.seed,
            };
            match act(&transfer, stage) {
                Ok(()) => return Ok(()),
                Err(new) => {
                    let is_telling = !matches!(new, PlanFailure::OutOfReach(_));
                    let has_acted = matches!(
                        new,
                        PlanFailure::Blocked { .. }
                            | PlanFailure::NotHeld(_)
                            | PlanFailure::Gone(_)
                    ) || stage.sight().limbs[limb]
                        .holds
                        .iter()
                        .any(|held| held == id);
                    if is_telling {
                        failure = new;
                    }
                    if failure == PlanFailure::Stopped {
                        return Err(failure);
                    }
                    if has_acted {
                        self.set_down(stage, limb)?;
                        return Err(failure);
                    }
                }
            }
        }
        Err(failure)
    }

    /// Opens a gripper that still holds something after a failure, and withdraws it.
    fn set_down(&self, stage: &mut dyn PlanningStage, limb: usize) -> Result<(), PlanFailure> {
        let widest = f64::from(self.body.limbs[limb].widest);
        crate::motion::grip(stage, limb, widest)?;
        let sight = stage.sight().clone();
        let clearance = Clearance::new(self.body, &sight, limb, &[]);
        if let Some(back) = crate::path::withdraw(&clearance, &clearance.here(), 1.0) {
            // After other failures it stays where it is.
            if let Err(PlanFailure::Stopped) = follow(stage, self.body, limb, &back, 2.5, "") {
                return Err(PlanFailure::Stopped);
            }
        }
        Ok(())
    }

    /// The object that occupies the goal of a step's object and does not belong there.
    fn occupant(
        &self,
        sight: &Sight,
        step: &TaskStep,
        id: &str,
    ) -> Result<Option<String>, PlanFailure> {
        let goals = candidates(step, self.binding, sight, &self.before)?;
        let object = sight
            .objects
            .get(id)
            .ok_or_else(|| PlanFailure::Gone(id.to_owned()))?;
        let others = step.relations.iter().filter_map(Relation::object);
        let meant: Vec<_> = others
            .filter_map(|role| self.binding.object(role))
            .collect();
        let in_the_way = |goal: &Candidate| {
            let solids = object.solids_at(Pose::new(
                goal.pose.location + Vec3::Z * 0.02,
                goal.pose.rotation,
            ));
            let others = sight.objects.iter().filter(|(other, seen)| {
                *other != id && !seen.is_fixed && !meant.contains(&other.as_str())
            });
            let mut overlapping = others.filter(|(_, other)| {
                let other = other.solids();
                let meets = |solid: &PlacedSolid| {
                    other
                        .iter()
                        .any(|other| solid.shrunk(0.01).is_within(1e-3, other))
                };
                solids.iter().any(meets)
            });
            overlapping.next().map(|(id, _)| id.clone())
        };
        let occupants: Vec<_> = goals.iter().map(in_the_way).collect();
        // Only if no goal is free.
        Ok(match occupants.iter().any(Option::is_none) {
            true => None,
            false => occupants.into_iter().flatten().next(),
        })
    }

    /// The nearest thing that leaves too little room for fingers beside an object or its place, and does not belong there.
    fn neighbour(
        &self,
        sight: &Sight,
        step: &TaskStep,
        id: &str,
    ) -> Result<Option<String>, PlanFailure> {
        let goals = candidates(step, self.binding, sight, &self.before)?;
        let Some(object) = sight.objects.get(id) else {
            return Ok(None);
        };
        let places = goals.first().map(|goal| goal.pose);
        let solids: Vec<_> = places
            .into_iter()
            .chain([object.pose])
            .flat_map(|pose| object.solids_at(pose))
            .collect();
        let others = step.relations.iter().filter_map(Relation::object);
        let done = self.task.steps.iter().take(step.number - 1);
        let settled = done.map(|step| step.object.as_str()).chain(others);
        let settled: Vec<_> = settled
            .filter_map(|role| self.binding.object(role))
            .collect();
        let is_movable = |other: &str, seen: &SeenObject| {
            let is_jointed = || {
                sight
                    .joints
                    .iter()
                    .any(|joint| joint.objects.iter().any(|one| one == other))
            };
            other != id && !seen.is_fixed && !settled.contains(&other) && !is_jointed()
        };
        let gap = |other: &SeenObject| {
            let theirs = other.solids();
            let gaps = solids
                .iter()
                .flat_map(|solid| theirs.iter().map(|other| solid.gap_from_above(other)));
            gaps.fold(f32::INFINITY, f32::min)
        };
        let near = sight
            .objects
            .iter()
            .filter(|(other, seen)| is_movable(other, seen))
            .map(|(other, seen)| (gap(seen), other))
            .filter(|(gap, _)| *gap < FINGER_ROOM);
        let nearest = near.min_by(|a, b| a.0.total_cmp(&b.0));
        Ok(nearest.map(|(_, other)| other.clone()))
    }

    /// Moves something out of the way, with what stands on it.
    fn clear(&self, stage: &mut dyn PlanningStage, id: &str, i: usize) -> Result<(), PlanFailure> {
        for above in stage.sight().above(id) {
            self.clear(stage, &above, i)?;
        }
        let sight = stage.sight().clone();
        let near = sight
            .objects
            .get(id)
            .map_or(Vec3::ZERO, |object| object.pose.location);
        self.put_aside(stage, id, near, i)
    }

    fn put_aside(
        &self,
        stage: &mut dyn PlanningStage,
        id: &str,
        near: Vec3,
        i: usize,
    ) -> Result<(), PlanFailure> {
        let sight = stage.sight().clone();
        let kept = self.kept(&sight, i);
        let mut spots = Vec::new();
        let all: Vec<_> = (0..self.body.limbs.len()).collect();
        for limbs in std::iter::once(all.clone()).chain(all.iter().map(|&limb| vec![limb])) {
            spots.extend(free_spots(self.body, &sight, id, near, &limbs, &kept));
        }
        let goals: Vec<_> = spots
            .into_iter()
            .map(|pose| Candidate {
                pose,
                cost: pose.location.distance(near) * 0.1,
            })
            .collect();
        if goals.is_empty() {
            return Err(PlanFailure::NoRoom(id.to_owned()));
        }
        self.by_some_limb(stage, id, near, |transfer, stage| {
            transfer.carry_out(stage, &goals)
        })
    }

    /// The solids that will stand on the table after this and the later steps. Nothing else is put there.
    fn kept(&self, sight: &Sight, from: usize) -> Vec<PlacedSolid> {
        let steps = self.task.steps[from..].iter();
        let later = steps.filter(|step| {
            let is_exact = step
                .goal
                .as_ref()
                .is_some_and(|goal| goal.place == PlaceRange::Exact);
            is_exact
                && !matches!(
                    step.relations.first(),
                    Some(Relation::Slid { .. } | Relation::Turned { .. })
                )
        });
        let places = later.filter_map(|step| {
            let id = self.binding.object(&step.object)?;
            let goals = candidates(step, self.binding, sight, &self.before).ok()?;
            Some(sight.objects.get(id)?.solids_at(goals.first()?.pose))
        });
        places.flatten().collect()
    }

    fn park_all(&mut self, stage: &mut dyn PlanningStage) -> Result<(), Stopped> {
        for (limb, seen) in stage.sight().limbs.iter().enumerate() {
            let side = self
                .body
                .end_effector(limb, &seen.angles)
                .location
                .x
                .signum();
            let place = Pose::at(PARKED * Vec3::new(side, 1.0, 1.0));
            let parked = self.body.reach(limb, place, &seen.angles);
            self.parked
                .push(parked.unwrap_or(self.body.limbs[limb].home));
        }
        for limb in 0..self.parked.len() {
            self.try_to_park(stage, limb)?;
        }
        Ok(())
    }

    /// Brings a limb to its waiting place if a path is free.
    fn try_to_park(&self, stage: &mut dyn PlanningStage, limb: usize) -> Result<(), Stopped> {
        match self.park(stage, limb) {
            Err(PlanFailure::Stopped) => Err(Stopped),
            Ok(()) | Err(_) => Ok(()),
        }
    }

    /// Brings a limb to its waiting place.
    ///
    /// # Errors
    /// No path is free, or something stops the limb.
    fn park(&self, stage: &mut dyn PlanningStage, limb: usize) -> Result<(), PlanFailure> {
        let sight = stage.sight().clone();
        let clearance = Clearance::new(self.body, &sight, limb, &[]);
        let here = clearance.here();
        if crate::path::largest_turn(&here, &self.parked[limb]) < 1e-3 {
            return Ok(());
        }
        let name = || format!("the {} arm", self.body.limbs[limb].name);
        let way = transit(
            &clearance,
            &here,
            &self.parked[limb],
            WaySearch::Trying(self.seed),
        );
        let way = way.ok_or_else(|| PlanFailure::NoWay(name()))?;
        follow(stage, self.body, limb, &way, 6.0, &name())
    }
}

/// The displacement by which a step slides an object.
fn slide(sight: &Sight, step: &TaskStep, id: &str, holder: &str) -> Option<Vec3> {
    let Some(Relation::Slid {
        opening, travel, ..
    }) = step.relations.first()
    else {
        return None;
    };
    let joint = sight
        .joints
        .iter()
        .find(|joint| joint.objects == [holder.to_owned(), id.to_owned()])?;
    let JointKind::Slider {
        max: own_travel, ..
    } = joint.kind
    else {
        return None;
    };
    let frame = sight.objects.get(holder)?.pose * joint.frames[0];
    let own = sight.objects.get(id)?.pose * joint.frames[1];
    let now = -(frame.inverse() * own.location).x;
    let wanted = opening / travel * own_travel;
    Some(frame.rotation * Vec3::NEG_X * (wanted - now))
}
