//! Sweep: the joints go to their targets as far as nothing is in the way (report section 5).

use std::rc::Rc;

use bevy::prelude::*;
use bevy_rapier3d::parry::bounding_volume::{Aabb, BoundingVolume};
use tabletop_core::{LimbId, Pose};
use tabletop_physics::Convex;

use crate::{
    articulation::self_collision::SelfCollisionMatrix,
    articulation::tree::{Articulation, Body, Carrier, Positions, Posture, TreePosition},
    clearance::{MARGIN, Owner, SQUEEZE, SweptSolid, are_near, part_left},
    command::joint_targets::{JointTargets, Setpoint},
    gripper::{
        alignment::PRESS,
        closing::{Closing, Graspable, close},
    },
    motion::environment::{Environment, FreeObject},
};

/// Largest distance of a body, in units, between two checks for obstacles: less than the thickness of a finger.
const STEP: f32 = 0.2;

/// Largest number of checks in a tick: a faster body is checked less densely.
const MOST_STEPS: f32 = 400.0;

/// Number of halvings of the last step, to come as near as possible.
const HALVINGS: u32 = 6;

/// Least part of a tick's way that is made.
const LEAST_PUSH: f64 = 0.05;

/// Largest distance from an end effector, in units, of an object between its fingers.
const BETWEEN: f32 = 2.0;

/// An object in a gripper, as the arm carries it.
pub(crate) struct Carried {
    /// The object.
    pub object: Entity,
    /// Its pose in the end effector's frame.
    pub pose: Pose,
    /// Its mass in kg.
    pub mass: f64,
    /// Its convex parts, in its own frame.
    pub parts: Vec<Convex>,
}

/// Poses of the robot at some positions of the joints.
pub(crate) struct Poses {
    positions: Positions,
    /// Its bodies.
    pub bodies: Vec<Pose>,
    /// A box around each body in any orientation.
    around: Vec<Aabb>,
    end_effectors: Vec<Pose>,
}

/// Margin of boxes around bodies, in units, for rounding errors.
const ROUNDING: f32 = 1e-3;

/// Number of answers that are remembered.
const MOST_ASKED: usize = 4;

/// The motion of a tick.
pub(crate) struct TickMotion<'a> {
    /// The robot.
    pub articulation: &'a Articulation,
    /// The pairs of its bodies that can collide.
    pub self_collisions: &'a SelfCollisionMatrix,
    /// Pose of its torso.
    pub base: Pose,
    /// Its surroundings.
    pub environment: Environment,
    /// True for each gripper that holds anything.
    pub holds: Vec<bool>,
    /// The objects that its grippers hold rigidly.
    pub carried: Vec<Vec<Carried>>,
    /// Positions of the joints, by [`JointId`](tabletop_core::JointId).
    pub positions: Positions,
    /// The obstacle that stopped each arm in this tick.
    pub blocked_by: Vec<Option<Owner>>,
    /// The object that each arm has squeezed so much in this tick that it waited.
    pub held_up_by: Vec<Option<Entity>>,
    /// True for each arm that was slowed in this tick by squeezing a free object.
    pub is_squeezing: Vec<bool>,
    /// True for each body that stands in an object, and pushes nothing.
    pub inside: Vec<bool>,
    /// True if it can meet anything.
    pub is_shown: bool,
    /// The last poses that were asked for.
    pub asked: Vec<Rc<Poses>>,
    /// Scratch space for a posture.
    pub scratch: Posture,
}

