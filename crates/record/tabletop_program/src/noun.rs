//! Nouns: the objects that a sentence is about.

use serde::{Deserialize, Serialize};
use tabletop_task::RelativeSide;

/// The objects that a sentence is about.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "noun", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Noun {
    /// An object by its id, or by the name that a procedure gives it.
    Named {
        /// The id.
        id: String,
    },
    /// Objects by their properties.
    Described {
        /// How many of them.
        quantity: HowMany,
        /// The kind of object.
        of: ObjectKind,
    },
}

/// How many objects of a kind are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum HowMany {
    /// The only one.
    The,
    /// Whichever.
    Any,
    /// All.
    Every,
    /// This number of them, 2 or more, whichever.
    Count(u32),
    /// Those that have most of a property.
    Most {
        /// Their number.
        count: u32,
        /// The property.
        of: Superlative,
    },
}

/// A comparison among the objects in view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Superlative {
    /// Of the greatest volume.
    Largest,
    /// Of the least volume.
    Smallest,
    /// Of the greatest mass.
    Heaviest,
    /// Of the least mass.
    Lightest,
    /// Of the greatest height as it lies.
    Tallest,
    /// Of the least height as it lies.
    Shortest,
    /// The farthest to the left.
    Leftmost,
    /// The farthest to the right.
    Rightmost,
    /// The nearest to the robot.
    Nearest,
    /// The farthest from the robot.
    Farthest,
    /// With nothing higher above the table.
    Topmost,
}

/// A kind of object.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObjectKind {
    /// True if those that the program has named before are not meant.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub other: bool,
    /// Its size among the objects of its kind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<RelativeSize>,
    /// The name of its colour.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<String>,
    /// What it is, as one word: `block`, `ball`, `tower`, or `object` for anything.
    pub is: String,
    /// What else is known of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub restriction: Option<Restriction>,
}

/// A size among the objects of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RelativeSize {
    /// Nearer to the smallest.
    Small,
    /// Nearer to the largest.
    Large,
}

/// What else is known of an object.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "restriction", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Restriction {
    /// Where it is.
    Where {
        /// True if it is not there.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        not: bool,
        /// The place.
        spot: Spot,
    },
    /// It is in, on, around or a part of this.
    From {
        /// The other.
        whole: Box<Noun>,
    },
    /// It is none of these.
    Except {
        /// These.
        others: Box<Noun>,
    },
    /// It has the feature of the object that is put to it.
    OfIts {
        /// The feature.
        feature: Feature,
    },
    /// One of its properties has this value.
    Whose {
        /// Name of the property, as `tabletop require` has it.
        property: String,
        /// The value.
        value: String,
    },
}

/// A feature that two objects may have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Feature {
    /// The name of their colour.
    Color,
    /// Their shape.
    Shape,
    /// Their size.
    Size,
}

/// Where something is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "spot", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Spot {
    /// On the table itself.
    Table {
        /// The part of the table.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        side: Option<TableSide>,
    },
    /// At another object.
    At {
        /// How.
        preposition: Preposition,
        /// The other object.
        noun: Box<Noun>,
    },
}

/// A relation to another object.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Preposition {
    /// Upon it, or upon what is upon it.
    On,
    /// In it, with walls on all sides.
    Inside,
    /// Around it, as a ring on its peg.
    Around,
    /// Beside it, on this side as the robot sees it.
    Beside(RelativeSide),
}

/// A part of the table, as the robot sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TableSide {
    /// Its left half.
    Left,
    /// Its right half.
    Right,
    /// The half that is nearer to the robot.
    Front,
    /// The other half.
    Back,
}

impl Noun {
    /// The object of this id.
    pub fn named(id: impl Into<String>) -> Self {
        Self::Named { id: id.into() }
    }
}

impl ObjectKind {
    /// All objects that are this, by one word.
    pub fn of(is: impl Into<String>) -> Self {
        Self {
            other: false,
            size: None,
            color: None,
            is: is.into(),
            restriction: None,
        }
    }
}

impl Spot {
    /// The table, wherever.
    pub const TABLE: Self = Self::Table { side: None };

    /// At an object.
    pub fn at(preposition: Preposition, noun: Noun) -> Self {
        Self::At {
            preposition,
            noun: Box::new(noun),
        }
    }

    /// The object that it is at.
    pub(crate) fn noun(&self) -> Option<&Noun> {
        match self {
            Self::Table { .. } => None,
            Self::At { noun, .. } => Some(noun),
        }
    }
}
