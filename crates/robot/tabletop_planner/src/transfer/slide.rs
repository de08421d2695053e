//! Slides: an arm takes an object that a joint guides, and moves it along the joint.

use bevy::math::Vec3;
use tabletop_controller::{Angles, Sight};

use super::{STEADY, Transfer};
use crate::{
    clearance::{Clearance, Margins},
    failure::PlanFailure,
    motion::follow,
    path::{Path, line},
    sight::{Arranged as _, Solids as _},
    stage::PlanningStage,
};

impl Transfer<'_> {
    /// Grasps the object and moves it by so much, as its joint allows. What stands in it goes along.
    pub fn slide(&self, stage: &mut dyn PlanningStage, by: Vec3) -> Result<(), PlanFailure> {
        let sight = stage.sight().clone();
        let (taking, approach) = self.plan_slide(&sight, by)?;
        self.take(stage, &taking, &approach)?;
        let sight = stage.sight().clone();
        let seen = &sight.limbs[self.limb];
        let (here, width) = (seen.angles, seen.opening as f32);
        let way = self.way_along(&sight, &here, by);
        let way = way.ok_or_else(|| self.no_way())?;
        let opening = self.release_along(&sight, &here, &way, width, by);
        let opening = opening.ok_or_else(|| self.no_way())?;
        follow(stage, self.body, self.limb, &way, STEADY, self.object)?;
        self.let_go(stage, opening)
    }

    /// The path on which the arm slides the object that it holds at these angles, obstacles aside.
    pub(super) fn way_along(&self, sight: &Sight, at: &Angles, by: Vec3) -> Option<Path> {
        let clearance = Clearance::new(self.body, sight, self.limb, &[]);
        let mut there = clearance.end_effector(at);
        there.location += by;
        line(&clearance, at, there)
    }

    /// Opening of the fingers, in units, at which the arm can let go of the object at the end of such a path; `None` if it cannot, or the path is not
    /// free. `width` is that of the part between the fingers.
    pub(super) fn release_along(
        &self,
        sight: &Sight,
        at: &Angles,
        way: &Path,
        width: f32,
        by: Vec3,
    ) -> Option<f32> {
        let riders = sight.stack_above(self.object);
        let moved: Vec<_> = riders
            .iter()
            .map(String::as_str)
            .chain([self.object])
            .collect();
        let grip = self.body.end_effector(self.limb, at).inverse();
        let seen = moved.iter().filter_map(|id| sight.objects.get(*id));
        let solids: Vec<_> = seen.flat_map(|object| object.solids()).collect();
        let guided = Clearance::new(self.body, sight, self.limb, &moved)
            .holding(&solids, grip, None)
            .guided()
            .opened(width);
        if !guided.is_way_free(way, Margins::NARROW) {
            return None;
        }
        let mut after = sight.clone();
        for id in moved {
            if let Some(object) = after.objects.get_mut(id) {
                object.pose.location += by;
            }
        }
        let released = self.taking(&after, self.seen(&after).ok()?);
        self.release(released, way.last()?, width)
    }
}
