//! Dynamic mode: arms that motors with limited torque drive.
//!
//! Each motor pulls its joint along with a place that goes where targets send it, as a joint of kinematic mode would. It is
//! never farther ahead than the motor can pull, so a joint that is held back does not wind up. Grippers and neck go as in
//! kinematic mode. The arms' own weight is borne by springs, as in the real robot; the motors bear what the grippers hold.

use std::array::from_fn;

use bevy::{math::DVec3, prelude::*};
use tabletop_core::{Arm, JOINTS_PER_ARM, Robot, RobotJoint, TICK_SECONDS, UNITS_PER_METER};
use tabletop_kinematics::Load;

use crate::{
    articulation::tree::Articulation,
    command::joint_targets::{JointTargets, Setpoint},
    dynamics::impulse::ContactLoad,
    dynamics::limb_dynamics::{LimbDynamics, Step},
    dynamics::matrix::{Joints, Matrix},
    dynamics::motor::{Motor, MotorTask, STRETCH},
    motion::sweep::Motion,
};

/// Share of a motor's torque with which a joint is slowed down before its goal.
const BRAKES: f64 = 0.5;

/// Speed in rad/s below which a joint has arrived.
const AT_REST: f64 = 0.02;

/// Speed in rad/s below which a joint stands still, as gears do.
const STILL: f64 = 1e-6;

/// Torques (N m) and speeds (rad/s) of Baxter's motors from the shoulder to the elbow, and of those beyond.
const USUAL: [(f64, f64); 2] = [(50.0, 1.5), (15.0, 4.0)];

/// What the motors have to remember from tick to tick.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct Motors {
    arms: [LimbMotors; 2],
    was_shown: bool,
}

/// An arm that motors drive.
#[derive(Clone, Debug, Default)]
struct LimbMotors {
    /// Where the joints were when the motors left them, in rad.
    angles: Joints,
    /// How fast they were, in rad/s.
    velocities: Joints,
    /// Where the motors pull them to, in rad.
    places: Joints,
}

/// A tick of an arm.
pub(crate) struct LimbStep {
    /// What the arm touches, as the masses have it.
    touched: Vec<Entity>,
    masses: LimbDynamics,
    motors: [Motor; 7],
    step: Step,
}

impl Motors {
    /// Forgets the motion of arms that have been moved by something else.
    pub fn look(&mut self, robot: &Robot) {
        let appears = std::mem::replace(&mut self.was_shown, robot.is_shown) != robot.is_shown;
        for arm in Arm::BOTH {
            let (driven, angles) = (&mut self.arms[arm as usize], robot.angles(arm));
            if appears || driven.angles != angles {
                *driven = LimbMotors {
                    angles,
                    velocities: [0.0; 7],
                    places: angles,
                };
            }
        }
    }

    /// What the motors do in this tick. `gravity` in units/s².
    pub fn pull(
        &self,
        motion: &mut Motion,
        targets: &JointTargets,
        gravity: f32,
        mut touches: impl FnMut(&mut Motion, Arm) -> Vec<(Entity, ContactLoad)>,
    ) -> [LimbStep; 2] {
        let mut all_touches = Arm::BOTH.map(|arm| touches(motion, arm));
        let articulation = motion.articulation;
        articulation.update(&mut motion.scratch, &motion.positions);
        let (model, frames) = (articulation.model(), motion.scratch.frames());
        let loads = Arm::BOTH.map(|arm| -> Vec<Load> {
            let carried = motion.carried[arm as usize].iter();
            carried
                .map(|it| articulation.load(arm, it.pose, it.mass))
                .collect()
        });
        let all_loads = loads.concat();
        let mut velocities = model.zero();
        for arm in Arm::BOTH {
            let chain = articulation.chain(arm).0;
            chain.set_angles(&self.arms[arm as usize].velocities, &mut velocities);
        }
        let inertia = model.inertia_matrix(frames, &all_loads);
        let turning =
            model.inverse_dynamics(frames, &velocities, &model.zero(), DVec3::ZERO, &all_loads);
        let down = DVec3::NEG_Z * (f64::from(gravity) / UNITS_PER_METER);
        Arm::BOTH.map(|arm| {
            let driven = &self.arms[arm as usize];
            let chain = articulation.chain(arm).0;
            let joints = *chain.joints();
            let inertia: Matrix = from_fn(|i| from_fn(|j| inertia[(joints[i], joints[j])]));
            let axes = articulation.axes(arm, &motion.scratch);
            let weights: Joints = from_fn(|i| {
                let (origin, axis) = axes[i];
                let of_load = |load: &Load| {
                    let arm = frames[load.link].transform_point3(load.point) - origin;
                    -axis.dot(arm.cross(down * load.mass))
                };
                loads[arm as usize].iter().map(of_load).sum()
            });
            let motors = driven.motors(articulation, arm, targets, &inertia, &weights);
            let (touched, touches) = std::mem::take(&mut all_touches[arm as usize])
                .into_iter()
                .unzip();
            let masses = LimbDynamics {
                angles: driven.angles,
                velocities: driven.velocities,
                inertia,
                bias: add(&chain.angles(&turning), &weights),
                damping: joints.map(|joint| model.joint(joint).damping),
                stops: RobotJoint::of_arm(arm).map(|joint| joint.limits().into()),
                touches,
            };
            let mut step = masses.step(&motors, f64::from(TICK_SECONDS));
            if step
                .velocities
                .iter()
                .all(|velocity| velocity.abs() < STILL)
            {
                step.velocities = [0.0; 7];
            }
            LimbStep {
                touched,
                masses,
                motors,
                step,
            }
        })
    }

