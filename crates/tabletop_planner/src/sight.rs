//! The world as it is seen.

use std::collections::BTreeMap;

use bevy::math::Vec3;
use tabletop_core::{JointSpec, Pose, Shape, Table};
use tabletop_task::{Arrangement, PlacedSolid};

use crate::body::Angles;

/// Depth to which a part that is above an object may be in it, in units.
const PLAY: f32 = 0.05;

/// Height above its place at which an object meets nothing that carries it, in units.
const RAISED: f32 = 0.02;

/// The world at the end of a tick.
#[derive(Clone, Debug, Default)]
pub struct Sight {
    /// The table.
    pub table: Table,
    /// The objects, by id.
    pub objects: BTreeMap<String, SeenObject>,
    /// Joints between objects.
    pub joints: Vec<JointSpec>,
    /// The robot's limbs.
    pub limbs: Vec<LimbSight>,
}

/// An object that is seen.
#[derive(Clone, Debug)]
pub struct SeenObject {
    /// Its shape.
    pub shape: Shape,
    /// Its pose.
    pub pose: Pose,
    /// True if nothing can move it.
    pub is_fixed: bool,
}

/// A limb of the robot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LimbSight {
    /// The angles of its joints, in rad.
    pub angles: Angles,
    /// Opening of its gripper, in units.
    pub opening: f64,
    /// Ids of the objects that its gripper holds.
    pub holds: Vec<String>,
    /// The obstacle in its way.
    pub blocked_by: Option<String>,
}

impl SeenObject {
    /// Its solids at its present pose.
    pub fn solids(&self) -> Vec<PlacedSolid> {
        self.solids_at(self.pose)
    }

    /// Its solids at another pose.
    pub fn solids_at(&self, pose: Pose) -> Vec<PlacedSolid> {
        let solids = self.shape.colliding();
        solids
            .iter()
            .map(|solid| PlacedSolid::of(solid, pose))
            .collect()
    }
}

impl Sight {
    /// The arrangement of the objects.
    pub fn arrangement(&self) -> Arrangement {
        let objects = self.objects.iter();
        Arrangement::new(objects.map(|(id, object)| (id.as_str(), &object.shape, object.pose)))
    }

    /// The arrangement of the objects if one of them were at this pose.
    pub(crate) fn arrangement_with(&self, moved: &str, pose: Pose) -> Arrangement {
        let objects = self.objects.iter().map(|(id, object)| match id == moved {
            true => (id.as_str(), &object.shape, pose),
            false => (id.as_str(), &object.shape, object.pose),
        });
        Arrangement::new(objects)
    }

    /// True if a part of one object is above another one.
    pub(crate) fn covers(&self, one: &str, other: &str) -> bool {
        let (Some(one), Some(other)) = (self.objects.get(one), self.objects.get(other)) else {
            return false;
        };
        is_above(&one.solids(), &other.solids())
    }

    /// An object, none of these, that is where another one would be at this pose.
    pub(crate) fn occupant(&self, id: &str, pose: Pose, except: &[&str]) -> Option<String> {
        let raised = Pose::new(pose.location + Vec3::Z * RAISED, pose.rotation);
        let solids = self.objects.get(id)?.solids_at(raised);
        let mut others = self.objects.iter();
        let occupant = others.find(|(other, seen)| {
            let theirs = seen.solids();
            let meets = |solid: &PlacedSolid| {
                let solid = solid.shrunk(0.01);
                theirs.iter().any(|other| solid.is_within(1e-3, other))
            };
            *other != id && !except.contains(&other.as_str()) && solids.iter().any(meets)
        });
        occupant.map(|(other, _)| other.clone())
    }

    /// Ids of the objects that stand directly on an object.
    pub fn above(&self, id: &str) -> Vec<String> {
        let arrangement = self.arrangement();
        let others = self.objects.keys();
        let above = others.filter(|other| arrangement.supports(other).contains(&id));
        above.cloned().collect()
    }
}

/// True if one of these solids is above all of the others.
pub(crate) fn is_above(solids: &[PlacedSolid], below: &[PlacedSolid]) -> bool {
    let [_, top] = heights(below);
    solids.iter().any(|part| {
        let is_over = |solid: &PlacedSolid| part.gap_from_above(solid) <= 0.0;
        part.heights()[0] > top - PLAY && below.iter().any(is_over)
    })
}

/// Lowest and highest Z of solids.
pub(crate) fn heights(solids: &[PlacedSolid]) -> [f32; 2] {
    let all = solids.iter().map(PlacedSolid::heights);
    all.reduce(|[low, high], [lower, higher]| [low.min(lower), high.max(higher)])
        .unwrap_or_default()
}

/// Angle by which an orientation leans from another one about level axes, in rad.
pub(crate) fn lean(rotation: bevy::math::Quat) -> f32 {
    (rotation * Vec3::Z).angle_between(Vec3::Z)
}
