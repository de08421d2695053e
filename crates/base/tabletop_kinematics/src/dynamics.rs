//! Dynamics: the forces that weight and motion of a robot exert on its joints.
//!
//! All vectors are in the root's frame. The robot's root does not move.

use std::ops::Index;

use glam::{DMat3, DVec3};

use crate::{Frames, JointType, JointValues, LinkId, ModelJointId, RobotModel};

/// A point mass that a link carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// The link that carries it.
    pub link: LinkId,
    /// Its place in the link's frame, in m.
    pub point: DVec3,
    /// Its mass in kg.
    pub mass: f64,
}

/// The inertia that joints feel, for each pair of a model's joints: kg m² where both turn, kg where both slide. Symmetric;
/// positive definite over the movable joints if these move masses.
#[derive(Clone, Debug, PartialEq)]
pub struct InertiaMatrix {
    joints: usize,
    values: Vec<f64>,
}

impl Index<(ModelJointId, ModelJointId)> for InertiaMatrix {
    type Output = f64;

    fn index(&self, (row, column): (ModelJointId, ModelJointId)) -> &f64 {
        &self.values[row.index() * self.joints + column.index()]
    }
}

/// A body in motion: how its frame's origin accelerates, and how it turns.
#[derive(Clone, Copy, Default)]
struct LinkMotion {
    acceleration: DVec3,
    spin: DVec3,
    spin_rate: DVec3,
}

/// Force and torque on a body, the latter about the origin of its frame.
#[derive(Clone, Copy, Default)]
struct LinkWrench {
    force: DVec3,
    torque: DVec3,
}

impl RobotModel {
    /// The torque (N m) or force (N) that each joint must have to hold the robot still.
    ///
    /// `gravity` is an acceleration in m/s² in the root's frame, such as `(0, 0, -9.81)`.
    ///
    /// ```
    /// use glam::DVec3;
    /// use tabletop_kinematics::{Load, baxter};
    ///
    /// let robot = baxter()?;
    /// let frames = robot.frames(&robot.zero());
    /// let gravity = DVec3::new(0.0, 0.0, -9.81);
    /// let book = Load { link: robot.find_link("left_end_effector")?, point: DVec3::ZERO, mass: 1.0 };
    /// let shoulder = robot.find_joint("left_s1")?;
    /// let without = robot.gravity_torques(&frames, gravity, &[])[shoulder];
    /// let with = robot.gravity_torques(&frames, gravity, &[book])[shoulder];
    /// assert!(with.abs() > without.abs() + 5.0, "an arm's length away from the shoulder");
    /// # Ok::<(), tabletop_kinematics::ModelError>(())
    /// ```
    pub fn gravity_torques(&self, frames: &Frames, gravity: DVec3, loads: &[Load]) -> JointValues {
        let still = self.zero();
        self.inverse_dynamics(frames, &still, &still, gravity, loads)
    }

    /// The torque (N m) or force (N) that each joint must have to move with these velocities and accelerations (rad, m, s).
    /// Without friction and damping.
    pub fn inverse_dynamics(
        &self,
        frames: &Frames,
        velocities: &JointValues,
        accelerations: &JointValues,
        gravity: DVec3,
        loads: &[Load],
    ) -> JointValues {
        let motions = self.motions(frames, velocities, accelerations, gravity);
        let mut wrenches: Vec<LinkWrench> = (0..self.links.len())
            .map(|i| {
                let inertial = &self.links[i].inertial;
                let center = frames[LinkId(i)].transform_vector3(inertial.center);
                let inertia = self.inertia_in_root(frames, LinkId(i));
                let motion = &motions[i];
                let mut wrench = motion.of_mass(inertial.mass, center);
                wrench.torque +=
                    inertia * motion.spin_rate + motion.spin.cross(inertia * motion.spin);
                wrench
            })
            .collect();
        for load in loads {
            let point = frames[load.link].transform_vector3(load.point);
            let of_load = motions[load.link.index()].of_mass(load.mass, point);
            let wrench = &mut wrenches[load.link.index()];
            wrench.force += of_load.force;
            wrench.torque += of_load.torque;
        }

        let mut torques = self.zero();
        for (i, joint) in self.joints.iter().enumerate().rev() {
            let LinkWrench { force, torque } = wrenches[joint.child.index()];
            if joint.kind != JointType::Fixed {
                let axis = self.axis_in_root(frames, ModelJointId(i));
                let along = if joint.kind.turns() { torque } else { force };
                let (leader, multiplier) = self.leader(ModelJointId(i));
                torques[leader] += multiplier * axis.dot(along);
            }
            let arm = frames[joint.child].translation - frames[joint.parent].translation;
            let parent = &mut wrenches[joint.parent.index()];
            parent.force += force;
            parent.torque += torque + arm.cross(force);
        }
        torques
    }

