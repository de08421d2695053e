//! Where an object is to be.

use bevy::math::Vec3;
use serde::{Deserialize, Serialize};
use tabletop_core::Pose;

use crate::{
    demonstration::Demonstration,
    manipulation::{Ending, Manipulation},
    relation::Relation,
    symmetry::{Symmetry, Turns},
};

/// The pose that a step is to bring its object to, relative to something else.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Goal {
    /// Relative to what.
    pub reference: Reference,
    /// The object's pose in the frame of the reference, as it was shown.
    pub pose: Pose,
    /// Which other orientations are as good: those after which the object looks the same.
    pub freedom: Freedom,
    /// Which other locations are as good.
    pub place: PlaceRange,
}

/// What a goal is relative to. Objects are meant by their ids.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Reference {
    /// The table.
    Table,
    /// Where another object is.
    Object {
        /// The object.
        object: String,
    },
    /// Where an object was in the beginning.
    PlaceOf {
        /// The object.
        object: String,
    },
    /// Where the object itself was before the step.
    Itself,
}

/// How many orientations look like that of a goal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Freedom {
    /// So many.
    Orientations(usize),
    /// All about an axis of the object, and perhaps those upside down.
    About {
        /// The axis, in the object's frame.
        axis: Vec3,
        /// Whether upside down looks the same.
        ends_alike: bool,
    },
    /// All.
    Any,
}

/// Which locations do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PlaceRange {
    /// That of the goal.
    Exact,
    /// Any in the reference.
    Inside,
    /// Any free one on the table.
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
    /// The goal of a manipulation that establishes these relations; none for what is removed or only held.
    pub(crate) fn of(
        shown: &Demonstration,
        manipulation: &Manipulation,
        relations: &[Relation],
    ) -> Option<Self> {
        if manipulation.ending != Ending::Released {
            return None;
        }
        let object = shown.named(&manipulation.object)?;
        let after = shown.at(manipulation.rest);
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
            Some(Relation::OnTable | Relation::Destroyed | Relation::Held) | None => {
                Reference::Table
            }
        };
        let frame = match &reference {
            Reference::Table => Pose::IDENTITY,
            Reference::Object { object } => after.pose(object)?,
            Reference::PlaceOf { object } => shown.named(object)?.track.at(shown.start)?,
            Reference::Itself => manipulation.from,
        };
        Some(Self {
            reference,
            pose: frame.inverse() * manipulation.to,
            freedom: Freedom::from(&Symmetry::of(&object.spec.shape)),
            place,
        })
    }
}
