//! Relations between an object and its surroundings after it was put down.

use bevy::math::{Quat, Vec3};
use serde::{Deserialize, Serialize};
use tabletop_core::{JointKind, JointSpec};
use tabletop_geometry::Pose;

use crate::{
    arrangement::{Arrangement, TOUCH},
    demonstration::Demonstration,
    detour::IN_PLACE,
    manipulation::{Ending, Manipulation},
    rotation::angle_between,
    symmetry::Symmetry,
};

/// A relation that a manipulation establishes. Objects are given by their ids.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Relation {
    /// It stands on the table.
    OnTable,
    /// It stands on an object.
    On {
        /// The object.
        object: String,
    },
    /// It is in an object that has walls on all sides.
    Inside {
        /// The object.
        object: String,
    },
    /// It is around a part of an object, as a ring on its peg.
    Around {
        /// The object.
        object: String,
    },
    /// It leans against an object, and stands on the table.
    Against {
        /// The object.
        object: String,
    },
    /// It stands beside an object. If it does so on opposite sides of two, it is between them.
    Beside {
        /// The object.
        object: String,
        /// The side of that object, as the robot sees it.
        side: RelativeSide,
    },
    /// Its sides are parallel to those of an object.
    AlignedWith {
        /// The object.
        object: String,
    },
    /// It is at the first pose of an object.
    InPlaceOf {
        /// The object.
        object: String,
    },
    /// It is out of the way, and will be moved again later.
    Aside,
    /// It has slid along the joint that connects it with an object.
    Slid {
        /// The object.
        object: String,
        /// Its final opening, in units.
        opening: f32,
        /// Largest possible opening, in units.
        travel: f32,
    },
    /// It has turned in place.
    Turned {
        /// The axis, in the table's frame.
        axis: Vec3,
        /// The angle, in degrees.
        degrees: f32,
    },
    /// It was let go in the air, and the recording ended before it came to rest.
    LetGo,
    /// It was removed.
    Destroyed,
    /// A hand still holds it at the end.
    Held,
}

/// The side of an object on which another one is, as the robot sees it, in front of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RelativeSide {
    /// Towards -X.
    Left,
    /// Towards +X.
    Right,
    /// Towards the robot.
    Front,
    /// Towards the robot and -X.
    FrontLeft,
    /// Towards the robot and +X.
    FrontRight,
    /// Away from the robot.
    Behind,
    /// Away from the robot, and towards -X.
    BehindLeft,
    /// Away from the robot, and towards +X.
    BehindRight,
}

impl RelativeSide {
    /// Its words in a sentence, before the object's name.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Left => "to the left of",
            Self::Right => "to the right of",
            Self::Front => "in front of",
            Self::FrontLeft => "in front and to the left of",
            Self::FrontRight => "in front and to the right of",
            Self::Behind => "behind",
            Self::BehindLeft => "behind and to the left of",
            Self::BehindRight => "behind and to the right of",
        }
    }

    /// The direction to it across the table, a unit vector.
    pub fn way(self) -> Vec3 {
        let way = match self {
            Self::Left => Vec3::NEG_X,
            Self::Right => Vec3::X,
            Self::Front => Vec3::NEG_Y,
            Self::FrontLeft => Vec3::NEG_X + Vec3::NEG_Y,
            Self::FrontRight => Vec3::X + Vec3::NEG_Y,
            Self::Behind => Vec3::Y,
            Self::BehindLeft => Vec3::NEG_X + Vec3::Y,
            Self::BehindRight => Vec3::X + Vec3::Y,
        };
        way.normalize()
    }

    /// The side in this direction across the table.
    pub fn of(way: Vec3) -> Self {
        // A direction more than 22° off an axis has a part of both sides.
        let is_along = |along: f32, across: f32| along.abs() > 2.4 * across.abs();
        match (way.x > 0.0, way.y > 0.0) {
            (right, _) if is_along(way.x, way.y) => match right {
                true => Self::Right,
                false => Self::Left,
            },
            (_, behind) if is_along(way.y, way.x) => match behind {
                true => Self::Behind,
                false => Self::Front,
            },
            (false, false) => Self::FrontLeft,
            (true, false) => Self::FrontRight,
            (false, true) => Self::BehindLeft,
            (true, true) => Self::BehindRight,
        }
    }
}

impl Relation {
    /// Its name, as in JSON.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::OnTable => "on-table",
            Self::On { .. } => "on",
            Self::Inside { .. } => "inside",
            Self::Around { .. } => "around",
            Self::Against { .. } => "against",
            Self::Beside { .. } => "beside",
            Self::AlignedWith { .. } => "aligned-with",
            Self::InPlaceOf { .. } => "in-place-of",
            Self::Aside => "aside",
            Self::Slid { .. } => "slid",
            Self::Turned { .. } => "turned",
            Self::LetGo => "let-go",
            Self::Destroyed => "destroyed",
            Self::Held => "held",
        }
    }

    /// The other object of the relation.
    pub fn object(&self) -> Option<&str> {
        match self {
            Self::On { object }
            | Self::Inside { object }
            | Self::Around { object }
            | Self::Against { object }
            | Self::Beside { object, .. }
            | Self::AlignedWith { object }
            | Self::InPlaceOf { object }
            | Self::Slid { object, .. } => Some(object),
            Self::OnTable
            | Self::Aside
            | Self::Turned { .. }
            | Self::LetGo
            | Self::Destroyed
            | Self::Held => None,
        }
    }
}

