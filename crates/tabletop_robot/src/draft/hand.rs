//! The hand of a limb: where its fingers meet, and how far they open.

use std::collections::BTreeMap;

use bevy::math::{DAffine3, DMat3, DVec3};
use tabletop_geometry::UNITS_PER_METER;
use tabletop_kinematics::{Frames, JointType, JointValues, LinkId, ModelJointId, RobotModel};

use super::anatomy::Branch;
use crate::{DescriptionSource, look::figure::figure_of};

/// Words in the names of links that are frames between fingers or at a tool, the surest first.
const TOOL_LINKS: [&str; 10] = [
    "tcp", "grasp", "pinch", "effector", "eef", "ee", "tool0", "tool", "tip", "frame",
];

/// Longest finger that is taken to touch things, in m.
const LONGEST_PAD: f64 = 0.05;

/// Farthest that a jaw is taken to turn open, in rad.
const WIDEST_TURN: f64 = 1.2;

/// The points of a jaw that are its tip: at least this share of the longest way from its hinge.
const TIP: f64 = 0.9;

/// Least cosine of the angle between two directions that are meant to be the same.
const SAME: f64 = 0.985;

/// A gripper where the description has none: extents of a finger in units, and the way from the flange to its middle in m.
const PLAIN_FINGER: DVec3 = DVec3::new(0.15, 0.2, 0.5);
const PLAIN_REACH: f64 = 0.08;

/// The end effector of a limb and its gripper.
pub(super) struct DraftHand {
    /// The link that carries the end effector.
    pub link: String,
    /// The end effector's origin on it, in m.
    pub at: DVec3,
    /// The end effector's axes on it.
    pub axes: DMat3,
    /// Least and largest opening, in units; `None` if the description does not tell.
    pub opening: Option<[f64; 2]>,
    /// Extents of a finger, in units.
    pub finger: DVec3,
    /// The links that the left and the right finger are.
    pub fingers: [Vec<String>; 2],
    /// The joints that slide the fingers.
    pub finger_joints: Vec<String>,
}

impl DraftHand {
    /// The hand at the end of a branch.
    pub fn of(model: &RobotModel, source: &DescriptionSource, branch: &Branch) -> Option<Self> {
        let wrist = *branch.joints.last()?;
        let palm = model.joint(wrist).child;
        let rigid = model.rigidly_on(palm);
        let roots = branch.fingers.iter().copied();
        let roots = roots.filter(|&joint| rigid.contains(&model.joint(joint).parent));
        let roots: Vec<_> = roots.collect();
        let seeker = Seeker {
            clouds: clouds(model, source, palm, &rigid),
            model,
            wrist,
            palm,
            rigid,
            fingers: &branch.fingers,
            roots,
        };
        Some(match seeker.roots.is_empty() {
            true => seeker.flange(),
            false => seeker.gripper(),
        })
    }
}

/// The points of the shapes of all links on a palm, in m, in the links' frames; the origin of a link of a finger without shapes.
fn clouds(
    model: &RobotModel,
    source: &DescriptionSource,
    palm: LinkId,
    rigid: &[LinkId],
) -> BTreeMap<LinkId, Vec<DVec3>> {
    let cloud = |id: LinkId| {
        let link = model.link(id);
        let shapes = match link.collisions.is_empty() {
            true => &link.visuals,
            false => &link.collisions,
        };
        let figures = shapes
            .iter()
            .flat_map(|shape| figure_of(shape, Some(source)));
        let points = figures.flat_map(|figure| figure.coarse.positions.clone());
        let points = points.map(|point| point.as_dvec3() / UNITS_PER_METER);
        let points: Vec<_> = points.collect();
        match points.is_empty() && !rigid.contains(&id) {
            true => vec![DVec3::ZERO],
            false => points,
        }
    };
    let links = model.all_on(palm).into_iter();
    links.map(|link| (link, cloud(link))).collect()
}

/// What a hand is found in. Places are in m in the palm's frame.
struct Seeker<'a> {
    model: &'a RobotModel,
    wrist: ModelJointId,
    palm: LinkId,
    /// The links that are one with the palm.
    rigid: Vec<LinkId>,
    fingers: &'a [ModelJointId],
    /// The first joint of each finger.
    roots: Vec<ModelJointId>,
    clouds: BTreeMap<LinkId, Vec<DVec3>>,
}

