//! The model that a description makes.

use std::collections::HashMap;

use glam::DVec3;

use crate::{
    JointType, Link, LinkId, Mimic, ModelError, ModelJoint, ModelJointId, RobotModel,
    urdf::{lines::Lines, link_tree::LinkTree, numbers::Numbers},
};

impl Lines {
    pub(super) fn model(&self, robot: urdf_rs::Robot) -> Result<RobotModel, ModelError> {
        let link_of = self.names("link", robot.links.iter().map(|link| &link.name))?;
        let joint_of = self.names("joint", robot.joints.iter().map(|joint| &joint.name))?;
        let tree = LinkTree::new(self, &robot, &link_of)?;

        let mut links = Vec::with_capacity(robot.links.len());
        let mut joints = Vec::with_capacity(robot.joints.len());
        // The new places of the text's links and joints.
        let mut place = vec![0; robot.links.len()];
        let mut joint_place = vec![0; robot.joints.len()];
        for &index in &tree.order {
            place[index] = links.len();
            let mut link = self.read_link(index, &robot)?;
            if let Some(by) = tree.carrier[index] {
                joint_place[by] = joints.len();
                link.joint = Some(ModelJointId(joints.len()));
                let parent = link_of[robot.joints[by].parent.link.as_str()];
                let (parent, child) = (LinkId(place[parent]), LinkId(place[index]));
                joints.push(self.read_joint(by, &robot.joints[by], parent, child)?);
            }
            links.push(link);
        }
        for (index, joint) in robot.joints.iter().enumerate() {
            if joint.mimic.is_some() {
                let mut mimic = self.follow(index, &robot, &joint_of)?;
                mimic.leader = ModelJointId(joint_place[mimic.leader.index()]);
                joints[joint_place[index]].mimic = Some(mimic);
            }
        }
        Ok(RobotModel {
            name: robot.name,
            links,
            joints,
        })
    }

