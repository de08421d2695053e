//! Goals of objects: when they are reached, and the step that reaches them.

use bevy::math::Vec3;
use tabletop_core::ObjectSpec;
use tabletop_geometry::{PlacedSolid, Pose};
use tabletop_task::{Arrangement, Relation, RelativeSide};

use crate::{
    noun::TableSide,
    placement::Room,
    scene::{SceneView, solids_at},
    step::ConcreteStep,
};

/// Where an object is to be, and where it has been sent.
#[derive(Clone, Debug)]
pub(crate) struct ObjectGoal {
    pub object: String,
    pub goal: GoalKind,
    pub sent: Option<Pose>,
}

/// Where an object is to be. Other objects are given by their ids.
#[derive(Clone, Debug)]
pub(crate) enum GoalKind {
    /// On another one, or on what stands on that.
    Upon(String),
    /// On another one itself, with nothing else on it.
    Directly(String),
    Inside(String),
    Around(String),
    Beside(String, RelativeSide),
    Table(Option<TableSide>),
    /// At this pose, and nothing else there.
    At(Pose),
    Aside,
    Removed,
    /// Its lid or drawer is open, or closed.
    Slid(bool),
}

/// The reason why a goal cannot be reached, and the object that it is about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Hindrance {
    pub object: Option<String>,
    pub reason: String,
}

/// Largest distance from its goal, in units, at which an object is there.
const NEAR: f32 = 0.3;

impl Hindrance {
    pub fn of(object: &str, reason: impl Into<String>) -> Self {
        Self {
            object: Some(object.to_owned()),
            reason: reason.into(),
        }
    }
}

impl From<String> for Hindrance {
    fn from(reason: String) -> Self {
        Self {
            object: None,
            reason,
        }
    }
}

impl ObjectGoal {
    pub fn new(object: &str, goal: GoalKind) -> Self {
        Self {
            object: object.to_owned(),
            goal,
            sent: None,
        }
    }

    /// The object that is moved to reach it: of what has a lid or a drawer, that.
    pub fn moved(&self, view: &SceneView) -> String {
        if let GoalKind::Slid(_) = self.goal
            && let Some(sliding) = view.sliding_part(&self.object)
        {
            return sliding.part;
        }
        self.object.clone()
    }

    /// True if it is reached.
    pub fn is_met(&self, view: &SceneView) -> bool {
        let id = self.object.as_str();
        let Some(object) = view.object(id) else {
            return matches!(self.goal, GoalKind::Removed);
        };
        let is_near = |pose: Pose| pose.location.distance(object.pose.location) < NEAR;
        let is_so = match &self.goal {
            GoalKind::Upon(base) => view.is_upon(id, base),
            GoalKind::Directly(base) => view.standing.rests_on(id, base),
            GoalKind::Inside(container) => view.is_inside(id, container),
            GoalKind::Around(post) => view.standing.is_around(id, post),
            GoalKind::Beside(other, side) => view.is_beside(id, other, *side),
            GoalKind::Table(side) => {
                let is_there = side.is_none_or(|side| side.has(object.pose.location));
                view.standing.is_on_table(id) && is_there
            }
            GoalKind::At(pose) => is_near(*pose),
            GoalKind::Aside => self.sent.is_some(),
            GoalKind::Removed => false,
            GoalKind::Slid(open) => view
                .sliding_part(id)
                .is_some_and(|part| part.is_open() == *open),
        };
        is_so || self.sent.is_some_and(is_near)
    }

    /// The step that reaches it, or one that makes room for that. Places in `kept` are to stay free.
    pub fn step(
        &mut self,
        view: &SceneView,
        kept: &[PlacedSolid],
    ) -> Result<ConcreteStep, Hindrance> {
        let id = self.object.clone();
        let object = view
            .object(&id)
            .ok_or_else(|| Hindrance::of(&id, "it is not there"))?;
        if let GoalKind::Slid(open) = self.goal {
            return slide(view, &id, open);
        }
        if !view.is_movable(&id) {
            return Err(Hindrance::of(&id, "it cannot be moved"));
        }
        if let Some(above) = view.stack_above(&id).first() {
            return put_aside(view, above, kept);
        }
        let room = Room::new(view, object);
        let no_room = |place: &str| Hindrance::of(&id, format!("there is no room for it {place}"));
        let is_itself = self.goal.other() == Some(&id);
        if is_itself {
            return Err(Hindrance::of(&id, "it cannot be put to itself"));
        }
        let pose = match &self.goal {
            GoalKind::Upon(base) => room
                .upon(base)
                .ok_or_else(|| no_room(&format!("on {base}")))?,
            GoalKind::Directly(base) => {
                let mut above = view.stack_above(base).into_iter();
                if let Some(above) = above.find(|above| *above != id) {
                    return put_aside(view, &above, kept);
                }
                room.directly_upon(base)
                    .ok_or_else(|| no_room(&format!("on {base}")))?
            }
            GoalKind::Inside(container) => {
                let lid = view.sliding_part(container);
                if lid.is_some_and(|lid| lid.holder == *container && !lid.is_open()) {
                    return Err(Hindrance::of(&id, format!("{container} is closed")));
                }
                room.within(container)
                    .ok_or_else(|| no_room(&format!("in {container}")))?
            }
            GoalKind::Around(post) => room.resting(view.location(post), object.pose.rotation),
            GoalKind::Beside(other, side) => room
                .beside(other, *side)
                .ok_or_else(|| no_room(&format!("beside {other}")))?,
            GoalKind::Table(side) => {
                let spot = room
                    .keeping(kept.to_vec())
                    .free_spot(object.pose.location, *side);
                spot.ok_or_else(|| no_room("on the table"))?
            }
            GoalKind::At(pose) => match room.occupant(*pose) {
                Some(occupant) => {
                    let above = view.stack_above(occupant);
                    let first = above.first().map_or(occupant, String::as_str);
                    return put_aside(view, first, kept);
                }
                None => *pose,
            },
            GoalKind::Aside => {
                let spot = room
                    .keeping(kept.to_vec())
                    .free_spot(object.pose.location, None);
                spot.ok_or_else(|| no_room("on the table"))?
            }
            GoalKind::Removed => {
                return Ok(ConcreteStep {
                    object: id,
                    relation: Relation::Destroyed,
                    pose: None,
                });
            }
            GoalKind::Slid(open) => return slide(view, &id, *open),
        };
        self.sent = Some(pose);
        Ok(ConcreteStep {
            relation: self.goal.relation(view, object, pose),
            object: id,
            pose: Some(pose),
        })
    }
}

