//! Conditions.

use crate::{
    condition::Condition,
    noun::{HowMany, Noun, ObjectKind, Preposition, Restriction, Spot},
    parse::{cursor::Cursor, nouns},
    words::number_of,
};

/// Reads a condition.
pub(crate) fn condition(cursor: &mut Cursor) -> Option<Condition> {
    cursor
        .attempt(there)
        .or_else(|| cursor.attempt(about_a_noun))
}

fn there(cursor: &mut Cursor) -> Option<Condition> {
    cursor.word("there")?;
    cursor.one_of(&["is", "are"])?;
    if cursor.word("more").is_some() {
        let of = kind(cursor)?;
        cursor.word("than")?;
        let than = kind(cursor)?;
        return Some(Condition::ThereAreMore { of, than });
    }
    if cursor.word("no").is_some() {
        let of = kind(cursor)?;
        return Some(Condition::ThereIsNo { of });
    }
    let _ = cursor.phrase("at least");
    let count = match cursor.phrases(&["a", "an", "any"]) {
        Some(()) => 1,
        None => cursor.known("a number", &["one", "two", "three"], number_of)?,
    };
    let of = kind(cursor)?;
    Some(Condition::ThereAre { count, of })
}

/// Reads a kind of object and where it is.
fn kind(cursor: &mut Cursor) -> Option<ObjectKind> {
    let (mut of, _) = nouns::kind(cursor)?;
    if of.restriction.is_none() {
        let spot = nouns::spot(cursor);
        of.restriction = spot.map(|spot| Restriction::Where { not: false, spot });
    }
    Some(of)
}

fn about_a_noun(cursor: &mut Cursor) -> Option<Condition> {
    let what = nouns::noun(cursor)?;
    cursor.one_of(&["is", "are"])?;
    let not = cursor.word("not").is_some();
    if cursor.word("open").is_some() {
        return Some(opened(what, !not));
    }
    if cursor.one_of(&["closed", "shut"]).is_some() {
        return Some(opened(what, not));
    }
    if cursor.word("empty").is_some() {
        return Some(emptied(what, !not));
    }
    let high = cursor.attempt(|cursor| {
        let _ = cursor.phrase("at least");
        let count = cursor.known("a number", &["two", "three"], number_of)?;
        let _ = nouns::kind(cursor);
        cursor.one_of(&["high", "tall"])?;
        Some(count)
    });
    if let Some(count) = high.filter(|_| !not) {
        return Some(Condition::IsHigh { what, count });
    }
    let spot = nouns::spot(cursor)?;
    Some(Condition::Is { what, not, spot })
}

fn opened(what: Noun, is_open: bool) -> Condition {
    match is_open {
        true => Condition::IsOpen { what },
        false => Condition::IsClosed { what },
    }
}

fn emptied(what: Noun, is_empty: bool) -> Condition {
    let mut of = ObjectKind::of("object");
    let spot = Spot::at(Preposition::Inside, what);
    of.restriction = Some(Restriction::Where { not: false, spot });
    match is_empty {
        true => Condition::ThereIsNo { of },
        false => Condition::ThereAre { count: 1, of },
    }
}

impl Condition {
    /// The opposite, if one can say it.
    pub(crate) fn negated(self) -> Option<Self> {
        match self {
            Self::Is { what, not, spot } => Some(Self::Is {
                what,
                not: !not,
                spot,
            }),
            Self::IsOpen { what } => Some(Self::IsClosed { what }),
            Self::IsClosed { what } => Some(Self::IsOpen { what }),
            Self::ThereIsNo { of } => Some(Self::ThereAre { count: 1, of }),
            Self::ThereAre { count: 1, of } => Some(Self::ThereIsNo { of }),
            Self::ThereAre { .. } | Self::ThereAreMore { .. } | Self::IsHigh { .. } => None,
        }
    }

    /// What `it` means where this holds.
    pub(crate) fn it(&self) -> Option<Noun> {
        let Some(subject) = self.subject() else {
            return self
                .place_of_kind()
                .filter(|noun| noun.is_definite())
                .cloned();
        };
        match (self, subject) {
            (_, subject) if subject.is_definite() => Some(subject.clone()),
            (
                Self::Is { not, spot, .. },
                Noun::Described {
                    quantity: HowMany::Any,
                    of,
                },
            ) if of.restriction.is_none() => {
                let restriction = Restriction::Where {
                    not: *not,
                    spot: spot.clone(),
                };
                Some(Noun::Described {
                    quantity: HowMany::Any,
                    of: ObjectKind {
                        restriction: Some(restriction),
                        ..of.clone()
                    },
                })
            }
            (
                Self::Is { .. }
                | Self::IsOpen { .. }
                | Self::IsClosed { .. }
                | Self::IsHigh { .. }
                | Self::ThereIsNo { .. }
                | Self::ThereAre { .. }
                | Self::ThereAreMore { .. },
                Noun::Named { .. } | Noun::Described { .. },
            ) => None,
        }
    }

    /// The noun of the place at which there is something.
    fn place_of_kind(&self) -> Option<&Noun> {
        match self {
            Self::ThereIsNo { of } | Self::ThereAre { of, .. } => match &of.restriction {
                Some(Restriction::Where { spot, .. }) => spot.noun(),
                None
                | Some(
                    Restriction::From { .. }
                    | Restriction::Except { .. }
                    | Restriction::OfIts { .. }
                    | Restriction::Whose { .. },
                ) => None,
            },
            Self::Is { .. }
            | Self::IsOpen { .. }
            | Self::IsClosed { .. }
            | Self::IsHigh { .. }
            | Self::ThereAreMore { .. } => None,
        }
    }
}
