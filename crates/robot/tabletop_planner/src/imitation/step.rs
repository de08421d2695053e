//! A step: its goals, and the way of the object to one of them.

use bevy::math::Vec3;
use tabletop_controller::Sight;
use tabletop_geometry::{PlacedSolid, Pose};
use tabletop_task::{Relation, TaskStep};

use super::{Imitator, clearing::MOST_CLEARED, slider::Slider};
use crate::{
    failure::PlanFailure,
    goals::{Candidate, Placement, bound, candidates, fits_inside, is_inside},
    grasp::GraspSide,
    inside::{places as places_in, room},
    sight::{Arranged as _, Solids as _, heights},
    stage::PlanningStage,
};

/// Heights above a container's rim from which something is let fall into it, in units: rather less, but above an open lid.
const ABOVE_RIM: [f32; 2] = [0.1, 0.4];
/// Cost of letting something fall, so that it is put down where that is possible.
const COST_OF_FALL: f32 = 10.0;
/// Distance from a container's walls, in units, at which something falls between them however it is let go.
const ROOM_FOR_FALL: f32 = 0.3;
/// Cost of leaving no room for an object that a later step puts into a container: rather let it fall.
const COST_OF_CROWDING: f32 = 20.0;

impl Imitator<'_> {
    /// Does a step with its object alone, or with what is noted as its load. The steps from number `i` on are yet to be done.
    pub(super) fn do_alone(
        &mut self,
        stage: &mut dyn PlanningStage,
        step: &TaskStep,
        i: usize,
    ) -> Result<(), PlanFailure> {
        let binding = self.binding;
        let id = bound(binding, &step.object)?;
        let sight = stage.sight().clone();
        let object = sight
            .objects
            .get(id)
            .ok_or_else(|| PlanFailure::Gone(id.to_owned()))?;
        self.clear_above(stage, id, i)?;
        match step.relations.first() {
            Some(Relation::Slid {
                object: holder,
                opening,
                travel,
            }) => {
                let holder = bound(binding, holder)?;
                let slider = Slider::of(&sight, id).filter(|slider| slider.holder == holder);
                let slider = slider.ok_or_else(|| PlanFailure::Gone(holder.to_owned()))?;
                let by = slider.by(opening / travel * slider.travel);
                self.put_back_under(stage, id, by)?;
                self.slide(stage, id, by, i)
            }
            Some(Relation::Held) => {
                self.by_some_limb(stage, id, object.pose.location, |transfer, stage| {
                    transfer.pick_up(stage)
                })
            }
            Some(Relation::LetGo) => Err(PlanFailure::NoGoal(id.to_owned())),
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
                | Relation::Against { .. }
                | Relation::Beside { .. }
                | Relation::AlignedWith { .. }
                | Relation::InPlaceOf { .. }
                | Relation::Turned { .. },
            )
            | None => {
                for (lid, by) in self.lids(stage.sight(), step, id)? {
                    self.remember(stage.sight(), &lid);
                    self.slide(stage, &lid, by, i)?;
                }
                for _ in 0..MOST_CLEARED {
                    let Some(occupant) = self.occupant(stage.sight(), step, id)? else {
                        break;
                    };
                    self.clear(stage, &occupant, i)?;
                }
                let mut outcome = self.put(stage, step, id, i);
                for _ in 0..MOST_CLEARED {
                    if !matches!(
                        outcome,
                        Err(PlanFailure::NoWay(_) | PlanFailure::Enclosed(_))
                    ) {
                        break;
                    }
                    let Some(neighbour) = self.neighbour(stage.sight(), step, id)? else {
                        break;
                    };
                    self.clear(stage, &neighbour, i)?;
                    outcome = self.put(stage, step, id, i);
                }
                self.or_from_beside(stage, outcome, |stage| {
                    let goals = self.goals(stage.sight(), step)?;
                    let at = goals.first().map_or(Vec3::ZERO, |goal| goal.pose.location);
                    self.by_some_limb_from(stage, GraspSide::Beside, id, at, |transfer, stage| {
                        transfer.carry_out(stage, &goals)
                    })
                })
            }
        }
    }

    /// Puts an object where a step wants it. If no limb reaches both ends, or has a grasp that is free at both, it goes by way of another place.
    fn put(
        &self,
        stage: &mut dyn PlanningStage,
        step: &TaskStep,
        id: &str,
        i: usize,
    ) -> Result<(), PlanFailure> {
        let straight = self.put_straight(stage, step, id);
        let Err(failure @ (PlanFailure::PlaceOutOfReach(_) | PlanFailure::NoWay(_))) = straight
        else {
            return straight;
        };
        let goals = self.goals(stage.sight(), step)?;
        let is_tipped = goals.iter().any(|goal| goal.is_tipped());
        let sight = stage.sight();
        let limbs = || 0..self.body.limbs.len();
        if !limbs().any(|limb| {
            self.transfer(limb, id, GraspSide::Any)
                .reaches(sight, &goals)
        }) {
            return Err(PlanFailure::PlaceOutOfReach(id.to_owned()));
        }
        let is_held = sight.limbs.iter().any(|limb| !limb.holds.is_empty());
        let (Some(object), false) = (sight.objects.get(id), is_held) else {
            return Err(failure);
        };
        let at = goals.first().map_or(Vec3::ZERO, |goal| goal.pose.location);
        let near = object.pose.location.midpoint(at);
        let is_on_its_way = match is_tipped {
            true => self.put_for_tipping(stage, id, near, &goals, i)?,
            false => self.put_halfway(stage, id, near, i)?,
        };
        match is_on_its_way {
            true => self.put_straight(stage, step, id),
            false if is_tipped => Err(PlanFailure::Tipped(id.to_owned())),
            false => Err(failure),
        }
    }

    fn put_straight(
        &self,
        stage: &mut dyn PlanningStage,
        step: &TaskStep,
        id: &str,
    ) -> Result<(), PlanFailure> {
        let goals = self.goals(stage.sight(), step)?;
        let at = goals.first().map_or(Vec3::ZERO, |goal| goal.pose.location);
        let side = match goals.iter().any(|goal| goal.is_tipped()) {
            true => GraspSide::Any,
            false => GraspSide::Above,
        };
        self.by_some_limb_from(stage, side, id, at, |transfer, stage| {
            transfer.carry_out(stage, &goals)
        })
    }

    fn goals(&self, sight: &Sight, step: &TaskStep) -> Result<Vec<Candidate>, PlanFailure> {
        let goals = candidates(step, self.binding, sight, &self.before)?;
        if !is_inside(step) {
            return Ok(goals);
        }
        let mut places = self.places_inside(sight, step)?;
        let object = self.binding.object(&step.object);
        if let Some(object) = object.and_then(|id| sight.objects.get(id)) {
            let later = self.later_inside(sight, step);
            for place in &mut places {
                let own = object.solids_at(place.pose);
                let meets = |other: &Vec<PlacedSolid>| {
                    own.iter()
                        .any(|own| other.iter().any(|other| own.is_within(1e-3, other)))
                };
                let crowded = later.iter().filter(|goals| goals.iter().all(meets));
                place.cost += COST_OF_CROWDING * crowded.count() as f32;
            }
        }
        let mut free = places.clone();
        free.retain(|place| self.is_free_inside(sight, step, place.pose));
        let falls = match free.is_empty() {
            true => &goals,
            false => &free,
        };
        places.extend(self.above_rim(sight, step, falls));
        Ok(places)
    }

    /// For each later step that puts something into a container, the solids of its object at each of its goals.
    fn later_inside(&self, sight: &Sight, step: &TaskStep) -> Vec<Vec<Vec<PlacedSolid>>> {
        let later = self.task.steps[step.number..].iter();
        let goals = later.filter(|later| is_inside(later)).filter_map(|later| {
            let object = sight.objects.get(self.binding.object(&later.object)?)?;
            let goals = candidates(later, self.binding, sight, &self.before).ok()?;
            let solids = goals.iter().map(|goal| object.solids_at(goal.pose));
            Some(solids.collect())
        });
        goals.filter(|goals: &Vec<_>| !goals.is_empty()).collect()
    }

    /// Places in a container.
    pub(super) fn places_inside(
        &self,
        sight: &Sight,
        step: &TaskStep,
    ) -> Result<Vec<Candidate>, PlanFailure> {
        let goals = candidates(step, self.binding, sight, &self.before)?;
        let container = step.relations.first().and_then(Relation::object);
        let [Some(object), Some(container)] = [Some(step.object.as_str()), container].map(|role| {
            let id = self.binding.object(role?)?;
            sight.objects.get(id)
        }) else {
            return Ok(goals);
        };
        let places = goals.into_iter();
        Ok(places
            .flat_map(|goal| places_in(goal, object, container))
            .collect())
    }

    /// True if a step's object fits into its container at this pose, beside what is in there.
    fn is_free_inside(&self, sight: &Sight, step: &TaskStep, pose: Pose) -> bool {
        let object = self.binding.object(&step.object);
        object.is_some_and(|id| sight.occupant(id, pose, &[]).is_none())
            && fits_inside(step, self.binding, sight, pose)
    }

    /// Places above a container from which an object falls to these.
    fn above_rim(&self, sight: &Sight, step: &TaskStep, goals: &[Candidate]) -> Vec<Candidate> {
        let container = step.relations.first().and_then(Relation::object);
        let container = container.and_then(|role| self.binding.object(role));
        let object = self.binding.object(&step.object);
        let seen = |id: Option<&str>| sight.objects.get(id?);
        let (Some(container), Some(object)) = (seen(container), seen(object)) else {
            return Vec::new();
        };
        let walls = container.solids();
        let [_, rim] = heights(&walls);
        let falls = ABOVE_RIM.iter();
        let falls = falls.flat_map(|above| goals.iter().map(move |goal| (*above, goal)));
        let raised = falls.map(|(above, goal)| {
            let own = object.solids_at(goal.pose);
            let [lowest, _] = heights(&own);
            let tightness = (ROOM_FOR_FALL - room(&own, &walls)).max(0.0);
            let up = Vec3::Z * (rim + above - lowest).max(0.0);
            let there = Pose::new(goal.pose.location + up, goal.pose.rotation);
            Candidate {
                pose: there,
                cost: goal.cost + COST_OF_FALL * (1.0 + tightness + above),
                placement: Placement::Dropped,
            }
        });
        raised.collect()
    }
}
