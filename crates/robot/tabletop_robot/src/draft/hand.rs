//! The hand of a limb: where its fingers meet, and how far they open.

use bevy::math::{DMat3, DVec3};
use tabletop_kinematics::{JointType, JointValues, LinkId, RobotModel};

use super::{anatomy::Branch, fingers::Fingers, pads::Pads};
use crate::DescriptionSource;

/// Words in the names of links that are frames between fingers or at a tool, the surest first.
const TOOL_LINKS: [&str; 10] = [
    "tcp", "grasp", "pinch", "effector", "eef", "ee", "tool0", "tool", "tip", "frame",
];

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
        let fingers = Fingers::of(model, source, branch)?;
        Some(match fingers.roots.is_empty() {
            true => Self::on_flange(&fingers),
            false => Self::between(&fingers),
        })
    }

    /// The end effector of a limb without fingers, in front of its flange or tool.
    fn on_flange(fingers: &Fingers) -> Self {
        let link = tool_link(fingers).or(fingers.rigid.last().copied());
        let link = link.unwrap_or(fingers.palm);
        let frame = fingers.frames(&fingers.model.zero())(link);
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
        Self {
            link: fingers.model.link(link).name.clone(),
            at: out * PLAIN_REACH,
            axes: DMat3::from_cols(x, z.cross(x), z),
            opening: None,
            finger: PLAIN_FINGER,
            fingers: Default::default(),
            finger_joints: Vec::new(),
        }
    }

    /// The end effector between the fingers.
    fn between(fingers: &Fingers) -> Self {
        let [closed, open] = fingers.ends();
        let (before, after) = (fingers.landmarks(&closed), fingers.landmarks(&open));
        let out = fingers.approach(&before);
        let across = fingers.across(&before, &after, out);
        let model = fingers.model;
        let carrier = fingers.roots.first();
        let carrier = carrier.map_or(fingers.palm, |&root| model.joint(root).parent);
        let link = tool_link(fingers).unwrap_or(carrier);

        let frame = fingers.frames(&open)(link);
        let to_link = frame.matrix3.transpose();
        let z = snapped(to_link * -out);
        let across = (to_link * across).reject_from(z);
        let x = snapped(across.normalize_or(z.any_orthonormal_vector()));
        let axes = DMat3::from_cols(x, z.cross(x), z);
        // From the palm's frame to one with the end effector's axes.
        let view = (frame.matrix3 * axes).transpose();
        let sides = sides(fingers, &after, view);
        let points = |values: &JointValues| {
            sides.each_ref().map(|roots| {
                let roots = roots.iter().flat_map(|&root| model.all_on(root));
                let mut links: Vec<_> = roots.collect();
                if links.is_empty() {
                    // A jaw closes on the palm.
                    links.clone_from(&fingers.rigid);
                }
                let points = fingers.points(&links, values).into_iter();
                points.map(|point| view * point).collect()
            })
        };
        let pads = Pads::measure(&points(&closed), &points(&open));
        let place = frame
            .inverse()
            .transform_point3(view.transpose() * pads.middle);
        let slides = fingers.joints.iter().map(|&joint| model.joint(joint));
        let slides =
            slides.filter(|joint| joint.kind == JointType::Prismatic && joint.mimic.is_none());
        Self {
            link: model.link(link).name.clone(),
            at: match place.is_finite() {
                true => place,
                // Lengths of strangers' files may add up to what is no place.
                false => DVec3::ZERO,
            },
            axes,
            opening: pads.opening,
            finger: pads.finger,
            fingers: sides.map(|side| {
                let names = side.iter().map(|&link| model.link(link).name.clone());
                names.collect()
            }),
            finger_joints: slides.map(|joint| joint.name.clone()).collect(),
        }
    }
}

/// The first links of the left and of the right fingers, by a point of each; a single jaw is a right one.
fn sides(fingers: &Fingers, landmarks: &[DVec3], view: DMat3) -> [Vec<LinkId>; 2] {
    let x = |landmark: &DVec3| (view * *landmark).x;
    let least = landmarks.iter().map(x).fold(f64::INFINITY, f64::min);
    let most = landmarks.iter().map(x).fold(f64::NEG_INFINITY, f64::max);
    let mut sides = [Vec::new(), Vec::new()];
    for (&root, landmark) in fingers.roots.iter().zip(landmarks) {
        let is_left = fingers.roots.len() > 1 && x(landmark) < (least + most) / 2.0;
        let side = if is_left { 0 } else { 1 };
        sides[side].push(fingers.model.joint(root).child);
    }
    sides
}

/// The link on the palm whose name says that it is between the fingers or at the tool.
fn tool_link(fingers: &Fingers) -> Option<LinkId> {
    let rank = |link: &&LinkId| {
        let name = fingers.model.link(**link).name.to_lowercase();
        let mut words = name.split(|letter: char| !letter.is_alphanumeric());
        let is_there = |tool: &str| match tool.len() {
            0..=3 => words.clone().any(|word| word == tool),
            _ => name.contains(tool),
        };
        let rank = TOOL_LINKS.iter().position(|tool| is_there(tool));
        // The link of the wrist itself is no frame for a tool.
        rank.filter(|_| words.next().is_some() && **link != fingers.palm)
    };
    let named = fingers.rigid.iter().filter(|link| rank(link).is_some());
    named.min_by_key(rank).copied()
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
