//! From URDF to a [`RobotModel`].

use std::collections::HashMap;

use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::{
    Geometry, Inertial, JointType, Link, LinkId, LinkShape, Mimic, ModelError, ModelJoint,
    ModelJointId, RobotModel,
    outline::{Child, Outline, outline},
    plain,
    turn::from_roll_pitch_yaw,
};

/// The largest length, in m.
const LONGEST: f64 = 1000.0;

/// The largest mass, in kg.
const HEAVIEST: f64 = 1e6;

/// The largest moment of inertia, in kg m²; beyond, products of three are not finite.
const MOST_INERTIA: f64 = 1e12;

impl RobotModel {
    /// Reads a robot from the text of a URDF file.
    ///
    /// ```
    /// use tabletop_kinematics::RobotModel;
    ///
    /// let text = r#"<robot name="door">
    ///   <link name="frame"/>
    ///   <link name="leaf"/>
    ///   <joint name="hinge" type="revolute">
    ///     <parent link="frame"/> <child link="gate"/>
    ///   </joint>
    /// </robot>"#;
    /// let error = RobotModel::from_urdf(text).unwrap_err();
    /// assert_eq!(error.to_string(), "line 4: joint hinge: there is no link gate");
    /// ```
    ///
    /// # Errors
    ///
    /// The text is no URDF, or its links and joints are no tree, or one of its numbers cannot be.
    pub fn from_urdf(text: &str) -> Result<Self, ModelError> {
        let outline = outline(text)?;
        let robot = read(text).map_err(|error| locate(error, text, &outline))?;
        Lines::new(&outline.children).model(robot)
    }
}

/// Why a text cannot be read.
enum Unread {
    Xml(plain::Fault),
    Urdf(urdf_rs::UrdfError),
}

fn read(text: &str) -> Result<urdf_rs::Robot, Unread> {
    let plain = plain::plain(text).map_err(Unread::Xml)?;
    urdf_rs::read_from_string(&plain).map_err(Unread::Urdf)
}

/// Finds what the reader could not read: an element that does not end, or one of the links and joints, each read alone.
fn locate(error: Unread, text: &str, outline: &Outline) -> ModelError {
    if let Some((tag, line, fault)) = &outline.unbalanced {
        return ModelError::Syntax {
            line: *line,
            element: (*tag).to_owned(),
            message: fault.clone(),
        };
    }
    let alone = outline
        .children
        .iter()
        .filter(|child| matches!(child.tag, "link" | "joint" | "material"))
        .find_map(|child| {
            let text = format!("<robot name=\"\">{}</robot>", child.text);
            Some((child, read(&text).err()?))
        });
    let (line, element, error) = match alone {
        Some((child, error)) => (child.line, child.named(), error),
        None => (line_of(&error, text), "robot".to_owned(), error),
    };
    let message = match error {
        Unread::Xml(fault) => fault.what,
        // With a prefix of the reader's own.
        Unread::Urdf(error) => error.to_string().trim_start_matches("custom: ").to_owned(),
    };
    ModelError::Syntax {
        line,
        element,
        message,
    }
}

fn line_of(error: &Unread, text: &str) -> usize {
    let before = match error {
        Unread::Xml(fault) => text.get(..fault.offset).unwrap_or_default(),
        Unread::Urdf(_) => "",
    };
    1 + before.matches('\n').count()
}

/// Lines of links and joints, in the order in which the text has them.
struct Lines {
    links: Vec<usize>,
    joints: Vec<usize>,
}

impl Lines {
    fn new(outline: &[Child]) -> Self {
        let of = |tag| {
            let children = outline.iter().filter(|child| child.tag == tag);
            children.map(|child| child.line).collect()
        };
        Self {
            links: of("link"),
            joints: of("joint"),
        }
    }

    fn link(&self, index: usize) -> usize {
        self.links.get(index).copied().unwrap_or(1)
    }

    fn joint(&self, index: usize) -> usize {
        self.joints.get(index).copied().unwrap_or(1)
    }

