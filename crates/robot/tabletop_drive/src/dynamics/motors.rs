//! Dynamic mode: motors with limited torque drive the arms.
//!
//! Each motor pulls its joint towards an angle that moves as a joint of kinematic mode would. That angle is
//! never farther ahead than the motor can pull, so a joint that is held back does not wind up. Grippers and neck move as in
//! kinematic mode. Springs bear the arms' own weight, as in the real robot; the motors bear the objects that the grippers hold.

use bevy::{math::DVec3, prelude::*};
use tabletop_core::{LimbId, Robot, RobotLayout, TICK_SECONDS};
use tabletop_geometry::UNITS_PER_METER;
use tabletop_kinematics::Load;

use tabletop_robot::{Articulation, Positions};

use crate::{
    command::joint_targets::JointTargets, command::joint_targets::Setpoint,
    dynamics::impulse::ContactLoad, dynamics::limb_dynamics::DynamicsStep,
    dynamics::limb_dynamics::LimbDynamics, dynamics::matrix::Joints, dynamics::matrix::Matrix,
    dynamics::matrix::each, dynamics::matrix::each_pair, dynamics::motor::Motor,
    dynamics::motor::MotorTask, dynamics::motor::STRETCH, motion::tick_motion::TickMotion,
};

/// Share of a motor's torque that slows a joint down before its goal.
const BRAKES: f64 = 0.5;

/// Speed, in rad/s, below which a joint has arrived.
const AT_REST: f64 = 0.02;

/// Speed, in rad/s, below which a joint stands still, as gears do.
const STILL: f64 = 1e-6;

/// The memory of the motors from tick to tick.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct Motors {
    limbs: Vec<LimbMotors>,
    was_shown: bool,
}

/// An arm that motors drive.
#[derive(Clone, Debug, Default)]
struct LimbMotors {
    /// Angles of the joints when the motors left them, in rad.
    angles: Joints,
    /// Their velocities then, in rad/s.
    velocities: Joints,
    /// Angles to which the motors pull them, in rad.
    places: Joints,
}

/// A tick of an arm.
pub(crate) struct LimbStep {
    /// The touched objects, in the order of the dynamics' loads.
    touched: Vec<Entity>,
    masses: LimbDynamics,
    motors: Vec<Motor>,
    step: DynamicsStep,
}

impl Motors {
    /// Forgets the motion of arms that something else has moved.
    pub fn look(&mut self, layout: &RobotLayout, robot: &Robot) {
        let appears = std::mem::replace(&mut self.was_shown, robot.is_shown) != robot.is_shown;
        self.limbs
            .resize_with(layout.limbs.len(), LimbMotors::default);
        for (motors, limb) in self.limbs.iter_mut().zip(&layout.limbs) {
            let angles = Joints::from_vec(robot.positions_of(&limb.joints));
            if appears || motors.angles != angles {
                *motors = LimbMotors {
                    velocities: each(angles.len(), |_| 0.0),
                    places: angles.clone(),
                    angles,
                };
            }
        }
    }

    /// The steps of the arms in this tick. `gravity` in units/s².
    pub fn pull(
        &self,
        motion: &mut TickMotion,
        targets: &JointTargets,
        gravity: f32,
        mut touches: impl FnMut(&mut TickMotion, LimbId) -> Vec<(Entity, ContactLoad)>,
    ) -> Vec<LimbStep> {
        let limbs = motion.articulation.layout.limb_ids();
        let all_touches: Vec<_> = limbs.clone().map(|limb| touches(motion, limb)).collect();
        let articulation = motion.articulation;
        articulation.update(&mut motion.scratch, &motion.positions);
        let (model, frames) = (articulation.model(), motion.scratch.frames());
        let loads = limbs.clone().map(|limb| -> Vec<Load> {
            let carried = motion.carried[limb.index()].iter();
            carried
                .map(|it| articulation.load(limb, it.pose, it.mass))
                .collect()
        });
        let loads: Vec<_> = loads.collect();
        let all_loads = loads.concat();
        let mut velocities = model.zero();
        for limb in limbs.clone() {
            let chain = articulation.chain(limb).0;
            chain.set_angles(&self.limbs[limb.index()].velocities, &mut velocities);
        }
        let inertia = model.inertia_matrix(frames, &all_loads);
        let turning =
            model.inverse_dynamics(frames, &velocities, &model.zero(), DVec3::ZERO, &all_loads);
        let down = DVec3::NEG_Z * (f64::from(gravity) / UNITS_PER_METER);
        let pulls = limbs.zip(all_touches).map(|(limb, touches)| {
            let driven = &self.limbs[limb.index()];
            let chain = articulation.chain(limb).0;
            let joints = chain.joints();
            let inertia = each_pair(joints.len(), |i, j| inertia[(joints[i], joints[j])]);
            let axes = articulation.axes(limb, &motion.scratch);
            let weights = each(joints.len(), |i| {
                let of_load = |load: &Load| {
                    let point = frames[load.link].transform_point3(load.point);
                    -axes[i].motion_of(point).dot(down * load.mass)
                };
                loads[limb.index()].iter().map(of_load).sum()
            });
            let motors = driven.motors(articulation, limb, targets, &inertia, &weights);
            let (touched, touches) = touches.into_iter().unzip();
            let masses = LimbDynamics {
                angles: driven.angles.clone(),
                velocities: driven.velocities.clone(),
                inertia,
                bias: add(&chain.angles(&turning), &weights),
                damping: each(joints.len(), |i| model.joint(joints[i]).damping),
                stops: chain.limits().to_vec(),
                touches,
            };
            let mut step = masses.step(&motors, f64::from(TICK_SECONDS));
            if step
                .velocities
                .iter()
                .all(|velocity| velocity.abs() < STILL)
            {
                step.velocities.fill(0.0);
            }
            LimbStep {
                touched,
                masses,
                motors,
                step,
            }
        });
        pulls.collect()
    }

