//! Description lengths: how much a program says, and how much it leaves to choice. The shortest explanation of examples is the likeliest.

use crate::{
    condition::Condition,
    instruction::{Instruction, TargetPlace},
    noun::{HowMany, Noun, ObjectKind, Restriction, Spot, Superlative},
    program::Sentence,
    selection::ANYTHING,
};

/// A description length, in quarters of a bit.
pub(crate) type Length = u32;

/// Lengths of the parts of programs, in quarters of a bit: the rarer a part is in what people say, the longer. Only their differences count;
/// `tests/grounding/shown.rs` has demonstrations that they decide.
mod part {
    use super::Length;

    pub const INSTRUCTION: Length = 8;
    pub const CONDITION: Length = 12;
    /// An object by its id, which says nothing of others.
    pub const ID: Length = 27;
    pub const THE: Length = 2;
    pub const EVERY: Length = 8;
    pub const ANY: Length = 12;
    pub const COUNT: Length = 13;
    pub const MOST: Length = 8;
    pub const KIND: Length = 4;
    /// A thing of any kind, which people say of things that are alike in another way.
    pub const ANYTHING: Length = 12;
    pub const COLOR: Length = 3;
    pub const SIZE: Length = 12;
    pub const OTHER: Length = 8;
    pub const RESTRICTION: Length = 6;
    pub const FEATURE: Length = 4;
    pub const VALUE: Length = 12;
    pub const PREPOSITION: Length = 2;
    pub const TABLE: Length = 2;
    /// One of four, and three demonstrations on the same side may be chance.
    pub const SIDE: Length = 11;
    pub const LOCATION: Length = 28;
    pub const PATTERN: Length = 6;
    pub const NUMBER: Length = 8;
    /// An order by how objects look, one by where they are, which may well be chance, and one by their weights, which nobody sees.
    pub const ORDER: Length = 8;
    pub const ORDER_OF_PLACES: Length = 14;
    pub const ORDER_OF_WEIGHTS: Length = 16;
    /// The same for the order in which things are done: a few things often come in some order of their places.
    pub const SEQUENCE_OF_PLACES: Length = 20;
    /// A deed that a pattern leaves unexplained, since another one with its object follows. (`a_tower_that_is_moved_is_no_tower_that_is_made`)
    pub const DETOUR: Length = 16;
}

/// Four times the binary logarithm of a number of ways.
pub(crate) fn choice(ways: u128) -> Length {
    ways.max(1).saturating_pow(4).ilog2()
}

/// The length of a deed which a pattern that comes about does not need.
pub(crate) const fn detour() -> Length {
    part::DETOUR
}

/// The number of orders of so many things.
pub(crate) fn orders(count: usize) -> u128 {
    (1..=count as u128).fold(1, u128::saturating_mul)
}

/// The length of a sentence.
pub(crate) fn sentence(sentence: &Sentence) -> Length {
    let all = |instructions: &[Instruction]| instructions.iter().map(instruction).sum::<Length>();
    match sentence {
        Sentence::Do { instructions } => all(instructions),
        Sentence::If {
            condition: when,
            then,
            otherwise,
        } => condition(when) + all(then) + all(otherwise),
        Sentence::Until {
            condition: when,
            instructions,
        } => condition(when) + all(instructions),
    }
}

fn instruction(instruction: &Instruction) -> Length {
    let rest = match instruction {
        Instruction::Put { what, to, first } => noun(what) + place(to) + first.map_or(0, sequence),
        Instruction::Remove { what, first } => noun(what) + first.map_or(0, sequence),
        Instruction::Open { what } | Instruction::Close { what } => noun(what),
        Instruction::Swap { one, other } => noun(one) + noun(other),
        Instruction::MoveTower { from, to, by } => noun(from) + noun(to) + noun(by),
        Instruction::Copy { what, to: _ } => noun(what) + part::SIDE,
        Instruction::Call { verb: _, with } => with.iter().map(noun).sum(),
    };
    part::INSTRUCTION + rest
}

