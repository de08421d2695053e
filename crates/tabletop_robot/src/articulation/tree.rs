//! The robot as the simulator moves it: which bodies it consists of, and where they are.

use std::{
    f32::consts::{FRAC_PI_2, PI},
    path::Path,
};

use bevy::{
    math::{DAffine3, DMat3, DQuat, DVec3},
    prelude::*,
};
use bevy_rapier3d::rapier::prelude::SharedShape;
use tabletop_core::{Arm, JOINTS_PER_ARM, Pose, RobotJoint, UNITS_PER_METER, WIDEST_GRIP};
use tabletop_kinematics::{
    ArmChain, Frames, Geometry, JointId, JointValues, LinkId, LinkShape, Load, ModelError,
    RobotModel,
};
use tabletop_physics::Convex;

use crate::look::{error::LookError, figure::figure_of};

/// Extents of a finger across, along the opening and along the finger, in units: x, y, z of the end effector's frame.
pub(crate) const FINGER: Vec3 = Vec3::new(0.3, 0.4, 1.5);

/// How far a finger of a wide open gripper stands back, in units: more than the distance at which something counts as touched. So what
/// is as wide as the opening is not jammed between the fingers.
const PLAY: f32 = 0.015;

/// From this share of the widest opening on, fingers begin to stand back.
const ALMOST_OPEN: f32 = 0.99;

/// From the end effector's axes to the wrist's, and back.
pub(crate) const WRIST_TURNED: DMat3 = DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_X, DVec3::NEG_Z);

/// Where the end effector is on the wrist of a description that does not name it, in m along the wrist's axis.
const END_EFFECTOR_ON_WRIST: f64 = 0.19535;

/// A rigid part of the robot.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    /// The link's name in the description; for fingers `left-gripper-right-finger`.
    pub id: String,
    /// What it is called.
    pub name: String,
    /// What carries it.
    pub carrier: Carrier,
    /// Where it is along the robot: bodies whose numbers are near each other cannot meet.
    pub place: TreePosition,
    /// Its solids, in its own frame.
    pub parts: Vec<Convex>,
}

/// What carries a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Carrier {
    /// It is a link.
    Link(LinkId),
    /// It is a finger of a gripper, on this side of the opening: -1 left, 1 right. Its x points inwards.
    Gripper(Arm, i8),
}

/// Where a body is along the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TreePosition {
    /// It does not move.
    Trunk,
    /// It turns with the neck.
    Head,
    /// So many joints of an arm carry it; fingers are carried by one more.
    Arm(Arm, usize),
}

/// The robot's model, and what of it the simulator moves.
#[derive(Resource, Clone, Debug)]
pub(crate) struct Articulation {
    model: RobotModel,
    joints: [Option<JointId>; 15],
    end_effectors: [(LinkId, DAffine3); 2],
    origins: [[LinkId; 3]; 2],
    chains: [ArmChain; 2],
    /// The bodies.
    pub bodies: Vec<Body>,
}

/// Where everything is at a moment, in the torso's frame.
#[derive(Clone, Debug)]
pub(crate) struct Posture {
    values: JointValues,
    frames: Frames,
    openings: [f64; 2],
}

impl Posture {
    /// Where the links are, in m.
    pub const fn frames(&self) -> &Frames {
        &self.frames
    }
}

impl Articulation {
    /// Finds the robot's arms, grippers and head in a model.
    pub fn new(model: RobotModel) -> Result<Self, ModelError> {
        let mut joints = [None; 15];
        for joint in RobotJoint::ALL.into_iter().take(joints.len()) {
            joints[joint.index()] = match joint {
                RobotJoint::HeadPan => model.find_joint(joint.name()).ok(),
                _ => Some(model.find_joint(joint.name())?),
            };
        }
        let end_effectors = [
            end_effector(&model, Arm::Left)?,
            end_effector(&model, Arm::Right)?,
        ];
        let chain = |arm: Arm| -> Result<_, ModelError> {
            let limits = RobotJoint::of_arm(arm).map(|joint| joint.limits().into());
            let chain = ArmChain::new(&model, model.root(), end_effectors[arm as usize].0)?;
            Ok(chain.with_limits(limits))
        };
        let origins = |arm: Arm| -> Result<_, ModelError> {
            let link = |name: &str| {
                let joint = model.find_joint(&format!("{arm}_{name}"))?;
                Ok::<_, ModelError>(model.joint(joint).child)
            };
            Ok([link("s1")?, link("e1")?, link("w1")?])
        };
        let mut articulation = Self {
            end_effectors,
            origins: [origins(Arm::Left)?, origins(Arm::Right)?],
            chains: [chain(Arm::Left)?, chain(Arm::Right)?],
            joints,
            bodies: Vec::new(),
            model,
        };
        articulation.bodies = articulation.find_bodies();
        Ok(articulation)
    }

