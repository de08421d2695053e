//! Transfer: grasping an object and putting it down elsewhere.

mod acts;
mod choice;
mod slide;
mod ways;

use bevy::math::Vec3;
use tabletop_controller::{SeenObject, Sight};
use tabletop_geometry::{PlacedSolid, Pose};

use crate::{
    body::RobotBody, failure::PlanFailure, goals::Candidate, grasp::GraspSide, sight::Solids as _,
};

/// Height above its goal at which an object is released, in units.
const DROP: f32 = 0.02;
/// Distance of opening fingers from neighbouring objects, in units.
const BESIDE: f32 = 0.012;
/// Speed of an end effector, in units/s, at which what is on or in the object stays where it is.
const STEADY: f64 = 1.5;
/// Number of pairs of grasp and goal that are examined at most.
const PAIRS: usize = 24;

/// A limb's transfer of an object.
pub(crate) struct Transfer<'a> {
    pub body: &'a RobotBody,
    pub limb: usize,
    pub object: &'a str,
    /// Ids of the objects that go along with it.
    pub load: &'a [String],
    pub side: GraspSide,
    /// Seed of the search for paths.
    pub seed: u64,
}

impl Transfer<'_> {
    fn seen<'s>(&self, sight: &'s Sight) -> Result<&'s SeenObject, PlanFailure> {
        let object = sight.objects.get(self.object);
        object.ok_or_else(|| PlanFailure::Gone(self.object.to_owned()))
    }

    /// Whether an object is moved, by itself or with the other.
    fn moves(&self, id: &str) -> bool {
        id == self.object || self.load.iter().any(|load| load == id)
    }

    /// Ids of the objects that are moved.
    fn moved(&self) -> Vec<&str> {
        let load = self.load.iter().map(String::as_str);
        load.chain([self.object]).collect()
    }

    /// The solids of the objects that go along, if the object were at this pose.
    fn load_at(&self, sight: &Sight, pose: Pose) -> Vec<PlacedSolid> {
        let Some(object) = sight.objects.get(self.object) else {
            return Vec::new();
        };
        let motion = pose * object.pose.inverse();
        let load = self.load.iter().filter_map(|id| sight.objects.get(id));
        load.flat_map(|load| load.solids_at(motion * load.pose))
            .collect()
    }

    fn no_way(&self) -> PlanFailure {
        PlanFailure::NoWay(self.object.to_owned())
    }
}

/// Pose of an end effector that releases an object held like this, so that it comes to rest at a goal.
fn above_place(goal: Candidate, grip: Pose) -> Pose {
    Pose::new(goal.pose.location + Vec3::Z * DROP, goal.pose.rotation) * grip.inverse()
}