impl TickMotion<'_> {
    /// Turns the neck.
    pub fn turn_head(&mut self, targets: &JointTargets) {
        let layout = &self.articulation.layout;
        if let Some(neck) = layout.neck {
            let position = &mut self.positions[neck.index()];
            *position = targets.setpoint(layout, neck, *position).position();
        }
    }

    /// Moves the joints of an arm to their setpoints.
    pub fn move_arm(&mut self, limb: LimbId, setpoints: &[Setpoint]) {
        let joints = &self.articulation.layout.limb(limb).joints;
        let mut there = self.positions.clone();
        for (joint, setpoint) in joints.iter().zip(setpoints) {
            there[joint.index()] = setpoint.position();
        }
        if there == self.positions {
            return;
        }
        let jumps = setpoints
            .iter()
            .any(|setpoint| matches!(setpoint, Setpoint::Jump(_)));
        if jumps
            && self
                .obstacle(limb, &self.positions.clone(), &there)
                .is_none()
        {
            self.positions = there;
            return;
        }
        let (part, pushed) = self.push(limb, &there);
        self.is_squeezing[limb.index()] = pushed.is_some();
        if part < LEAST_PUSH {
            self.held_up_by[limb.index()] = pushed;
            return;
        }
        self.blocked_by[limb.index()] = self.sweep(limb, lerp(&self.positions, &there, part));
    }

    /// Opens or closes a gripper, which may be pressing on objects that its fingers touch. Returns the objects found between them while closing.
    pub fn move_fingers(
        &mut self,
        limb: LimbId,
        targets: &JointTargets,
        is_pressing: bool,
    ) -> Closing {
        let layout = &self.articulation.layout;
        let joint = layout.limb(limb).gripper.joint;
        let [least, _] = layout.joint(joint).limits;
        let opening = self.positions[joint.index()];
        let setpoint = targets.setpoint(layout, joint, opening).position();
        let mut closing = Closing::default();
        let mut there = self.positions.clone();
        if setpoint > opening {
            there[joint.index()] = setpoint;
        } else if setpoint < opening && !self.holds[limb.index()] {
            closing = close(
                self.end_effector(limb),
                opening as f32,
                layout.limb(limb).gripper.finger,
                &self.between(limb),
            );
            let press = if is_pressing { PRESS } else { 0.0 };
            let room = f64::from(closing.room) + press;
            there[joint.index()] = setpoint.max(opening - room).max(least);
        }
        if there == self.positions {
            return closing;
        }
        let (part, _) = self.push(limb, &there);
        if part >= LEAST_PUSH {
            self.sweep(limb, lerp(&self.positions, &there, part));
        }
        closing
    }

    /// Pose of an end effector.
    pub fn end_effector(&mut self, limb: LimbId) -> Pose {
        self.poses(&self.positions.clone()).end_effectors[limb.index()]
    }

    /// Objects that may be between the fingers of a gripper.
    fn between(&mut self, limb: LimbId) -> Vec<Graspable> {
        let at = self.end_effector(limb).location;
        let near = Aabb::new(at - BETWEEN, at + BETWEEN);
        let things = self.environment.free.iter();
        things
            .filter(|thing| are_near(&thing.bounds, &near))
            .map(|thing| Graspable {
                object: thing.object,
                parts: thing.parts.clone(),
            })
            .collect()
    }

    /// Goes towards these positions as far as no obstacle is in the way of an arm. Returns the obstacle.
    fn sweep(&mut self, limb: LimbId, there: Positions) -> Option<Owner> {
        let start = self.positions.clone();
        let between = |part: f64| lerp(&start, &there, part);
        let steps = (self.way(limb, &start, &there) / STEP)
            .ceil()
            .clamp(1.0, MOST_STEPS);
        for step in 1..=steps as u32 {
            let ahead = f64::from(step) / f64::from(steps);
            let Some(mut obstacle) = self.obstacle(limb, &self.positions.clone(), &between(ahead))
            else {
                self.positions = between(ahead);
                continue;
            };
            let (mut free, mut blocked) = (f64::from(step - 1) / f64::from(steps), ahead);
            for _ in 0..HALVINGS {
                let middle = (free + blocked) / 2.0;
                match self.obstacle(limb, &self.positions.clone(), &between(middle)) {
                    None => free = middle,
                    Some(nearer) => (blocked, obstacle) = (middle, nearer),
                }
            }
            self.positions = between(free);
            return Some(obstacle);
        }
        None
    }

    /// The part of the way to these positions that an arm can go in a tick with the objects that it pushes, and the object that it squeezes most.
    fn push(&mut self, limb: LimbId, there: &Positions) -> (f64, Option<Entity>) {
        if self.environment.free.is_empty() {
            return (1.0, None);
        }
        let [here, there] = [&self.positions.clone(), there].map(|at| self.poses(at));
        let mut solids = self.solids_of(limb, &here, &there, |number| {
            let way = here.around[number].merged(&there.around[number]);
            let mut free = self.environment.free.iter();
            free.any(|thing| are_near(&way, &thing.bounds))
        });
        solids.retain(|(_, solid)| !self.stands_inside(solid.owner));
        let (mut part, mut most_pushed) = (1.0, None);
        for (i, thing) in self.environment.free.iter().enumerate() {
            let approaches = solids
                .iter()
                .filter(|(_, solid)| solid.passes(&thing.bounds))
                .flat_map(|(_, solid)| thing.solids().filter_map(|thing| solid.approach(&thing)));
            let mut can_go = 1.0_f32;
            let mut pushes = Vec::new();
            for approach in approaches {
                can_go = can_go.min(approach.part());
                pushes.extend(approach.is_push().then_some(approach));
            }
            let is_pushed = !pushes.is_empty();
            if is_pushed {
                let squeeze = self.environment.squeeze(i);
                can_go = can_go.min(part_left(squeeze));
                for push in pushes {
                    if self.environment.is_stopped(i, push.direction) {
                        can_go = can_go.min(push.part_pressing(squeeze));
                    }
                }
            }
            if can_go < part {
                (part, most_pushed) = (can_go, is_pushed.then_some(thing.object));
            }
        }
        let least = if most_pushed.is_some() {
            0.0
        } else {
            LEAST_PUSH
        };
        (f64::from(part).max(least), most_pushed)
    }

    /// True for a body that stands in an object.
    fn stands_inside(&self, owner: Owner) -> bool {
        match owner {
            Owner::Body(number) => self.inside.get(number).copied().unwrap_or(false),
            Owner::Thing(_) => false,
        }
    }

    /// True if a body is deeper in an object than it could press into it.
    pub fn is_inside_object(&self, number: usize, poses: &Poses) -> bool {
        let around = &poses.around[number];
        let parts = &self.articulation.bodies[number].parts;
        let pose = poses.bodies[number];
        let solids: Vec<_> = SweptSolid::moving(parts, Owner::Body(number), pose, pose).collect();
        let is_entered = |thing: &SweptSolid| {
            are_near(thing.bounds(), around)
                && solids.iter().any(|solid| solid.depth_in(thing) > SQUEEZE)
        };
        let environment = &self.environment;
        let mut free = environment.free.iter().flat_map(FreeObject::solids);
        environment.immovable.iter().any(is_entered) || free.any(|thing| is_entered(&thing))
    }

    /// Approximate distance that the bodies of an arm go between two positions, in units.
    fn way(&mut self, limb: LimbId, from: &Positions, to: &Positions) -> f32 {
        let [from, to] = [from, to].map(|positions| self.poses(positions));
        self.bodies_of(limb)
            .map(|number| (from.bodies[number], to.bodies[number]))
            .map(|(from, to)| {
                from.location.distance(to.location) + from.rotation.angle_between(to.rotation)
            })
            .fold(0.0, f32::max)
    }

    /// The numbers of the bodies of an arm.
    fn bodies_of(&self, limb: LimbId) -> impl Iterator<Item = usize> {
        let bodies = self.articulation.bodies.iter().enumerate();
        bodies
            .filter(move |(_, body)| is_of(body, limb))
            .map(|(number, _)| number)
    }

    /// Poses of the robot. The last few answers are remembered, because most are asked for several times.
    pub fn poses(&mut self, positions: &Positions) -> Rc<Poses> {
        let is_asked = |poses: &&Rc<Poses>| poses.positions == *positions;
        if let Some(poses) = self.asked.iter().find(is_asked) {
            return Rc::clone(poses);
        }
        self.articulation.update(&mut self.scratch, positions);
        let bodies = self.scratch.bodies().to_vec();
        let around = bodies.iter().zip(&self.articulation.bodies);
        let around = around.map(|(at, body)| {
            let radius = body.radius + ROUNDING;
            Aabb::new(at.location - radius, at.location + radius)
        });
        let poses = Rc::new(Poses {
            positions: positions.clone(),
            around: around.collect(),
            bodies,
            end_effectors: self.scratch.end_effectors().to_vec(),
        });
        if self.asked.len() == MOST_ASKED {
            self.asked.remove(0);
        }
        self.asked.push(Rc::clone(&poses));
        poses
    }

    /// The solids of an arm and of the objects it holds, each with the number of the body by which it meets things.
    pub fn solids(
        &mut self,
        limb: LimbId,
        from: &Positions,
        to: &Positions,
    ) -> Vec<(usize, SweptSolid)> {
        let [from, to] = [from, to].map(|positions| self.poses(positions));
        self.solids_of(limb, &from, &to, |_| true)
    }

    /// The solids of the needed bodies of an arm, and of the objects it holds.
    fn solids_of(
        &self,
        limb: LimbId,
        from: &Poses,
        to: &Poses,
        is_needed: impl Fn(usize) -> bool,
    ) -> Vec<(usize, SweptSolid)> {
        let mut solids = Vec::with_capacity(self.articulation.bodies.len());
        for number in self.bodies_of(limb).filter(|number| is_needed(*number)) {
            let parts = &self.articulation.bodies[number].parts;
            let [from, to] = [from, to].map(|poses| poses.bodies[number]);
            let moving = SweptSolid::moving(parts, Owner::Body(number), from, to);
            solids.extend(moving.map(|solid| (number, solid)));
        }
        let finger = self.finger(limb);
        for carried in &self.carried[limb.index()] {
            let [from, to] =
                [from, to].map(|poses| poses.end_effectors[limb.index()] * carried.pose);
            let moving = SweptSolid::moving(&carried.parts, Owner::Thing(carried.object), from, to);
            solids.extend(moving.map(|solid| (finger, solid)));
        }
        solids
    }

    /// The number of a finger of an arm.
    fn finger(&self, limb: LimbId) -> usize {
        let is_finger = |body: &Body| matches!(body.carrier, Carrier::Gripper(of, _) if of == limb);
        self.articulation
            .bodies
            .iter()
            .position(is_finger)
            .unwrap_or(0)
    }

    /// An obstacle that an arm is inside of.
    pub fn is_inside(&mut self, limb: LimbId) -> Option<Owner> {
        let here = self.positions.clone();
        let solids = self.solids(limb, &here, &here);
        let mut immovable = self.environment.immovable.iter();
        immovable
            .find(|obstacle| {
                solids
                    .iter()
                    .any(|(_, solid)| solid.depth_in(obstacle) > 0.0)
            })
            .map(|obstacle| obstacle.owner)
    }

    /// The obstacle in the way of an arm between two positions.
    fn obstacle(&mut self, limb: LimbId, from: &Positions, to: &Positions) -> Option<Owner> {
        if !self.is_shown {
            return None;
        }
        let here = self.poses(&self.positions.clone());
        let [from, to] = [from, to].map(|positions| self.poses(positions));
        let solids = self.solids_of(limb, &from, &to, |number| {
            self.may_collide(limb, number, &here, &to)
        });
        let outside = solids.iter().find_map(|(_, solid)| {
            let mut immovable = self.environment.immovable.iter();
            immovable
                .find(|obstacle| solid.collides_with(obstacle, solid.give()))
                .map(|obstacle| obstacle.owner)
        });
        outside.or_else(|| self.own_body(limb, &solids, &here))
    }

    /// True if a body of an arm, or an object it holds, may come near an obstacle on this way.
    fn may_collide(&self, limb: LimbId, number: usize, here: &Poses, there: &Poses) -> bool {
        if !self.carried[limb.index()].is_empty() {
            return true;
        }
        let around = &there.around[number];
        let mut immovable = self.environment.immovable.iter();
        let mut partners = self.self_collisions.partners(number).iter();
        immovable.any(|obstacle| are_near(obstacle.bounds(), around))
            || partners.any(|&other| {
                let bodies = &self.articulation.bodies;
                let poses = if is_of(&bodies[other], limb) {
                    there
                } else {
                    here
                };
                let reach = bodies[number].radius + bodies[other].radius + MARGIN + ROUNDING;
                let [at, other_at] = [there.bodies[number], poses.bodies[other]];
                at.location.distance_squared(other_at.location) < reach * reach
            })
    }

    /// The body of the robot that solids of an arm would collide with.
    fn own_body(
        &self,
        limb: LimbId,
        solids: &[(usize, SweptSolid)],
        here: &Poses,
    ) -> Option<Owner> {
        for (i, (a, solid)) in solids.iter().enumerate() {
            let met = solids[..i].iter().find(|(b, other)| {
                self.self_collisions.can_meet(*a, *b) && solid.collides_with(other, 0.0)
            });
            if let Some((_, other)) = met {
                return Some(other.owner);
            }
        }
        let bounds = solids.iter().map(|(_, solid)| *solid.bounds());
        let bounds = bounds.reduce(|one, other| one.merged(&other))?;
        for (number, body) in self.articulation.bodies.iter().enumerate() {
            let around = &here.around[number];
            if is_of(body, limb) || !are_near(&bounds, around) {
                continue;
            }
            let may_meet = |(a, solid): &(usize, SweptSolid)| {
                self.self_collisions.can_meet(*a, number) && are_near(solid.bounds(), around)
            };
            if !solids.iter().any(may_meet) {
                continue;
            }
            let pose = here.bodies[number];
            for other in SweptSolid::moving(&body.parts, Owner::Body(number), pose, pose) {
                let is_met = solids.iter().any(|(a, solid)| {
                    self.self_collisions.can_meet(*a, number) && solid.collides_with(&other, 0.0)
                });
                if is_met {
                    return Some(other.owner);
                }
            }
        }
        None
    }

    /// True if a body comes near no free object on its way from some poses to others.
    pub fn is_far(&self, number: usize, from: &Poses, to: &Poses) -> bool {
        let way = from.around[number].merged(&to.around[number]);
        let [from, to] = [from, to].map(|poses| poses.bodies[number]);
        let parts = &self.articulation.bodies[number].parts;
        let free = self.environment.free.iter();
        let mut near = free.filter(|thing| way.intersects(&thing.vicinity));
        near.all(|thing| {
            let mut solids = SweptSolid::moving(parts, Owner::Body(number), from, to);
            solids.all(|solid| !solid.passes(&thing.vicinity))
        })
    }

    /// True if a solid of an arm is near this box at present.
    pub fn is_near(&mut self, limb: LimbId, bounds: &Aabb) -> bool {
        let here = self.poses(&self.positions.clone());
        let may_be_near = |number: usize| are_near(&here.around[number], bounds);
        let solids = self.solids_of(limb, &here, &here, may_be_near);
        solids
            .iter()
            .any(|(_, solid)| are_near(solid.bounds(), bounds))
    }
}

/// A box around everything that the arms may meet in a tick.
pub(crate) fn reach(poses: impl Iterator<Item = Vec3>) -> Aabb {
    let mut bounds: Option<Aabb> = None;
    for at in poses {
        let around = Aabb::new(at - 5.0, at + 5.0);
        bounds = Some(bounds.map_or(around, |bounds| bounds.merged(&around)));
    }
    bounds.unwrap_or_else(Aabb::new_invalid)
}

/// Positions on the way between others.
fn lerp(from: &Positions, to: &Positions, part: f64) -> Positions {
    if part >= 1.0 {
        return to.clone();
    }
    let ways = from.iter().zip(to);
    ways.map(|(from, to)| from + (to - from) * part).collect()
}

fn is_of(body: &Body, limb: LimbId) -> bool {
    matches!(body.place, TreePosition::Limb(of, _) if of == limb)
}
