//! Goals of objects.

use bevy::math::Vec3;
use serde::{Deserialize, Serialize};
use tabletop_geometry::Pose;

use crate::{
    arrangement::Arrangement,
    demonstration::Demonstration,
    manipulation::{Ending, Manipulation},
    relation::Relation,
    symmetry::{Symmetry, Turns},
};

/// The pose to which a step brings its object, relative to a reference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Goal {
    /// The reference.
    pub reference: Reference,
    /// The object's pose in the frame of the reference, as demonstrated.
    pub pose: Pose,
    /// The vertical in the frame of the reference, as demonstrated: a unit vector.
    pub up: Vec3,
    /// The orientations that are as good: those in which the object looks the same.
    pub freedom: Freedom,
    /// The locations that are as good.
    pub place: PlaceRange,
}

/// The reference of a goal. Objects are given by their ids.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Reference {
    /// The table.
    Table,
    /// The present pose of another object.
    Object {
        /// The object.
        object: String,
    },
    /// The first pose of an object.
    PlaceOf {
        /// The object.
        object: String,
    },
    /// The pose of the moved object itself before the step.
    Itself,
}

/// The freedom of a goal's orientation: the orientations that look like the demonstrated one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Freedom {
    /// A number of orientations.
    Orientations(usize),
    /// All orientations about an axis of the object, perhaps including those upside down.
    About {
        /// The axis, in the object's frame.
        axis: Vec3,
        /// True if the object looks the same upside down.
        ends_alike: bool,
    },
    /// All orientations.
    Any,
}

/// The freedom of a goal's location.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PlaceRange {
    /// The location of the goal only.
    Exact,
    /// Any location inside the reference.
    Inside,
    /// Any free location on the table.
    Anywhere,
}

impl From<&Symmetry> for Freedom {
    fn from(symmetry: &Symmetry) -> Self {
        match symmetry.turns {
            Turns::Finite(ref turns) => Self::Orientations(turns.len()),
            Turns::About { axis, ends_alike } => Self::About { axis, ends_alike },
            Turns::Any => Self::Any,
        }
    }
}

impl Goal {
    /// The goal of a manipulation that establishes these relations; `None` if its object is removed, only held, or still
    /// falls.
    pub(crate) fn of(
        shown: &Demonstration,
        manipulation: &Manipulation,
        relations: &[Relation],
    ) -> Option<Self> {
        if manipulation.ending != Ending::Released || relations.first() == Some(&Relation::LetGo) {
            return None;
        }
        let after = shown.at(manipulation.rest);
        let way = [manipulation.from, manipulation.to];
        Self::at(shown, &after, &manipulation.object, relations, way)
    }

    /// The goal of an object that is brought from one pose to another, where these relations hold.
    pub(crate) fn at(
        shown: &Demonstration,
        after: &Arrangement,
        id: &str,
        relations: &[Relation],
        [from, to]: [Pose; 2],
    ) -> Option<Self> {
        let object = shown.named(id)?;
        let mut place = PlaceRange::Exact;
        let reference = match relations.first() {
            Some(Relation::Inside { object }) => {
                place = PlaceRange::Inside;
                Reference::Object {
                    object: object.clone(),
                }
            }
            Some(
                Relation::On { object }
                | Relation::Around { object }
                | Relation::Against { object }
                | Relation::Beside { object, .. }
                | Relation::AlignedWith { object }
                | Relation::Slid { object, .. },
            ) => Reference::Object {
                object: object.clone(),
            },
            Some(Relation::InPlaceOf { object }) => Reference::PlaceOf {
                object: object.clone(),
            },
            Some(Relation::Turned { .. }) => Reference::Itself,
            Some(Relation::Aside) => {
                place = PlaceRange::Anywhere;
                Reference::Table
            }
            Some(Relation::OnTable | Relation::LetGo | Relation::Destroyed | Relation::Held)
            | None => Reference::Table,
        };
        let frame = match &reference {
            Reference::Table => Pose::IDENTITY,
            Reference::Object { object } => after.pose(object)?,
            Reference::PlaceOf { object } => shown.named(object)?.track.at(shown.start)?,
            Reference::Itself => from,
        };
        Some(Self {
            reference,
            pose: frame.inverse() * to,
            up: frame.rotation.inverse() * Vec3::Z,
            freedom: Freedom::from(&Symmetry::of(&object.spec.shape)),
            place,
        })
    }
}
