//! The robot's body, as planning uses it.

use bevy::math::{DAffine3, DMat3, DQuat, DVec3, Quat, Vec3};
use tabletop_controller::{Angles, angles};
use tabletop_core::{LimbLayout, LinkFrame, RobotLayout, Table};
use tabletop_geometry::{PlacedSolid, Pose, Solid, UNITS_PER_METER};
use tabletop_kinematics::{
    ArmChain, Frames, Geometry, JointValues, LinkId, LinkShape, MOST_ARM_JOINTS, ModelError,
    RobotModel, Target,
};

use crate::{arm_length::ArmLength, guarded_gaps::GuardedGaps, reach::reaches};

/// A robot: its links, limbs and grippers.
#[derive(Clone, Debug)]
pub struct RobotBody {
    model: RobotModel,
    base: Pose,
    /// Its limbs.
    pub limbs: Vec<LimbBody>,
    links: Vec<LinkBody>,
    /// Pairs of links that cannot meet, or whose solids overlap anyway.
    apart: Vec<(usize, usize)>,
    /// The solids that no limb moves.
    trunk: Vec<LinkSolid>,
    pub(crate) guarded_gaps: GuardedGaps,
}

/// An arm with its gripper.
#[derive(Clone, Debug)]
pub struct LimbBody {
    /// Its name.
    pub name: String,
    chain: ArmChain,
    length: ArmLength,
    end_effector: DAffine3,
    /// Extents of a finger, in units, in the end effector's frame.
    pub finger: Vec3,
    /// Largest opening of its gripper, in units.
    pub widest: f32,
    /// Speeds of its joints, in rad/s or m/s.
    pub speeds: Angles,
    /// Its angles at the beginning.
    pub home: Angles,
    /// The solids that its joints carry.
    solids: Vec<CarriedSolid>,
    /// How far the points of each of its parts, the fingers last, can be from each joint's axis, in units; for joints that slide, units for each m.
    reaches: Vec<Angles>,
}

/// A solid that a joint of a limb turns.
#[derive(Clone, Debug)]
struct CarriedSolid {
    link: usize,
    joint: usize,
    /// Its pose in the joint's frame, in units.
    pose: Pose,
    solid: Solid,
}

/// A solid of a link, with its pose.
#[derive(Clone, Debug)]
pub(crate) struct LinkSolid {
    pub link: usize,
    pub solid: PlacedSolid,
}

/// A link that can be touched.
#[derive(Clone, Debug)]
struct LinkBody {
    link: LinkId,
    /// The limb that moves it, and the number of joints that do.
    carrier: Option<(usize, usize)>,
    solids: Vec<(Pose, Solid)>,
}

/// Number of postures from which a pose is tried.
const STARTS: usize = 24;
/// Number of postures from which one of many poses is tried.
const FEW_STARTS: usize = 5;
/// Share of the motors' speed that joints use.
const SHARE_OF_SPEED: f64 = 0.75;

