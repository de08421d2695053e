//! A tick of the robot.

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_rapier3d::prelude::*;
use tabletop_core::{Arm, Robot, RobotJoint, RobotMode, SimFact};
use tabletop_physics::PhysicsSettings;

use crate::{
    articulation::link_entities::{positions, put},
    clearance::Owner,
    command::joint_targets::JointTargets,
    dynamics::{contact_loads::contact_loads, motors::Motors},
    gripper::{
        closing::{Closing, STEEPEST_GRIP, Touched},
        grips::{self, Grips},
    },
    motion::view::RobotView,
};

/// Farthest that something moves in a tick, in units, and still pushes what it meets; what goes farther has jumped.
const JUMP: f32 = 1.0;

/// What the robot moves.
#[derive(SystemParam)]
pub(crate) struct MovedBodies<'w, 's> {
    rapier: WriteRapierContext<'w, 's>,
    transforms: Query<'w, 's, &'static mut Transform>,
    sleeping: Query<'w, 's, &'static mut Sleeping>,
}

/// Moves the joints, the grippers and what they hold.
pub(crate) fn advance(
    known: RobotView,
    settings: Res<PhysicsSettings>,
    mut targets: ResMut<JointTargets>,
    mut motors: ResMut<Motors>,
    mut robot: ResMut<Robot>,
    mut grips: ResMut<Grips>,
    mut moved: MovedBodies,
    mut facts: MessageWriter<SimFact>,
    mut commands: Commands,
) -> Result {
    let is_dynamic = robot.mode == RobotMode::Dynamic;
    let is_told = targets.are_given();
    if !is_dynamic && !is_told {
        stand_still(&mut robot);
        return Ok(());
    }
    let mut rapier = moved.rapier.single_mut()?;
    let mut motion = known.motion(&robot, &grips, &rapier);
    let pulls = is_dynamic.then(|| {
        motors.look(&robot);
        motors.pull(&mut motion, &targets, settings.gravity, |motion, arm| {
            let is_mine =
                |body| known.bodies.contains(body) || grips.all().any(|object| object == body);
            contact_loads(motion, arm, &rapier, settings.gravity, is_mine)
        })
    });
    motion.turn_head(&targets);
    let mut actions = Vec::new();
    for arm in Arm::BOTH {
        let setpoints = match &pulls {
            Some(pulls) => pulls[arm as usize].setpoints(arm),
            None => targets.arm_setpoints(arm, robot.angles(arm)),
        };
        motion.move_arm(arm, setpoints);
        let gripper = RobotJoint::gripper(arm);
        let opens = targets.open(gripper, motion.positions[gripper.index()]);
        let closing = motion.move_fingers(arm, &targets);
        actions.extend(decide(&known, arm, opens, closing, &mut grips));
    }

    let before = positions(&robot);
    robot.move_to(&motion.positions);
    match pulls {
        Some(pulls) => {
            motors.note(&pulls, &mut motion, &mut robot);
            targets.end_tick(&motors.reached(&motion.positions));
        }
        None => targets.end_tick(&motion.positions),
    }
    for arm in Arm::BOTH {
        let blocked_by = known.blocked_by(arm, &motion, &mut targets);
        if let Some(by) = &blocked_by {
            targets.give_up(arm);
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
    known.publish(&mut robot, &targets, motion.base);

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

/// What follows from a gripper's opening or closing.
fn decide(
    known: &RobotView,
    arm: Arm,
    opens: bool,
    closing: Closing,
    grips: &mut Grips,
) -> Vec<Action> {
    if opens {
        grips.refused[arm as usize].clear();
        let holds = !grips.of(arm).is_empty();
        return holds.then_some(Action::Release(arm)).into_iter().collect();
    }
    let mut actions = Vec::new();
    for touched in closing.touched {
        let Touched { object, angle, .. } = touched;
        if !grips::can_take(object, &known.objects) {
            continue;
        }
        if angle < STEEPEST_GRIP {
            actions.push(Action::Take(arm, touched));
        } else if !grips.refused[arm as usize].contains(&object) {
            grips.refused[arm as usize].push(object);
            let id = known.name(Owner::Thing(object));
            actions.push(Action::Refuse { arm, id, angle });
        }
    }
    actions
}
