//! The robot as a tree of bodies, and their poses.

use std::{
    collections::BTreeSet,
    f32::consts::{FRAC_PI_2, PI},
};

use bevy::{
    math::{DAffine3, DMat3, DQuat, DVec3},
    prelude::*,
};
use bevy_rapier3d::rapier::prelude::SharedShape;
use smallvec::SmallVec;
use tabletop_core::{HandCamera, JointId, JointRole, LimbId, LimbLayout, LinkFrame, RobotLayout};
use tabletop_geometry::{Pose, UNITS_PER_METER};
use tabletop_kinematics::{
    ArmChain, Frames, Geometry, JointValues, LinkId, LinkShape, Load, ModelError, ModelJointId,
    MovingFrames, RobotModel,
};
use tabletop_physics::Convex;

use crate::{
    look::{error::LookError, figure::figure_of},
    source::DescriptionSource,
};

/// Distance, in units, by which a finger of a wide open gripper stands back: more than the distance at which things touch. So an object
/// as wide as the opening is not jammed between the fingers.
const PLAY: f32 = 0.015;

/// Share of the widest opening from which fingers begin to stand back.
const ALMOST_OPEN: f32 = 0.99;

/// One number for every joint of the robot, by [`JointId`].
pub type Positions = SmallVec<[f64; 24]>;

/// A rigid part of the robot.
#[derive(Clone, Debug)]
pub struct Body {
    /// The link's name in the description; for fingers `left-gripper-right-finger`.
    pub id: String,
    /// Its name.
    pub name: String,
    /// Its carrier.
    pub carrier: Carrier,
    /// Its position along the robot: bodies near each other there cannot collide.
    pub place: TreePosition,
    /// Its solids, in its own frame.
    pub parts: Vec<Convex>,
    /// Radius of the ball about its origin that encloses them, in units.
    pub radius: f32,
}

/// The carrier of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carrier {
    /// It is a link.
    Link(LinkId),
    /// It is a finger of a gripper, on this side of the opening: -1 left, 1 right. Its x points inwards.
    Gripper(LimbId, i8),
}

/// The position of a body along the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TreePosition {
    /// The body does not move.
    Trunk,
    /// The body turns with the neck.
    Head,
    /// The number of a limb's joints that carry the body, and one more for a finger.
    Limb(LimbId, usize),
}

/// The robot's model, and the parts of it that the simulator moves.
#[derive(Resource, Clone, Debug)]
pub struct Articulation {
    model: RobotModel,
    /// Its limbs and joints.
    pub layout: RobotLayout,
    /// The model's joints, by [`JointId`]; `None` for openings and a neck that the model lacks.
    joints: Vec<Option<ModelJointId>>,
    limbs: Vec<Limb>,
    /// The bodies.
    pub bodies: Vec<Body>,
    /// The cameras on its links.
    pub hand_cameras: Vec<HandCamera>,
}

/// The model's part of a limb.
#[derive(Clone, Debug)]
struct Limb {
    chain: ArmChain,
    /// The link that carries the end effector, and the end effector's frame on it.
    end_effector: (LinkId, DAffine3),
    /// The links whose origins are tracked.
    trackers: Vec<LinkId>,
}

/// The line about which a joint turns, or along which it slides.
#[derive(Clone, Copy, Debug)]
pub struct JointAxis {
    origin: DVec3,
    direction: DVec3,
    turns: bool,
}

impl JointAxis {
    /// The motion of a point that the joint carries, in m per rad or m of the joint.
    pub fn motion_of(&self, point: DVec3) -> DVec3 {
        match self.turns {
            true => self.direction.cross(point - self.origin),
            false => self.direction,
        }
    }
}

/// The posture of the robot: the frames of its links and the poses of its bodies.
#[derive(Clone, Debug)]
pub struct Posture {
    positions: Positions,
    values: JointValues,
    links: MovingFrames,
    base: Pose,
    bodies: Vec<Pose>,
    end_effectors: Vec<Pose>,
}

impl Posture {
    /// Frames of the links, from the torso's frame, in m.
    pub const fn frames(&self) -> &Frames {
        self.links.frames()
    }

