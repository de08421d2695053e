//! The robot's view of the world.

use std::collections::BTreeSet;

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_rapier3d::prelude::*;
use tabletop_core::{Held, Joint, LimbId, ObjectSpec, Obstacle, Robot, Table};
use tabletop_geometry::Pose;
use tabletop_physics::{Environment, convex_parts};

use tabletop_robot::{Articulation, LinkEntities, Posture, RobotLink, positions};

use crate::{
    command::joint_targets::JointTargets, gripper::grips::Grips, motion::poses::Poses,
    motion::tick_motion::Carried, motion::tick_motion::TickMotion, motion::tick_motion::reach,
    owner::Owner, self_collision::SelfCollisionMatrix,
};

/// The robot's view of the world.
#[derive(SystemParam)]
pub(crate) struct RobotView<'w, 's> {
    pub articulation: Res<'w, Articulation>,
    pub self_collisions: Res<'w, SelfCollisionMatrix>,
    pub parts: Res<'w, LinkEntities>,
    pub tables: Query<'w, 's, &'static Table>,
    pub bodies: Query<'w, 's, (), With<RobotLink>>,
    pub objects: Query<'w, 's, (&'static ObjectSpec, Has<Held>)>,
    pub joints: Query<'w, 's, &'static Joint>,
}

impl RobotView<'_, '_> {
    /// The motion of the tick, before anything has moved.
    pub fn motion<'a>(
        &'a self,
        robot: &Robot,
        grips: &Grips,
        rapier: &RapierContextMut,
        posture: Posture,
    ) -> TickMotion<'a> {
        let positions = positions(robot);
        let held: BTreeSet<_> = grips.all().collect();
        let near = reach(posture.bodies().iter().map(|pose| pose.location));
        let is_met = |object| !self.bodies.contains(object) && !held.contains(&object);
        let environment = match robot.is_shown {
            true => Environment::new(
                &rapier.colliders,
                &rapier.rigidbody_set,
                near,
                is_met,
                self.joints.iter(),
            ),
            false => Environment::default(), // A hidden robot meets nothing.
        };
        let limbs = self.articulation.layout.limb_ids();
        let carried = limbs.clone().map(|limb| {
            grips
                .of(limb)
                .iter()
                .filter(|grip| !grip.is_jointed)
                .map(|grip| Carried {
                    object: grip.object,
                    pose: grip.pose,
                    mass: self
                        .objects
                        .get(grip.object)
                        .map_or(0.0, |(spec, ..)| spec.mass.into()),
                    parts: parts_of(rapier, grip.object),
                })
                .collect()
        });
        TickMotion {
            articulation: &self.articulation,
            self_collisions: &self.self_collisions,
            base: posture.base(),
            environment,
            carried: carried.collect(),
            positions,
            blocked_by: vec![None; limbs.len()],
            held_up_by: vec![None; limbs.len()],
            is_squeezing: vec![false; limbs.len()],
            holds: limbs.map(|limb| !grips.of(limb).is_empty()).collect(),
            inside: Vec::new(),
            is_shown: robot.is_shown,
            asked: Vec::new(),
            scratch: posture,
        }
    }

    /// Posture of the robot, updated from a known one if there is one.
    pub fn posture(&self, robot: &Robot, known: Option<Posture>) -> Posture {
        let (base, positions) = (self.base(), positions(robot));
        let known = known.filter(|known| known.base() == base && !self.articulation.is_changed());
        match known {
            Some(mut posture) => {
                self.articulation.update(&mut posture, &positions);
                posture
            }
            None => self.articulation.posture(&positions, base),
        }
    }

    /// Pose of the torso's frame in front of the present table.
    pub fn base(&self) -> Pose {
        let table = self.tables.iter().next().copied().unwrap_or_default();
        self.articulation.layout.base.pose(&table)
    }

    /// The obstacle that stopped an arm in a tick: something immovable, or an object squeezed for too long.
    pub fn blocked_by(
        &self,
        limb: LimbId,
        motion: &TickMotion,
        targets: &mut JointTargets,
    ) -> Option<Obstacle> {
        let squeezed = targets.wait_for(limb, motion.held_up_by[limb.index()]);
        let obstacle = motion.blocked_by[limb.index()].or(squeezed.map(Owner::Thing));
        obstacle.map(|owner| self.obstacle(owner))
    }

    /// Poses of the bodies and of the rigidly held objects after a motion.
    pub fn places(
        &self,
        motion: &mut TickMotion,
        robot: &Robot,
        grips: &Grips,
    ) -> Vec<(Entity, Pose)> {
        let poses = motion.here();
        let bodies = self
            .parts
            .0
            .iter()
            .copied()
            .zip(poses.bodies.iter().copied());
        let held = self.articulation.layout.limb_ids().flat_map(|limb| {
            let end_effector = robot.limb(limb).end_effector;
            let rigid = grips.of(limb).iter().filter(|grip| !grip.is_jointed);
            rigid.map(move |grip| (grip.object, end_effector * grip.pose))
        });
        bodies.chain(held).collect()
    }

    /// The owner of a solid as an obstacle.
    pub fn obstacle(&self, owner: Owner) -> Obstacle {
        match owner {
            Owner::Body(number) => Obstacle::Link(self.articulation.bodies[number].name.clone()),
            Owner::Thing(thing) => self.id(thing).map_or(Obstacle::Table, Obstacle::Object),
        }
    }

    /// The id of an object; the table has none.
    pub fn id(&self, thing: Entity) -> Option<String> {
        let (spec, ..) = self.objects.get(thing).ok()?;
        Some(spec.id.clone())
    }

    /// Writes the state of the limbs.
    pub fn publish(&self, robot: &mut Robot, targets: &JointTargets, posture: &Posture) {
        for limb in self.articulation.layout.limb_ids() {
            let state = &mut robot.limbs[limb.index()];
            state.end_effector = posture.end_effectors()[limb.index()];
            state.joint_origins.clear();
            state
                .joint_origins
                .extend(self.articulation.joint_origins(limb, posture));
            state.is_moving = targets.is_under_way(&self.articulation.layout, limb);
        }
    }

    /// Whether each body is so far from all free objects on its way from these poses to its present ones that it touches none.
    pub fn far_bodies(&self, motion: &mut TickMotion, before: &Poses, grips: &Grips) -> Vec<bool> {
        if grips.hold_jointed() {
            return Vec::new();
        }
        let here = motion.here();
        let bodies = 0..self.articulation.bodies.len();
        bodies
            .map(|number| motion.is_far(number, before, &here))
            .collect()
    }

    /// The sleeping objects that the arms may touch in this tick. Rapier would let things move into sleeping objects for a tick.
    pub fn near_arms(&self, motion: &mut TickMotion) -> Vec<Entity> {
        let things = motion.environment.free.iter();
        let sleeping = things.filter(|thing| thing.is_sleeping);
        let sleeping: Vec<_> = sleeping.map(|thing| (thing.object, thing.bounds)).collect();
        let limbs = self.articulation.layout.limb_ids();
        let near = sleeping
            .into_iter()
            .filter(|(_, bounds)| limbs.clone().any(|limb| motion.is_near(limb, bounds)));
        near.map(|(object, _)| object).collect()
    }
}

/// The convex parts of an object, in its own frame.
fn parts_of(rapier: &RapierContextMut, object: Entity) -> Vec<tabletop_physics::Convex> {
    let handle = rapier.colliders.entity2collider().get(&object).copied();
    handle
        .and_then(|handle| rapier.colliders.colliders.get(handle))
        .map(|collider| convex_parts(Pose::IDENTITY, collider.shared_shape()))
        .unwrap_or_default()
}
