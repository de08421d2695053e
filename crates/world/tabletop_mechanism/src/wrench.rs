//! The robot's grippers as wrenches: they fasten and loosen a held guest by turning it at its host.

use bevy::prelude::*;
use tabletop_core::{
    Bond, Bonds, LimbName, ObjectSpec, Operator, Paused, Robot, RobotLayout, SimFact, Turn,
};
use tabletop_geometry::Pose;

use crate::bonds::{Pair, pair, take_turn, turned};

/// How near, in units, a loose guest is to a place of its host to be at it.
const NEAR: f32 = 0.2;

/// How far, in units, it goes from there until it has left.
const AWAY: f32 = 1.0;

/// How far, in rad, a loose guest may lean at its host: 15°.
const LEAN: f32 = 0.262;

/// Share of the angle of a step that may be missing.
const PLAY: f32 = 0.02;

/// How far, in units, a guest is pulled that comes off its host without a turn.
const PULL: f32 = 0.5;

/// Grippers with guests at hosts.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub(crate) struct Wrenches(Vec<Wrench>);

/// A gripper with a guest at a host.
#[derive(Clone, Debug, PartialEq)]
struct Wrench {
    limb: LimbName,
    guest_point: String,
    host_point: String,
    /// The gripper in the frame of the host point, a tick ago.
    gripper: Pose,
    /// Angle by which it has turned since the last step, about the axis of the next one.
    angle: f32,
    /// How far it has gone since the last step.
    way: Vec3,
}

/// An object in a gripper.
struct Gripped {
    limb: LimbName,
    gripper: Pose,
    object: String,
}

/// Run condition: a gripper may hold a guest.
pub(crate) fn is_possible(robot: Res<Robot>, wrenches: Res<Wrenches>) -> bool {
    !wrenches.0.is_empty() || robot.limbs.iter().any(|limb| !limb.holds.is_empty())
}

/// Fastens and loosens objects by a step once grippers have turned them far enough.
pub(crate) fn turn(world: &mut World) {
    if world.resource::<Paused>().0 {
        return;
    }
    let before = world.resource::<Wrenches>().clone();
    let mut wrenches = Wrenches::default();
    for gripped in gripped(world) {
        if let Some(wrench) = turn_one(world, &before, &gripped) {
            wrenches.0.push(wrench);
        }
    }
    if wrenches != before {
        world.insert_resource(wrenches);
    }
}

fn gripped(world: &World) -> Vec<Gripped> {
    let limbs = &world.resource::<RobotLayout>().limbs;
    let states = &world.resource::<Robot>().limbs;
    let mut gripped = Vec::new();
    for (limb, state) in limbs.iter().zip(states) {
        let specs = state.holds.iter();
        let specs = specs.filter_map(|&object| world.get::<ObjectSpec>(object));
        let guests = specs.filter(|spec| !spec.guest_points().is_empty());
        gripped.extend(guests.map(|spec| Gripped {
            limb: limb.name,
            gripper: state.end_effector,
            object: spec.id.clone(),
        }));
    }
    gripped
}

/// Follows a gripper for a tick, and makes the step that is due. None if its guest is at no host.
fn turn_one(world: &mut World, before: &Wrenches, gripped: &Gripped) -> Option<Wrench> {
    let bonds = &world.resource::<Bonds>().0;
    let bond = bonds.iter().find(|bond| bond.guest == gripped.object);
    let (bond, tightness) = match bond {
        Some(bond) => (bond.clone(), bond.tightness),
        None => (turned(world, &gripped.object, Turn::Tighter).ok()?, 0),
    };
    let pair = pair(world, &bond)?;
    let gripper = pair.host.inverse() * gripped.gripper;
    let wrench = before.of(gripped.limb, &bond);
    let has_arrived = wrench.is_none();
    if tightness == 0 && !is_at_host(&pair) {
        // A loosened object is fastened again only after it has been away.
        let has_left = pair.guest.location.distance(pair.host.location) > AWAY;
        return wrench
            .filter(|_| !has_left)
            .map(|_| Wrench::at(gripped.limb, &bond, gripper));
    }
    let mut wrench = wrench.map_or_else(|| Wrench::at(gripped.limb, &bond, gripper), Wrench::clone);
    wrench.follow(gripper, &pair, tightness);
    if let Some(turn) = wrench.due(&pair, tightness, has_arrived) {
        match turned(world, &bond.guest_point, turn) {
            Ok(bond) => {
                wrench.make_step(&pair, tightness, turn);
                let by = Operator::Limb(gripped.limb);
                if let Err(reason) = take_turn(world, None, by, (bond, turn)) {
                    let cause = None;
                    world.write_message(SimFact::Refused { cause, reason });
                }
            }
            // The fingers slip.
            Err(_locked) => wrench.start_anew(),
        }
    }
    Some(wrench)
}

