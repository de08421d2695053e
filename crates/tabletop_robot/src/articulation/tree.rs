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
use smallvec::SmallVec;
use tabletop_core::{
    JointId, JointRole, LimbId, LimbLayout, LinkFrame, Pose, RobotLayout, UNITS_PER_METER,
};
use tabletop_kinematics::{
    ArmChain, Frames, Geometry, JointValues, LinkId, LinkShape, Load, ModelError, ModelJointId,
    MovingFrames, RobotModel,
};
use tabletop_physics::Convex;

use crate::look::{error::LookError, figure::figure_of};

/// How far a finger of a wide open gripper stands back, in units: more than the distance at which something counts as touched. So what
/// is as wide as the opening is not jammed between the fingers.
const PLAY: f32 = 0.015;

/// From this share of the widest opening on, fingers begin to stand back.
const ALMOST_OPEN: f32 = 0.99;

/// One number for every joint of the robot, by [`JointId`].
pub(crate) type Positions = SmallVec<[f64; 24]>;

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
    /// The radius of a ball about its origin that holds them, in units.
    pub radius: f32,
}

/// What carries a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Carrier {
    /// It is a link.
    Link(LinkId),
    /// It is a finger of a gripper, on this side of the opening: -1 left, 1 right. Its x points inwards.
    Gripper(LimbId, i8),
}

/// Where a body is along the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TreePosition {
    /// It does not move.
    Trunk,
    /// It turns with the neck.
    Head,
    /// So many joints of a limb carry it; fingers are carried by one more.
    Limb(LimbId, usize),
}

/// The robot's model, and what of it the simulator moves.
#[derive(Resource, Clone, Debug)]
pub(crate) struct Articulation {
    model: RobotModel,
    /// Its limbs and joints.
    pub layout: RobotLayout,
    /// The model's joints, by [`JointId`]; `None` for openings and a neck that the model lacks.
    joints: Vec<Option<ModelJointId>>,
    limbs: Vec<Limb>,
    /// The bodies.
    pub bodies: Vec<Body>,
}

/// What of the model a limb is.
#[derive(Clone, Debug)]
struct Limb {
    chain: ArmChain,
    /// What carries the end effector, and the end effector's frame there.
    end_effector: (LinkId, DAffine3),
    /// The links whose origins are tracked.
    trackers: Vec<LinkId>,
}

/// Where everything is at a moment.
#[derive(Clone, Debug)]
pub(crate) struct Posture {
    values: JointValues,
    links: MovingFrames,
    openings: SmallVec<[f64; 2]>,
    base: Pose,
    bodies: Vec<Pose>,
    end_effectors: Vec<Pose>,
}

impl Posture {
    /// Where the links are in the torso's frame, in m.
    pub const fn frames(&self) -> &Frames {
        self.links.frames()
    }

    /// Where the torso's frame stands, in units.
    pub const fn base(&self) -> Pose {
        self.base
    }

    /// Where the bodies are, by their numbers, in units.
    pub fn bodies(&self) -> &[Pose] {
        &self.bodies
    }

    /// Where the end effectors are, in units.
    pub fn end_effectors(&self) -> &[Pose] {
        &self.end_effectors
    }
}

impl Articulation {
    /// Finds the joints and links of a layout in a model.
    pub fn new(model: RobotModel, layout: RobotLayout) -> Result<Self, ModelError> {
        let joints = layout.joints.iter().map(|joint| match joint.role {
            JointRole::Limb { .. } => model.find_joint(joint.name.as_str()).map(Some),
            JointRole::Neck => Ok(model.find_joint(joint.name.as_str()).ok()),
            JointRole::Gripper(_) => Ok(None),
        });
        let joints = joints.collect::<Result<Vec<_>, _>>()?;
        let limbs = layout
            .limbs
            .iter()
            .map(|limb| Limb::new(&model, &layout, limb));
        let mut articulation = Self {
            limbs: limbs.collect::<Result<_, _>>()?,
            joints,
            bodies: Vec::new(),
            layout,
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
            body.radius = radius(&body.parts);
        }
        lacking
    }

    /// The model.
    pub const fn model(&self) -> &RobotModel {
        &self.model
    }

    /// The chain, with the limits of the layout, from the root to the link that carries an end effector, and the end effector's frame
    /// on that link.
    pub fn chain(&self, limb: LimbId) -> (&ArmChain, DAffine3) {
        let limb = &self.limbs[limb.index()];
        (&limb.chain, limb.end_effector.1)
    }