impl Seeker<'_> {
    /// The end effector of a limb without fingers, in front of its flange or tool.
    fn flange(&self) -> DraftHand {
        let link = self.tool_link().or(self.rigid.last()).copied();
        let link = link.unwrap_or(self.palm);
        let frames = self.frames(&self.model.zero());
        let frame = frames(link);
        // ROS has the z of a flange away from the arm.
        let out = match frame.translation.length() > 0.01 {
            true => nearest_axis(frame.matrix3.transpose() * frame.translation.normalize()),
            false => DVec3::Z,
        };
        let z = -out;
        let x = match out.z.abs() > 0.5 {
            true => DVec3::X,
            false => DVec3::Z,
        };
        DraftHand {
            link: self.model.link(link).name.clone(),
            at: out * PLAIN_REACH,
            axes: DMat3::from_cols(x, z.cross(x), z),
            opening: None,
            finger: PLAIN_FINGER,
            fingers: Default::default(),
            finger_joints: Vec::new(),
        }
    }

    /// The end effector between the fingers.
    fn gripper(&self) -> DraftHand {
        let [closed, open] = self.ends();
        let (before, after) = (self.landmarks(&closed), self.landmarks(&open));
        let out = self.approach(&before);
        let across = self.across(&before, &after, out);
        let link = self.tool_link().copied().unwrap_or_else(|| {
            let root = self
                .roots
                .first()
                .map(|&root| self.model.joint(root).parent);
            root.unwrap_or(self.palm)
        });

        let frame = self.frames(&open)(link);
        let to_link = frame.matrix3.transpose();
        let z = snapped(to_link * -out);
        let x = snapped(
            (to_link * across)
                .reject_from(z)
                .normalize_or(z.any_orthonormal_vector()),
        );
        let axes = DMat3::from_cols(x, z.cross(x), z);
        // From the palm's frame to one with the end effector's axes.
        let view = (frame.matrix3 * axes).transpose();

        let split = after.iter().map(|&center| (view * center).x);
        let (least, most) = split.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        let is_left =
            |center: &DVec3| self.roots.len() > 1 && (view * *center).x < (least + most) / 2.0;
        let (left, right): (Vec<_>, Vec<_>) = self
            .roots
            .iter()
            .zip(&after)
            .partition(|(_, center)| is_left(center));
        let roots_of = |side: &[(&ModelJointId, &DVec3)]| -> Vec<LinkId> {
            let joints = side
                .iter()
                .map(|&(joint, _)| self.model.joint(*joint).child);
            joints.collect()
        };
        let sides = [roots_of(&left), roots_of(&right)];

        // What a side is made of, seen by the end effector; a jaw closes on the palm.
        let seen = |side: usize, values: &JointValues| -> Vec<DVec3> {
            let links: Vec<LinkId> = match sides[side].is_empty() {
                true => self.rigid.clone(),
                false => {
                    let roots = sides[side].iter();
                    roots.flat_map(|&root| self.model.all_on(root)).collect()
                }
            };
            let points = self.points(&links, values).into_iter();
            points.map(|point| view * point).collect()
        };
        let [shut, wide] = [&closed, &open].map(|values| [seen(0, values), seen(1, values)]);
        // z is back to the wrist.
        let [low, high] = bounds(&shut[1]);
        let (tip, pad) = (low.z, (high.z - low.z).clamp(0.02, LONGEST_PAD));
        let pads = |sides: &[Vec<DVec3>; 2]| {
            let pad_of = |side: usize| -> Vec<DVec3> {
                let pairs = shut[side].iter().zip(&sides[side]);
                let touching = pairs.filter(|(shut, _)| shut.z < tip + pad);
                touching.map(|(_, point)| *point).collect()
            };
            [0, 1].map(|side| bounds(&pad_of(side)))
        };
        let [shut, wide] = [pads(&shut), pads(&wide)];
        let gap = |[left, right]: &[[DVec3; 2]; 2]| {
            let gap = right[0].x - left[1].x;
            round(gap.max(0.0) * UNITS_PER_METER, 100.0)
        };
        let opening = [gap(&shut), gap(&wide)];
        let is_told = opening[1].is_finite() && opening[1] - opening[0] > 0.05;
        let across_middle = match is_told {
            true => (wide[0][1].x + wide[1][0].x) / 2.0,
            false => 0.0,
        };
        let [low, high] = shut[1];
        let span = (high - low) * UNITS_PER_METER;
        let middle = DVec3::new(across_middle, (low.y + high.y) / 2.0, tip + pad / 2.0);
        let place = frame.inverse().transform_point3(view.transpose() * middle);
        let names = |links: &[LinkId]| {
            let names = links.iter().map(|&link| self.model.link(link).name.clone());
            names.collect::<Vec<_>>()
        };
        let slides = self.fingers.iter().map(|&joint| self.model.joint(joint));
        let slides =
            slides.filter(|joint| joint.kind == JointType::Prismatic && joint.mimic.is_none());
        DraftHand {
            link: self.model.link(link).name.clone(),
            // Lengths of strangers' files may add up to what is no place.
            at: if place.is_finite() {
                place
            } else {
                DVec3::ZERO
            },
            axes,
            opening: is_told.then_some(opening),
            finger: DVec3::new(
                round(span.x.clamp(0.1, 0.3), 100.0),
                round(span.y.clamp(0.1, 0.4), 100.0),
                round(pad * UNITS_PER_METER, 100.0),
            ),
            fingers: [names(&sides[0]), names(&sides[1])],
            finger_joints: slides.map(|joint| joint.name.clone()).collect(),
        }
    }

    /// The link on the palm whose name says that it is between the fingers or at the tool.
    fn tool_link(&self) -> Option<&LinkId> {
        let rank = |link: &&LinkId| {
            let name = self.model.link(**link).name.to_lowercase();
            let mut words = name.split(|letter: char| !letter.is_alphanumeric());
            let is_there = |tool: &str| match tool.len() {
                0..=3 => words.clone().any(|word| word == tool),
                _ => name.contains(tool),
            };
            let rank = TOOL_LINKS.iter().position(|tool| is_there(tool));
            // The link of the wrist itself is no frame for a tool.
            rank.filter(|_| words.next().is_some() && **link != self.palm)
        };
        let named = self.rigid.iter().filter(|link| rank(link).is_some());
        named.min_by_key(rank)
    }

    /// The frames of links, in the palm's, with the fingers in these positions.
    fn frames(&self, values: &JointValues) -> impl Fn(LinkId) -> DAffine3 + use<> {
        let frames: Frames = self.model.frames(values);
        let to_palm = frames[self.palm].inverse();
        move |link| to_palm * frames[link]
    }

    /// The points of links, with the fingers in these positions.
    fn points(&self, links: &[LinkId], values: &JointValues) -> Vec<DVec3> {
        let frames = self.frames(values);
        let points = links.iter().flat_map(|link| {
            let frame = frames(*link);
            let cloud = self.clouds[link].iter();
            cloud.map(move |point| frame.transform_point3(*point))
        });
        points.collect()
    }

    /// A point of each finger: the middle of several, the tip of a jaw.
    fn landmarks(&self, values: &JointValues) -> Vec<DVec3> {
        let landmarks = self.roots.iter().map(|&root| {
            let root = self.model.joint(root).child;
            let points = self.points(&self.model.all_on(root), values);
            let hinge = self.frames(values)(root).translation;
            let distance = |point: &DVec3| point.distance(hinge);
            match self.roots.len() {
                1 => {
                    let longest = points.iter().map(distance).fold(0.0, f64::max);
                    let is_tip = |point: &&DVec3| distance(point) >= TIP * longest;
                    mean(points.iter().filter(is_tip))
                }
                _ => mean(&points),
            }
        });
        landmarks.collect()
    }

    /// The fingers closed and open: each joint where it brings them nearest together and farthest apart.
    fn ends(&self) -> [JointValues; 2] {
        let mut middle = self.model.zero();
        let free = self.fingers.iter().copied();
        let free: Vec<_> = free
            .filter(|&joint| self.model.joint(joint).mimic.is_none())
            .collect();
        let range = |joint: ModelJointId| {
            let [least, largest] = self.model.joint(joint).limits;
            [
                least.max(-WIDEST_TURN * 2.0),
                largest.min(WIDEST_TURN * 2.0),
            ]
        };
        for &joint in &free {
            let [least, largest] = range(joint);
            middle[joint] = (least + largest) / 2.0;
        }
        let (mut closed, mut open) = (middle.clone(), middle.clone());
        for &joint in &free {
            let ends = range(joint);
            let spreads = ends.map(|end| {
                let mut values = middle.clone();
                values[joint] = end;
                self.spread(&values)
            });
            let (near, far) = match spreads[0] < spreads[1] {
                true => (ends[0], ends[1]),
                false => (ends[1], ends[0]),
            };
            closed[joint] = near;
            open[joint] = match self.model.joint(joint).kind.turns() {
                true => near + (far - near).clamp(-WIDEST_TURN, WIDEST_TURN),
                false => far,
            };
        }
        [closed, open]
    }

    /// How far apart the fingers are; for a jaw, how far its tip is from the palm.
    fn spread(&self, values: &JointValues) -> f64 {
        match &self.landmarks(values)[..] {
            [jaw] => {
                let palm = self.points(&self.rigid, values);
                let distances = palm.iter().map(|point| point.distance(*jaw));
                distances.fold(f64::INFINITY, f64::min)
            }
            landmarks => {
                let middle = mean(landmarks);
                let distances = landmarks.iter().map(|place| place.distance(middle));
                distances.sum()
            }
        }
    }

    /// The direction from the wrist to the fingers: along the wrist's axis where that leads there.
    fn approach(&self, landmarks: &[DVec3]) -> DVec3 {
        let middle = self.across_hinge(mean(landmarks));
        let wrist = self.model.joint(self.wrist);
        let axis = wrist.axis * middle.dot(wrist.axis).signum();
        let out = middle.normalize_or(axis);
        match wrist.kind.turns() && out.dot(axis) > 0.8 {
            true => axis,
            false => out,
        }
    }

    /// The part of a direction in which a jaw can move; all of it for several fingers.
    fn across_hinge(&self, direction: DVec3) -> DVec3 {
        let [root] = self.roots[..] else {
            return direction;
        };
        let joint = self.model.joint(root);
        let frame = self.frames(&self.model.zero())(joint.child);
        match joint.kind.turns() {
            true => direction.reject_from(frame.matrix3 * joint.axis),
            false => direction,
        }
    }

    /// The direction from the left finger to the right one, across the approach.
    fn across(&self, before: &[DVec3], after: &[DVec3], out: DVec3) -> DVec3 {
        let ways: Vec<DVec3> = before.iter().zip(after).map(|(a, b)| *b - *a).collect();
        let pairs = (0..after.len()).flat_map(|i| (0..i).map(move |j| (j, i)));
        let apart = |&(i, j): &(usize, usize)| after[i].distance(after[j]);
        let farthest = pairs.max_by(|a, b| apart(a).total_cmp(&apart(b)));
        let across = match farthest {
            None => ways.first().copied().unwrap_or(DVec3::ZERO),
            Some((left, right)) => {
                let way = (ways[right] - ways[left]).reject_from(out);
                match way.length() > 1e-3 {
                    true => way,
                    false => after[right] - after[left],
                }
            }
        };
        let across = self.across_hinge(across).reject_from(out);
        across.normalize_or(out.any_orthonormal_vector())
    }
}

fn mean<'a>(points: impl IntoIterator<Item = &'a DVec3>) -> DVec3 {
    let points = points.into_iter();
    let (sum, count) = points.fold((DVec3::ZERO, 0.0), |(sum, count), point| {
        (sum + *point, count + 1.0)
    });
    sum / f64::max(count, 1.0)
}

/// The least and the largest coordinates of some points.
fn bounds(points: &[DVec3]) -> [DVec3; 2] {
    let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    points.iter().fold(none, |[low, high], point| {
        [low.min(*point), high.max(*point)]
    })
}

/// The axis that a direction is nearest to.
fn nearest_axis(direction: DVec3) -> DVec3 {
    let axes = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
    let nearest = axes.max_by(|a, b| a.dot(direction).total_cmp(&b.dot(direction)));
    nearest.unwrap_or(DVec3::Z)
}

/// The axis that a direction is meant to be, or the direction.
fn snapped(direction: DVec3) -> DVec3 {
    let axis = nearest_axis(direction);
    match axis.dot(direction) > SAME {
        true => axis,
        false => direction,
    }
}

fn round(number: f64, parts: f64) -> f64 {
    (number * parts).round() / parts
}