    /// Pose of the torso's frame, in units.
    pub const fn base(&self) -> Pose {
        self.base
    }

    /// Poses of the bodies, by their numbers, in units.
    pub fn bodies(&self) -> &[Pose] {
        &self.bodies
    }

    /// Poses of the end effectors, in units.
    pub fn end_effectors(&self) -> &[Pose] {
        &self.end_effectors
    }
}

impl Articulation {
    /// Finds the joints and links of a layout in a model.
    pub fn new(model: RobotModel, layout: RobotLayout) -> Result<Self, ModelError> {
        let joints = layout.joints.iter().map(|joint| match joint.role {
            JointRole::Limb { .. } => model.find_joint(&joint.urdf_name).map(Some),
            JointRole::Neck => Ok(model.find_joint(&joint.urdf_name).ok()),
            JointRole::Gripper(_) => Ok(None),
        });
        let joints = joints.collect::<Result<Vec<_>, _>>()?;
        let limbs = layout
            .limbs
            .iter()
            .map(|limb| Limb::new(&model, &layout, limb));
        let cameras = layout.hand_cameras.iter();
        let cameras = cameras.map(|camera| Ok(camera.on(first_there(&model, &camera.frame)?.1)));
        let mut articulation = Self {
            limbs: limbs.collect::<Result<_, _>>()?,
            hand_cameras: cameras.collect::<Result<_, _>>()?,
            joints,
            bodies: Vec::new(),
            layout,
            model,
        };
        articulation.bodies = articulation.find_bodies();
        Ok(articulation)
    }