impl LimbBody {
    fn new<'l>(
        layout: &RobotLayout,
        limb: &'l LimbLayout,
        model: &RobotModel,
    ) -> Result<Self, ModelError> {
        let found = |frame: &'l LinkFrame| Some((frame, model.find_link(&frame.link).ok()?));
        let (frame, tip) = match limb.end_effector.iter().find_map(found) {
            Some(found) => found,
            None => {
                return Err(ModelError::NoSuchLink {
                    robot: layout.name.clone(),
                    link: format!("of an end effector of limb {}", limb.name),
                });
            }
        };
        let axes = frame.axes.map(DVec3::from_array);
        let joints = limb.joints.iter().map(|&joint| layout.joint(joint));
        let joints: Vec<_> = joints.collect();
        let chain = ArmChain::new(model, model.root(), tip)?;
        Ok(Self {
            name: limb.name.to_string(),
            length: ArmLength::of(&chain, joints.iter().map(|joint| joint.home)),
            chain: chain.with_limits(joints.iter().map(|joint| joint.limits)),
            end_effector: DAffine3::from_mat3_translation(
                DMat3::from_cols(axes[0], axes[1], axes[2]),
                DVec3::from_array(frame.at),
            ),
            finger: limb.gripper.finger,
            widest: layout.joint(limb.gripper.joint).limits[1] as f32,
            speeds: angles(joints.iter().map(|joint| match joint.speed > 0.0 {
                true => joint.speed * SHARE_OF_SPEED,
                false => joint.manual_speed(),
            })),
            home: angles(joints.iter().map(|joint| joint.home)),
            solids: Vec::new(),
            reaches: Vec::new(),
        })
    }

    /// How far the points of each of its parts, the fingers last, can be from each joint's axis, in units; for joints that slide, units for each m.
    pub(crate) fn reaches(&self) -> &[Angles] {
        &self.reaches
    }

    /// Finds out how far its points can be from its joints' axes.
    fn measure(&mut self) {
        let joints = 0..self.chain.joints().len();
        let frames: Vec<_> = self.chain.frames(self.own(&self.home)).collect();
        let turns: Vec<_> = joints.map(|joint| self.chain.turns(joint)).collect();
        // How far each joint is from the one before, wherever that slides.
        let offsets = (0..frames.len()).map(|joint| {
            let before = joint.checked_sub(1);
            let from = before.map_or(DVec3::ZERO, |before| frames[before].translation);
            let slides = match turns[joint] {
                true => 0.0,
                false => self.limits()[joint]
                    .into_iter()
                    .map(f64::abs)
                    .fold(0.0, f64::max),
            };
            (from.distance(frames[joint].translation) + slides) * UNITS_PER_METER
        });
        let offsets: Vec<_> = offsets.collect();
        let last = frames.len() - 1;
        let tip = in_units(frames[last]).inverse()
            * in_units(self.chain.tip(self.own(&self.home)) * self.end_effector);
        let hand = tip.location.length() + self.finger.length() + self.widest;
        let solids = self.solids.iter().map(|part| {
            let placed = PlacedSolid {
                pose: part.pose,
                solid: part.solid.clone(),
            };
            (
                part.joint,
                f64::from(part.pose.location.length() + placed.radius()),
            )
        });
        let fingers = [(last, f64::from(hand)); 2];
        let carried: Vec<_> = solids.chain(fingers).collect();
        self.reaches = reaches(&offsets, &turns, &carried);
    }

    /// Least and largest angle of each joint, in rad.
    pub fn limits(&self) -> &[[f64; 2]] {
        self.chain.limits()
    }

    /// The angles of the joints that it has.
    fn own<'a>(&self, angles: &'a Angles) -> &'a [f64] {
        &angles[..self.chain.joints().len()]
    }
}

impl RobotBody {
    /// The size of its largest hand, as a part of that for which the distances of this crate are meant: one that opens by 2 units.
    pub(crate) fn hand_size(&self) -> f32 {
        let openings = self.limbs.iter().map(|limb| limb.widest);
        openings.fold(0.0, f32::max) / 2.0
    }

    /// The robot of this layout and model, at this table.
    ///
    /// # Errors
    /// The model does not have the layout's limbs.
    pub fn new(layout: &RobotLayout, model: RobotModel, table: &Table) -> Result<Self, ModelError> {
        let limbs: Result<Vec<_>, ModelError> = layout
            .limbs
            .iter()
            .map(|limb| LimbBody::new(layout, limb, &model))
            .collect();
        let limbs = limbs?;
        // The simulator's fingers stand in for those of the description.
        let is_finger = |name: &String| {
            let grippers = layout.limbs.iter().map(|limb| &limb.gripper);
            name.contains("_finger")
                || grippers
                    .flat_map(|it| it.fingers.iter().flatten())
                    .any(|own| own == name)
        };
        let links = model.links().iter().filter_map(|link| {
            let solids: Vec<_> = link.collisions.iter().filter_map(solid).collect();
            if solids.is_empty() || is_finger(&link.name) {
                return None;
            }
            let id = model.find_link(&link.name).ok()?;
            Some(LinkBody {
                carrier: carrier(&model, &limbs, id),
                link: id,
                solids,
            })
        });
        let mut body = Self {
            links: links.collect(),
            apart: Vec::new(),
            trunk: Vec::new(),
            guarded_gaps: GuardedGaps::NONE,
            base: layout.base.pose(table),
            limbs,
            model,
        };
        body.apart = body.always_together();
        body.trunk = body.found_trunk();
        body.carry();
        for limb in &mut body.limbs {
            limb.measure();
        }
        Ok(body)
    }

    /// The same robot, whose guard keeps these gaps.
    #[must_use]
    pub const fn guarded(mut self, gaps: GuardedGaps) -> Self {
        self.guarded_gaps = gaps;
        self
    }

