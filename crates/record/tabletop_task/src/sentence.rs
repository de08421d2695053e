//! Sentences about steps.

use std::fmt;

use bevy::math::Vec3;
use tabletop_core::{Hand, Manipulator};

use crate::{
    relation::Relation, requirement::Requirements, role::Role, spot::spot, step::TaskStep,
    task::Task, tipping::Tipping,
};

impl Task {
    /// Writes the sentences again, with the requirements on the objects.
    pub fn phrase(&mut self, requirements: &Requirements) {
        for role in &mut self.roles {
            let shown = self.nouns.get(&role.id).cloned();
            if let Some(noun) = requirements.phrase(&role.id).or(shown) {
                role.noun = noun;
            }
        }
        self.tell_apart();
        for i in 0..self.steps.len() {
            self.steps[i].sentence = sentence(self, &self.steps[i]);
        }
    }

    /// Numbers the roles that have the same name.
    fn tell_apart(&mut self) {
        let nouns: Vec<_> = self.roles.iter().map(|role| role.noun.clone()).collect();
        for (i, role) in self.roles.iter_mut().enumerate() {
            let alike = |nouns: &[String]| nouns.iter().filter(|noun| **noun == role.noun).count();
            if alike(&nouns) > 1 {
                role.noun = numbered(&role.noun, alike(&nouns[..i]));
            }
        }
    }
}

/// A name that so many roles before have, too.
fn numbered(noun: &str, before: usize) -> String {
    let (kind, is_any) = match (noun.strip_prefix("any "), noun.strip_prefix("the ")) {
        (Some(kind), _) => (kind, true),
        (None, kind) => (kind.unwrap_or(noun), false),
    };
    match (ORDINALS.get(before), is_any) {
        (Some(_), true) if before == 0 => noun.to_owned(),
        (Some(_), true) if before == 1 => format!("another {kind}"),
        (Some(ordinal), true) => format!("a {ordinal} {kind}"),
        (Some(ordinal), false) => format!("the {ordinal} {kind}"),
        (None, _) => format!("{kind} {}", before + 1),
    }
}

/// Words that tell roles of the same name apart, in the order of the roles; further ones have numbers.
const ORDINALS: [&str; 5] = ["first", "second", "third", "fourth", "fifth"];

/// A step in one sentence.
fn sentence(task: &Task, step: &TaskStep) -> String {
    let noun = |id: &str| task.noun(id);
    let object = with_load(task, step);
    let place = place(task, step);
    let deed = match step.relations.first() {
        Some(Relation::Destroyed) => format!("remove {object}"),
        Some(Relation::Held) => format!("pick up {object}"),
        Some(Relation::LetGo) => format!("let go of {object} in the air"),
        Some(Relation::Turned { axis, degrees }) => match step.tipping {
            Some(tipping) => tipped(tipping, &object),
            None => format!("turn {object} {}", turn(*axis, *degrees)),
        },
        Some(Relation::Slid {
            object: on,
            opening,
            travel,
        }) => {
            // A box is opened by its lid, and a drawer by itself.
            let is_lid = task.role(&step.object).is_some_and(Role::is_lid);
            let opened = if is_lid { noun(on) } else { object };
            match opening / travel {
                open if open > 0.9 => format!("open {opened}"),
                open if open < 0.1 => format!("close {opened}"),
                _ => format!("open {opened} by {opening:.1}"),
            }
        }
        Some(
            Relation::OnTable
            | Relation::On { .. }
            | Relation::Inside { .. }
            | Relation::Around { .. }
            | Relation::Against { .. }
            | Relation::Beside { .. }
            | Relation::AlignedWith { .. }
            | Relation::InPlaceOf { .. }
            | Relation::Aside,
        )
        | None => match handing_over(&step.hands) {
            Some(hands) => format!(
                "hand {object} {hands} and {}",
                put(task, step, "it", &place)
            ),
            None => put(task, step, &object, &place),
        },
    };
    let deed = match step.meanwhile {
        true => format!("meanwhile, {deed}"),
        false => deed,
    };
    let mut letters = deed.chars();
    let first = letters.next().map(|letter| letter.to_ascii_uppercase());
    first.into_iter().chain(letters).chain(['.']).collect()
}

