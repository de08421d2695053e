//! What the robot knows of the world.

use std::collections::BTreeSet;

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_rapier3d::{parry::bounding_volume::Aabb, prelude::*};
use tabletop_core::{Arm, Gripped, Held, ObjectSpec, Pose, Robot, Table, robot_base};
use tabletop_physics::convex_parts;

use crate::{
    articulation::{
        link_entities::{LinkEntities, RobotBody, poses, positions},
        self_collision::SelfCollisionMatrix,
        tree::Articulation,
    },
    clearance::{Owner, are_near},
    command::joint_targets::JointTargets,
    gripper::grips::Grips,
    motion::{
        environment::Environment,
        sweep::{Carried, Motion, reach},
    },
};

/// What the robot knows of the world.
#[derive(SystemParam)]
pub(crate) struct RobotView<'w, 's> {
    pub articulation: Res<'w, Articulation>,
    pub self_collisions: Res<'w, SelfCollisionMatrix>,
    pub parts: Res<'w, LinkEntities>,
    pub tables: Query<'w, 's, &'static Table>,
    pub bodies: Query<'w, 's, (), With<RobotBody>>,
    pub objects: Query<'w, 's, (&'static ObjectSpec, Has<Held>, Has<Gripped>)>,
}

impl RobotView<'_, '_> {
    /// The tick's motion, before anything has moved.
    pub fn motion<'a>(
        &'a self,
        robot: &Robot,
        grips: &Grips,
        rapier: &RapierContextMut,
    ) -> Motion<'a> {
        let base = self.base();
        let positions = positions(robot);
        let posture = self.articulation.posture(&positions);
        let held: BTreeSet<_> = grips.all().collect();
        let near = reach(
            poses(&self.articulation, &posture, base)
                .into_iter()
                .map(|pose| pose.location),
        );
        let environment = Environment::new(rapier, &near, &self.bodies, &held, robot.is_shown);
        let carried = Arm::BOTH.map(|arm| {
            grips
                .of(arm)
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
        Motion {
            articulation: &self.articulation,
            self_collisions: &self.self_collisions,
            base,
            environment,
            carried,
            positions,
            blocked_by: [None; 2],
            held_up_by: [None; 2],
            is_squeezing: [false; 2],
            holds: Arm::BOTH.map(|arm| !grips.of(arm).is_empty()),
            is_shown: robot.is_shown,
            asked: Vec::new(),
            scratch: posture,
        }
    }

    /// Where the torso's frame stands, in front of the present table.
    pub fn base(&self) -> Pose {
        robot_base(&self.tables.iter().next().copied().unwrap_or_default())
    }

    /// What an arm was stopped by in a tick, by name: what cannot be passed, or what it has squeezed for too long.
    pub fn blocked_by(
        &self,
        arm: Arm,
        motion: &Motion,
        targets: &mut JointTargets,
    ) -> Option<String> {
        let squeezed = targets.wait_for(arm, motion.held_up_by[arm as usize]);
        let obstacle = motion.blocked_by[arm as usize].or(squeezed.map(Owner::Thing));
        obstacle.map(|owner| self.name(owner))
    }

    /// Where the bodies are after a motion, and what the grippers hold rigidly.
    pub fn places(&self, motion: &Motion, robot: &Robot, grips: &Grips) -> Vec<(Entity, Pose)> {
        let posture = self.articulation.posture(&motion.positions);
        let poses = poses(&self.articulation, &posture, motion.base);
        let bodies = self.parts.0.iter().copied().zip(poses);
        let held = Arm::BOTH.into_iter().flat_map(|arm| {
            let end_effector = robot.arm(arm).end_effector;
            let rigid = grips.of(arm).iter().filter(|grip| !grip.is_jointed);
            rigid.map(move |grip| (grip.object, end_effector * grip.pose))
        });
        bodies.chain(held).collect()
    }

    /// What something is called.
    pub fn name(&self, owner: Owner) -> String {
        match owner {
            Owner::Body(number) => self.articulation.bodies[number].name.clone(),
            Owner::Thing(thing) => match self.objects.get(thing) {
                Ok((spec, ..)) => spec.id.clone(),
                Err(_) => "table".into(),
            },
        }
    }

    /// Writes what is known of the arms.
    pub fn publish(&self, robot: &mut Robot, targets: &JointTargets, base: Pose) {
        let posture = self.articulation.posture(&positions(robot));
        for arm in Arm::BOTH {
            let state = &mut robot.arms[arm as usize];
            state.end_effector = self.articulation.end_effector(arm, &posture, base);
            state.joint_origins = self.articulation.joint_origins(arm, &posture, base);
            state.is_moving = targets.is_under_way(arm);
        }
    }

    /// The sleeping objects that the arms may touch in this tick: Rapier lets things move into sleeping ones for a tick.
    pub fn near_arms(&self, motion: &mut Motion) -> Vec<Entity> {
        let mut bounds: Vec<Aabb> = Vec::new();
        if motion
            .environment
            .free
            .iter()
            .any(|thing| thing.is_sleeping)
        {
            for arm in Arm::BOTH {
                bounds.extend(motion.bounds(arm));
            }
        }
        let things = motion.environment.free.iter();
        things
            .filter(|thing| thing.is_sleeping)
            .filter(|thing| bounds.iter().any(|bounds| are_near(bounds, &thing.bounds)))
            .map(|thing| thing.object)
            .collect()
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