    fn model(&self, robot: urdf_rs::Robot) -> Result<RobotModel, ModelError> {
        let link_of = self.names("link", robot.links.iter().map(|link| &link.name))?;
        let joint_of = self.names("joint", robot.joints.iter().map(|joint| &joint.name))?;
        let tree = LinkTree::new(self, &robot, &link_of)?;

        let mut links = Vec::with_capacity(robot.links.len());
        let mut joints = Vec::with_capacity(robot.joints.len());
        // Where the links and joints of the text end up.
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
            read.shape(&visual.origin, &visual.geometry, color)
        });
        let collisions = link
            .collision
            .iter()
            .map(|collision| read.shape(&collision.origin, &collision.geometry, None));
        Ok(Link {
            inertial: read.inertial(&link.inertial)?,
            visuals: visuals.collect::<Result<_, _>>()?,
            collisions: collisions.collect::<Result<_, _>>()?,
            name: link.name.clone(),
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

    /// Whom a joint follows in the end, by its place in the text.
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
                return Err(fault(&mimic.joint, "there is no such joint"));
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

/// Who hangs on whom, by places in the text.
struct LinkTree {
    /// The joint that carries each link.
    carrier: Vec<Option<usize>>,
    /// The links, each one after the link that it hangs on.
    order: Vec<usize>,
}

impl LinkTree {
    fn new(
        lines: &Lines,
        robot: &urdf_rs::Robot,
        link_of: &HashMap<&str, usize>,
    ) -> Result<Self, ModelError> {
        let mut carrier: Vec<Option<usize>> = vec![None; robot.links.len()];
        let mut children = vec![Vec::new(); robot.links.len()];
        for (index, joint) in robot.joints.iter().enumerate() {
            let end = |link: &str| {
                link_of
                    .get(link)
                    .copied()
                    .ok_or_else(|| ModelError::MissingLink {
                        line: lines.joint(index),
                        joint: joint.name.clone(),
                        link: link.to_owned(),
                    })
            };
            let (parent, child) = (end(&joint.parent.link)?, end(&joint.child.link)?);
            if let Some(other) = carrier[child].replace(index) {
                return Err(ModelError::TwoParents {
                    line: lines.joint(index),
                    joint: joint.name.clone(),
                    link: joint.child.link.clone(),
                    other: robot.joints[other].name.clone(),
                });
            }
            children[parent].push(child);
        }

        let name = |link: usize| robot.links[link].name.clone();
        let mut roots = (0..robot.links.len()).filter(|&link| carrier[link].is_none());
        let root = match (roots.next(), roots.next()) {
            (Some(root), None) => root,
            (Some(root), Some(second)) => {
                return Err(ModelError::SecondRoot {
                    line: lines.link(second),
                    link: name(second),
                    root: name(root),
                });
            }
            (None, _) if robot.links.is_empty() => return Err(ModelError::Empty),
            (None, _) => {
                return Err(ModelError::Cycle {
                    line: lines.link(0),
                    link: name(0),
                });
            }
        };

        let mut order = vec![root];
        let mut next = 0;
        while let Some(&link) = order.get(next) {
            order.extend(&children[link]);
            next += 1;
        }
        let mut reached = vec![false; robot.links.len()];
        for &link in &order {
            reached[link] = true;
        }
        match reached.iter().position(|reached| !reached) {
            Some(link) => Err(ModelError::Cycle {
                line: lines.link(link),
                link: name(link),
            }),
            None => Ok(Self { carrier, order }),
        }
    }
}

/// Reads the numbers of an element.
struct Numbers {
    line: usize,
    element: String,
}

impl Numbers {
    fn fault(&self, fault: &'static str) -> ModelError {
        ModelError::Number {
            line: self.line,
            element: self.element.clone(),
            fault,
        }
    }

    fn vector(&self, numbers: [f64; 3], fault: &'static str) -> Result<DVec3, ModelError> {
        let vector = DVec3::from_array(numbers);
        match vector.is_finite() {
            true => Ok(vector),
            false => Err(self.fault(fault)),
        }
    }

    /// A number from 0 to infinity.
    fn amount(&self, number: f64, fault: &'static str) -> Result<f64, ModelError> {
        match number >= 0.0 {
            true => Ok(number),
            false => Err(self.fault(fault)),
        }
    }

    /// A length from 0 up, in m.
    fn length(&self, number: f64) -> Result<f64, ModelError> {
        match number {
            0.0..=LONGEST => Ok(number.abs()),
            LONGEST.. => Err(self.fault("a length is over 1000 m")),
            _ => Err(self.fault("a length is negative or not finite")),
        }
    }

    fn rotation(&self, rpy: [f64; 3]) -> Result<DQuat, ModelError> {
        let DVec3 { x, y, z } = self.vector(rpy, "an rpy is not finite")?;
        Ok(from_roll_pitch_yaw(x, y, z))
    }

    fn pose(&self, pose: &urdf_rs::Pose) -> Result<DAffine3, ModelError> {
        Ok(DAffine3::from_rotation_translation(
            self.rotation(*pose.rpy)?,
            self.vector(*pose.xyz, "an xyz is not finite")?,
        ))
    }

    fn inertial(&self, inertial: &urdf_rs::Inertial) -> Result<Inertial, ModelError> {
        let mass = inertial.mass.value;
        if !(mass >= 0.0 && mass.is_finite()) {
            return Err(self.fault("its mass is negative or not finite"));
        }
        if mass > HEAVIEST {
            return Err(self.fault("its mass is over 1,000,000 kg"));
        }
        let i = &inertial.inertia;
        let fault = "its inertia is negative or not finite";
        let moments = self.vector([i.ixx, i.iyy, i.izz], fault)?;
        let products = self.vector([i.ixy, i.ixz, i.iyz], fault)?;
        if moments.min_element() < 0.0 {
            return Err(self.fault(fault));
        }
        if !is_of_a_body(moments, products) {
            return Err(self.fault("no body has its inertia: it has a negative principal moment"));
        }
        let own = DMat3::from_cols_array_2d(&[
            [i.ixx, i.ixy, i.ixz],
            [i.ixy, i.iyy, i.iyz],
            [i.ixz, i.iyz, i.izz],
        ]);
        let origin = self.pose(&inertial.origin)?;
        Ok(Inertial {
            mass,
            center: origin.translation,
            inertia: origin.matrix3 * own * origin.matrix3.transpose(),
        })
    }

    fn shape(
        &self,
        origin: &urdf_rs::Pose,
        geometry: &urdf_rs::Geometry,
        color: Option<&urdf_rs::Color>,
    ) -> Result<LinkShape, ModelError> {
        let geometry = match geometry {
            urdf_rs::Geometry::Box { size } => Geometry::Box {
                size: DVec3::new(
                    self.length(size[0])?,
                    self.length(size[1])?,
                    self.length(size[2])?,
                ),
            },
            urdf_rs::Geometry::Cylinder { radius, length } => Geometry::Cylinder {
                radius: self.length(*radius)?,
                length: self.length(*length)?,
            },
            urdf_rs::Geometry::Sphere { radius } => Geometry::Sphere {
                radius: self.length(*radius)?,
            },
            urdf_rs::Geometry::Mesh { filename, scale } => Geometry::Mesh {
                file: filename.clone(),
                scale: match scale {
                    Some(scale) => self.vector(**scale, "a mesh's scale is not finite")?,
                    None => DVec3::ONE,
                },
            },
            urdf_rs::Geometry::Capsule { .. } => {
                return Err(ModelError::Capsule {
                    line: self.line,
                    element: self.element.clone(),
                });
            }
        };
        Ok(LinkShape {
            origin: self.pose(origin)?,
            geometry,
            color: color.map(|color| *color.rgba),
        })
    }
}

/// Whether no principal moment is negative, but for what rounding does.
fn is_of_a_body(moments: DVec3, products: DVec3) -> bool {
    let scale = moments.max_element();
    if scale > MOST_INERTIA {
        return false;
    }
    if scale == 0.0 {
        return products == DVec3::ZERO;
    }
    let (
        DVec3 {
            x: xx,
            y: yy,
            z: zz,
        },
        DVec3 {
            x: xy,
            y: xz,
            z: yz,
        },
    ) = (moments / scale, products / scale);
    let minors = [xx * yy - xy * xy, xx * zz - xz * xz, yy * zz - yz * yz];
    let determinant = xx * minors[2] - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    minors
        .iter()
        .chain([&determinant])
        .all(|&minor| minor >= -1e-9)
}