/// The object of a step, with those that go along with it.
fn with_load(task: &Task, step: &TaskStep) -> String {
    let mut inside = Vec::<&str>::new();
    let (mut within, mut upon) = (Vec::new(), Vec::new());
    for load in &step.load {
        let mut relations = load.relations.iter();
        let is_inside = relations.any(|relation| {
            let is_directly =
                matches!(relation, Relation::Inside { object } if *object == step.object);
            let base = relation.object();
            is_directly || base.is_some_and(|base| inside.contains(&base))
        });
        match is_inside {
            true => {
                inside.push(&load.object);
                within.push(task.noun(&load.object));
            }
            false => upon.push(task.noun(&load.object)),
        }
    }
    let object = task.noun(&step.object);
    match (listed(&within), listed(&upon)) {
        (within, upon) if within.is_empty() && upon.is_empty() => object,
        (within, upon) if upon.is_empty() => format!("{object} with {within} in it"),
        (within, upon) if within.is_empty() => format!("{object} with {upon} on it"),
        (within, upon) => format!("{object} with {within} in it and {upon} on it"),
    }
}

/// The putting of an object to a place, on whichever of its sides.
fn put(task: &Task, step: &TaskStep, object: &str, place: &PlacePhrase) -> String {
    if let Some(spill) = &step.spilled {
        let from = task.noun(&spill.from);
        return match spill.was_inside {
            true => format!("pour {object} out of {from} {}", place.ground()),
            false => format!("tip {object} off {from} {}", place.ground()),
        };
    }
    if let Some(Relation::Against { .. }) = step.relations.first() {
        return format!("lean {object} {place}");
    }
    match step.tipping {
        None if !step.load.is_empty() => format!("move {object} {}", place.end()),
        None => format!("put {object} {place}"),
        Some(tipping @ (Tipping::StoodUp | Tipping::LaidDown)) => {
            format!("{} {place}", tipped(tipping, object))
        }
        Some(tipping @ (Tipping::TurnedOver | Tipping::OntoAnotherSide)) => {
            format!("{} and put it {place}", tipped(tipping, object))
        }
    }
}

fn tipped(tipping: Tipping, object: &str) -> String {
    match tipping {
        Tipping::StoodUp => format!("stand {object} up"),
        Tipping::LaidDown => format!("lay {object} down"),
        Tipping::TurnedOver => format!("turn {object} over"),
        Tipping::OntoAnotherSide => format!("tip {object} onto another side"),
    }
}

/// The place to which a step brings its object.
enum PlacePhrase {
    /// On these objects.
    On(String),
    /// Where this object was.
    Of(String),
    /// At this spot of the table.
    Table(String),
    /// Anywhere else, in words.
    Elsewhere(String),
}

impl fmt::Display for PlacePhrase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::On(objects) => write!(f, "on {objects}"),
            Self::Of(object) => write!(f, "where {object} was"),
            Self::Table(spot) => write!(f, "on the table at {spot}"),
            Self::Elsewhere(place) => write!(f, "{place}"),
        }
    }
}

impl PlacePhrase {
    /// The place as the end of a motion.
    fn end(&self) -> String {
        match self {
            Self::On(objects) => format!("onto {objects}"),
            Self::Of(object) => format!("to where {object} was"),
            Self::Table(spot) => format!("to {spot}"),
            Self::Elsewhere(place) => place.clone(),
        }
    }

    /// The place as the end of a fall.
    fn ground(&self) -> String {
        match self {
            Self::Table(spot) => format!("onto the table at {spot}"),
            Self::On(_) | Self::Of(_) | Self::Elsewhere(_) => self.end(),
        }
    }
}

