//! A tick of the robot.

use std::collections::BTreeSet;

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_rapier3d::{parry::bounding_volume::Aabb, prelude::*};
use tabletop_core::{
    Arm, Gripped, Held, ObjectSpec, Pose, Robot, RobotJoint, RobotMode, SimFact, Table, robot_base,
};
use tabletop_physics::{PhysicsSettings, convex_parts};

use crate::{
    clearance::{Owner, are_near},
    driven::Motors,
    grip::{Closing, STEEPEST_GRIP, Touched},
    grips::{self, Grips},
    meeting::Meetings,
    motion::{Carried, Motion, reach},
    orders::Orders,
    parts::{Parts, RobotBody, poses, positions, put},
    skeleton::Skeleton,
    surroundings::Surroundings,
    touch::touches,
};

/// Farthest that something moves in a tick, in units, and still pushes what it meets; what goes farther has jumped.
const JUMP: f32 = 1.0;

/// What the robot knows of the world.
#[derive(SystemParam)]
pub(crate) struct Known<'w, 's> {
    skeleton: Res<'w, Skeleton>,
    meetings: Res<'w, Meetings>,
    parts: Res<'w, Parts>,
    tables: Query<'w, 's, &'static Table>,
    bodies: Query<'w, 's, (), With<RobotBody>>,
    objects: Query<'w, 's, (&'static ObjectSpec, Has<Held>, Has<Gripped>)>,
}

/// What the robot moves.
#[derive(SystemParam)]
pub(crate) struct Moved<'w, 's> {
    rapier: WriteRapierContext<'w, 's>,
    transforms: Query<'w, 's, &'static mut Transform>,
    sleeping: Query<'w, 's, &'static mut Sleeping>,
}

/// Moves the joints, the grippers and what they hold.
pub(crate) fn advance(
    known: Known,
    settings: Res<PhysicsSettings>,
    mut orders: ResMut<Orders>,
    mut motors: ResMut<Motors>,
    mut robot: ResMut<Robot>,
    mut grips: ResMut<Grips>,
    mut moved: Moved,
    mut facts: MessageWriter<SimFact>,
    mut commands: Commands,
) -> Result {
    let is_dynamic = robot.mode == RobotMode::Dynamic;
    let is_told = orders.are_given();
    if !is_dynamic && !is_told {
        stand_still(&mut robot);
        return Ok(());
    }
    let mut rapier = moved.rapier.single_mut()?;
    let mut motion = known.motion(&robot, &grips, &rapier);
    let pulls = is_dynamic.then(|| {
        motors.look(&robot);
        motors.pull(&mut motion, &orders, settings.gravity, |motion, arm| {
            let is_mine =
                |body| known.bodies.contains(body) || grips.all().any(|object| object == body);
            touches(motion, arm, &rapier, settings.gravity, is_mine)
        })
    });
    motion.turn_head(&orders);
    let mut actions = Vec::new();
    for arm in Arm::BOTH {
        let wants = match &pulls {
            Some(pulls) => pulls[arm as usize].wants(arm),
            None => orders.want_arm(arm, robot.angles(arm)),
        };
        motion.move_arm(arm, wants);
        let gripper = RobotJoint::gripper(arm);
        let opens = orders.open(gripper, motion.positions[gripper.index()]);
        let closing = motion.move_fingers(arm, &orders);
        actions.extend(known.decide(arm, opens, closing, &mut grips));
    }

    let before = positions(&robot);
    robot.move_to(&motion.positions);
    match pulls {
        Some(pulls) => {
            motors.note(&pulls, &mut motion, &mut robot);
            orders.end_tick(&motors.reached(&motion.positions));
        }
        None => orders.end_tick(&motion.positions),
    }
    for arm in Arm::BOTH {
        let blocked_by = known.blocked_by(arm, &motion, &mut orders);
        if let Some(by) = &blocked_by {
            orders.give_up(arm);
            motors.stay(arm);
            if robot.arm(arm).blocked_by.as_ref() != Some(by) {
                let by = by.clone();
                facts.write(SimFact::ArmBlocked { arm, by });
            }
        }
        let has_moved = RobotJoint::of_arm(arm)
            .iter()
            .any(|joint| motion.positions[joint.index()] != before[joint.index()]);
        if (is_told && has_moved) || blocked_by.is_some() {
            robot.arms[arm as usize].blocked_by = blocked_by;
        }
    }
    known.publish(&mut robot, &orders, motion.base);

    for object in known.near_arms(&mut motion) {
        if let Ok(mut sleeping) = moved.sleeping.get_mut(object) {
            sleeping.sleeping = false;
        }
    }
    for (entity, pose) in known.places(&motion, &robot, &grips) {
        let Ok(mut transform) = moved.transforms.get_mut(entity) else {
            continue;
        };
        if transform.translation.distance(pose.location) > JUMP {
            put(&mut rapier.rigidbody_set, entity, pose);
        }
        transform.set_if_neq(pose.into());
    }
    for action in actions {
        action.carry_out(&mut commands, &mut facts);
    }
    Ok(())
}

/// Puts the arms home that have come into the table or something else while the robot was hidden and met nothing.
pub(crate) fn leave_obstacles(
    known: Known,
    grips: Res<Grips>,
    mut robot: ResMut<Robot>,
    mut rapier: WriteRapierContext,
    mut facts: MessageWriter<SimFact>,
) -> Result {
    let rapier = rapier.single_mut()?;
    let mut motion = known.motion(&robot, &grips, &rapier);
    for arm in Arm::BOTH {
        let Some(obstacle) = motion.is_inside(arm) else {
            continue;
        };
        for joint in RobotJoint::of_arm(arm) {
            robot.joints[joint.index()].position = joint.home();
        }
        let by = known.name(obstacle);
        facts.write(SimFact::ArmBlocked { arm, by });
    }
    Ok(())
}

/// Nothing moves.
fn stand_still(robot: &mut ResMut<Robot>) {
    if robot.joints.iter().any(|joint| joint.velocity != 0.0) {
        for joint in &mut robot.joints {
            joint.velocity = 0.0;
        }
    }
}

/// What a gripper does besides moving its fingers.
enum Action {
    Take(Arm, Touched),
    Release(Arm),
    Refuse { arm: Arm, id: String, angle: f32 },
}

impl Action {
    fn carry_out(self, commands: &mut Commands, facts: &mut MessageWriter<SimFact>) {
        match self {
            Self::Take(arm, touched) => {
                commands.queue(move |world: &mut World| grips::take(world, arm, touched));
            }
            Self::Release(arm) => {
                commands.queue(move |world: &mut World| grips::release(world, arm));
            }
            Self::Refuse { arm, id, angle } => {
                facts.write(SimFact::GripRefused { arm, id, angle });
            }
        }
    }
}

impl Known<'_, '_> {
    /// The tick's motion, before anything has moved.
    fn motion<'a>(&'a self, robot: &Robot, grips: &Grips, rapier: &RapierContextMut) -> Motion<'a> {
        let base = self.base();
        let positions = positions(robot);
        let posture = self.skeleton.posture(&positions);
        let held: BTreeSet<_> = grips.all().collect();
        let near = reach(
            poses(&self.skeleton, &posture, base)
                .into_iter()
                .map(|pose| pose.location),
        );
        let surroundings = Surroundings::new(rapier, &near, &self.bodies, &held, robot.is_shown);
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
            skeleton: &self.skeleton,
            meetings: &self.meetings,
            base,
            surroundings,
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
    fn blocked_by(&self, arm: Arm, motion: &Motion, orders: &mut Orders) -> Option<String> {
        let squeezed = orders.wait_for(arm, motion.held_up_by[arm as usize]);
        let obstacle = motion.blocked_by[arm as usize].or(squeezed.map(Owner::Thing));
        obstacle.map(|owner| self.name(owner))
    }

