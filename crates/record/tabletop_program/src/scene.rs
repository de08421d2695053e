//! The table as it is now.

use std::{cmp::Reverse, collections::BTreeMap};

use bevy::math::Vec3;
use tabletop_core::{JointKind, JointSpec, ObjectSpec, Table};
use tabletop_geometry::{PlacedSolid, Pose};
use tabletop_task::RelativeSide;

use crate::{
    look::{color_of, volume},
    standing::Standing,
};

/// The objects that are on the table now. The pose of each description is its present one.
#[derive(Clone, Debug, Default)]
pub struct TableScene {
    /// The table.
    pub table: Table,
    /// The objects, in an order that decides where nothing else does.
    pub objects: Vec<ObjectSpec>,
    /// Joints between them.
    pub joints: Vec<JointSpec>,
}

/// The largest gap between objects beside each other, in units, as `tabletop explain` has it.
const BESIDE: f32 = 0.6;
/// The share of its way beyond which a lid or a drawer is open.
const OPEN: f32 = 0.5;

/// A scene with all that follows from it.
pub(crate) struct SceneView<'s> {
    pub scene: &'s TableScene,
    pub standing: Standing,
    looks: BTreeMap<&'s str, ObjectLook>,
}

/// What an object looks like.
struct ObjectLook {
    color: Option<String>,
    volume: f32,
}

/// A part that slides along a joint: a lid, or a drawer.
pub(crate) struct SlidingPart {
    /// Id of the part.
    pub part: String,
    /// Id of what it belongs to.
    pub holder: String,
    /// The direction in which it opens, a unit vector.
    way: Vec3,
    /// How far it is open, in units.
    opening: f32,
    /// How far it opens, in units.
    pub travel: f32,
}

impl SlidingPart {
    pub fn is_open(&self) -> bool {
        self.opening > OPEN * self.travel
    }

    /// The displacement that opens or closes it.
    pub fn by(&self, open: bool) -> Vec3 {
        let opening = if open { self.travel } else { 0.0 };
        self.way * (opening - self.opening)
    }
}

impl TableScene {
    /// The object of this id.
    pub fn object(&self, id: &str) -> Option<&ObjectSpec> {
        self.objects.iter().find(|object| object.id == id)
    }

    pub(crate) fn view(&self) -> SceneView<'_> {
        let looks = self.objects.iter().map(|object| {
            let (color, volume) = (color_of(object), volume(object));
            (object.id.as_str(), ObjectLook { color, volume })
        });
        SceneView {
            scene: self,
            standing: Standing::of(&self.objects),
            looks: looks.collect(),
        }
    }
}

impl<'s> SceneView<'s> {
    pub fn object(&self, id: &str) -> Option<&'s ObjectSpec> {
        self.scene.object(id)
    }

    pub fn location(&self, id: &str) -> Vec3 {
        self.object(id)
            .map_or(Vec3::ZERO, |object| object.pose.location)
    }

    /// The name of its colour, if it has just one.
    pub fn color(&self, id: &str) -> Option<&str> {
        self.looks.get(id)?.color.as_deref()
    }

    pub fn volume(&self, id: &str) -> f32 {
        self.looks.get(id).map_or(0.0, |look| look.volume)
    }

    /// The solids of an object.
    pub fn solids(&self, id: &str) -> Vec<PlacedSolid> {
        self.object(id)
            .map_or(Vec::new(), |object| solids_at(object, object.pose))
    }

    /// The height of its highest point.
    pub fn top(&self, id: &str) -> f32 {
        let tops = self.solids(id).into_iter().map(|solid| solid.heights()[1]);
        tops.fold(0.0, f32::max)
    }

    /// True if a hand can move it freely.
    pub fn is_movable(&self, id: &str) -> bool {
        let is_jointed = |joint: &JointSpec| joint.objects.iter().any(|other| other == id);
        self.object(id).is_some_and(|object| !object.is_fixed())
            && !self.scene.joints.iter().any(is_jointed)
    }

    /// All that stands on an object, directly or on each other, the highest first. What is in it does not stand on it.
    pub fn stack_above(&self, id: &str) -> Vec<String> {
        let mut found = Vec::<String>::new();
        let mut next = vec![id.to_owned()];
        while let Some(below) = next.pop() {
            for above in self.standing.on(&below) {
                let is_within = self.standing.is_between_walls(above, &below)
                    || self.standing.is_around(above, &below);
                let is_part = self.sliding_part(&below).is_some_and(|it| it.part == above);
                let is_new = above != id && found.iter().all(|known| known != above);
                if is_new && !is_within && !is_part {
                    found.push(above.to_owned());
                    next.push(above.to_owned());
                }
            }
        }
        let height = |id: &String| (self.top(id) * 1000.0) as i64;
        found.sort_by_key(|id| Reverse(height(id)));
        found
    }

    /// True if it stands on the other, or on what stands on that.
    pub fn is_upon(&self, id: &str, base: &str) -> bool {
        self.stack_above(base).iter().any(|above| above == id)
    }

    /// True if it is in the other, or on what is in that.
    pub fn is_inside(&self, id: &str, container: &str) -> bool {
        // A peg has a ring around it, but does not lie on it.
        let is_in = |id: &str| {
            self.standing.is_between_walls(id, container) && self.standing.rests_on(id, container)
        };
        let below = |base: &&ObjectSpec| is_in(&base.id) && self.is_upon(id, &base.id);
        is_in(id) || self.scene.objects.iter().any(|base| below(&base))
    }

    /// True if it is beside the other, on this side.
    pub fn is_beside(&self, id: &str, other: &str, side: RelativeSide) -> bool {
        let way = self.location(id) - self.location(other);
        id != other && RelativeSide::of(way) == side && self.gap(id, other) < BESIDE
    }

    fn gap(&self, id: &str, other: &str) -> f32 {
        let others = self.solids(other);
        let solids = self.solids(id).into_iter();
        let gaps = solids.flat_map(|own| {
            let gaps: Vec<_> = others
                .iter()
                .map(|other| own.away_from(other).length())
                .collect();
            gaps
        });
        gaps.fold(f32::INFINITY, f32::min)
    }

    /// The lid or the drawer of an object, or that it is.
    pub fn sliding_part(&self, id: &str) -> Option<SlidingPart> {
        self.scene.joints.iter().find_map(|joint| {
            let JointKind::Slider { max: travel, .. } = joint.kind else {
                return None;
            };
            if joint.objects.iter().all(|object| object != id) {
                return None;
            }
            let [holder, part] = &joint.objects;
            let frame = self.object(holder)?.pose * joint.frames[0];
            let own = self.object(part)?.pose * joint.frames[1];
            Some(SlidingPart {
                part: part.clone(),
                holder: holder.clone(),
                way: frame.rotation * Vec3::NEG_X,
                opening: -(frame.inverse() * own.location).x,
                travel,
            })
        })
    }
}

/// The solids of an object at a pose.
pub(crate) fn solids_at(object: &ObjectSpec, pose: Pose) -> Vec<PlacedSolid> {
    let solids = object.shape.colliding();
    solids
        .iter()
        .map(|solid| PlacedSolid::of(solid, pose))
        .collect()
}