    /// The joint of the model that a joint of the robot is.
    pub fn joint(&self, joint: JointId) -> Option<ModelJointId> {
        self.joints.get(joint.index()).copied().flatten()
    }

    fn find_bodies(&self) -> Vec<Body> {
        let links = (0..self.model.links().len()).filter_map(|i| self.link_body(i));
        let fingers = self.layout.limb_ids().flat_map(|id| {
            let limb = self.layout.limb(id);
            let arm = limb.name;
            [("left", -1), ("right", 1)].map(|(name, side)| {
                let parts = vec![Convex {
                    pose: Pose::IDENTITY,
                    shape: cuboid(limb.gripper.finger),
                }];
                Body {
                    id: format!("{arm}-gripper-{name}-finger"),
                    name: format!("{name} finger of the {arm} gripper"),
                    carrier: Carrier::Gripper(id, side),
                    place: TreePosition::Limb(id, limb.joints.len() + 1),
                    radius: radius(&parts),
                    parts,
                }
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
        let parts: Vec<_> = link.collisions.iter().filter_map(convex).collect();
        Some(Body {
            id: link.name.clone(),
            name: link.name.replace('_', " "),
            carrier: Carrier::Link(id),
            place: self.place(id),
            radius: radius(&parts),
            parts,
        })
    }

    /// How far along the robot a link is.
    fn place(&self, link: LinkId) -> TreePosition {
        let carriers: Vec<_> = std::iter::successors(Some(link), |&link| self.model.parent(link))
            .filter_map(|link| self.model.link(link).joint)
            .collect();
        let is_carrier = |joint: &JointId| {
            self.joint(*joint)
                .is_some_and(|joint| carriers.contains(&joint))
        };
        if self.layout.neck.as_ref().is_some_and(is_carrier) {
            return TreePosition::Head;
        }
        self.layout
            .limb_ids()
            .find_map(|limb| {
                let joints = self.layout.limb(limb).joints.iter();
                let count = joints.filter(|joint| is_carrier(joint)).count();
                (count > 0).then_some(TreePosition::Limb(limb, count))
            })
            .unwrap_or(TreePosition::Trunk)
    }

    /// Where everything is when the joints are at these positions, by [`JointId`], and the torso's frame stands at `base`, in units.
    pub fn posture(&self, positions: &[f64], base: Pose) -> Posture {
        let mut values = self.model.zero();
        self.set_values(&mut values, positions);
        let mut posture = Posture {
            links: MovingFrames::new(&self.model, values.clone()),
            values,
            openings: self.openings(positions),
            base,
            bodies: vec![Pose::IDENTITY; self.bodies.len()],
            end_effectors: vec![Pose::IDENTITY; self.limbs.len()],
        };
        self.place_moved(&mut posture, |_| true);
        posture
    }

    /// Brings a posture to other positions of the joints.
    pub fn update(&self, posture: &mut Posture, positions: &[f64]) {
        self.set_values(&mut posture.values, positions);
        posture.links.move_to(&self.model, &posture.values);
        let openings = self.openings(positions);
        let before = std::mem::replace(&mut posture.openings, openings.clone());
        self.place_moved(posture, |limb| {
            before[limb.index()].to_bits() != openings[limb.index()].to_bits()
        });
    }

    fn set_values(&self, values: &mut JointValues, positions: &[f64]) {
        for (joint, position) in self.joints.iter().zip(positions) {
            if let Some(joint) = *joint {
                values[joint] = *position;
            }
        }
    }

    fn openings(&self, positions: &[f64]) -> SmallVec<[f64; 2]> {
        let limbs = self.layout.limbs.iter();
        limbs
            .map(|limb| positions[limb.gripper.joint.index()])
            .collect()
    }

    /// Places the bodies whose links have moved, and the fingers whose openings have changed.
    fn place_moved(&self, posture: &mut Posture, opens: impl Fn(LimbId) -> bool) {
        let Posture {
            links,
            openings,
            base,
            bodies,
            end_effectors,
            ..
        } = posture;
        for (limb, end_effector) in self.limbs.iter().zip(end_effectors.iter_mut()) {
            let (link, offset) = limb.end_effector;
            if links.has_moved(link) {
                *end_effector = *base * in_units(links.frames()[link] * offset);
            }
        }
        for (body, pose) in self.bodies.iter().zip(bodies) {
            match body.carrier {
                Carrier::Link(link) if links.has_moved(link) => {
                    *pose = *base * in_units(links.frames()[link]);
                }
                Carrier::Gripper(limb, side)
                    if opens(limb) || links.has_moved(self.limbs[limb.index()].end_effector.0) =>
                {
                    let finger = self.finger(limb, side, openings[limb.index()] as f32);
                    *pose = end_effectors[limb.index()] * finger;
                }
                Carrier::Link(_) | Carrier::Gripper(..) => {}
            }
        }
    }

    /// Where a finger is in its end effector's frame.
    fn finger(&self, limb: LimbId, side: i8, opening: f32) -> Pose {
        let gripper = &self.layout.limb(limb).gripper;
        let [_, widest] = self.layout.joint(gripper.joint).limits;
        let out = opening / 2.0 + play(opening, widest) + gripper.finger.x / 2.0;
        let inwards = if side < 0 { 0.0 } else { PI };
        Pose::new(
            Vec3::X * f32::from(side) * out,
            Quat::from_rotation_z(inwards),
        )
    }

    /// What the joints of a limb turn about: a point and a unit vector, in m in the torso's frame.
    pub fn axes(&self, limb: LimbId, posture: &Posture) -> Vec<(DVec3, DVec3)> {
        let joints = self.limbs[limb.index()].chain.joints().iter();
        joints
            .map(|&joint| {
                let joint = self.model.joint(joint);
                let frame = posture.frames()[joint.child];
                (frame.translation, frame.transform_vector3(joint.axis))
            })
            .collect()
    }

    /// Something that an end effector carries, at this pose in its frame, in units, with this mass in kg.
    pub fn load(&self, limb: LimbId, pose: Pose, mass: f64) -> Load {
        let (link, offset) = self.limbs[limb.index()].end_effector;
        Load {
            link,
            point: offset.transform_point3(pose.location.as_dvec3() / UNITS_PER_METER),
            mass,
        }
    }

    /// Where the origins of the tracked joints of a limb are.
    pub fn joint_origins(&self, limb: LimbId, posture: &Posture) -> impl Iterator<Item = Vec3> {
        let trackers = self.limbs[limb.index()].trackers.iter();
        trackers.map(|&link| {
            posture.base * (posture.frames()[link].translation * UNITS_PER_METER).as_vec3()
        })
    }
}

impl Limb {
    fn new(
        model: &RobotModel,
        layout: &RobotLayout,
        limb: &LimbLayout,
    ) -> Result<Self, ModelError> {
        let end_effector = frame_on(model, &limb.end_effector)?;
        let limits = limb.joints.iter().map(|&joint| layout.joint(joint).limits);
        let trackers = limb.trackers.iter().map(|&joint| {
            let joint = model.find_joint(layout.joint(joint).name.as_str())?;
            Ok(model.joint(joint).child)
        });
        let chain = ArmChain::new(model, model.root(), end_effector.0)?;
        for (i, &joint) in limb.joints.iter().enumerate() {
            let found = model.find_joint(layout.joint(joint).name.as_str())?;
            if chain.joints().get(i) != Some(&found) || chain.joints().len() != limb.joints.len() {
                return Err(ModelError::NoArm {
                    base: model.link(model.root()).name.clone(),
                    tip: model.link(end_effector.0).name.clone(),
                    reason: format!("its joints are not those of the limb {}", limb.name),
                });
            }
        }
        Ok(Self {
            chain: chain.with_limits(limits),
            end_effector,
            trackers: trackers.collect::<Result<_, _>>()?,
        })
    }
}

/// The first of these frames whose link the model has.
fn frame_on(model: &RobotModel, frames: &[LinkFrame]) -> Result<(LinkId, DAffine3), ModelError> {
    let mut missing = model.find_link("");
    for frame in frames {
        missing = model.find_link(&frame.link);
        if let Ok(link) = missing {
            let axes = DMat3::from_cols_array_2d(&frame.axes);
            let origin = DVec3::from_array(frame.at);
            return Ok((link, DAffine3::from_mat3_translation(axes, origin)));
        }
    }
    missing.map(|link| (link, DAffine3::IDENTITY))
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

/// The radius of a ball about the origin that holds these solids.
fn radius(parts: &[Convex]) -> f32 {
    let farthest = parts.iter().map(|part| {
        let ball = part.shape.compute_local_bounding_sphere();
        (part.pose * ball.center()).length() + ball.radius()
    });
    farthest.fold(0.0, f32::max)
}

fn cuboid(span: Vec3) -> SharedShape {
    SharedShape::cuboid(span.x / 2.0, span.y / 2.0, span.z / 2.0)
}

/// How far a finger stands back at an opening, in units.
fn play(opening: f32, widest: f64) -> f32 {
    let share = opening / widest as f32;
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