    /// Where the bodies are after a motion, and what the grippers hold rigidly.
    fn places(&self, motion: &Motion, robot: &Robot, grips: &Grips) -> Vec<(Entity, Pose)> {
        let posture = self.skeleton.posture(&motion.positions);
        let poses = poses(&self.skeleton, &posture, motion.base);
        let bodies = self.parts.0.iter().copied().zip(poses);
        let held = Arm::BOTH.into_iter().flat_map(|arm| {
            let end_effector = robot.arm(arm).end_effector;
            let rigid = grips.of(arm).iter().filter(|grip| !grip.is_jointed);
            rigid.map(move |grip| (grip.object, end_effector * grip.pose))
        });
        bodies.chain(held).collect()
    }

    /// What follows from a gripper's opening or closing.
    fn decide(&self, arm: Arm, opens: bool, closing: Closing, grips: &mut Grips) -> Vec<Action> {
        if opens {
            grips.refused[arm as usize].clear();
            let holds = !grips.of(arm).is_empty();
            return holds.then_some(Action::Release(arm)).into_iter().collect();
        }
        let mut actions = Vec::new();
        for touched in closing.touched {
            let Touched { object, angle, .. } = touched;
            if !grips::can_take(object, &self.objects) {
                continue;
            }
            if angle < STEEPEST_GRIP {
                actions.push(Action::Take(arm, touched));
            } else if !grips.refused[arm as usize].contains(&object) {
                grips.refused[arm as usize].push(object);
                let id = self.name(Owner::Thing(object));
                actions.push(Action::Refuse { arm, id, angle });
            }
        }
        actions
    }

    /// What something is called.
    fn name(&self, owner: Owner) -> String {
        match owner {
            Owner::Body(number) => self.skeleton.bodies[number].name.clone(),
            Owner::Thing(thing) => match self.objects.get(thing) {
                Ok((spec, ..)) => spec.id.clone(),
                Err(_) => "table".into(),
            },
        }
    }

    /// Writes what is known of the arms.
    pub fn publish(&self, robot: &mut Robot, orders: &Orders, base: Pose) {
        let posture = self.skeleton.posture(&positions(robot));
        for arm in Arm::BOTH {
            let state = &mut robot.arms[arm as usize];
            state.end_effector = self.skeleton.end_effector(arm, &posture, base);
            state.joint_origins = self.skeleton.joint_origins(arm, &posture, base);
            state.is_moving = orders.is_under_way(arm);
        }
    }

    /// The sleeping objects that the arms may touch in this tick: Rapier lets things move into sleeping ones for a tick.
    fn near_arms(&self, motion: &mut Motion) -> Vec<Entity> {
        let mut bounds: Vec<Aabb> = Vec::new();
        if motion
            .surroundings
            .free
            .iter()
            .any(|thing| thing.is_sleeping)
        {
            for arm in Arm::BOTH {
                bounds.extend(motion.bounds(arm));
            }
        }
        let things = motion.surroundings.free.iter();
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
