//! The fingers on a palm: where they are closed and open, and in which directions.

use std::collections::BTreeMap;

use bevy::math::{DAffine3, DVec3};
use tabletop_geometry::UNITS_PER_METER;
use tabletop_kinematics::{Frames, JointValues, LinkId, ModelJointId, RobotModel};

use super::anatomy::Branch;
use crate::{DescriptionSource, look::figure::figure_of};

/// Farthest that a jaw is taken to turn open, in rad.
const WIDEST_TURN: f64 = 1.2;

/// The points of a jaw that are its tip: at least this share of the longest way from its hinge.
const TIP: f64 = 0.9;

/// A palm and the fingers on it. Places are in m in the palm's frame.
pub(super) struct Fingers<'a> {
    pub model: &'a RobotModel,
    wrist: ModelJointId,
    pub palm: LinkId,
    /// The links that are one with the palm.
    pub rigid: Vec<LinkId>,
    /// All their joints.
    pub joints: &'a [ModelJointId],
    /// The first joint of each.
    pub roots: Vec<ModelJointId>,
    clouds: BTreeMap<LinkId, Vec<DVec3>>,
}

impl<'a> Fingers<'a> {
    /// Those at the end of a branch.
    pub fn of(
        model: &'a RobotModel,
        source: &DescriptionSource,
        branch: &'a Branch,
    ) -> Option<Self> {
        let wrist = *branch.joints.last()?;
        let palm = model.joint(wrist).child;
        let rigid = model.rigidly_on(palm);
        let roots = branch.fingers.iter().copied();
        let roots = roots.filter(|&joint| rigid.contains(&model.joint(joint).parent));
        Some(Self {
            roots: roots.collect(),
            clouds: clouds(model, source, palm, &rigid),
            joints: &branch.fingers,
            model,
            wrist,
            palm,
            rigid,
        })
    }

    /// The frames of links, in the palm's, with the fingers in these positions.
    pub fn frames(&self, values: &JointValues) -> impl Fn(LinkId) -> DAffine3 + use<> {
        let frames: Frames = self.model.frames(values);
        let to_palm = frames[self.palm].inverse();
        move |link| to_palm * frames[link]
    }

    /// The points of links, with the fingers in these positions.
    pub fn points(&self, links: &[LinkId], values: &JointValues) -> Vec<DVec3> {
        let frames = self.frames(values);
        let points = links.iter().flat_map(|link| {
            let frame = frames(*link);
            let cloud = self.clouds[link].iter();
            cloud.map(move |point| frame.transform_point3(*point))
        });
        points.collect()
    }

    /// A point of each finger: the middle of several, the tip of a jaw.
    pub fn landmarks(&self, values: &JointValues) -> Vec<DVec3> {
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
    pub fn ends(&self) -> [JointValues; 2] {
        let mut middle = self.model.zero();
        let free = self.joints.iter().copied();
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
    pub fn approach(&self, landmarks: &[DVec3]) -> DVec3 {
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
    pub fn across(&self, before: &[DVec3], after: &[DVec3], out: DVec3) -> DVec3 {
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

fn mean<'a>(points: impl IntoIterator<Item = &'a DVec3>) -> DVec3 {
    let points = points.into_iter();
    let (sum, count) = points.fold((DVec3::ZERO, 0.0), |(sum, count), point| {
        (sum + *point, count + 1.0)
    });
    sum / f64::max(count, 1.0)
}