/// Whether a loose guest is where it can be fastened.
fn is_at_host(Pair { guest, host, what }: &Pair) -> bool {
    let guest = host.inverse() * *guest;
    let first = what.place(1);
    let is_near = |place: Pose| guest.location.distance(place.location) < NEAR;
    match what.turn_to(1) {
        Some(turn) => {
            let axis = turn.normalize();
            let is_upright = (guest.rotation * axis).angle_between(axis) < LEAN;
            is_upright && (is_near(Pose::IDENTITY) || is_near(first))
        }
        None => is_near(first) && guest.rotation.angle_between(first.rotation) < LEAN,
    }
}

impl Wrenches {
    fn of(&self, limb: LimbName, bond: &Bond) -> Option<&Wrench> {
        self.0.iter().find(|wrench| {
            wrench.limb == limb
                && wrench.guest_point == bond.guest_point
                && wrench.host_point == bond.host_point
        })
    }
}

impl Wrench {
    fn at(limb: LimbName, bond: &Bond, gripper: Pose) -> Self {
        Self {
            limb,
            guest_point: bond.guest_point.clone(),
            host_point: bond.host_point.clone(),
            gripper,
            angle: 0.0,
            way: Vec3::ZERO,
        }
    }

    /// Goes with the gripper. Where nothing more can be fastened or loosened, the fingers slip.
    fn follow(&mut self, gripper: Pose, Pair { what, .. }: &Pair, tightness: u32) {
        let turn = gripper.rotation * self.gripper.rotation.inverse();
        let turn = if turn.w < 0.0 { -turn } else { turn }.to_scaled_axis();
        self.way += gripper.location - self.gripper.location;
        self.gripper = gripper;
        let (next, last) = (what.turn_to(tightness + 1), what.turn_to(tightness));
        let Some(axis) = next.or(last).map(Vec3::normalize) else {
            return;
        };
        let most = next.map_or(0.0, Vec3::length);
        let least = last.map_or(0.0, |last| last.dot(axis).max(0.0));
        self.angle = (self.angle + turn.dot(axis)).clamp(-least, most);
    }

    /// The step that the gripper has made.
    fn due(&self, Pair { what, .. }: &Pair, tightness: u32, has_arrived: bool) -> Option<Turn> {
        let reaches = |angle: f32, turn: Vec3| angle >= turn.length() * (1.0 - PLAY);
        let is_tighter = match what.turn_to(tightness + 1) {
            Some(turn) => reaches(self.angle, turn),
            None => tightness == 0 && has_arrived,
        };
        let is_looser = match what.turn_to(tightness) {
            Some(turn) => reaches(-self.angle, turn),
            None => tightness == 1 && self.way.length() > PULL,
        };
        match (is_tighter, is_looser) {
            (true, _) => Some(Turn::Tighter),
            (false, true) => Some(Turn::Looser),
            (false, false) => None,
        }
    }

    /// Makes a step: its angle is taken off the gripper's turn.
    fn make_step(&mut self, Pair { what, .. }: &Pair, tightness: u32, turn: Turn) {
        let angle = |tightness| what.turn_to(tightness).map_or(0.0, Vec3::length);
        self.angle += match turn {
            Turn::Tighter => -angle(tightness + 1),
            Turn::Looser => angle(tightness),
        };
        self.way = Vec3::ZERO;
    }

    fn start_anew(&mut self) {
        self.angle = 0.0;
        self.way = Vec3::ZERO;
    }
}
