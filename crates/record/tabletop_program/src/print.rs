//! Programs as English sentences, in the one form that each has.

use std::fmt::{self, Display, Formatter};

use crate::{
    condition::Condition,
    instruction::{Instruction, Pattern, TargetPlace},
    noun::{
        Feature, HowMany, Noun, ObjectKind, Preposition, RelativeSize, Restriction, Spot,
        Superlative, TableSide,
    },
    program::{Procedure, Sentence, TaskProgram},
    words::{is_plain_id, number_word, plural},
};

impl Display for TaskProgram {
    /// A sentence a line.
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let procedures = self.procedures.iter().map(procedure);
        let sentences = self.sentences.iter().map(whole);
        let lines: Vec<_> = procedures.chain(sentences).collect();
        f.write_str(&lines.join("\n"))
    }
}

impl TaskProgram {
    /// It in one line.
    pub fn in_a_line(&self) -> String {
        self.to_string().replace('\n', " ")
    }
}

impl Display for Sentence {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&whole(self))
    }
}

impl Display for Noun {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&noun(self, "every"))
    }
}

impl Display for Condition {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&condition(self, None))
    }
}

impl Display for Superlative {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

fn procedure(procedure: &Procedure) -> String {
    let names = procedure.objects.iter().map(|name| id(name)).collect();
    let sentences: Vec<_> = procedure.sentences.iter().map(sentence).collect();
    let name = called(&procedure.verb, names);
    format!("To {name}: {}.", sentences.join("; "))
}

/// A verb with its objects.
fn called(verb: &str, objects: Vec<String>) -> String {
    match objects.is_empty() {
        true => verb.to_owned(),
        false => format!("{verb} {}", objects.join(" and ")),
    }
}

/// A sentence with a capital and a full stop.
fn whole(one: &Sentence) -> String {
    let text = sentence(one);
    let mut letters = text.chars();
    let first = letters.next().map(|letter| letter.to_ascii_uppercase());
    first.into_iter().chain(letters).chain(['.']).collect()
}

fn sentence(sentence: &Sentence) -> String {
    match sentence {
        Sentence::Do { instructions } => chain(instructions, None),
        Sentence::If {
            condition: when,
            then,
            otherwise,
        } => {
            let it = when.subject().filter(|subject| subject.is_definite());
            let (when, then) = (condition(when, None), chain(then, it));
            match otherwise.is_empty() {
                true => format!("if {when}, {then}"),
                false => format!("if {when}, {then}, otherwise {}", chain(otherwise, it)),
            }
        }
        Sentence::Until {
            condition: when,
            instructions,
        } => {
            let it = target(instructions).filter(|target| target.is_definite());
            format!(
                "{} until {}",
                chain(instructions, None),
                condition(when, it)
            )
        }
    }
}

/// The object to which the last of these instructions puts something.
pub(crate) fn target(instructions: &[Instruction]) -> Option<&Noun> {
    match instructions.last()? {
        Instruction::Put { to, .. } => match to {
            TargetPlace::Spot(spot) => spot.noun(),
            TargetPlace::Location { .. }
            | TargetPlace::Aside
            | TargetPlace::PlaceOf { .. }
            | TargetPlace::Arranged { .. } => None,
        },
        Instruction::Remove { .. }
        | Instruction::Open { .. }
        | Instruction::Close { .. }
        | Instruction::Swap { .. }
        | Instruction::MoveTower { .. }
        | Instruction::Copy { .. }
        | Instruction::Call { .. } => None,
    }
}

fn chain(instructions: &[Instruction], it: Option<&Noun>) -> String {
    let all: Vec<_> = instructions
        .iter()
        .map(|one| instruction(one, it))
        .collect();
    all.join(", then ")
}

fn instruction(instruction: &Instruction, it: Option<&Noun>) -> String {
    let what_of = |what: &Noun, every: &str| match Some(what) == it {
        true => "it".to_owned(),
        false => noun(what, every),
    };
    let what_of_any = |what: &Noun| what_of(what, "every");
    match instruction {
        Instruction::Put { what, to, first } => {
            let every = match (to, to.pairs()) {
                (TargetPlace::Arranged { .. }, _) => "all",
                (_, true) => "each",
                (_, false) => "every",
            };
            let (what, order) = (what_of(what, every), order(*first));
            format!("put {what} {}{order}", place(to))
        }
        Instruction::Remove { what, first } => {
            format!("remove {}{}", what_of_any(what), order(*first))
        }
        Instruction::Open { what } => format!("open {}", what_of_any(what)),
        Instruction::Close { what } => format!("close {}", what_of_any(what)),
        Instruction::Swap { one, other } => {
            format!("swap {} and {}", what_of_any(one), what_of_any(other))
        }
        Instruction::MoveTower { from, to, by } => {
            let [from, to, by] = [from, to, by].map(what_of_any);
            format!("move the tower from {from} to {to} by way of {by}")
        }
        Instruction::Copy { what, to } => {
            format!("copy {} to the {} side", what_of_any(what), to.word())
        }
        Instruction::Call { verb, with } => called(verb, with.iter().map(what_of_any).collect()),
    }
}

fn order(first: Option<Superlative>) -> String {
    first.map_or_else(String::new, |first| format!(", the {first} first"))
}

fn place(to: &TargetPlace) -> String {
    match to {
        TargetPlace::Spot(to) => spot(to, "into"),
        TargetPlace::Location { x, y } => format!("on the table at ({x}, {y})"),
        TargetPlace::Aside => "aside".into(),
        TargetPlace::PlaceOf { noun: of } => format!("where {of} was"),
        TargetPlace::Arranged { pattern, at } => {
            let pattern = match pattern {
                Pattern::Tower => "on each other".to_owned(),
                Pattern::Row => "in a row".to_owned(),
                Pattern::Column => "in a column".to_owned(),
                Pattern::Grid(columns) => {
                    format!("in a grid of {} columns", number_word(*columns))
                }
            };
            at.as_ref().map_or(pattern.clone(), |at| {
                format!("{pattern} {}", spot(at, "in"))
            })
        }
    }
}

fn spot(spot: &Spot, inside: &str) -> String {
    match spot {
        Spot::Table { side: None } => "on the table".into(),
        Spot::Table { side: Some(side) } => format!("on the {} side of the table", side.word()),
        Spot::At { preposition, noun } => {
            let preposition = match preposition {
                Preposition::On => "on",
                Preposition::Inside => inside,
                Preposition::Around => "around",
                Preposition::Beside(side) => side.words(),
            };
            format!("{preposition} {noun}")
        }
    }
}

fn condition(condition: &Condition, it: Option<&Noun>) -> String {
    let subject = |what: &Noun| match Some(what) == it {
        true => "it".to_owned(),
        false => what.to_string(),
    };
    let is_are = |what: &Noun| if what.is_plural() { "are" } else { "is" };
    match condition {
        Condition::Is {
            what,
            not,
            spot: place,
        } => {
            let not = if *not { " not" } else { "" };
            format!(
                "{} {}{not} {}",
                subject(what),
                is_are(what),
                spot(place, "in")
            )
        }
        Condition::IsOpen { what } => format!("{} {} open", subject(what), is_are(what)),
        Condition::IsClosed { what } => format!("{} {} closed", subject(what), is_are(what)),
        Condition::IsHigh { what, count } => {
            format!(
                "{} {} {} high",
                subject(what),
                is_are(what),
                number_word(*count)
            )
        }
        Condition::ThereIsNo { of } => format!("there is no {}", kind(of, false)),
        Condition::ThereAre { count: 1, of } => format!("there is one {}", kind(of, false)),
        Condition::ThereAre { count, of } => {
            format!("there are {} {}", number_word(*count), kind(of, true))
        }
        Condition::ThereAreMore { of, than } => {
            format!(
                "there are more {} than {}",
                kind(of, true),
                kind(than, true)
            )
        }
    }
}

fn noun(noun: &Noun, every: &str) -> String {
    match noun {
        Noun::Named { id: name } => id(name),
        Noun::Described { quantity, of } => match quantity {
            HowMany::The => format!("the {}", kind(of, false)),
            HowMany::Any => format!("any {}", kind(of, false)),
            HowMany::Every => format!("{every} {}", kind(of, every == "all")),
            HowMany::Count(count) => format!("{} {}", number_word(*count), kind(of, true)),
            HowMany::Most { count: 1, of: most } => format!("the {most} {}", kind(of, false)),
            HowMany::Most { count, of: most } => {
                format!("the {} {most} {}", number_word(*count), kind(of, true))
            }
        },
    }
}

fn kind(kind: &ObjectKind, is_plural: bool) -> String {
    let mut words = Vec::new();
    if kind.other {
        words.push("other".to_owned());
    }
    match kind.size {
        Some(RelativeSize::Small) => words.push("small".into()),
        Some(RelativeSize::Large) => words.push("large".into()),
        None => {}
    }
    words.extend(kind.color.clone());
    words.push(match is_plural {
        true => plural(&kind.is),
        false => kind.is.clone(),
    });
    match &kind.restriction {
        None => {}
        Some(Restriction::Where { not, spot: place }) => {
            let is = if is_plural { "are" } else { "is" };
            let not = if *not { " not" } else { "" };
            words.push(format!("that {is}{not} {}", spot(place, "in")));
        }
        Some(Restriction::From { whole }) => words.push(format!("from {whole}")),
        Some(Restriction::Except { others }) => words.push(format!("except {others}")),
        Some(Restriction::OfIts { feature }) => words.push(format!("of its {}", feature.word())),
        Some(Restriction::Whose { property, value }) => {
            words.push(format!("whose {} is {}", text(property), text(value)));
        }
    }
    words.join(" ")
}

fn id(id: &str) -> String {
    match is_plain_id(id) {
        true => id.to_owned(),
        false => format!("\"{id}\""),
    }
}

/// A text, in quotation marks unless it is one word.
fn text(text: &str) -> String {
    let is_word = !text.is_empty() && text.chars().all(|letter| letter.is_ascii_alphanumeric());
    match is_word {
        true => text.to_owned(),
        false => format!("\"{text}\""),
    }
}

impl Noun {
    /// Whether it means the same objects wherever it stands.
    pub(crate) fn is_definite(&self) -> bool {
        match self {
            Self::Named { .. } => true,
            Self::Described { quantity, .. } => match quantity {
                HowMany::The | HowMany::Most { count: 1, .. } => true,
                HowMany::Any | HowMany::Every | HowMany::Count(_) | HowMany::Most { .. } => false,
            },
        }
    }

