//! A tick of the robot.

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_rapier3d::{prelude::*, rapier::prelude::RigidBodyHandle};
use tabletop_core::{LimbId, LimbName, Robot, RobotFact, RobotLayout, RobotMode, SimFact};
use tabletop_physics::{MovedBody, PhysicsSettings};

use tabletop_robot::{LinkEntities, PassiveLinks, Posture, positions};

use crate::{
    command::joint_targets::{JointTargets, MirroredJoints, Setpoint},
    dynamics::contact_loads::contact_loads,
    dynamics::motors::Motors,
    gripper::alignment::Judgement,
    gripper::alignment::judge,
    gripper::closing::Closing,
    gripper::closing::Touched,
    gripper::grips,
    gripper::grips::Grips,
    motion::tick_motion::TickMotion,
    motion::view::RobotView,
};

/// The bodies that the robot moves.
#[derive(SystemParam)]
pub(crate) struct MovedBodies<'w, 's> {
    rapier: WriteRapierContext<'w, 's>,
    places: Query<'w, 's, MovedBody>,
    sleeping: Query<'w, 's, &'static mut Sleeping>,
}

/// Moves the joints, the grippers and the objects in them.
pub(crate) fn advance(
    known: RobotView,
    settings: If<Res<PhysicsSettings>>,
    mut targets: ResMut<JointTargets>,
    mut motors: ResMut<Motors>,
    mut robot: ResMut<Robot>,
    mut grips: ResMut<Grips>,
    mut passive: ResMut<PassiveLinks>,
    mut moved: MovedBodies,
    mut facts: MessageWriter<SimFact>,
    mut commands: Commands,
    mut posture: Local<Option<Posture>>,
) -> Result {
    let layout = &known.articulation.layout;
    let is_dynamic = robot.mode == RobotMode::Dynamic;
    let is_commanded = targets.are_given();
    let inside = passive.inside.clone();
    if robot.is_mirror && targets.mirrored().is_none() {
        robot.end_mirror();
    }
    if !is_dynamic && !is_commanded {
        stand_still(&mut robot);
        let standing = PassiveLinks::new(Vec::new(), inside);
        if *passive != standing {
            let shapes = &mut moved.rapier.single_mut()?.colliders;
            passive.set(standing, &known.parts.0, shapes);
        }
        return let_sleep(&known.parts, &mut moved.rapier);
    }
    let mut rapier = moved.rapier.single_mut()?;
    let here = known.posture(&robot, posture.take());
    let mut motion = known.motion(&robot, &grips, &rapier, here);
    motion.inside.clone_from(&inside);
    let start = motion.here();
    let pulls = is_dynamic.then(|| {
        motors.look(layout, &robot);
        motors.pull(&mut motion, &targets, settings.gravity, |motion, limb| {
            let is_mine =
                |body| known.bodies.contains(body) || grips.all().any(|object| object == body);
            contact_loads(motion, limb, &rapier, settings.gravity, is_mine)
        })
    });
    let mirrored = targets.mirrored().cloned();
    let actions = match &mirrored {
        Some(measured) => mirror(&known, measured, &mut motion, &grips),
        None => {
            let setpoints = |limb: LimbId| match &pulls {
                Some(pulls) => pulls[limb.index()].setpoints(),
                None => {
                    let joints = &layout.limb(limb).joints;
                    targets.limb_setpoints(layout, limb, &robot.positions_of(joints))
                }
            };
            drive(&known, &targets, setpoints, &mut motion, &mut grips)
        }
    };

    let before = positions(&robot);
    match &mirrored {
        Some(measured) => robot.mirror(measured),
        None => robot.move_to(&motion.positions),
    }
    match pulls {
        Some(pulls) => {
            motors.note(&pulls, &mut motion, &mut robot);
            targets.end_tick(layout, &motors.reached(layout, &motion.positions));
        }
        None => targets.end_tick(layout, &motion.positions),
    }
    for limb in layout.limb_ids() {
        let blocked_by = known.blocked_by(limb, &motion, &mut targets);
        if let Some(by) = &blocked_by {
            targets.give_up(layout, limb);
            motors.stay(limb);
            if robot.limb(limb).blocked_by.as_ref() != Some(by) {
                let by = by.clone();
                let arm = layout.limb(limb).name;
                facts.write(SimFact::Robot(RobotFact::ArmBlocked { arm, by }));
            }
        }
        let mut joints = layout.limb(limb).joints.iter();
        let has_moved =
            joints.any(|joint| motion.positions[joint.index()] != before[joint.index()]);
        if (is_commanded && has_moved) || blocked_by.is_some() || mirrored.is_some() {
            robot.limbs[limb.index()].blocked_by = blocked_by;
        }
        robot.limbs[limb.index()].says_it_grips =
            (mirrored.as_ref()).and_then(|measured| says_it_grips(layout, measured, limb));
    }
    known
        .articulation
        .update(&mut motion.scratch, &motion.positions);
    known.publish(&mut robot, &targets, &motion.scratch);

    for object in known.near_arms(&mut motion) {
        if let Ok(mut sleeping) = moved.sleeping.get_mut(object) {
            sleeping.sleeping = false;
        }
    }
    if robot.is_shown {
        let far = known.far_bodies(&mut motion, &start, &grips);
        let now = PassiveLinks::new(far, inside);
        if *passive != now {
            passive.set(now, &known.parts.0, &mut rapier.colliders);
        }
    }
    let places = known.places(&mut motion, &robot, &grips);
    for (number, (entity, pose)) in places.into_iter().enumerate() {
        let Ok(mut body) = moved.places.get_mut(entity) else {
            continue;
        };
        let bodies = &mut rapier.rigidbody_set;
        match passive.is_far(number) {
            true => body.put_asleep(bodies, pose),
            false => body.send(bodies, pose),
        }
    }
    *posture = Some(motion.scratch);
    for action in actions {
        action.carry_out(&mut commands, &mut facts);
    }
    Ok(())
}