    /// Adds the convex hulls of the meshes by which links are touched, as coarse as the head camera sees them. `urdf` is the
    /// file of the description. Returns what could not be added, and the links that lack it.
    pub fn add_meshes(&mut self, urdf: Option<&Path>) -> Vec<(String, LookError)> {
        let mut lacking = Vec::new();
        for body in &mut self.bodies {
            let Carrier::Link(link) = body.carrier else {
                continue;
            };
            for collision in &self.model.link(link).collisions {
                if let Geometry::Mesh { file, .. } = &collision.geometry {
                    match hull_of(collision, file, urdf) {
                        Ok(hull) => body.parts.push(hull),
                        Err(error) => lacking.push((body.id.clone(), error)),
                    }
                }
            }
        }
        lacking
    }

    /// The model.
    pub const fn model(&self) -> &RobotModel {
        &self.model
    }

    /// The chain, with the limits of table 1, from the torso to the link that carries an end effector, and the end effector's frame on that link.
    pub const fn chain(&self, arm: Arm) -> (&ArmChain, DAffine3) {
        (
            &self.chains[arm as usize],
            self.end_effectors[arm as usize].1,
        )
    }

    /// The joint of the model that a joint of the robot is.
    pub fn joint(&self, joint: RobotJoint) -> Option<JointId> {
        self.joints.get(joint.index()).copied().flatten()
    }

    fn find_bodies(&self) -> Vec<Body> {
        let links = (0..self.model.links().len()).filter_map(|i| self.link_body(i));
        let fingers = Arm::BOTH.into_iter().flat_map(|arm| {
            [("left", -1), ("right", 1)].map(|(name, side)| Body {
                id: format!("{arm}-gripper-{name}-finger"),
                name: format!("{name} finger of the {arm} gripper"),
                carrier: Carrier::Gripper(arm, side),
                place: TreePosition::Arm(arm, JOINTS_PER_ARM + 1),
                parts: vec![Convex {
                    pose: Pose::IDENTITY,
                    shape: cuboid(FINGER),
                }],
            })
        });
        links.chain(fingers).collect()
    }

    /// The body of a link; `None` for mere frames, and for the fingers of a description, whose place the simulator's take.
    fn link_body(&self, index: usize) -> Option<Body> {
        let link = &self.model.links()[index];
        let is_frame = link.collisions.is_empty() && link.visuals.is_empty();
        if is_frame || link.name.contains("_finger") {
            return None;
        }
        let id = self.model.find_link(&link.name).ok()?;
        Some(Body {
            id: link.name.clone(),
            name: link.name.replace('_', " "),
            carrier: Carrier::Link(id),
            place: self.place(id),
            parts: link.collisions.iter().filter_map(convex).collect(),
        })
    }

    /// How far along the robot a link is.
    fn place(&self, link: LinkId) -> TreePosition {
        let carriers: Vec<_> = std::iter::successors(Some(link), |&link| self.model.parent(link))
            .filter_map(|link| self.model.link(link).joint)
            .collect();
        let is_carrier = |joint: &RobotJoint| {
            self.joint(*joint)
                .is_some_and(|joint| carriers.contains(&joint))
        };
        if is_carrier(&RobotJoint::HeadPan) {
            return TreePosition::Head;
        }
        Arm::BOTH
            .into_iter()
            .find_map(|arm| {
                let joints = RobotJoint::of_arm(arm);
                let count = joints.iter().filter(|joint| is_carrier(joint)).count();
                (count > 0).then_some(TreePosition::Arm(arm, count))
            })
            .unwrap_or(TreePosition::Trunk)
    }

    /// Where everything is when the joints are at these positions, by [`RobotJoint::index`].
    pub fn posture(&self, positions: &[f64; 17]) -> Posture {
        let mut posture = Posture {
            values: self.model.zero(),
            frames: Frames::default(),
            openings: [0.0; 2],
        };
        self.update(&mut posture, positions);
        posture
    }

    /// Brings a posture to other positions of the joints.
    pub fn update(&self, posture: &mut Posture, positions: &[f64; 17]) {
        for (joint, position) in self.joints.iter().zip(positions) {
            if let Some(joint) = *joint {
                posture.values[joint] = *position;
            }
        }
        posture.openings = Arm::BOTH.map(|arm| positions[RobotJoint::gripper(arm).index()]);
        self.model.frames_into(&posture.values, &mut posture.frames);
    }

    /// Where a body is, in the frame in which the torso stands at `base`, in units.
    pub fn pose(&self, body: &Body, posture: &Posture, base: Pose) -> Pose {
        match body.carrier {
            Carrier::Link(link) => base * in_units(posture.frames[link]),
            Carrier::Gripper(arm, side) => {
                let opening = posture.openings[arm as usize] as f32;
                let out = opening / 2.0 + play(opening) + FINGER.x / 2.0;
                let inwards = if side < 0 { 0.0 } else { PI };
                self.end_effector(arm, posture, base)
                    * Pose::new(
                        Vec3::X * f32::from(side) * out,
                        Quat::from_rotation_z(inwards),
                    )
            }
        }
    }