/// Largest distance, in units, from the first place of another object at which an object counts as in that place.
const PLACE: f32 = 0.3;
/// Largest gap, in units, between objects beside each other.
const NEIGHBOURHOOD: f32 = 0.6;
/// Least angle, in rad, between the ways from two objects to one that is between them.
const OPPOSITE: f32 = 2.4;
/// Largest angle, in rad, between aligned objects.
const ALIGNED: f32 = 0.1;
/// Largest displacement across the table, in units, and least angle, in rad, of an object that turns in place.
const TURNED: (f32, f32) = (IN_PLACE, 0.05);

/// The relations that a manipulation establishes, the most telling first. `later` are the manipulations after it.
pub(crate) fn established(
    shown: &Demonstration,
    manipulation: &Manipulation,
    later: &[Manipulation],
) -> Vec<Relation> {
    match manipulation.ending {
        Ending::Destroyed => return vec![Relation::Destroyed],
        Ending::Held => return vec![Relation::Held],
        Ending::Released => {}
    }
    let id = manipulation.object.as_str();
    let after = shown.at(manipulation.rest);
    if let Some(slid) = slid(shown, &after, id) {
        return vec![slid];
    }
    let owned = |id: &str| id.to_owned();
    let mut relations = standing(&after, id);
    if relations.is_empty() && !after.is_on_table(id) {
        if shown.is_poses_only {
            relations.extend(presumed(&after, id));
        }
        if relations.is_empty() && is_in_the_air(shown, &after, manipulation) {
            return vec![Relation::LetGo];
        }
    }
    if relations.is_empty() {
        relations.extend(turned(shown, manipulation));
    }
    if relations.is_empty() {
        let place = in_place_of(shown, &after, manipulation);
        let is_moved_later = later.iter().any(|next| next.object == id);
        let on_table = place
            .or_else(|| is_moved_later.then_some(Relation::Aside))
            .map_or_else(|| beside(&after, id, later), |relation| vec![relation]);
        relations.extend(on_table);
    }
    if let Some(object) = relations.first().and_then(Relation::object)
        && is_aligned(shown, &after, id, object)
    {
        let object = owned(object);
        relations.push(Relation::AlignedWith { object });
    }
    if after.is_on_table(id) {
        relations.push(Relation::OnTable);
    }
    relations
}

/// The relations to what an object is around, in and on.
pub(crate) fn standing(arrangement: &Arrangement, id: &str) -> Vec<Relation> {
    let owned = |id: &str| id.to_owned();
    let posts = arrangement.posts(id).into_iter();
    let posts = posts.map(|id| Relation::Around { object: owned(id) });
    let containers = arrangement.containers(id).into_iter();
    let containers = containers.map(|id| Relation::Inside { object: owned(id) });
    let mut relations: Vec<_> = posts.chain(containers).collect();
    let props = arrangement.props(id);
    if relations.is_empty() && !props.is_empty() {
        let props = props.into_iter();
        return props
            .map(|id| Relation::Against { object: owned(id) })
            .collect();
    }
    let mut supports = arrangement.supports(id);
    supports.retain(|support| {
        let mut inner = relations.iter().filter_map(Relation::object);
        !inner.any(|inner| inner == *support)
    });
    let on = supports.into_iter();
    relations.extend(on.map(|id| Relation::On { object: owned(id) }));
    relations
}

/// The relations to what an object at rest is on, for all that is known of the sizes.
fn presumed(after: &Arrangement, id: &str) -> Vec<Relation> {
    let (posts, support) = after.presumed_bases(id);
    let object = |id: &str| id.to_owned();
    let around = posts.into_iter().map(|post| Relation::Around {
        object: object(post),
    });
    let on = support.map(|support| Relation::On {
        object: object(support),
    });
    around.chain(on).collect()
}

/// True if an object that lies on nothing has not come to rest before the end.
fn is_in_the_air(shown: &Demonstration, after: &Arrangement, manipulation: &Manipulation) -> bool {
    let id = &manipulation.object;
    let is_jointed = shown.joints.iter().any(|joint| joint.objects.contains(id));
    let track = shown.named(id).map(|object| &object.track);
    let is_still = track.is_some_and(|track| track.is_still_at(manipulation.rest));
    let has_rested = manipulation.rest < shown.end && !shown.is_poses_only;
    !(is_jointed || has_rested || is_still && after.touches_anything(id))
}

