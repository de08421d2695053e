//! Whether a posture of the robot is free.

use bevy::math::Vec3;
use tabletop_core::{Pose, Table};
use tabletop_task::Convex;

use crate::{
    body::{Angles, RobotBody, is_within},
    sight::{Sight, lean},
};

/// A limb among what it must not touch.
pub(crate) struct Clearance<'a> {
    pub body: &'a RobotBody,
    pub limb: usize,
    /// The angles of all limbs; those of the others stay.
    angles: Vec<Angles>,
    table: Table,
    obstacles: Vec<Convex>,
    others_fingers: Vec<Convex>,
    /// How far the gripper is open, in units.
    pub opening: f32,
    /// What it holds, in the end effector's frame.
    pub held: Vec<Convex>,
}

/// How much is kept from what.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Margins {
    fingers: f32,
    held: f32,
    held_above_table: f32,
    /// How far what is held may lean, in rad.
    lean: f32,
}

impl Margins {
    /// On the way.
    pub const WIDE: Self = Self {
        fingers: 0.1,
        held: 0.1,
        held_above_table: 0.08,
        lean: 0.3,
    };
    /// Where something is taken or put.
    pub const NARROW: Self = Self {
        fingers: 0.025,
        held: 0.004,
        held_above_table: 0.004,
        lean: 0.3,
    };
}

/// What the links of an arm keep from objects and table.
const LINKS: f32 = 0.05;

impl<'a> Clearance<'a> {
    /// Among all that is seen, but for these objects.
    pub fn new(body: &'a RobotBody, sight: &Sight, limb: usize, without: &[&str]) -> Self {
        let angles: Vec<_> = sight.limbs.iter().map(|limb| limb.angles).collect();
        let objects = sight.objects.iter();
        let obstacles = objects
            .filter(|(id, _)| !without.contains(&id.as_str()))
            .flat_map(|(_, object)| object.solids());
        let others = (0..angles.len()).filter(|&other| other != limb);
        let fingers = others.flat_map(|other| {
            let end_effector = body.end_effector(other, &angles[other]);
            body.fingers(other, end_effector, sight.limbs[other].opening as f32)
        });
        Self {
            obstacles: obstacles.collect(),
            others_fingers: fingers.collect(),
            opening: sight.limbs[limb].opening as f32,
            held: Vec::new(),
            table: sight.table,
            angles,
            body,
            limb,
        }
    }

    /// Holding this object, which the end effector carries at `grip`, in its frame.
    pub fn holding(mut self, solids: &[Convex], grip: Pose) -> Self {
        self.held = solids
            .iter()
            .map(|solid| Convex {
                pose: grip * solid.pose,
                solid: solid.solid,
            })
            .collect();
        self
    }

    pub fn opened(mut self, opening: f32) -> Self {
        self.opening = opening;
        self
    }

    /// Where the limb is now.
    pub fn here(&self) -> Angles {
        self.angles[self.limb]
    }

    pub fn end_effector(&self, angles: &Angles) -> Pose {
        self.body.end_effector(self.limb, angles)
    }

    pub fn reach(&self, pose: Pose, seed: &Angles) -> Option<Angles> {
        self.body.reach(self.limb, pose, seed)
    }

    /// Whether all of a way is free.
    pub fn is_way_free(&self, way: &[Angles], margins: Margins) -> bool {
        way.iter().all(|angles| self.is_free(angles, margins))
    }

    /// Whether nothing is in the way of the limb with these angles.
    pub fn is_free(&self, angles: &Angles, margins: Margins) -> bool {
        let end_effector = self.end_effector(angles);
        let fingers = self.body.fingers(self.limb, end_effector, self.opening);
        let held: Vec<_> = self
            .held
            .iter()
            .map(|solid| Convex {
                pose: end_effector * solid.pose,
                solid: solid.solid,
            })
            .collect();
        if !held.is_empty() && lean(end_effector.rotation) > margins.lean {
            return false;
        }
        if fingers
            .iter()
            .any(|finger| self.is_at_table(finger, margins.fingers))
            || held
                .iter()
                .any(|solid| self.is_at_table(solid, margins.held_above_table))
            || self.meets(&fingers, margins.fingers)
            || self.meets(&held, margins.held)
        {
            return false;
        }
        let meets_fingers = |solids: &[Convex]| {
            let near = |one: &Convex| {
                self.others_fingers
                    .iter()
                    .any(|other| is_within(one, other, 0.15))
            };
            solids.iter().any(near)
        };
        if meets_fingers(&fingers) || meets_fingers(&held) {
            return false;
        }
        let mut all = self.angles.clone();
        all[self.limb] = *angles;
        let (links, is_apart) = self.body.meet(self.limb, &all);
        is_apart
            && !links.iter().any(|link| self.is_at_table(link, LINKS))
            && !self.meets(&links, LINKS)
            && !meets_fingers(&links)
    }

    fn meets(&self, solids: &[Convex], margin: f32) -> bool {
        let near = |one: &Convex| {
            self.obstacles
                .iter()
                .any(|other| is_within(one, other, margin))
        };
        solids.iter().any(near)
    }

    /// Whether it is nearer to the table's top than this, or below it.
    fn is_at_table(&self, solid: &Convex, margin: f32) -> bool {
        let half = Vec3::new(self.table.xspan, self.table.yspan, 0.0) / 2.0;
        let at = solid.pose.location;
        let radius = solid.radius();
        at.z - radius < margin
            && at.x.abs() - radius < half.x
            && at.y.abs() - radius < half.y
            && solid.heights()[0] < margin
    }
}