    fn is_plural(&self) -> bool {
        match self {
            Self::Named { .. } => false,
            Self::Described { quantity, .. } => match quantity {
                HowMany::The | HowMany::Any | HowMany::Every => false,
                HowMany::Count(_) => true,
                HowMany::Most { count, .. } => *count > 1,
            },
        }
    }

    /// True if it depends on the object that is put to it.
    pub(crate) fn pairs(&self) -> bool {
        match self {
            Self::Named { .. } => false,
            Self::Described { of, .. } => {
                matches!(of.restriction, Some(Restriction::OfIts { .. }))
            }
        }
    }
}

impl TargetPlace {
    /// True if it depends on the object that is put there.
    pub(crate) fn pairs(&self) -> bool {
        match self {
            Self::Spot(Spot::At { noun, .. }) => noun.pairs(),
            Self::PlaceOf { noun } => noun.pairs(),
            Self::Spot(Spot::Table { .. })
            | Self::Location { .. }
            | Self::Aside
            | Self::Arranged { .. } => false,
        }
    }
}

impl Condition {
    /// The noun of which it says something.
    pub(crate) fn subject(&self) -> Option<&Noun> {
        match self {
            Self::Is { what, .. }
            | Self::IsOpen { what }
            | Self::IsClosed { what }
            | Self::IsHigh { what, .. } => Some(what),
            Self::ThereIsNo { .. } | Self::ThereAre { .. } | Self::ThereAreMore { .. } => None,
        }
    }
}

impl Superlative {
    /// All of them.
    pub(crate) const ALL: [Self; 11] = [
        Self::Largest,
        Self::Smallest,
        Self::Heaviest,
        Self::Lightest,
        Self::Tallest,
        Self::Shortest,
        Self::Leftmost,
        Self::Rightmost,
        Self::Nearest,
        Self::Farthest,
        Self::Topmost,
    ];

    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::Largest => "largest",
            Self::Smallest => "smallest",
            Self::Heaviest => "heaviest",
            Self::Lightest => "lightest",
            Self::Tallest => "tallest",
            Self::Shortest => "shortest",
            Self::Leftmost => "leftmost",
            Self::Rightmost => "rightmost",
            Self::Nearest => "nearest",
            Self::Farthest => "farthest",
            Self::Topmost => "topmost",
        }
    }
}

impl TableSide {
    /// All of them.
    pub(crate) const ALL: [Self; 4] = [Self::Left, Self::Right, Self::Front, Self::Back];

    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
            Self::Front => "front",
            Self::Back => "back",
        }
    }
}

impl Feature {
    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::Color => "colour",
            Self::Shape => "shape",
            Self::Size => "size",
        }
    }
}