/// The joint along which an object slides, with the greatest displacement that it allows.
pub(crate) fn slider<'s>(joints: &'s [JointSpec], id: &str) -> Option<(&'s JointSpec, f32)> {
    joints.iter().find_map(|joint| match joint.kind {
        JointKind::Slider { max, .. } if joint.objects[1] == id => Some((joint, max)),
        JointKind::Slider { .. }
        | JointKind::PushButton { .. }
        | JointKind::Hinge { .. }
        | JointKind::Shears { .. }
        | JointKind::Ball
        | JointKind::Fixed => None,
    })
}

fn slid(shown: &Demonstration, after: &Arrangement, id: &str) -> Option<Relation> {
    let (joint, travel) = slider(&shown.joints, id)?;
    let frame = after.pose(&joint.objects[0])? * joint.frames[0];
    let own = after.pose(id)? * joint.frames[1];
    let opening = -(frame.inverse() * own.location).x;
    Some(Relation::Slid {
        object: joint.objects[0].clone(),
        opening: opening.clamp(0.0, travel),
        travel,
    })
}

fn turned(shown: &Demonstration, manipulation: &Manipulation) -> Option<Relation> {
    let object = shown.named(&manipulation.object)?;
    let symmetry = Symmetry::of(&object.spec.shape);
    let (from, to) = (manipulation.from, manipulation.to);
    let across = (to.location - from.location).truncate().length();
    let (_, angle) = symmetry.difference(from, to);
    if across > TURNED.0 || angle < TURNED.1 {
        return None;
    }
    let from = symmetry.nearest(from, to);
    let mut turn: Quat = to.rotation * from.rotation.inverse();
    if turn.w < 0.0 {
        turn = -turn;
    }
    let (mut axis, mut angle) = turn.to_axis_angle();
    // A unique axis: one that points up, or right, or away.
    let main = axis.abs().max_position();
    if axis[main] < 0.0 {
        (axis, angle) = (-axis, -angle);
    }
    Some(Relation::Turned {
        axis,
        degrees: angle.to_degrees(),
    })
}

fn in_place_of(
    shown: &Demonstration,
    after: &Arrangement,
    manipulation: &Manipulation,
) -> Option<Relation> {
    let at = manipulation.to.location.truncate();
    let near = |pose: Pose| pose.location.truncate().distance(at);
    let object = shown.objects.iter().find(|other| {
        let id = other.spec.id.as_str();
        let first = other.track.at(shown.start);
        let has_left = |first| {
            after
                .pose(id)
                .is_none_or(|now| now.location.distance(first) > PLACE)
        };
        other.spec.id != manipulation.object
            && first.is_some_and(|first| near(first) < PLACE && has_left(first.location))
    })?;
    Some(Relation::InPlaceOf {
        object: object.spec.id.clone(),
    })
}

/// The neighbour of an object on the table or, if another one is on its opposite side, both.
fn beside(after: &Arrangement, id: &str, later: &[Manipulation]) -> Vec<Relation> {
    let Some(own) = after.get(id) else {
        return Vec::new();
    };
    let load = after.load(id);
    let stays =
        |other: &str| !load.contains(&other) && later.iter().all(|next| next.object != other);
    let mut near: Vec<_> = after
        .others(id)
        .filter(|(other, placed)| stays(other) && placed.lowest().abs() < TOUCH)
        .map(|(other, placed)| {
            (
                own.gap(placed),
                other,
                own.pose.location - placed.pose.location,
            )
        })
        .filter(|(gap, ..)| *gap < NEIGHBOURHOOD)
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some((_, nearest, way)) = near.first().copied() else {
        return Vec::new();
    };
    let is_opposite = |other: Vec3| way.truncate().angle_to(other.truncate()).abs() > OPPOSITE;
    let opposite = near.iter().find(|(.., other)| is_opposite(*other));
    let opposite = opposite.map(|(_, other, way)| (*other, *way));
    let both = std::iter::once((nearest, way)).chain(opposite);
    let relations = both.map(|(object, way)| Relation::Beside {
        object: object.to_owned(),
        side: RelativeSide::of(way),
    });
    relations.collect()
}

/// True if an orientation that looks like the one object's equals an orientation that looks like the other's.
fn is_aligned(shown: &Demonstration, after: &Arrangement, id: &str, other: &str) -> bool {
    let known = [id, other].map(|id| Some((shown.named(id)?, after.pose(id)?)));
    let [Some((_, own)), Some((_, other))] = known else {
        return false;
    };
    // Blocks are aligned up to quarter turns: their sides have no names.
    let relative = other.rotation.inverse() * own.rotation;
    let quarters = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| relative * axis);
    quarters.iter().all(|axis| {
        let main = axis.abs().max_position();
        let mut nearest = Vec3::ZERO;
        nearest[main] = axis[main].signum();
        angle_between(Quat::IDENTITY, Quat::from_rotation_arc(*axis, nearest)) < ALIGNED
    })
}
