//! A robot: links, and the joints between them.

use glam::{DAffine3, DVec3};

use crate::{JointValues, Link, LinkId, ModelError, ModelJointId, turn::turn_about};

/// The degrees of freedom of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointType {
    /// Nothing.
    Fixed,
    /// A turn about its axis, within limits.
    Revolute,
    /// A turn about its axis, without limits.
    Continuous,
    /// A slide along its axis, within limits.
    Prismatic,
}

impl JointType {
    /// True if it turns about its axis.
    pub const fn turns(self) -> bool {
        matches!(self, Self::Revolute | Self::Continuous)
    }
}

/// A joint: how a link hangs on another one.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelJoint {
    /// Its name, unique among joints.
    pub name: String,
    /// The line of the description in which it starts, from 1.
    pub line: usize,
    /// Its degrees of freedom.
    pub kind: JointType,
    /// The link that it hangs on.
    pub parent: LinkId,
    /// The link that it carries.
    pub child: LinkId,
    /// From its child's frame, while it stands at 0, to its parent's. In m.
    pub origin: DAffine3,
    /// The unit vector that it turns about or slides along, in its child's frame.
    pub axis: DVec3,
    /// Least and largest position, in rad or m; infinite for [`Continuous`](JointType::Continuous) ones.
    pub limits: [f64; 2],
    /// Largest torque or force of its motor, in N m or N; 0 if the description names none.
    pub effort: f64,
    /// Largest speed, in rad/s or m/s; 0 if the description names none.
    pub velocity: f64,
    /// Torque or force against its motion, per rad/s or m/s.
    pub damping: f64,
    /// The joint that it follows, if it does not move by itself.
    pub mimic: Option<Mimic>,
}

impl ModelJoint {
    /// From the child's frame to the parent's, with the joint at a position in rad or m.
    pub fn motion(&self, position: f64) -> DAffine3 {
        match self.kind {
            JointType::Fixed => self.origin,
            JointType::Revolute | JointType::Continuous => {
                self.origin * DAffine3::from_mat3(turn_about(self.axis, position))
            }
            JointType::Prismatic => self.origin * DAffine3::from_translation(self.axis * position),
        }
    }
}

/// A joint that follows another one: its position is `multiplier * leader + offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mimic {
    /// The joint that leads; it follows none itself.
    pub leader: ModelJointId,
    /// Motion per motion of the leader.
    pub multiplier: f64,
    /// Position while the leader stands at 0, in rad or m.
    pub offset: f64,
}

/// A robot: a tree of links and joints. Parents stand before their children.
#[derive(Clone, Debug)]
pub struct RobotModel {
    pub(crate) name: String,
    /// The first one is the root.
    pub(crate) links: Vec<Link>,
    /// `joints[i]` carries `links[i + 1]`.
    pub(crate) joints: Vec<ModelJoint>,
}

impl RobotModel {
    /// The robot's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The links, the root first, each one after the link that it hangs on.
    pub fn links(&self) -> &[Link] {
        &self.links
    }

    /// The joints, in the order of the links that they carry.
    pub fn joints(&self) -> &[ModelJoint] {
        &self.joints
    }

    /// The link that hangs on nothing; its frame is the frame of all results.
    pub const fn root(&self) -> LinkId {
        LinkId(0)
    }

    /// A link.
    pub fn link(&self, link: LinkId) -> &Link {
        &self.links[link.index()]
    }

    /// A joint.
    pub fn joint(&self, joint: ModelJointId) -> &ModelJoint {
        &self.joints[joint.index()]
    }

    /// The link of this name.
    ///
    /// # Errors
    ///
    /// There is none.
    pub fn find_link(&self, name: &str) -> Result<LinkId, ModelError> {
        let found = self.links.iter().position(|link| link.name == name);
        found.map(LinkId).ok_or_else(|| ModelError::NoSuchLink {
            robot: self.name.clone(),
            link: name.to_owned(),
        })
    }