impl GoalKind {
    /// The other object that it names.
    fn other(&self) -> Option<&String> {
        match self {
            Self::Upon(other)
            | Self::Directly(other)
            | Self::Inside(other)
            | Self::Around(other)
            | Self::Beside(other, _) => Some(other),
            Self::Table(_) | Self::At(_) | Self::Aside | Self::Removed | Self::Slid(_) => None,
        }
    }

    /// The relation that an object has once it is at a pose for this goal.
    fn relation(&self, view: &SceneView, object: &ObjectSpec, pose: Pose) -> Relation {
        match self {
            Self::Inside(other) => Relation::Inside {
                object: other.clone(),
            },
            Self::Around(other) => Relation::Around {
                object: other.clone(),
            },
            Self::Beside(other, side) => Relation::Beside {
                object: other.clone(),
                side: *side,
            },
            Self::Aside => Relation::Aside,
            Self::Removed => Relation::Destroyed,
            Self::Upon(_) | Self::Directly(_) | Self::Table(_) | Self::At(_) | Self::Slid(_) => {
                let objects = view.scene.objects.iter();
                let arrangement = Arrangement::new(objects.map(|other| {
                    let here = if other.id == object.id {
                        pose
                    } else {
                        other.pose
                    };
                    (other.id.as_str(), &other.shape, here)
                }));
                let first = |found: Vec<&str>| found.first().map(|other| (*other).to_owned());
                if let Some(object) = first(arrangement.containers(&object.id)) {
                    return Relation::Inside { object };
                }
                let support = first(arrangement.supports(&object.id));
                support.map_or(Relation::OnTable, |object| Relation::On { object })
            }
        }
    }
}

/// Puts an object aside that is in the way.
fn put_aside(view: &SceneView, id: &str, kept: &[PlacedSolid]) -> Result<ConcreteStep, Hindrance> {
    let in_the_way = || Hindrance::of(id, "it is in the way, and cannot be moved");
    let object = view
        .object(id)
        .filter(|_| view.is_movable(id))
        .ok_or_else(in_the_way)?;
    let room = Room::new(view, object).keeping(kept.to_vec());
    let spot = room.free_spot(object.pose.location, None);
    let pose = spot.ok_or_else(|| Hindrance::of(id, "there is no room to put it aside"))?;
    Ok(ConcreteStep {
        object: id.to_owned(),
        relation: Relation::Aside,
        pose: Some(pose),
    })
}

fn slide(view: &SceneView, id: &str, open: bool) -> Result<ConcreteStep, Hindrance> {
    let none = || Hindrance::of(id, "it has neither lid nor drawer");
    let sliding = view.sliding_part(id).ok_or_else(none)?;
    let part = view.object(&sliding.part).ok_or_else(none)?;
    let by: Vec3 = sliding.by(open);
    Ok(ConcreteStep {
        object: sliding.part.clone(),
        relation: Relation::Slid {
            object: sliding.holder.clone(),
            opening: if open { sliding.travel } else { 0.0 },
            travel: sliding.travel,
        },
        pose: Some(Pose::new(part.pose.location + by, part.pose.rotation)),
    })
}

/// The solids of the objects of these goals at the poses that they are to have.
pub(crate) fn kept_places(view: &SceneView, goals: &[ObjectGoal]) -> Vec<PlacedSolid> {
    let places = goals.iter().filter_map(|goal| match goal.goal {
        GoalKind::At(pose) => Some(solids_at(view.object(&goal.object)?, pose)),
        GoalKind::Upon(_)
        | GoalKind::Directly(_)
        | GoalKind::Inside(_)
        | GoalKind::Around(_)
        | GoalKind::Beside(..)
        | GoalKind::Table(_)
        | GoalKind::Aside
        | GoalKind::Removed
        | GoalKind::Slid(_) => None,
    });
    places.flatten().collect()
}