    /// Places by name.
    fn names<'a>(
        &self,
        what: &'static str,
        names: impl Iterator<Item = &'a String>,
    ) -> Result<HashMap<&'a str, usize>, ModelError> {
        let mut places = HashMap::new();
        for (index, name) in names.enumerate() {
            if places.insert(name.as_str(), index).is_some() {
                let line = match what {
                    "link" => self.link(index),
                    _ => self.joint(index),
                };
                return Err(ModelError::Duplicate {
                    line,
                    what,
                    name: name.clone(),
                });
            }
        }
        Ok(places)
    }

    fn read_link(&self, index: usize, robot: &urdf_rs::Robot) -> Result<Link, ModelError> {
        let link = &robot.links[index];
        let read = Numbers {
            line: self.link(index),
            element: format!("link {}", link.name),
        };
        let visuals = link.visual.iter().map(|visual| {
            let color = visual.material.as_ref().and_then(|material| {
                let shared = robot.materials.iter().find(|m| m.name == material.name);
                let color = material.color.as_ref();
                color.or_else(|| shared?.color.as_ref())
            });
            read.shapes(&visual.origin, &visual.geometry, color)
        });
        let collisions = link
            .collision
            .iter()
            .map(|collision| read.shapes(&collision.origin, &collision.geometry, None));
        Ok(Link {
            inertial: read.inertial(&link.inertial)?,
            visuals: visuals.collect::<Result<Vec<_>, _>>()?.concat(),
            collisions: collisions.collect::<Result<Vec<_>, _>>()?.concat(),
            name: link.name.clone(),
            line: self.link(index),
            joint: None,
        })
    }

    fn read_joint(
        &self,
        index: usize,
        joint: &urdf_rs::Joint,
        parent: LinkId,
        child: LinkId,
    ) -> Result<ModelJoint, ModelError> {
        let line = self.joint(index);
        let unsupported = |kind| ModelError::JointType {
            line,
            joint: joint.name.clone(),
            kind,
        };
        let kind = match joint.joint_type {
            urdf_rs::JointType::Fixed => JointType::Fixed,
            urdf_rs::JointType::Revolute => JointType::Revolute,
            urdf_rs::JointType::Continuous => JointType::Continuous,
            urdf_rs::JointType::Prismatic => JointType::Prismatic,
            urdf_rs::JointType::Floating => return Err(unsupported("floating")),
            urdf_rs::JointType::Planar => return Err(unsupported("planar")),
            urdf_rs::JointType::Spherical => return Err(unsupported("spherical")),
        };
        let read = Numbers {
            line,
            element: format!("joint {}", joint.name),
        };
        let axis = read.vector(*joint.axis.xyz, "its axis is not finite")?;
        let axis = match (axis.try_normalize(), kind) {
            (Some(axis), _) => axis,
            (None, JointType::Fixed) => DVec3::X,
            (None, _) => return Err(read.fault("its axis has no direction")),
        };
        let (lower, upper) = (joint.limit.lower, joint.limit.upper);
        let limits = match kind {
            JointType::Fixed => [0.0; 2],
            JointType::Continuous => [f64::NEG_INFINITY, f64::INFINITY],
            JointType::Revolute | JointType::Prismatic if lower <= upper => [lower, upper],
            JointType::Revolute | JointType::Prismatic => {
                return Err(read.fault("its lower limit is above its upper one"));
            }
        };
        let damping = joint
            .dynamics
            .as_ref()
            .map_or(0.0, |dynamics| dynamics.damping);
        Ok(ModelJoint {
            name: joint.name.clone(),
            line,
            kind,
            parent,
            child,
            origin: read.pose(&joint.origin)?,
            axis,
            limits,
            effort: read.amount(joint.limit.effort, "its effort is negative or not a number")?,
            velocity: read.amount(
                joint.limit.velocity,
                "its velocity is negative or not a number",
            )?,
            damping: read.amount(damping, "its damping is negative or not a number")?,
            mimic: None,
        })
    }

    /// The joint that a joint follows in the end, by its place in the text.
    fn follow(
        &self,
        index: usize,
        robot: &urdf_rs::Robot,
        joint_of: &HashMap<&str, usize>,
    ) -> Result<Mimic, ModelError> {
        let follower = &robot.joints[index];
        let mut found = Mimic {
            leader: ModelJointId(index),
            multiplier: 1.0,
            offset: 0.0,
        };
        // A ring of followers would be longer than all joints.
        for _ in 0..=robot.joints.len() {
            let joint = &robot.joints[found.leader.index()];
            let fault = |leader: &str, reason| ModelError::Mimic {
                line: self.joint(index),
                joint: follower.name.clone(),
                leader: leader.to_owned(),
                reason,
            };
            let Some(mimic) = &joint.mimic else {
                return if joint.joint_type == urdf_rs::JointType::Fixed {
                    Err(fault(&joint.name, "that joint is fixed"))
                } else {
                    Ok(found)
                };
            };
            let (multiplier, offset) =
                (mimic.multiplier.unwrap_or(1.0), mimic.offset.unwrap_or(0.0));
            if !multiplier.is_finite() || !offset.is_finite() {
                return Err(fault(
                    &mimic.joint,
                    "its multiplier or offset is not finite",
                ));
            }
            let Some(&leader) = joint_of.get(mimic.joint.as_str()) else {
                return Err(fault(
                    &mimic.joint,
                    "there is no such joint; name one, or remove its <mimic>",
                ));
            };
            found = Mimic {
                leader: ModelJointId(leader),
                multiplier: found.multiplier * multiplier,
                offset: found.offset + found.multiplier * offset,
            };
        }
        Err(ModelError::Mimic {
            line: self.joint(index),
            joint: follower.name.clone(),
            leader: robot.joints[found.leader.index()].name.clone(),
            reason: "it follows itself",
        })
    }
}
