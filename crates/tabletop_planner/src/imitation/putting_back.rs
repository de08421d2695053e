//! Putting obstacles back, after the last step.

use tabletop_controller::Sight;

use super::{Imitator, cleared::Cleared, slider::Slider};
use crate::{
    failure::PlanFailure,
    goals::Candidate,
    stage::{PlanningStage, Stopped},
};

impl Imitator<'_> {
    /// Remembers how something stands that is about to be moved out of the way.
    pub(super) fn remember(&mut self, sight: &Sight, id: &str) {
        let is_known = self.cleared.iter().any(|cleared| cleared.id == id);
        let mut steps = self.task.steps.iter();
        let is_of_task = steps.any(|step| self.binding.object(&step.object) == Some(id));
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
