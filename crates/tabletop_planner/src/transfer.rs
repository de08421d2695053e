//! Transfer: grasping an object and putting it down elsewhere.

mod acts;
mod choice;
mod slide;
mod ways;

use bevy::math::Vec3;
use tabletop_controller::{SeenObject, Sight};
use tabletop_geometry::Pose;

use crate::{body::RobotBody, failure::PlanFailure, goals::Candidate, grasp::GraspSide};

/// Height above its goal at which an object is released, in units.
const DROP: f32 = 0.02;
/// Distance of opening fingers from neighbouring objects, in units.
const BESIDE: f32 = 0.012;
/// Number of pairs of grasp and goal that are examined at most.
const PAIRS: usize = 24;

/// A limb's transfer of an object.
pub(crate) struct Transfer<'a> {
    pub body: &'a RobotBody,
    pub limb: usize,
    pub object: &'a str,
    pub side: GraspSide,
    /// Seed of the search for paths.
    pub seed: u64,
}

impl Transfer<'_> {
    fn seen<'s>(&self, sight: &'s Sight) -> Result<&'s SeenObject, PlanFailure> {
        let object = sight.objects.get(self.object);
        object.ok_or_else(|| PlanFailure::Gone(self.object.to_owned()))
    }

    fn no_way(&self) -> PlanFailure {
        PlanFailure::NoWay(self.object.to_owned())
    }
}

/// Pose of an end effector that releases an object held like this, so that it comes to rest at a goal.
fn above_place(goal: Candidate, grip: Pose) -> Pose {
    Pose::new(goal.pose.location + Vec3::Z * DROP, goal.pose.rotation) * grip.inverse()
}
