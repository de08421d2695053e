//! Clearance: whether a posture of the robot is free of collisions.

use std::cell::RefCell;

use bevy::math::{Quat, Vec3};
use tabletop_controller::{Angles, Sight};
use tabletop_core::Table;
use tabletop_geometry::{PlacedSolid, Pose};

use crate::{
    body::{LinkSolid, RobotBody},
    guarded_gaps::GuardedGaps,
    sight::{Solids as _, lean},
};

/// A limb among the obstacles that it must not touch.
pub(crate) struct Clearance<'a> {
    pub body: &'a RobotBody,
    pub limb: usize,
    /// The angles of all limbs; those of the other limbs are fixed.
    angles: Vec<Angles>,
    table: Table,
    obstacles: Vec<PlacedSolid>,
    /// The object that is taken or has been let go: only the fingers may be beside it.
    taken: Vec<PlacedSolid>,
    /// The rest of the robot, including the fingers of other limbs.
    rest: Vec<LinkSolid>,
    others_fingers: Vec<PlacedSolid>,
    scratch: RefCell<Vec<LinkSolid>>,
    /// Opening of the gripper, in units.
    pub opening: f32,
    /// The held solids, in the end effector's frame.
    held: Vec<PlacedSolid>,
    /// The same, where the posture that was last asked for carries them.
    carried: RefCell<Vec<PlacedSolid>>,
    /// Rotation from the held object, when it does not lean, to the end effector's frame; `None` if it may lean.
    upright: Option<Quat>,
    /// Largest tilt of the held object, in rad, unless it may lean.
    tilt: f32,
    /// True if a joint guides the held object, which may touch what it slides along.
    is_guided: bool,
}

/// Distances to be kept from obstacles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Margins {
    fingers: f32,
    held: f32,
    held_above_table: f32,
    /// True if the gaps are kept that a guard of the robot keeps, too.
    is_guarded: bool,
}

impl Margins {
    /// For motions between places.
    pub const WIDE: Self = Self {
        fingers: 0.1,
        held: 0.1,
        held_above_table: 0.08,
        is_guarded: true,
    };
    /// For motions between places where there is no more room.
    pub const TIGHT: Self = Self {
        fingers: 0.04,
        held: 0.03,
        held_above_table: 0.03,
        is_guarded: true,
    };
    /// For motions from where a guard would not have let the robot go: it lets it leave.
    pub const LEAVING: Self = Self {
        is_guarded: false,
        ..Self::TIGHT
    };
    /// For motions where an object is grasped or put down.
    pub const NARROW: Self = Self {
        fingers: 0.025,
        held: 0.004,
        held_above_table: 0.004,
        is_guarded: true,
    };
    /// For fingers that come from beside an object, which may have neighbours.
    pub const BARE: Self = Self {
        fingers: 0.005,
        ..Self::NARROW
    };
}

/// Largest tilt of a held object, in rad, unless it is to be tipped.
const LEAN: f32 = 0.3;
/// The same of one with something on it or in it, which is not to slide.
const LOADED_LEAN: f32 = 0.1;
/// Distance of an arm's links from objects and table, and of parts of the robot from each other, in units.
const LINKS: f32 = 0.05;
const PARTS: f32 = 0.15;

impl<'a> Clearance<'a> {
    /// The [size of the robot's hand](RobotBody::hand_size).
    pub fn hand_size(&self) -> f32 {
        self.body.hand_size()
    }