    /// Adds the convex hulls of the meshes that are the links' collision shapes, as coarse as the head camera sees them. `source` is where
    /// the description was read from. Returns the failures, each with the link that lacks the mesh.
    pub fn add_meshes(&mut self, source: Option<&DescriptionSource>) -> Vec<(String, LookError)> {
        let mut lacking = Vec::new();
        for body in &mut self.bodies {
            let Carrier::Link(link) = body.carrier else {
                continue;
            };
            for collision in &self.model.link(link).collisions {
                if let Geometry::Mesh { file, .. } = &collision.geometry {
                    match hull_of(collision, file, source) {
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

    /// The chain, with the limits of the layout, from the root to the link that carries the end effector, and the end effector's frame
    /// on that link.
    pub fn chain(&self, limb: LimbId) -> (&ArmChain, DAffine3) {
        let limb = &self.limbs[limb.index()];
        (&limb.chain, limb.end_effector.1)
    }

    /// The model's joint for a joint of the robot.
    pub fn joint(&self, joint: JointId) -> Option<ModelJointId> {
        self.joints.get(joint.index()).copied().flatten()
    }

    fn find_bodies(&self) -> Vec<Body> {
        let limbs = self.layout.limb_ids();
        let own: BTreeSet<_> = limbs
            .flat_map(|limb| [-1, 1].map(|side| self.own_finger(limb, side)))
            .flatten()
            .collect();
        let links = self
            .model
            .all_on(self.model.root())
            .into_iter()
            .filter_map(|link| self.link_body(link, &own));
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

    /// The body of a link; `None` for mere frames, and for a description's fingers, which the simulator replaces.
    fn link_body(&self, id: LinkId, fingers: &BTreeSet<LinkId>) -> Option<Body> {
        let link = self.model.link(id);
        let is_frame = link.collisions.is_empty() && link.visuals.is_empty();
        if is_frame || fingers.contains(&id) || link.name.contains("_finger") {
            return None;
        }
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

    /// The position of a link along the robot.
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

    /// The posture at these positions of the joints, by [`JointId`], with the torso's frame at `base`, in units.
    pub fn posture(&self, positions: &[f64], base: Pose) -> Posture {
        let mut values = self.model.zero();
        self.set_values(&mut values, positions);
        let mut posture = Posture {
            positions: Positions::from_slice(positions),
            links: MovingFrames::new(&self.model, values.clone()),
            values,
            base,
            bodies: vec![Pose::IDENTITY; self.bodies.len()],
            end_effectors: vec![Pose::IDENTITY; self.limbs.len()],
        };
        self.place_moved(&mut posture, |_| true);
        posture
    }

    /// Brings a posture to other positions of the joints.
    pub fn update(&self, posture: &mut Posture, positions: &[f64]) {
        let is_same = |(before, now): (&f64, &f64)| before.to_bits() == now.to_bits();
        if posture.positions.iter().zip(positions).all(is_same) {
            return;
        }
        let before = std::mem::replace(&mut posture.positions, Positions::from_slice(positions));
        self.set_values(&mut posture.values, positions);
        posture.links.move_to(&self.model, &posture.values);
        self.place_moved(posture, |joint| {
            let [before, now] = [&before, positions].map(|positions| positions[joint.index()]);
            before.to_bits() != now.to_bits()
        });
    }

    fn set_values(&self, values: &mut JointValues, positions: &[f64]) {
        for (joint, position) in self.joints.iter().zip(positions) {
            if let Some(joint) = *joint {
                values[joint] = *position;
            }
        }
    }

    /// Places the bodies whose links have moved, and the fingers whose joints have changed.
    fn place_moved(&self, posture: &mut Posture, has_changed: impl Fn(JointId) -> bool) {
        let Posture {
            positions,
            links,
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
                Carrier::Gripper(limb, side) => {
                    let joint = self.layout.limb(limb).gripper.joint;
                    let end_effector = self.limbs[limb.index()].end_effector.0;
                    if has_changed(joint) || links.has_moved(end_effector) {
                        let finger = self.finger(limb, side, positions[joint.index()] as f32);
                        *pose = end_effectors[limb.index()] * finger;
                    }
                }
                Carrier::Link(_) => {}
            }
        }
    }

    /// Pose of a finger in the frame of its end effector.
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

    /// The links that the layout says a finger is, with all that hangs on them; `side` is -1 for the left one, 1 for the right one.
    fn own_finger(&self, limb: LimbId, side: i8) -> Vec<LinkId> {
        let [left, right] = &self.layout.limb(limb).gripper.fingers;
        let names = if side < 0 { left } else { right };
        let links = names.iter().flat_map(|name| self.model.find_link(name));
        links.flat_map(|link| self.model.all_on(link)).collect()
    }

    /// The same links, each with its frame in the finger's, in m, where the gripper is closed: the joints that slide fingers have half of the
    /// opening, those that turn them are at 0.
    pub(crate) fn finger_links(&self, limb: LimbId, side: i8) -> Vec<(LinkId, DAffine3)> {
        let gripper = &self.layout.limb(limb).gripper;
        let [closed, _] = self.layout.joint(gripper.joint).limits;
        let mut configuration = self.model.zero();
        let joints = gripper.finger_joints.iter();
        for joint in joints.flat_map(|name| self.model.find_joint(name)) {
            configuration[joint] = closed / UNITS_PER_METER / 2.0;
        }
        let frames = self.model.frames(&configuration);
        let (link, end_effector) = self.limbs[limb.index()].end_effector;
        let finger = in_meters(self.finger(limb, side, closed as f32));
        let to_finger = (frames[link] * end_effector * finger).inverse();
        let links = self.own_finger(limb, side).into_iter();
        links.map(|link| (link, to_finger * frames[link])).collect()
    }

    /// The axes of a limb's joints, in m in the torso's frame.
    pub fn axes(&self, limb: LimbId, posture: &Posture) -> Vec<JointAxis> {
        let joints = self.limbs[limb.index()].chain.joints().iter();
        joints
            .map(|&joint| {
                let joint = self.model.joint(joint);
                let frame = posture.frames()[joint.child];
                JointAxis {
                    origin: frame.translation,
                    direction: frame.transform_vector3(joint.axis),
                    turns: joint.kind.turns(),
                }
            })
            .collect()
    }

    /// The load of an object that the end effector carries at this pose in its frame, in units, with this mass in kg.
    pub fn load(&self, limb: LimbId, pose: Pose, mass: f64) -> Load {
        let (link, offset) = self.limbs[limb.index()].end_effector;
        Load {
            link,
            point: offset.transform_point3(pose.location.as_dvec3() / UNITS_PER_METER),
            mass,
        }
    }

    /// Origins of a limb's tracked joints.
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
            let joint = model.find_joint(&layout.joint(joint).urdf_name)?;
            Ok(model.joint(joint).child)
        });
        let chain = ArmChain::new(model, model.root(), end_effector.0)?;
        for (i, &joint) in limb.joints.iter().enumerate() {
            let found = model.find_joint(&layout.joint(joint).urdf_name)?;
            if chain.joints().get(i) != Some(&found) || chain.joints().len() != limb.joints.len() {
                return Err(ModelError::NoArm {
                    base: model.link(model.root()).name.clone(),
                    tip: model.link(end_effector.0).name.clone(),
                    reason: format!(
                        "the joints between them are {}: these are the limb {}, in this order, unless some stand `still`",
                        names(model, chain.joints()),
                        limb.name
                    ),
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

/// The names of joints, as a message lists them.
fn names(model: &RobotModel, joints: &[ModelJointId]) -> String {
    let names = joints.iter().map(|&joint| &*model.joint(joint).name);
    names.collect::<Vec<_>>().join(", ")
}

/// The first of these frames whose link the model has, and the link.
fn first_there<'f>(
    model: &RobotModel,
    frames: &'f [LinkFrame],
) -> Result<(LinkId, &'f LinkFrame), ModelError> {
    let found = frames
        .iter()
        .map(|frame| Ok((model.find_link(&frame.link)?, frame)));
    found.reduce(Result::or).unwrap_or(Err(ModelError::Empty))
}

/// The first of these frames whose link the model has.
fn frame_on(model: &RobotModel, frames: &[LinkFrame]) -> Result<(LinkId, DAffine3), ModelError> {
    let (link, frame) = first_there(model, frames)?;
    let axes = DMat3::from_cols_array_2d(&frame.axes);
    let origin = DVec3::from_array(frame.at);
    Ok((link, DAffine3::from_mat3_translation(axes, origin)))
}

/// A frame of the model as a pose in units.
pub fn in_units(frame: DAffine3) -> Pose {
    let rotation = DQuat::from_mat3(&frame.matrix3).normalize();
    Pose::new(
        (frame.translation * UNITS_PER_METER).as_vec3(),
        rotation.as_quat(),
    )
}

/// A pose in units as a frame of the model.
pub fn in_meters(pose: Pose) -> DAffine3 {
    DAffine3::from_rotation_translation(
        pose.rotation.as_dquat().normalize(),
        pose.location.as_dvec3() / UNITS_PER_METER,
    )
}

/// Radius of the ball about the origin that encloses these solids.
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

/// Distance by which a finger stands back at an opening, in units.
fn play(opening: f32, widest: f64) -> f32 {
    let share = opening / widest as f32;
    PLAY * ((share - ALMOST_OPEN) / (1.0 - ALMOST_OPEN)).clamp(0.0, 1.0)
}

/// The convex hull of a mesh, in the frame of the link whose collision shape it is.
fn hull_of(
    mesh: &LinkShape,
    file: &str,
    source: Option<&DescriptionSource>,
) -> Result<Convex, LookError> {
    let points = &figure_of(mesh, source)?.coarse.positions;
    let hull = SharedShape::convex_hull(points);
    let shape = hull.ok_or_else(|| LookError::Empty { path: file.into() })?;
    Ok(Convex {
        pose: Pose::IDENTITY,
        shape,
    })
}

/// The solid of a link's collision geometry, in the link's frame. For a mesh, see [`hull_of`].
fn convex(shape: &LinkShape) -> Option<Convex> {
    let origin = in_units(shape.origin);
    let scale = UNITS_PER_METER as f32;
    Some(match &shape.geometry {
        Geometry::Box { size } => Convex {
            pose: origin,
            shape: cuboid(size.as_vec3() * scale),
        },
        Geometry::Cylinder { radius, length } => Convex {
            // It lies along z there, along y here.
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