    /// The inertia that the joints feel.
    pub fn inertia_matrix(&self, frames: &Frames, loads: &[Load]) -> InertiaMatrix {
        let joints = self.joints.len();
        let mut matrix = InertiaMatrix {
            joints,
            values: vec![0.0; joints * joints],
        };
        let bodies = self.composite_bodies(frames, loads);
        for i in (0..joints).map(ModelJointId) {
            let joint = self.joint(i);
            if joint.kind == JointType::Fixed {
                continue;
            }
            // The force that accelerates everything that the joint carries by 1.
            let body = &bodies[joint.child.index()];
            let axis = self.axis_in_root(frames, i);
            let origin = frames[joint.child].translation;
            let (force, torque) = match joint.kind.turns() {
                true => (
                    body.mass * axis.cross(body.center - origin),
                    body.inertia * axis,
                ),
                false => (body.mass * axis, DVec3::ZERO),
            };
            let (leader, multiplier) = self.leader(i);
            for j in self.carriers(joint.child) {
                let other = self.joint(j);
                let axis = self.axis_in_root(frames, j);
                let felt = match other.kind.turns() {
                    true => {
                        let arm = body.center - frames[other.child].translation;
                        axis.dot(torque + arm.cross(force))
                    }
                    false => axis.dot(force),
                };
                let (other_leader, other_multiplier) = self.leader(j);
                let felt = multiplier * other_multiplier * felt;
                matrix.values[leader.index() * joints + other_leader.index()] += felt;
                if i != j {
                    matrix.values[other_leader.index() * joints + leader.index()] += felt;
                }
            }
        }
        matrix
    }

    /// The motions of the links. Gravity is felt as an acceleration of the root the other way.
    fn motions(
        &self,
        frames: &Frames,
        velocities: &JointValues,
        accelerations: &JointValues,
        gravity: DVec3,
    ) -> Vec<LinkMotion> {
        let mut motions = Vec::with_capacity(self.links.len());
        motions.push(LinkMotion {
            acceleration: -gravity,
            ..LinkMotion::default()
        });
        for (i, joint) in self.joints.iter().enumerate() {
            let parent: LinkMotion = motions[joint.parent.index()];
            let arm = frames[joint.child].translation - frames[joint.parent].translation;
            let mut motion = LinkMotion {
                acceleration: parent.acceleration_at(arm),
                ..parent
            };
            let (leader, multiplier) = self.leader(ModelJointId(i));
            let axis = self.axis_in_root(frames, ModelJointId(i)) * multiplier;
            let (speed, rate) = (axis * velocities[leader], axis * accelerations[leader]);
            match joint.kind {
                JointType::Fixed => {}
                JointType::Revolute | JointType::Continuous => {
                    motion.spin += speed;
                    motion.spin_rate += rate + parent.spin.cross(speed);
                }
                JointType::Prismatic => {
                    motion.acceleration += rate + 2.0 * parent.spin.cross(speed);
                }
            }
            motions.push(motion);
        }
        motions
    }

    fn inertia_in_root(&self, frames: &Frames, link: LinkId) -> DMat3 {
        let rotation = frames[link].matrix3;
        rotation * self.link(link).inertial.inertia * rotation.transpose()
    }

    /// Each link with everything that hangs on it, as one rigid body.
    fn composite_bodies(&self, frames: &Frames, loads: &[Load]) -> Vec<CompositeBody> {
        let mut bodies: Vec<CompositeBody> = (0..self.links.len())
            .map(|i| {
                let inertial = &self.links[i].inertial;
                CompositeBody {
                    mass: inertial.mass,
                    center: frames[LinkId(i)].transform_point3(inertial.center),
                    inertia: self.inertia_in_root(frames, LinkId(i)),
                }
            })
            .collect();
        for load in loads {
            bodies[load.link.index()].add(&CompositeBody {
                mass: load.mass,
                center: frames[load.link].transform_point3(load.point),
                inertia: DMat3::ZERO,
            });
        }
        for joint in self.joints.iter().rev() {
            let child = bodies[joint.child.index()];
            bodies[joint.parent.index()].add(&child);
        }
        bodies
    }
}

impl LinkMotion {
    /// The acceleration of a point of the body, this far from its frame's origin.
    fn acceleration_at(&self, arm: DVec3) -> DVec3 {
        self.acceleration + self.spin_rate.cross(arm) + self.spin.cross(self.spin.cross(arm))
    }

    /// The inertia of a point mass that moves along with the body, this far from its frame's origin.
    fn of_mass(&self, mass: f64, arm: DVec3) -> LinkWrench {
        let force = mass * self.acceleration_at(arm);
        LinkWrench {
            force,
            torque: arm.cross(force),
        }
    }
}

/// A rigid body in the root's frame.
#[derive(Clone, Copy)]
struct CompositeBody {
    mass: f64,
    center: DVec3,
    /// About the centre.
    inertia: DMat3,
}

impl CompositeBody {
    fn add(&mut self, other: &Self) {
        let mass = self.mass + other.mass;
        if mass <= 0.0 {
            return;
        }
        let between = other.center - self.center;
        self.inertia += other.inertia;
        self.inertia += point_inertia(between) * (self.mass * other.mass / mass);
        self.center += between * (other.mass / mass);
        self.mass = mass;
    }
}

/// The inertia of a mass of 1 kg at a point, about the origin.
fn point_inertia(point: DVec3) -> DMat3 {
    let outer = DMat3::from_cols(point * point.x, point * point.y, point * point.z);
    DMat3::from_diagonal(DVec3::splat(point.length_squared())) - outer
}