    /// A limb among all that is seen, except these objects.
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
            taken: Vec::new(),
            others_fingers: fingers.collect(),
            rest: body.rest(limb, &angles),
            scratch: RefCell::default(),
            opening: sight.limbs[limb].opening as f32,
            held: Vec::new(),
            carried: RefCell::default(),
            upright: None,
            tilt: LEAN,
            is_guided: false,
            table: sight.table,
            angles,
            body,
            limb,
        }
    }

    /// The limb as it takes an object of these solids, or lets it go.
    pub fn taking(mut self, solids: Vec<PlacedSolid>) -> Self {
        self.taken = solids;
        self
    }

    /// The limb with an object that its end effector carries at `grip`, a pose in the end effector's frame. The object does not lean when the end
    /// effector is turned by the inverse of `upright`; if there is none, it may lean.
    pub fn holding(mut self, solids: &[PlacedSolid], grip: Pose, upright: Option<Quat>) -> Self {
        self.upright = upright;
        self.held = solids
            .iter()
            .map(|solid| PlacedSolid {
                pose: grip * solid.pose,
                solid: solid.solid.clone(),
            })
            .collect();
        self.carried = RefCell::new(self.held.clone());
        self
    }

    /// The limb with an object on which, or in which, something is.
    pub fn loaded(mut self) -> Self {
        self.tilt = LOADED_LEAN;
        self
    }

    /// The limb with these obstacles, too.
    pub fn beside(mut self, solids: impl IntoIterator<Item = PlacedSolid>) -> Self {
        self.obstacles.extend(solids);
        self
    }

    /// The limb with an object that a joint guides: only the limb keeps clear of obstacles.
    pub fn guided(mut self) -> Self {
        self.is_guided = true;
        self
    }

    pub fn opened(mut self, opening: f32) -> Self {
        self.opening = opening;
        self
    }

    /// Present angles of the limb.
    pub fn here(&self) -> Angles {
        self.angles[self.limb]
    }

    pub fn end_effector(&self, angles: &Angles) -> Pose {
        self.body.end_effector(self.limb, angles)
    }

    pub fn reach(&self, pose: Pose, seed: &Angles) -> Option<Angles> {
        self.body.reach(self.limb, pose, seed)
    }

    pub fn reach_soon(&self, pose: Pose, seed: &Angles) -> Option<Angles> {
        self.body.reach_soon(self.limb, pose, seed)
    }

    pub fn reach_from(&self, pose: Pose, seed: &Angles) -> Option<Angles> {
        self.body.reach_from(self.limb, pose, seed)
    }

    /// True if every posture of a path is free.
    pub fn is_way_free(&self, way: &[Angles], margins: Margins) -> bool {
        way.iter().all(|angles| self.is_free(angles, margins))
    }

    /// True if the limb collides with nothing at these angles.
    pub fn is_free(&self, angles: &Angles, margins: Margins) -> bool {
        let end_effector = self.end_effector(angles);
        let fingers = self.body.fingers(self.limb, end_effector, self.opening);
        let mut held = self.carried.borrow_mut();
        for (solid, in_hand) in held.iter_mut().zip(&self.held) {
            solid.pose = end_effector * in_hand.pose;
        }
        let held = held.as_slice();
        let gaps = match margins.is_guarded {
            true => self.body.guarded_gaps,
            false => GuardedGaps::NONE,
        };
        let above_table = margins.fingers.max(gaps.fingers_above_table);
        let (links_above_table, between_parts) = (LINKS.max(gaps.links), PARTS.max(gaps.links));
        let leans = |upright: Quat| lean(end_effector.rotation * upright) > self.tilt;
        if self.upright.is_some_and(leans) {
            return false;
        }
        if fingers
            .iter()
            .any(|finger| self.is_at_table(finger, above_table))
            || self.meets(&fingers, margins.fingers)
            || !self.is_guided && self.is_held_at_obstacle(held, margins)
        {
            return false;
        }
        let meets_fingers = |one: &PlacedSolid| is_near(one, &self.others_fingers, between_parts);
        if fingers.iter().chain(held).any(meets_fingers) {
            return false;
        }
        let mut own = self.scratch.borrow_mut();
        self.body.own(self.limb, angles, &mut own);
        let far_out = |link: &LinkSolid| self.body.is_far_out(link.link);
        let is_clear = |solid: &PlacedSolid| {
            !self.is_at_table(solid, links_above_table)
                && !is_near(solid, &self.obstacles, LINKS)
                && !is_near(solid, &self.taken, LINKS)
                && !is_near(solid, held, LINKS)
                && !meets_fingers(solid)
        };
        own.iter()
            .filter(|link| far_out(link))
            .all(|link| is_clear(&link.solid))
            && own.iter().enumerate().all(|(i, one)| {
                let others = own[..i].iter().chain(&self.rest);
                others.into_iter().all(|other| {
                    let between = one.solid.pose.location - other.solid.pose.location;
                    let near = one.solid.radius() + other.solid.radius() + between_parts;
                    between.length_squared() > near * near
                        || !self.body.can_meet(one.link, other.link)
                        || !one.solid.is_within(between_parts, &other.solid)
                })
            })
    }

    /// True if there is room for fingers at this opening.
    pub fn has_room_for_fingers(&self, end_effector: Pose, opening: f32, margin: f32) -> bool {
        let fingers = self.body.fingers(self.limb, end_effector, opening);
        !self.meets(&fingers, margin)
    }

    fn is_held_at_obstacle(&self, held: &[PlacedSolid], margins: Margins) -> bool {
        held.iter()
            .any(|solid| self.is_at_table(solid, margins.held_above_table))
            || self.meets(held, margins.held)
    }

    fn meets(&self, solids: &[PlacedSolid], margin: f32) -> bool {
        solids
            .iter()
            .any(|solid| is_near(solid, &self.obstacles, margin))
    }

    /// True if it is nearer to the table's top than this margin, or below it.
    fn is_at_table(&self, solid: &PlacedSolid, margin: f32) -> bool {
        let half = Vec3::new(self.table.xspan, self.table.yspan, 0.0) / 2.0;
        let at = solid.pose.location;
        let radius = solid.radius();
        at.z - radius < margin
            && at.x.abs() - radius < half.x
            && at.y.abs() - radius < half.y
            && solid.heights()[0] < margin
    }
}

fn is_near(solid: &PlacedSolid, others: &[PlacedSolid], margin: f32) -> bool {
    others.iter().any(|other| solid.is_within(margin, other))
}
