//! Clearing: obstacles are put aside.

use bevy::math::{Quat, Vec3};
use tabletop_controller::{SeenObject, Sight};
use tabletop_geometry::{PlacedSolid, Pose};
use tabletop_task::{PlaceRange, Relation, TaskStep};

use super::{Imitator, slider::Slider};
use crate::{
    failure::PlanFailure,
    free_spot::free_spots,
    goals::{Candidate, candidates, fits_inside, is_inside},
    sight::{Arranged as _, Solids as _, is_above},
    stage::PlanningStage,
};

/// How many things are moved out of the way for a step.
pub(super) const MOST_CLEARED: usize = 4;
/// Distance, in units and hand sizes, below which an object leaves no room for fingers.
const FINGER_ROOM: f32 = 0.7;

impl Imitator<'_> {
    /// The object that occupies the goal of a step's object and does not belong there.
    ///
    /// # Errors
    /// Nothing moves it.
    pub(super) fn occupant(
        &self,
        sight: &Sight,
        step: &TaskStep,
        id: &str,
    ) -> Result<Option<String>, PlanFailure> {
        let goals = match is_inside(step) {
            // All in the container.
            true => {
                let places = self.places_inside(sight, step)?.into_iter();
                places
                    .filter(|place| fits_inside(step, self.binding, sight, place.pose))
                    .collect()
            }
            false => candidates(step, self.binding, sight, &self.before)?,
        };
        let others = step.relations.iter().filter_map(Relation::object);
        let meant: Vec<_> = others
            .filter_map(|role| self.binding.object(role))
            .chain(self.load_of(id).iter().map(String::as_str))
            .collect();
        let is_fixed =
            |other: &String| sight.objects.get(other).is_some_and(|other| other.is_fixed);
        let in_the_way = |goal: &Candidate| sight.occupant(id, goal.pose, &meant);
        let occupants: Option<Vec<_>> = goals.iter().map(in_the_way).collect();
        // Only if no goal is free.
        let Some(occupants) = occupants else {
            return Ok(None);
        };
        let movable = occupants.iter().find(|other| !is_fixed(other));
        match (movable, occupants.first()) {
            (None, Some(fixed)) if !is_inside(step) => Err(PlanFailure::Occupied {
                object: id.to_owned(),
                by: fixed.clone(),
            }),
            (movable, _) => Ok(movable.cloned()),
        }
    }

    /// The nearest thing that leaves too little room for fingers beside an object or its place, and does not belong there or carry it.
    pub(super) fn neighbour(
        &self,
        sight: &Sight,
        step: &TaskStep,
        id: &str,
    ) -> Result<Option<String>, PlanFailure> {
        let rooms = self.rooms(sight, step, id)?;
        let settled = self.settled(sight, step, id);
        let is_movable = |other: &String, seen: &SeenObject| {
            let mut joints = sight.joints.iter();
            other != id
                && !self.load_of(id).contains(other)
                && !seen.is_fixed
                && !settled.contains(other)
                && !joints.any(|joint| joint.objects.contains(other))
        };
        let gap = |other: &SeenObject| {
            let theirs = other.solids();
            let solids = rooms.iter().flatten();
            let gaps =
                solids.flat_map(|solid| theirs.iter().map(|other| solid.gap_from_above(other)));
            gaps.fold(f32::INFINITY, f32::min)
        };
        let near = sight
            .objects
            .iter()
            .filter(|(other, seen)| is_movable(other, seen))
            .map(|(other, seen)| (gap(seen), other))
            .filter(|(gap, _)| *gap < FINGER_ROOM * self.body.hand_size());
        let nearest = near.min_by(|a, b| a.0.total_cmp(&b.0));
        Ok(nearest.map(|(_, other)| other.clone()))
    }

    /// The solids of a step's object at its goal, if there is one, and at its place.
    fn rooms(
        &self,
        sight: &Sight,
        step: &TaskStep,
        id: &str,
    ) -> Result<Vec<Vec<PlacedSolid>>, PlanFailure> {
        let goals = candidates(step, self.binding, sight, &self.before)?;
        let Some(object) = sight.objects.get(id) else {
            return Ok(Vec::new());
        };
        let goal = goals.first().map(|goal| goal.pose);
        let poses = goal.into_iter().chain([object.pose]);
        Ok(poses.map(|pose| object.solids_at(pose)).collect())
    }

    /// Objects that stay beside a step's object: those of the steps up to this one, and the supports of the object.
    fn settled(&self, sight: &Sight, step: &TaskStep, id: &str) -> Vec<String> {
        let steps = &self.task.steps[..step.number];
        let relations = steps.iter().flat_map(|step| &step.relations);
        let done = steps[..step.number - 1].iter();
        let roles = done
            .map(|step| step.object.as_str())
            .chain(relations.filter_map(Relation::object));
        let arrangement = sight.arrangement();
        let carriers = [
            arrangement.supports(id),
            arrangement.containers(id),
            arrangement.posts(id),
        ];
        let carriers = carriers.concat().into_iter();
        let settled = roles
            .filter_map(|role| self.binding.object(role))
            .chain(carriers.filter(|carrier| !sight.covers(carrier, id)));
        settled.map(str::to_owned).collect()
    }

    /// The lids above an object or its place, and the displacements after which they are no longer.
    pub(super) fn lids(
        &self,
        sight: &Sight,
        step: &TaskStep,
        id: &str,
    ) -> Result<Vec<(String, Vec3)>, PlanFailure> {
        let rooms = self.rooms(sight, step, id)?;
        let lids = sight.objects.iter().filter_map(|(other, seen)| {
            let slider = Slider::of(sight, other).filter(|_| other != id)?;
            let covers = |by: Vec3| {
                let solids = seen.solids_at(Pose::new(seen.pose.location + by, seen.pose.rotation));
                rooms.iter().any(|room| is_above(&solids, room))
            };
            let ends = [slider.travel, 0.0].map(|end| slider.by(end));
            let by = ends.into_iter().find(|by| !covers(*by))?;
            covers(Vec3::ZERO).then(|| (other.clone(), by))
        });
        Ok(lids.collect())
    }

    /// Moves an object out of the way, with the objects that stand on it.
    pub(super) fn clear(
        &mut self,
        stage: &mut dyn PlanningStage,
        id: &str,
        i: usize,
    ) -> Result<(), PlanFailure> {
        self.clear_above(stage, id, i)?;
        self.clear_alone(stage, id, i)
    }

    /// Moves the objects that stand on another one out of the way. What is in a part that slides goes along with it.
    pub(super) fn clear_above(
        &mut self,
        stage: &mut dyn PlanningStage,
        id: &str,
        i: usize,
    ) -> Result<(), PlanFailure> {
        let sight = stage.sight();
        let arrangement = sight.arrangement();
        let slides = Slider::of(sight, id).is_some();
        let goes_along = |above: &str| slides && arrangement.containers(above).contains(&id);
        let mut stack = sight.stack_above(id);
        stack.retain(|above| !goes_along(above) && !self.load_of(id).contains(above));
        let mut stack = stack.iter();
        stack.try_for_each(|above| self.clear_alone(stage, above, i))
    }

    fn clear_alone(
        &mut self,
        stage: &mut dyn PlanningStage,
        id: &str,
        i: usize,
    ) -> Result<(), PlanFailure> {
        let sight = stage.sight().clone();
        self.remember(&sight, id);
        let near = sight
            .objects
            .get(id)
            .map_or(Vec3::ZERO, |object| object.pose.location);
        self.put_aside(stage, id, near, i)
    }

    pub(super) fn put_aside(
        &self,
        stage: &mut dyn PlanningStage,
        id: &str,
        near: Vec3,
        i: usize,
    ) -> Result<(), PlanFailure> {
        let sight = stage.sight().clone();
        let kept = self.kept(&sight, i);
        let object = sight.objects.get(id);
        let rotation = object.map_or(Quat::IDENTITY, |object| object.pose.rotation);
        let mut spots = Vec::new();
        let all: Vec<_> = (0..self.body.limbs.len()).collect();
        for limbs in std::iter::once(all.clone()).chain(all.iter().map(|&limb| vec![limb])) {
            spots.extend(free_spots(
                self.body, &sight, id, rotation, near, &limbs, &kept,
            ));
        }
        let goals: Vec<_> = spots
            .into_iter()
            .map(|pose| Candidate::new(pose, pose.location.distance(near) * 0.1))
            .collect();
        if goals.is_empty() {
            return Err(PlanFailure::NoRoom(id.to_owned()));
        }
        self.by_some_limb(stage, id, near, |transfer, stage| {
            transfer.carry_out(stage, &goals)
        })
    }

    /// The solids that will stand on the table after this and the later steps. Nothing else is put there.
    pub(super) fn kept(&self, sight: &Sight, from: usize) -> Vec<PlacedSolid> {
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
}