    /// Finds the solids that each joint carries.
    fn carry(&mut self) {
        let mut frames = Frames::default();
        let zero = self.model.zero();
        self.model.frames_into(&zero, &mut frames);
        for (number, link) in self.links.iter().enumerate() {
            let Some((limb, count)) = link.carrier else {
                continue;
            };
            let limb = &mut self.limbs[limb];
            let joints: Vec<_> = limb.chain.frames(&Angles::default()).collect();
            let frame = joints[count - 1].inverse() * frames[link.link];
            let solids = link.solids.iter().map(|(pose, solid)| CarriedSolid {
                link: number,
                joint: count - 1,
                pose: in_units(frame) * *pose,
                solid: solid.clone(),
            });
            limb.solids.extend(solids);
        }
    }

    /// Pairs of links that touch at home, or are neighbours.
    fn always_together(&self) -> Vec<(usize, usize)> {
        let home: Vec<_> = self.limbs.iter().map(|limb| limb.home).collect();
        let solids = self.links_at(&home);
        let mut pairs = Vec::new();
        for a in 0..self.links.len() {
            for b in a + 1..self.links.len() {
                let near = match (self.links[a].carrier, self.links[b].carrier) {
                    (Some((one, i)), Some((other, j))) => one == other && i.abs_diff(j) < 3,
                    (None, Some((_, place))) | (Some((_, place)), None) => place < 3,
                    (None, None) => true,
                };
                let touch = || {
                    solids[a]
                        .iter()
                        .any(|one| solids[b].iter().any(|other| one.is_within(0.1, other)))
                };
                if near || touch() {
                    pairs.push((a, b));
                }
            }
        }
        pairs
    }

    fn values(&self, angles: &[Angles]) -> JointValues {
        let mut values = self.model.zero();
        for (limb, angles) in self.limbs.iter().zip(angles) {
            limb.chain.set_angles(limb.own(angles), &mut values);
        }
        values
    }

    fn found_trunk(&self) -> Vec<LinkSolid> {
        let home: Vec<_> = self.limbs.iter().map(|limb| limb.home).collect();
        let links = self.links_at(&home).into_iter().enumerate();
        links
            .filter(|(link, _)| self.links[*link].carrier.is_none())
            .flat_map(|(link, solids)| {
                solids
                    .into_iter()
                    .map(move |solid| LinkSolid { link, solid })
            })
            .collect()
    }

    /// The solids that no limb moves.
    pub(crate) fn trunk(&self) -> &[LinkSolid] {
        &self.trunk
    }

    /// The solids of each link at these angles of the limbs, in the table's frame.
    fn links_at(&self, angles: &[Angles]) -> Vec<Vec<PlacedSolid>> {
        let mut frames = Frames::default();
        self.model.frames_into(&self.values(angles), &mut frames);
        let placed = self.links.iter().map(|link| {
            let frame = self.base * in_units(frames[link.link]);
            let solids = link.solids.iter();
            solids
                .map(|(pose, solid)| PlacedSolid {
                    pose: frame * *pose,
                    solid: solid.clone(),
                })
                .collect()
        });
        placed.collect()
    }

    /// The solids of everything but this limb, at these angles of all limbs.
    pub(crate) fn rest(&self, limb: usize, angles: &[Angles]) -> Vec<LinkSolid> {
        let links = self.links_at(angles).into_iter().enumerate();
        links
            .filter(|(link, _)| !self.is_of(*link, limb))
            .flat_map(|(link, solids)| {
                let solids = solids.into_iter();
                solids.map(move |solid| LinkSolid { link, solid })
            })
            .collect()
    }

    /// The solids of its links when it begins.
    pub fn at_home(&self) -> Vec<PlacedSolid> {
        let home: Vec<_> = self.limbs.iter().map(|limb| limb.home).collect();
        let links = self.links_at(&home).into_iter().flatten();
        let fingers = (0..self.limbs.len()).flat_map(|limb| {
            let end_effector = self.end_effector(limb, &home[limb]);
            self.fingers(limb, end_effector, self.limbs[limb].widest)
        });
        links.chain(fingers).collect()
    }

    fn is_of(&self, link: usize, limb: usize) -> bool {
        self.links[link].carrier.is_some_and(|(own, _)| own == limb)
    }

    /// The solids of a limb at these angles.
    pub(crate) fn own(&self, limb: usize, angles: &Angles, solids: &mut Vec<LinkSolid>) {
        let limb = &self.limbs[limb];
        let mut frames = [Pose::IDENTITY; MOST_ARM_JOINTS];
        for (frame, joint) in frames.iter_mut().zip(limb.chain.frames(limb.own(angles))) {
            *frame = self.base * in_units(joint);
        }
        solids.clear();
        solids.extend(limb.solids.iter().map(|part| LinkSolid {
            link: part.link,
            solid: PlacedSolid {
                pose: frames[part.joint] * part.pose,
                solid: part.solid.clone(),
            },
        }));
    }