    /// Takes in the result of a tick: how far the arms have come, and with which torques.
    pub fn note(&mut self, pulls: &[LimbStep], motion: &mut TickMotion, robot: &mut Robot) {
        let layout = &motion.articulation.layout;
        for (limb, pull) in layout.limb_ids().zip(pulls) {
            let joints = &layout.limb(limb).joints;
            let angles = each(joints.len(), |i| motion.positions[joints[i].index()]);
            // Where a free object has only just been reached, an arm keeps its speed.
            let is_free =
                motion.blocked_by[limb.index()].is_none() && !motion.is_squeezing[limb.index()];
            let (velocities, torques) = match is_free {
                true => (pull.step.velocities.clone(), pull.step.torques.clone()),
                false => pull.held_back(&angles),
            };
            for (joint, torque) in joints.iter().zip(torques) {
                robot.joints[joint.index()].torque = torque;
            }
            let held_up_by = &mut motion.held_up_by[limb.index()];
            *held_up_by = held_up_by.or_else(|| pull.stalled_by());
            let places = each(angles.len(), |i| match pull.motors[i].task {
                MotorTask::Follow { angle, .. } => {
                    angle.clamp(angles[i] - STRETCH, angles[i] + STRETCH)
                }
                MotorTask::Torque(_) => angles[i],
            });
            self.limbs[limb.index()] = LimbMotors {
                angles,
                velocities,
                places,
            };
        }
    }

    /// Lets a limb stay in place.
    pub fn stay(&mut self, limb: LimbId) {
        if let Some(motors) = self.limbs.get_mut(limb.index()) {
            motors.places.clone_from(&motors.angles);
        }
    }

    /// The positions by which targets have been reached: for motor-driven joints at rest, the angle to which the motor pulls; for all
    /// others, these positions.
    pub fn reached(&self, layout: &RobotLayout, positions: &[f64]) -> Positions {
        let mut reached = Positions::from_slice(positions);
        for (motors, limb) in self.limbs.iter().zip(&layout.limbs) {
            for (i, joint) in limb.joints.iter().enumerate() {
                let is_near = (motors.angles[i] - motors.places[i]).abs() < STRETCH;
                if is_near && motors.velocities[i].abs() < AT_REST {
                    reached[joint.index()] = motors.places[i];
                }
            }
        }
        reached
    }
}

impl LimbMotors {
    /// The motors with their tasks in this tick. `inertia` in kg m², `weights` in N m.
    fn motors(
        &self,
        articulation: &Articulation,
        limb: LimbId,
        targets: &JointTargets,
        inertia: &Matrix,
        weights: &Joints,
    ) -> Vec<Motor> {
        let layout = &articulation.layout;
        let joints = &layout.limb(limb).joints;
        let setpoints = targets.limb_setpoints(layout, limb, &self.places);
        let motor = |i: usize| {
            let joint = articulation
                .model()
                .joint(articulation.chain(limb).0.joints()[i]);
            let usual = layout.joint(joints[i]);
            let effort = if joint.effort > 0.0 {
                joint.effort
            } else {
                usual.effort
            };
            let speed = if joint.velocity > 0.0 {
                joint.velocity
            } else {
                usual.speed
            };
            let task = match targets.torque(joints[i]) {
                Some(torque) => MotorTask::Torque(torque),
                None => {
                    let way = setpoints[i].position() - self.places[i];
                    // As fast as still allows it to stop at its goal.
                    let brakes = BRAKES * effort / inertia[i][i].max(f64::MIN_POSITIVE);
                    let left = targets
                        .goal(layout, joints[i])
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
        };
        (0..joints.len()).map(motor).collect()
    }
}

impl LimbStep {
    /// Setpoints of the joints for the tick.
    pub fn setpoints(&self) -> Vec<Setpoint> {
        let angles = self.masses.angles.iter().zip(&self.step.velocities);
        angles
            .zip(&self.masses.stops)
            .map(|((angle, velocity), [least, largest])| {
                let way = f64::from(TICK_SECONDS) * velocity;
                Setpoint::Move((angle + way).clamp(*least, *largest))
            })
            .collect()
    }

    /// An object against which a motor stalls.
    fn stalled_by(&self) -> Option<Entity> {
        let DynamicsStep {
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

    /// Velocities and torques of an arm that came only to these angles because of an obstacle.
    fn held_back(&self, angles: &Joints) -> (Joints, Joints) {
        let velocities = each(angles.len(), |i| {
            (angles[i] - self.masses.angles[i]) / f64::from(TICK_SECONDS)
        });
        let torques = each(angles.len(), |i| {
            self.motors[i].torque(angles[i], velocities[i])
        });
        (velocities, torques)
    }
}

fn add(a: &[f64], b: &[f64]) -> Joints {
    each(a.len(), |i| a[i] + b[i])
}
