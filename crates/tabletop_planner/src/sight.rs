//! What is seen of the world.

use std::collections::BTreeMap;

use bevy::math::Vec3;
use tabletop_core::{JointSpec, Pose, Shape, Table};
use tabletop_task::{Arrangement, PlacedSolid};

use crate::body::Angles;

/// The world at the end of a tick.
#[derive(Clone, Debug, Default)]
pub struct Sight {
    /// The table.
    pub table: Table,
    /// The objects, by id.
    pub objects: BTreeMap<String, SeenObject>,
    /// What connects objects.
    pub joints: Vec<JointSpec>,
    /// The robot's limbs.
    pub limbs: Vec<LimbSight>,
}

/// An object.
#[derive(Clone, Debug)]
pub struct SeenObject {
    /// Its shape.
    pub shape: Shape,
    /// Where it is.
    pub pose: Pose,
    /// Whether nothing moves it.
    pub is_fixed: bool,
}

/// A limb of the robot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LimbSight {
    /// The angles of its joints, in rad.
    pub angles: Angles,
    /// How far its gripper is open, in units.
    pub opening: f64,
    /// Ids of the objects that its gripper holds.
    pub holds: Vec<String>,
    /// What is in its way.
    pub blocked_by: Option<String>,
}

impl SeenObject {
    /// Its solids where it is.
    pub fn solids(&self) -> Vec<PlacedSolid> {
        self.solids_at(self.pose)
    }

    /// Its solids where it might be.
    pub fn solids_at(&self, pose: Pose) -> Vec<PlacedSolid> {
        let solids = self.shape.colliding();
        solids
            .iter()
            .map(|solid| PlacedSolid::of(solid, pose))
            .collect()
    }
}

impl Sight {
    /// Where the objects are to each other.
    pub fn arrangement(&self) -> Arrangement {
        let objects = self.objects.iter();
        Arrangement::new(objects.map(|(id, object)| (id.as_str(), &object.shape, object.pose)))
    }

    /// Where the objects would be to each other if one of them were here.
    pub(crate) fn arrangement_with(&self, moved: &str, pose: Pose) -> Arrangement {
        let objects = self.objects.iter().map(|(id, object)| match id == moved {
            true => (id.as_str(), &object.shape, pose),
            false => (id.as_str(), &object.shape, object.pose),
        });
        Arrangement::new(objects)
    }

    /// The ids of what stands on an object, directly.
    pub fn above(&self, id: &str) -> Vec<String> {
        let arrangement = self.arrangement();
        let others = self.objects.keys();
        let above = others.filter(|other| arrangement.supports(other).contains(&id));
        above.cloned().collect()
    }
}

/// The lowest and the highest Z of solids.
pub(crate) fn heights(solids: &[PlacedSolid]) -> [f32; 2] {
    let all = solids.iter().map(PlacedSolid::heights);
    all.reduce(|[low, high], [lower, higher]| [low.min(lower), high.max(higher)])
        .unwrap_or_default()
}

/// How far an orientation leans from another one about level axes, in rad.
pub(crate) fn lean(rotation: bevy::math::Quat) -> f32 {
    (rotation * Vec3::Z).angle_between(Vec3::Z)
}