/// Moves the joints to these setpoints, as far as nothing is in the way. Returns the changes of the grips.
fn drive(
    known: &RobotView,
    targets: &JointTargets,
    setpoints: impl Fn(LimbId) -> Vec<Setpoint>,
    motion: &mut TickMotion,
    grips: &mut Grips,
) -> Vec<GripChange> {
    let layout = &known.articulation.layout;
    motion.turn_head(targets);
    let mut changes = Vec::new();
    for limb in layout.limb_ids() {
        motion.move_arm(limb, &setpoints(limb));
        let gripper = layout.limb(limb).gripper.joint;
        let opens = targets.open(layout, gripper, motion.positions[gripper.index()]);
        let closing = motion.move_fingers(limb, targets, grips.is_pressing(limb));
        changes.extend(decide(known, limb, opens, closing, grips));
    }
    changes
}

/// Puts the joints where they were measured. Returns the changes of the grips: a gripper holds something only if it says so.
fn mirror(
    known: &RobotView,
    measured: &MirroredJoints,
    motion: &mut TickMotion,
    grips: &Grips,
) -> Vec<GripChange> {
    motion.mirror(measured);
    let layout = &known.articulation.layout;
    let mut changes = Vec::new();
    for limb in layout.limb_ids() {
        let holds = !grips.of(limb).is_empty();
        match (says_it_grips(layout, measured, limb), holds) {
            (Some(false), true) => changes.push(GripChange::Release(limb)),
            (Some(true), false) => {
                let gripped = motion.gripped(limb).into_iter();
                let gripped = gripped.filter(|it| grips::can_take(it.object, &known.objects));
                changes.extend(gripped.map(|touched| GripChange::Take(limb, touched)));
            }
            (Some(false), false) | (Some(true), true) | (None, _) => {}
        }
    }
    changes
}

/// Whether a gripper says that it holds something.
fn says_it_grips(layout: &RobotLayout, measured: &MirroredJoints, limb: LimbId) -> Option<bool> {
    let gripper = layout.limb(limb).gripper.joint;
    measured[gripper.index()]?.grips
}

/// Sets all velocities to zero.
fn stand_still(robot: &mut ResMut<Robot>) {
    if robot.joints.iter().any(|joint| joint.velocity != 0.0) {
        for joint in &mut robot.joints {
            joint.velocity = 0.0;
        }
    }
}

/// Lets the robot's bodies sleep when they stand still and nothing else is awake. The engine would not, because rounding leaves them
/// small velocities.
fn let_sleep(parts: &LinkEntities, rapier: &mut WriteRapierContext) -> Result {
    let mut rapier = rapier.single_mut()?;
    let set = &rapier.rigidbody_set;
    let stands = |handle: &RigidBodyHandle| {
        let body = set.bodies.get(*handle);
        body.is_some_and(|body| body.is_kinematic() && body.position() == body.next_position())
    };
    let awake: Vec<_> = rapier.simulation.islands.active_bodies().collect();
    if awake.is_empty() || !awake.iter().all(stands) {
        return Ok(());
    }
    let is_of_robot = |handle: &RigidBodyHandle| {
        let entity = set.rigid_body_entity(*handle);
        entity.is_some_and(|entity| parts.0.contains(&entity))
    };
    if !awake.iter().all(is_of_robot) {
        return Ok(());
    }
    for handle in awake {
        if let Some(body) = rapier.rigidbody_set.bodies.get_mut(handle) {
            body.sleep();
        }
    }
    Ok(())
}

/// A change of a gripper's grips.
enum GripChange {
    Take(LimbId, Touched),
    Release(LimbId),
    Refuse {
        arm: LimbName,
        id: String,
        angle: f32,
    },
}

impl GripChange {
    fn carry_out(self, commands: &mut Commands, facts: &mut MessageWriter<SimFact>) {
        match self {
            Self::Take(limb, touched) => {
                commands.queue(move |world: &mut World| grips::take(world, limb, touched));
            }
            Self::Release(limb) => {
                commands.queue(move |world: &mut World| grips::release(world, limb));
            }
            Self::Refuse { arm, id, angle } => {
                facts.write(SimFact::Robot(RobotFact::GripRefused { arm, id, angle }));
            }
        }
    }
}

/// The change that a gripper's opening or closing causes.
fn decide(
    known: &RobotView,
    limb: LimbId,
    opens: bool,
    closing: Closing,
    grips: &mut Grips,
) -> Vec<GripChange> {
    if opens {
        grips.refused[limb.index()].clear();
        grips.alignments[limb.index()] = None;
        let holds = !grips.of(limb).is_empty();
        return holds
            .then_some(GripChange::Release(limb))
            .into_iter()
            .collect();
    }
    let mut actions = Vec::new();
    for touched in closing.touched {
        let Touched { object, angle, .. } = touched;
        if !grips::can_take(object, &known.objects) {
            continue;
        }
        match judge(&mut grips.alignments[limb.index()], object, angle) {
            Judgement::Hold => actions.push(GripChange::Take(limb, touched)),
            Judgement::Press => {}
            Judgement::Refuse => {
                if let Some(id) = known.id(object)
                    && !grips.refused[limb.index()].contains(&object)
                {
                    grips.refused[limb.index()].push(object);
                    let arm = grips.name_of(limb);
                    actions.push(GripChange::Refuse { arm, id, angle });
                }
            }
        }
    }
    actions
}