    /// Where an end effector is.
    pub fn end_effector(&self, arm: Arm, posture: &Posture, base: Pose) -> Pose {
        let (link, offset) = self.end_effectors[arm as usize];
        base * in_units(posture.frames[link] * offset)
    }

    /// What the joints of an arm turn about: a point and a unit vector, in m in the torso's frame.
    pub fn axes(&self, arm: Arm, posture: &Posture) -> [(DVec3, DVec3); JOINTS_PER_ARM] {
        self.chains[arm as usize].joints().map(|joint| {
            let joint = self.model.joint(joint);
            let frame = posture.frames[joint.child];
            (frame.translation, frame.transform_vector3(joint.axis))
        })
    }

    /// Something that an end effector carries, at this pose in its frame, in units, with this mass in kg.
    pub fn load(&self, arm: Arm, pose: Pose, mass: f64) -> Load {
        let (link, offset) = self.end_effectors[arm as usize];
        Load {
            link,
            point: offset.transform_point3(pose.location.as_dvec3() / UNITS_PER_METER),
            mass,
        }
    }

    /// Where the origins of the joints S1, E1 and W1 of an arm are.
    pub fn joint_origins(&self, arm: Arm, posture: &Posture, base: Pose) -> [Vec3; 3] {
        self.origins[arm as usize].map(|link| base * in_units(posture.frames[link]).location)
    }
}

/// The frame of an end effector, on the link that carries it.
fn end_effector(model: &RobotModel, arm: Arm) -> Result<(LinkId, DAffine3), ModelError> {
    if let Ok(link) = model.find_link(&format!("{arm}_end_effector")) {
        return Ok((link, DAffine3::IDENTITY));
    }
    let wrist = model.find_link(&format!("{arm}_wrist"))?;
    Ok((wrist, end_effector_on_wrist()))
}

/// The fingers point along the wrist's z, away from it; the left one is on the wrist's y side.
fn end_effector_on_wrist() -> DAffine3 {
    DAffine3::from_mat3_translation(WRIST_TURNED, DVec3::Z * END_EFFECTOR_ON_WRIST)
}

/// A frame of the model as a pose in units.
fn in_units(frame: DAffine3) -> Pose {
    let rotation = DQuat::from_mat3(&frame.matrix3).normalize();
    Pose::new(
        (frame.translation * UNITS_PER_METER).as_vec3(),
        rotation.as_quat(),
    )
}

/// A pose in units as a frame of the model.
pub(crate) fn in_meters(pose: Pose) -> DAffine3 {
    DAffine3::from_rotation_translation(
        pose.rotation.as_dquat().normalize(),
        pose.location.as_dvec3() / UNITS_PER_METER,
    )
}

fn cuboid(span: Vec3) -> SharedShape {
    SharedShape::cuboid(span.x / 2.0, span.y / 2.0, span.z / 2.0)
}

/// How far a finger stands back at an opening, in units.
fn play(opening: f32) -> f32 {
    let share = opening / WIDEST_GRIP as f32;
    PLAY * ((share - ALMOST_OPEN) / (1.0 - ALMOST_OPEN)).clamp(0.0, 1.0)
}

/// The convex hull of a mesh, in the frame of the link that is touched by it.
fn hull_of(mesh: &LinkShape, file: &str, urdf: Option<&Path>) -> Result<Convex, LookError> {
    let points = &figure_of(mesh, urdf)?.coarse.positions;
    let hull = SharedShape::convex_hull(points);
    let shape = hull.ok_or_else(|| LookError::Empty { path: file.into() })?;
    Ok(Convex {
        pose: Pose::IDENTITY,
        shape,
    })
}

/// The solid of a link's collision geometry, in the link's frame; of a mesh, [`hull_of`] knows it.
fn convex(shape: &LinkShape) -> Option<Convex> {
    let origin = in_units(shape.origin);
    let scale = UNITS_PER_METER as f32;
    Some(match &shape.geometry {
        Geometry::Box { size } => Convex {
            pose: origin,
            shape: cuboid(size.as_vec3() * scale),
        },
        Geometry::Cylinder { radius, length } => Convex {
            // Along z there, along y here.
            pose: origin * Pose::new(Vec3::ZERO, Quat::from_rotation_x(FRAC_PI_2)),
            shape: SharedShape::cylinder(*length as f32 * scale / 2.0, *radius as f32 * scale),
        },
        Geometry::Sphere { radius } => Convex {
            pose: origin,
            shape: SharedShape::ball(*radius as f32 * scale),
        },
        Geometry::Mesh { .. } => return None,
    })
}