    /// The joint of this name.
    ///
    /// # Errors
    ///
    /// There is none.
    pub fn find_joint(&self, name: &str) -> Result<ModelJointId, ModelError> {
        let found = self.joints.iter().position(|joint| joint.name == name);
        found
            .map(ModelJointId)
            .ok_or_else(|| ModelError::NoSuchJoint {
                robot: self.name.clone(),
                joint: name.to_owned(),
            })
    }

    /// The joints that move independently: neither fixed nor following another one.
    pub fn movable(&self) -> impl Iterator<Item = ModelJointId> {
        let joints = self.joints.iter().enumerate();
        joints
            .filter(|(_, joint)| joint.kind != JointType::Fixed && joint.mimic.is_none())
            .map(|(i, _)| ModelJointId(i))
    }

    /// A link and all that hangs on it, directly or not.
    pub fn all_on(&self, link: LinkId) -> Vec<LinkId> {
        self.reached_from(link, |_| true)
    }

    /// A link and all that is rigidly connected to it and hangs on it.
    pub fn rigidly_on(&self, link: LinkId) -> Vec<LinkId> {
        self.reached_from(link, |joint| joint.kind == JointType::Fixed)
    }

    fn reached_from(&self, link: LinkId, by: impl Fn(&ModelJoint) -> bool) -> Vec<LinkId> {
        let mut is_reached = vec![false; self.links.len()];
        is_reached[link.index()] = true;
        let mut reached = vec![link];
        // Parents stand before their children.
        for joint in &self.joints[link.index()..] {
            if is_reached[joint.parent.index()] && by(joint) {
                is_reached[joint.child.index()] = true;
                reached.push(joint.child);
            }
        }
        reached
    }

    /// The link that a link hangs on; `None` for the root.
    pub fn parent(&self, link: LinkId) -> Option<LinkId> {
        self.link(link).joint.map(|joint| self.joint(joint).parent)
    }

    /// A 0 for every joint.
    pub fn zero(&self) -> JointValues {
        JointValues(vec![0.0; self.joints.len()])
    }

    /// The position of a joint, in rad or m: its own number, or the one that follows from its leader's.
    pub fn position(&self, joint: ModelJointId, configuration: &JointValues) -> f64 {
        match self.joint(joint).mimic {
            Some(mimic) => mimic.multiplier * configuration[mimic.leader] + mimic.offset,
            None => configuration[joint],
        }
    }

    /// Lets a joint stand still at a position, in rad or m, as if it were fixed there; joints that follow it stand where it has them.
    ///
    /// ```
    /// let mut robot = tabletop_kinematics::baxter()?;
    /// let neck = robot.find_joint("head_pan")?;
    /// let moving = robot.movable().count();
    /// robot.hold(neck, 0.5);
    /// assert_eq!(robot.movable().count(), moving - 1);
    /// # Ok::<(), tabletop_kinematics::ModelError>(())
    /// ```
    pub fn hold(&mut self, held: ModelJointId, position: f64) {
        for (i, joint) in self.joints.iter_mut().enumerate() {
            let at = match joint.mimic {
                _ if i == held.index() => position,
                Some(mimic) if mimic.leader == held => mimic.multiplier * position + mimic.offset,
                Some(_) | None => continue,
            };
            *joint = ModelJoint {
                origin: joint.motion(at),
                kind: JointType::Fixed,
                limits: [0.0; 2],
                mimic: None,
                ..joint.clone()
            };
        }
    }

    /// The joint whose number moves this one, and how much this one moves per motion of it.
    pub(crate) fn leader(&self, joint: ModelJointId) -> (ModelJointId, f64) {
        match self.joint(joint).mimic {
            Some(mimic) => (mimic.leader, mimic.multiplier),
            None => (joint, 1.0),
        }
    }

    /// The moving joints between a link and the root, from the link.
    pub(crate) fn carriers(&self, link: LinkId) -> impl Iterator<Item = ModelJointId> {
        let next = |joint: &ModelJointId| self.link(self.joint(*joint).parent).joint;
        std::iter::successors(self.link(link).joint, next)
            .filter(|&joint| self.joint(joint).kind != JointType::Fixed)
    }
}