    /// Notes what has become of a tick: how far the arms have come, and with which torques.
    pub fn note(&mut self, pulls: &[LimbStep; 2], motion: &mut Motion, robot: &mut Robot) {
        for (arm, pull) in Arm::BOTH.into_iter().zip(pulls) {
            let joints = RobotJoint::of_arm(arm);
            let angles = joints.map(|joint| motion.positions[joint.index()]);
            // Where something free is only just reached, an arm keeps its speed.
            let is_free =
                motion.blocked_by[arm as usize].is_none() && !motion.is_squeezing[arm as usize];
            let (velocities, torques) = match is_free {
                true => (pull.step.velocities, pull.step.torques),
                false => pull.held_back(&angles),
            };
            for (joint, torque) in joints.into_iter().zip(torques) {
                robot.joints[joint.index()].torque = torque;
            }
            let held_up_by = &mut motion.held_up_by[arm as usize];
            *held_up_by = held_up_by.or_else(|| pull.stalled_by());
            let places = from_fn(|i| match pull.motors[i].task {
                MotorTask::Follow { angle, .. } => {
                    angle.clamp(angles[i] - STRETCH, angles[i] + STRETCH)
                }
                MotorTask::Torque(_) => angles[i],
            });
            self.arms[arm as usize] = LimbMotors {
                angles,
                velocities,
                places,
            };
        }
    }

    /// Lets an arm stay where it is.
    pub fn stay(&mut self, arm: Arm) {
        let driven = &mut self.arms[arm as usize];
        driven.places = driven.angles;
    }

    /// How far targets have been carried out: to where the motors pull joints that have come to rest, and these positions
    /// of all others.
    pub fn reached(&self, positions: &[f64; 17]) -> [f64; 17] {
        let mut reached = *positions;
        for arm in Arm::BOTH {
            let driven = &self.arms[arm as usize];
            for (i, joint) in RobotJoint::of_arm(arm).into_iter().enumerate() {
                let is_near = (driven.angles[i] - driven.places[i]).abs() < STRETCH;
                if is_near && driven.velocities[i].abs() < AT_REST {
                    reached[joint.index()] = driven.places[i];
                }
            }
        }
        reached
    }
}

impl LimbMotors {
    /// What the motors are to do in this tick. `inertia` in kg m², `weights` in N m.
    fn motors(
        &self,
        articulation: &Articulation,
        arm: Arm,
        targets: &JointTargets,
        inertia: &Matrix,
        weights: &Joints,
    ) -> [Motor; 7] {
        let joints = RobotJoint::of_arm(arm);
        let setpoints = targets.arm_setpoints(arm, self.places);
        from_fn(|i| {
            let joint = articulation
                .model()
                .joint(articulation.chain(arm).0.joints()[i]);
            let usual = USUAL[usize::from(i > 3)];
            let effort = if joint.effort > 0.0 {
                joint.effort
            } else {
                usual.0
            };
            let speed = if joint.velocity > 0.0 {
                joint.velocity
            } else {
                usual.1
            };
            let task = match targets.torque(joints[i]) {
                Some(torque) => MotorTask::Torque(torque),
                None => {
                    let way = setpoints[i].position() - self.places[i];
                    // As fast as it can still stop where it is to go.
                    let brakes = BRAKES * effort / inertia[i][i].max(f64::MIN_POSITIVE);
                    let left = targets
                        .goal(joints[i])
                        .map(|goal| (goal - self.places[i]).abs());
                    let fastest =
                        left.map_or(speed, |left| speed.min((2.0 * brakes * left).sqrt()));
                    let most = fastest * f64::from(TICK_SECONDS);
                    let step = way.clamp(-most, most);
                    MotorTask::Follow {
                        angle: if step == way {
                            setpoints[i].position()
                        } else {
                            self.places[i] + step
                        },
                        velocity: step / f64::from(TICK_SECONDS),
                        known: weights[i],
                    }
                }
            };
            Motor {
                effort,
                speed,
                task,
            }
        })
    }
}

impl LimbStep {
    /// Where the joints are to be after the tick.
    pub fn setpoints(&self, arm: Arm) -> [Setpoint; JOINTS_PER_ARM] {
        let joints = RobotJoint::of_arm(arm);
        from_fn(|i| {
            let way = f64::from(TICK_SECONDS) * self.step.velocities[i];
            Setpoint::Move(joints[i].clamp(self.masses.angles[i] + way))
        })
    }

    /// What a motor pushes in vain with all its might.
    fn stalled_by(&self) -> Option<Entity> {
        let Step {
            velocities,
            torques,
        } = &self.step;
        let mut pulls = self.motors.iter().zip(torques);
        if !pulls.any(|(motor, torque)| torque.abs() >= motor.effort) {
            return None;
        }
        let mut touches = self.touched.iter().zip(&self.masses.touches);
        touches
            .find(|(_, touch)| touch.withstands(velocities))
            .map(|(thing, _)| *thing)
    }

    /// Velocities and torques of an arm that came only to these angles, because something is in its way.
    fn held_back(&self, angles: &Joints) -> (Joints, Joints) {
        let velocities = from_fn(|i| (angles[i] - self.masses.angles[i]) / f64::from(TICK_SECONDS));
        let torques = from_fn(|i| self.motors[i].torque(angles[i], velocities[i]));
        (velocities, torques)
    }
}

fn add(a: &Joints, b: &Joints) -> Joints {
    from_fn(|i| a[i] + b[i])
}