fn place(task: &Task, step: &TaskStep) -> PlacePhrase {
    let noun = |id: &str| task.noun(id);
    let supports = step.relations.iter().filter_map(|relation| {
        let Relation::On { object } = relation else {
            return None;
        };
        Some(noun(object))
    });
    let on: Vec<_> = supports.collect();
    let on = listed(&on);
    match step.relations.first() {
        Some(Relation::Around { object }) => PlacePhrase::Elsewhere(match on.is_empty() {
            true => format!("around {}", noun(object)),
            false => format!("around {}, on {on}", noun(object)),
        }),
        Some(Relation::Inside { object }) => PlacePhrase::Elsewhere(match on.is_empty() {
            true => format!("into {}", noun(object)),
            false => format!("into {}, on {on}", noun(object)),
        }),
        Some(Relation::On { .. }) => PlacePhrase::On(on),
        Some(Relation::Against { .. }) => {
            let props = step.relations.iter();
            let props = props.filter(|relation| matches!(relation, Relation::Against { .. }));
            let held = props.filter_map(|prop| prop.object().map(noun));
            PlacePhrase::Elsewhere(format!("against {}", listed(&held.collect::<Vec<_>>())))
        }
        Some(Relation::Beside { object, side }) => {
            PlacePhrase::Elsewhere(match step.relations.get(1) {
                Some(Relation::Beside { object: other, .. }) => {
                    format!("between {} and {}", noun(object), noun(other))
                }
                Some(_) | None => format!("{} {}", side.words(), noun(object)),
            })
        }
        Some(Relation::InPlaceOf { object }) => PlacePhrase::Of(noun(object)),
        Some(Relation::Aside) => PlacePhrase::Elsewhere("aside".into()),
        Some(
            Relation::OnTable
            | Relation::AlignedWith { .. }
            | Relation::Slid { .. }
            | Relation::Turned { .. }
            | Relation::LetGo
            | Relation::Destroyed
            | Relation::Held,
        )
        | None => {
            let goal = step.goal.as_ref();
            PlacePhrase::Table(spot(goal.map_or(Vec3::ZERO, |goal| goal.pose.location)))
        }
    }
}

fn handing_over(hands: &[Manipulator]) -> Option<String> {
    let [first, .., last] = hands else {
        return None;
    };
    (first != last).then(|| format!("from {} to {}", holder(*first), holder(*last)))
}

fn holder(by: Manipulator) -> String {
    match by {
        Manipulator::Hand(Hand::Left) => "the left hand".into(),
        Manipulator::Hand(Hand::Right) => "the right hand".into(),
        Manipulator::Hand(Hand::Both) => "both hands".into(),
        Manipulator::Hand(Hand::Any) => "a free hand".into(),
        Manipulator::Gripper(limb) => format!("the {limb} gripper"),
    }
}

fn turn(axis: Vec3, degrees: f32) -> String {
    let degrees_whole = degrees.abs().round();
    let is_about = |other: Vec3| axis.dot(other) > 0.99;
    if is_about(Vec3::Z) {
        let way = if degrees > 0.0 {
            "counterclockwise"
        } else {
            "clockwise"
        };
        return format!("by {degrees_whole}° {way}");
    }
    let about = match (is_about(Vec3::X), is_about(Vec3::Y)) {
        (true, _) => "X".to_owned(),
        (_, true) => "Y".to_owned(),
        _ => format!("({:.1}, {:.1}, {:.1})", axis.x, axis.y, axis.z),
    };
    format!("by {}° about {about}", degrees.round())
}

/// `a`, `a and b`, `a, b and c`.
pub(crate) fn listed(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::LimbName;

    use super::*;

    #[test]
    fn lists_and_turns_read_as_english() {
        let names = ["a", "b", "c"].map(str::to_owned);
        assert_eq!(listed(&names), "a, b and c");
        assert_eq!(listed(&names[..2]), "a and b");
        assert_eq!(turn(Vec3::Z, -45.2), "by 45° clockwise");
        assert_eq!(turn(Vec3::X, -90.0), "by -90° about X");
        let [left, right] = [Hand::Left, Hand::Right].map(Manipulator::Hand);
        let gripper = Manipulator::Gripper(LimbName::from_static("left"));
        assert_eq!(handing_over(&[left]), None);
        for (hands, words) in [
            ([left, right], "from the left hand to the right hand"),
            ([gripper, right], "from the left gripper to the right hand"),
        ] {
            assert_eq!(handing_over(&hands).as_deref(), Some(words));
        }
    }
}
