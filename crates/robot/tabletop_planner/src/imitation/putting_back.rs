//! Putting obstacles back, after the last step.

use bevy::math::Vec3;
use tabletop_controller::Sight;
use tabletop_geometry::Pose;

use super::{Imitator, cleared::Cleared, slider::Slider};
use crate::{
    failure::PlanFailure,
    goals::Candidate,
    sight::{Arranged as _, Solids as _, is_above},
    stage::{PlanningStage, Stopped},
};

impl Imitator<'_> {
    /// Remembers how something stands that is about to be moved out of the way.
    pub(super) fn remember(&mut self, sight: &Sight, id: &str) {
        let is_known = self.cleared.iter().any(|cleared| cleared.id == id);
        let steps = self.task.steps.iter();
        let mut moved = steps.flat_map(|step| {
            let load = step.load.iter().map(|load| &load.object);
            load.chain([&step.object])
        });
        let is_of_task = moved.any(|role| self.binding.object(role) == Some(id));
        if !is_known && !is_of_task {
            self.cleared.extend(Cleared::new(sight, id));
        }
    }

    /// Puts objects back that were moved out of the way, the last first. An object that does not fit any more, or cannot be put back, stays.
    pub(super) fn put_all_back(&mut self, stage: &mut dyn PlanningStage) -> Result<(), Stopped> {
        for cleared in std::mem::take(&mut self.cleared).iter().rev() {
            if let Err(PlanFailure::Stopped) = self.put_back(stage, cleared) {
                return Err(Stopped);
            }
        }
        Ok(())
    }

    /// Puts back what a part is about to cover as it slides by so much.
    pub(super) fn put_back_under(
        &mut self,
        stage: &mut dyn PlanningStage,
        id: &str,
        by: Vec3,
    ) -> Result<(), Stopped> {
        let sight = stage.sight();
        let part = sight.objects.get(id).map(|part| {
            let there = Pose::new(part.pose.location + by, part.pose.rotation);
            part.solids_at(there)
        });
        let is_covered = |cleared: &Cleared| {
            let object = sight.objects.get(&cleared.id);
            let pair = part.as_ref().zip(object);
            let there = sight.arrangement_with(&cleared.id, cleared.pose);
            pair.is_some_and(|(part, object)| is_above(part, &object.solids_at(cleared.pose)))
                || there.containers(&cleared.id).contains(&id)
        };
        let covered: Vec<_> = self.cleared.iter().map(is_covered).collect();
        let mut covered = covered.into_iter();
        let (under, rest) = std::mem::take(&mut self.cleared)
            .into_iter()
            .partition(|_| covered.next() == Some(true));
        self.cleared = under;
        self.put_all_back(stage)?;
        self.cleared = rest;
        Ok(())
    }

    fn put_back(
        &self,
        stage: &mut dyn PlanningStage,
        cleared: &Cleared,
    ) -> Result<(), PlanFailure> {
        let Cleared { id, pose, .. } = cleared;
        let sight = stage.sight().clone();
        let Some(object) = sight.objects.get(id) else {
            return Ok(());
        };
        if Slider::of(&sight, id).is_some() {
            let by = pose.location - object.pose.location;
            return self.slide_past(stage, id, by);
        }
        match cleared.fits(&sight) {
            true => self.by_some_limb(stage, id, pose.location, |transfer, stage| {
                transfer.carry_out(stage, &[Candidate::new(*pose, 0.0)])
            }),
            false => Ok(()),
        }
    }
}