    /// True if a link of a limb can collide with its surroundings: the first two joints move only parts beside the trunk.
    pub(crate) fn is_far_out(&self, link: usize) -> bool {
        self.links[link].carrier.is_some_and(|(_, place)| place > 2)
    }

    /// True if two links can meet.
    pub(crate) fn can_meet(&self, one: usize, other: usize) -> bool {
        one != other && !self.apart.contains(&(one.min(other), one.max(other)))
    }

    /// The fingers of a limb, for an end effector at this pose and this opening of the gripper.
    pub(crate) fn fingers(
        &self,
        limb: usize,
        end_effector: Pose,
        opening: f32,
    ) -> [PlacedSolid; 2] {
        let finger = self.limbs[limb].finger;
        [-1.0, 1.0].map(|side| PlacedSolid {
            pose: end_effector * Pose::at(Vec3::X * side * (opening + finger.x) / 2.0),
            solid: Solid::Cuboid(finger),
        })
    }

    /// Pose of a limb's end effector, in the table's frame.
    pub fn end_effector(&self, limb: usize, angles: &Angles) -> Pose {
        let limb = &self.limbs[limb];
        self.base * in_units(limb.chain.tip(limb.own(angles)) * limb.end_effector)
    }

    /// Angles that bring a limb's end effector to this pose; of several solutions, one near the seed.
    pub fn reach(&self, limb: usize, pose: Pose, seed: &Angles) -> Option<Angles> {
        self.solve(limb, pose, seed, STARTS)
    }

    /// The same, if a short search finds it.
    pub(crate) fn reach_soon(&self, limb: usize, pose: Pose, seed: &Angles) -> Option<Angles> {
        self.solve(limb, pose, seed, FEW_STARTS)
    }

    /// The same, if the search from the seed alone finds it.
    pub(crate) fn reach_from(&self, limb: usize, pose: Pose, seed: &Angles) -> Option<Angles> {
        self.solve(limb, pose, seed, 1)
    }

    fn solve(&self, limb: usize, pose: Pose, seed: &Angles, starts: usize) -> Option<Angles> {
        let limb = &self.limbs[limb];
        let target = in_meters(self.base.inverse() * pose) * limb.end_effector.inverse();
        // For a target beyond the arm's length, the search would take long to fail.
        if limb.length.excludes(&target) {
            return None;
        }
        let solved = limb
            .chain
            .solve_from(&Target::Pose(target), limb.own(seed), starts)
            .ok()?;
        let mut angles = Angles::default();
        angles[..solved.len()].copy_from_slice(&solved);
        Some(angles)
    }
}

/// The limb whose joints move a link, and their number.
fn carrier(model: &RobotModel, limbs: &[LimbBody], link: LinkId) -> Option<(usize, usize)> {
    let carriers: Vec<_> = std::iter::successors(Some(link), |&link| model.parent(link))
        .filter_map(|link| model.link(link).joint)
        .collect();
    limbs.iter().enumerate().find_map(|(i, limb)| {
        let own = limb
            .chain
            .joints()
            .iter()
            .filter(|joint| carriers.contains(joint));
        let count = own.count();
        (count > 0).then_some((i, count))
    })
}

/// A body of a link as a solid; `None` for a mesh.
fn solid(shape: &LinkShape) -> Option<(Pose, Solid)> {
    let pose = in_units(shape.origin);
    let units = |meters: f64| (meters * UNITS_PER_METER) as f32;
    match shape.geometry {
        Geometry::Box { size } => Some((pose, Solid::Cuboid((size * UNITS_PER_METER).as_vec3()))),
        Geometry::Cylinder { radius, length } => Some((
            // A cylinder of ours lies along y.
            pose * Pose::new(
                Vec3::ZERO,
                Quat::from_rotation_x(std::f32::consts::FRAC_PI_2),
            ),
            Solid::Cylinder {
                radius: units(radius),
                yspan: units(length),
            },
        )),
        Geometry::Sphere { radius } => Some((pose, Solid::Ball(units(radius)))),
        Geometry::Mesh { .. } => None,
    }
}

fn in_units(frame: DAffine3) -> Pose {
    let rotation = DQuat::from_mat3(&frame.matrix3).normalize();
    Pose::new(
        (frame.translation * UNITS_PER_METER).as_vec3(),
        rotation.as_quat(),
    )
}

fn in_meters(pose: Pose) -> DAffine3 {
    DAffine3::from_rotation_translation(
        pose.rotation.as_dquat().normalize(),
        pose.location.as_dvec3() / UNITS_PER_METER,
    )
}
