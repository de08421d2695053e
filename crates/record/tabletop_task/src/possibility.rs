//! Requirements that an object can meet.

use tabletop_core::Shape;
use tabletop_geometry::{ColorError, Rgb};

use crate::{
    property::{LENGTHS, PropertyKind, is_same_text, numbers, range},
    task::Task,
};

/// The property that means "the same object as in another step".
pub(crate) const SAME: &str = "same";

/// The most lengths that define a shape.
const MOST_LENGTHS: usize = 3;

/// The reason why no object can meet a requirement.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "the message says it")]
pub enum ImpossibleRequirement {
    #[error("`{name}` is no property of an object; expected one of {known}")]
    Property { name: String, known: String },
    #[error("no object has the {name} `{value}`; expected {expected}")]
    Value {
        name: String,
        value: String,
        expected: String,
    },
    #[error(transparent)]
    Color(#[from] ColorError),
    #[error("the demonstration has no step {0}")]
    NoStep(String),
}

impl Task {
    /// Checks that some object can have this value of a property.
    pub(crate) fn check(&self, name: &str, value: &str) -> Result<(), ImpossibleRequirement> {
        if name == SAME {
            let step = value.trim().parse().ok().and_then(|step| self.step(step));
            let no_step = || ImpossibleRequirement::NoStep(value.to_owned());
            return step.map(|_| ()).ok_or_else(no_step);
        }
        if self.knows(name, value) {
            return Ok(());
        }
        let expected = match PropertyKind::of(name) {
            PropertyKind::Color => return Ok(value.parse::<Rgb>().map(|_| ())?),
            PropertyKind::Description if !self.vocabulary.contains_key(name) => {
                let (name, known) = (name.to_owned(), self.property_names());
                return Err(ImpossibleRequirement::Property { name, known });
            }
            PropertyKind::Id | PropertyKind::Description if !value.trim().is_empty() => {
                return Ok(());
            }
            PropertyKind::Length | PropertyKind::Mass if is_amount(value) => return Ok(()),
            PropertyKind::Size if is_size(value) => return Ok(()),
            PropertyKind::Id | PropertyKind::Description => "a text".to_owned(),
            PropertyKind::Length | PropertyKind::Mass => {
                "a number that is not negative, or a range such as 1..2".to_owned()
            }
            PropertyKind::Size => "one to three lengths, such as 2x2x1".to_owned(),
            PropertyKind::Shape => match self.shape_names() {
                known if known.iter().any(|known| is_same_text(known, value)) => return Ok(()),
                known => format!("one of {}", known.join(", ")),
            },
        };
        Err(ImpossibleRequirement::Value {
            name: name.to_owned(),
            value: value.to_owned(),
            expected,
        })
    }

    /// True if the demonstration has an object of this id.
    pub(crate) fn has_object(&self, id: &str) -> bool {
        let ids = self.vocabulary.get("id");
        ids.is_some_and(|ids| ids.contains(id))
    }

    /// True if an object of the demonstration has this text as a property.
    fn knows(&self, name: &str, value: &str) -> bool {
        let mut known = self.vocabulary.get(name).into_iter().flatten();
        known.any(|known| is_same_text(known, value))
    }

    /// The shapes of objects. That of a mesh is its file's name.
    fn shape_names(&self) -> Vec<&str> {
        let known = Shape::NAMES.into_iter().filter(|name| *name != "custom");
        let shown = self.vocabulary.get("shape").into_iter().flatten();
        let further = shown.filter(|name| !Shape::NAMES.contains(&name.as_str()));
        known.chain(further.map(String::as_str)).collect()
    }

    fn property_names(&self) -> String {
        let known = ["id", "shape", "color", "size", "mass"].into_iter();
        let known = known.chain(LENGTHS);
        let described = self.vocabulary.keys().map(String::as_str);
        let described =
            described.filter(|name| PropertyKind::of(name) == PropertyKind::Description);
        let all: Vec<_> = known.chain(described).chain([SAME]).collect();
        all.join(", ")
    }
}

/// True if a length or a mass can be this number, or in this range.
fn is_amount(value: &str) -> bool {
    match (range(value), numbers(value).as_deref()) {
        (Some((least, most)), _) => least <= most && most >= 0.0,
        (None, Some([number])) => *number >= 0.0,
        (None, _) => false,
    }
}

fn is_size(value: &str) -> bool {
    let lengths = numbers(value);
    let is_size = lengths
        .is_some_and(|all| all.len() <= MOST_LENGTHS && all.iter().all(|length| *length >= 0.0));
    is_size || is_amount(value)
}
