//! Sentences about steps.

use bevy::math::Vec3;
use tabletop_core::Hand;

use crate::{
    relation::{Relation, RelativeSide},
    requirement::Requirements,
    spot::spot,
    step::TaskStep,
    task::Task,
    tipping::Tipping,
};

impl Task {
    /// Writes the sentences again, with the requirements on the objects.
    pub fn phrase(&mut self, requirements: &Requirements) {
        for role in &mut self.roles {
            if let Some(phrase) = requirements.phrase(&role.id) {
                role.noun = phrase;
            }
        }
        for i in 0..self.steps.len() {
            self.steps[i].sentence = sentence(self, &self.steps[i]);
        }
    }
}

/// A step in one sentence.
fn sentence(task: &Task, step: &TaskStep) -> String {
    let noun = |id: &str| {
        task.role(id)
            .map_or_else(|| id.to_owned(), |role| role.noun.clone())
    };
    let object = noun(&step.object);
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
            let (whole, lid) = (noun(on), &object);
            match opening / travel {
                open if open > 0.9 => format!("open {whole}"),
                open if open < 0.1 => format!("close {whole}"),
                _ => format!("slide {lid} open by {opening:.1}"),
            }
        }
        Some(
            Relation::OnTable
            | Relation::On { .. }
            | Relation::Inside { .. }
            | Relation::Around { .. }
            | Relation::Beside { .. }
            | Relation::AlignedWith { .. }
            | Relation::InPlaceOf { .. }
            | Relation::Aside,
        )
        | None => match handing_over(&step.hands) {
            Some(hands) => format!("hand {object} {hands} and {}", put(step, "it", &place)),
            None => put(step, &object, &place),
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

/// The putting of an object to a place, on whichever of its sides.
fn put(step: &TaskStep, object: &str, place: &str) -> String {
    match step.tipping {
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
fn place(task: &Task, step: &TaskStep) -> String {
    let noun = |id: &str| {
        task.role(id)
            .map_or_else(|| id.to_owned(), |role| role.noun.clone())
    };
    let supports = step.relations.iter().filter_map(|relation| {
        let Relation::On { object } = relation else {
            return None;
        };
        Some(noun(object))
    });
    let on: Vec<_> = supports.collect();
    let on = listed(&on);
    match step.relations.first() {
        Some(Relation::Around { object }) => match on.is_empty() {
            true => format!("around {}", noun(object)),
            false => format!("around {}, on {on}", noun(object)),
        },
        Some(Relation::Inside { object }) => match on.is_empty() {
            true => format!("into {}", noun(object)),
            false => format!("into {}, on {on}", noun(object)),
        },
        Some(Relation::On { .. }) => format!("on {on}"),
        Some(Relation::Beside { object, side }) => format!("{} {}", beside(*side), noun(object)),
        Some(Relation::InPlaceOf { object }) => format!("where {} was", noun(object)),
        Some(Relation::Aside) => "aside".into(),
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
            let at = step
                .goal
                .as_ref()
                .map_or(Vec3::ZERO, |goal| goal.pose.location);
            format!("on the table at {}", spot(at))
        }
    }
}

fn beside(side: RelativeSide) -> &'static str {
    match side {
        RelativeSide::Left => "to the left of",
        RelativeSide::Right => "to the right of",
        RelativeSide::Front => "in front of",
        RelativeSide::FrontLeft => "in front and to the left of",
        RelativeSide::FrontRight => "in front and to the right of",
        RelativeSide::Behind => "behind",
        RelativeSide::BehindLeft => "behind and to the left of",
        RelativeSide::BehindRight => "behind and to the right of",
    }
}

fn handing_over(hands: &[Hand]) -> Option<String> {
    let [first, .., last] = hands else {
        return None;
    };
    (first != last).then(|| format!("from {} to {}", hand(*first), hand(*last)))
}

fn hand(hand: Hand) -> &'static str {
    match hand {
        Hand::Left => "the left hand",
        Hand::Right => "the right hand",
        Hand::Both => "both hands",
        Hand::Any => "a free hand",
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
    use super::*;

    #[test]
    fn lists_and_turns_read_as_english() {
        let names = ["a", "b", "c"].map(str::to_owned);
        assert_eq!(listed(&names), "a, b and c");
        assert_eq!(listed(&names[..2]), "a and b");
        assert_eq!(turn(Vec3::Z, -45.2), "by 45° clockwise");
        assert_eq!(turn(Vec3::X, -90.0), "by -90° about X");
        assert_eq!(handing_over(&[Hand::Left]), None);
        assert_eq!(
            handing_over(&[Hand::Left, Hand::Right]).as_deref(),
            Some("from the left hand to the right hand")
        );
    }
}