fn sequence(first: Superlative) -> Length {
    match first {
        Superlative::Leftmost
        | Superlative::Rightmost
        | Superlative::Nearest
        | Superlative::Farthest => part::SEQUENCE_OF_PLACES,
        Superlative::Largest
        | Superlative::Smallest
        | Superlative::Heaviest
        | Superlative::Lightest
        | Superlative::Tallest
        | Superlative::Shortest
        | Superlative::Topmost => order(first),
    }
}

fn order(first: Superlative) -> Length {
    match first {
        Superlative::Largest
        | Superlative::Smallest
        | Superlative::Tallest
        | Superlative::Shortest
        | Superlative::Topmost => part::ORDER,
        Superlative::Leftmost
        | Superlative::Rightmost
        | Superlative::Nearest
        | Superlative::Farthest => part::ORDER_OF_PLACES,
        Superlative::Heaviest | Superlative::Lightest => part::ORDER_OF_WEIGHTS,
    }
}

fn place(place: &TargetPlace) -> Length {
    match place {
        TargetPlace::Spot(at) => spot(at),
        TargetPlace::Location { .. } => part::LOCATION,
        TargetPlace::Aside => part::TABLE,
        TargetPlace::PlaceOf { noun: of } => part::PREPOSITION + noun(of),
        TargetPlace::Arranged { pattern: _, at } => part::PATTERN + at.as_ref().map_or(0, spot),
    }
}

fn spot(spot: &Spot) -> Length {
    match spot {
        Spot::Table { side: None } => part::TABLE,
        Spot::Table { side: Some(_) } => part::TABLE + part::SIDE,
        Spot::At {
            preposition: _,
            noun: at,
        } => part::PREPOSITION + noun(at),
    }
}

fn noun(noun: &Noun) -> Length {
    match noun {
        Noun::Named { .. } => part::ID,
        Noun::Described { quantity, of } => {
            let quantity = match quantity {
                // One is small or large beside others: then it is the smallest or largest.
                HowMany::The if of.size.is_some() => part::MOST + part::ORDER,
                HowMany::The => part::THE,
                HowMany::Any => part::ANY,
                HowMany::Every => part::EVERY,
                HowMany::Count(_) => part::COUNT,
                HowMany::Most { count: 1, of } => part::MOST + order(*of),
                HowMany::Most { count: _, of } => part::MOST + part::NUMBER + order(*of),
            };
            quantity + kind(of)
        }
    }
}

fn kind(kind: &ObjectKind) -> Length {
    let word = match kind.is.as_str() {
        ANYTHING => part::ANYTHING,
        _ => part::KIND,
    };
    let restriction = kind.restriction.as_ref().map_or(0, |restriction| {
        part::RESTRICTION
            + match restriction {
                Restriction::Where { not: _, spot: at } => spot(at),
                Restriction::From { whole: other } | Restriction::Except { others: other } => {
                    noun(other)
                }
                Restriction::OfIts { .. } => part::FEATURE,
                Restriction::Whose { .. } => part::VALUE,
            }
    });
    word + restriction
        + if kind.other { part::OTHER } else { 0 }
        + kind.size.map_or(0, |_| part::SIZE)
        + kind.color.as_ref().map_or(0, |_| part::COLOR)
}

fn condition(condition: &Condition) -> Length {
    let rest = match condition {
        Condition::Is {
            what,
            not: _,
            spot: at,
        } => noun(what) + spot(at),
        Condition::IsOpen { what } | Condition::IsClosed { what } => noun(what),
        Condition::IsHigh { what, count: _ } => noun(what) + part::NUMBER,
        Condition::ThereIsNo { of } => kind(of),
        Condition::ThereAre { count: _, of } => kind(of) + part::NUMBER,
        Condition::ThereAreMore { of, than } => kind(of) + kind(than),
    };
    part::CONDITION + rest
}
