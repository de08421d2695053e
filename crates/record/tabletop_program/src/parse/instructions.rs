//! Instructions.

use crate::{
    instruction::{Instruction, Pattern, TargetPlace},
    noun::{HowMany, Noun, ObjectKind, Restriction, Spot, Superlative},
    parse::{cursor::Cursor, nouns, token::Token},
    words::number_of,
};

/// The verbs of the grammar, which no procedure can have.
const VERBS: [&str; 25] = [
    "put", "place", "move", "lay", "set", "drop", "bring", "stack", "pile", "line", "remove",
    "delete", "clear", "take", "pick", "grasp", "grab", "lift", "open", "close", "shut", "swap",
    "exchange", "switch", "copy",
];

/// Other words that begin or join sentences, which no procedure can have for a verb.
const KEYWORDS: [&str; 6] = ["if", "while", "then", "until", "otherwise", "to"];

/// The verbs of an object that is put somewhere.
const PUT: [&str; 7] = ["put", "place", "move", "lay", "set", "drop", "bring"];

/// Reads instructions one after the other.
pub(crate) fn chain(cursor: &mut Cursor, it: Option<&Noun>) -> Option<Vec<Instruction>> {
    let mut all = Vec::new();
    loop {
        if let Some(it) = it {
            cursor.it = Some(it.clone());
        }
        let next = instruction(cursor)?;
        if let Some(what) = next.object().filter(|what| what.is_definite()) {
            cursor.it = Some(what.clone());
        }
        all.push(next);
        let goes_on = cursor.attempt(|cursor| {
            let _ = cursor.word(",");
            cursor.phrases(&["and then", "then", "and"])?;
            is_verb(cursor).then_some(())
        });
        if goes_on.is_none() {
            return Some(all);
        }
    }
}

/// True if an instruction begins here.
fn is_verb(cursor: &Cursor) -> bool {
    let word = cursor.peek();
    VERBS.contains(&word) || cursor.verbs.iter().any(|verb| verb == word)
}

/// Reads an instruction.
fn instruction(cursor: &mut Cursor) -> Option<Instruction> {
    let at = cursor.at;
    if cursor.phrase("move the tower from").is_some() {
        return moved_tower(cursor);
    }
    if cursor.phrases(&["line up", "line"]).is_some() {
        return arranged(cursor, Pattern::Row);
    }
    if cursor.one_of(&["stack", "pile"]).is_some() {
        let _ = cursor.word("up");
        return arranged(cursor, Pattern::Tower);
    }
    if cursor.one_of(&PUT).is_some() {
        return put(cursor);
    }
    if cursor
        .phrases(&["pick up", "pick", "grasp", "grab", "lift up", "lift"])
        .is_some()
    {
        let what = nouns::noun(cursor)?;
        return picked(cursor, what);
    }
    if cursor
        .phrases(&["take away", "clear away", "remove", "delete"])
        .is_some()
    {
        let what = placed_noun(cursor)?;
        let first = order(cursor);
        return Some(Instruction::Remove { what, first });
    }
    if cursor.word("take").is_some() {
        return taken(cursor);
    }
    if cursor.word("open").is_some() {
        let what = placed_noun(cursor)?;
        return Some(Instruction::Open { what });
    }
    if cursor.one_of(&["close", "shut"]).is_some() {
        let what = placed_noun(cursor)?;
        return Some(Instruction::Close { what });
    }
    if cursor.one_of(&["swap", "exchange", "switch"]).is_some() {
        let one = nouns::noun(cursor)?;
        cursor.one_of(&["and", "with", "for"])?;
        let other = nouns::noun(cursor)?;
        return Some(Instruction::Swap { one, other });
    }
    if cursor.word("copy").is_some() {
        return copied(cursor);
    }
    debug_assert_eq!(cursor.at, at);
    called(cursor)
}

fn moved_tower(cursor: &mut Cursor) -> Option<Instruction> {
    let from = nouns::noun(cursor)?;
    cursor.one_of(&["to", "onto"])?;
    let to = nouns::noun(cursor)?;
    cursor.phrases(&["by way of", "via", "over", "by"])?;
    let by = nouns::noun(cursor)?;
    Some(Instruction::MoveTower { from, to, by })
}

fn arranged(cursor: &mut Cursor, pattern: Pattern) -> Option<Instruction> {
    let what = nouns::noun(cursor)?;
    let to = pattern_of(&what, pattern, cursor)?;
    let first = order(cursor);
    Some(Instruction::Put { what, to, first })
}

/// Reads where a pattern is. A single object makes one only with those that are there.
fn pattern_of(what: &Noun, pattern: Pattern, cursor: &mut Cursor) -> Option<TargetPlace> {
    let at = nouns::spot(cursor);
    (at.is_some() || !what.is_definite()).then_some(TargetPlace::Arranged { pattern, at })
}

/// What is taken off something is put on the table.
fn taken(cursor: &mut Cursor) -> Option<Instruction> {
    let mut what = nouns::noun(cursor)?;
    if cursor.phrases(&["off", "out of"]).is_none() {
        return picked(cursor, what);
    }
    let restriction = Restriction::From {
        whole: Box::new(nouns::noun(cursor)?),
    };
    restrict(&mut what, restriction)?;
    let first = order(cursor);
    let to = TargetPlace::Spot(Spot::TABLE);
    Some(Instruction::Put { what, to, first })
}

fn put(cursor: &mut Cursor) -> Option<Instruction> {
    let what = nouns::noun(cursor)?;
    placed(cursor, what)
}

/// What is picked up has to be put somewhere.
fn picked(cursor: &mut Cursor, what: Noun) -> Option<Instruction> {
    let _ = cursor.word(",");
    cursor.phrases(&["and then", "and", "then"])?;
    cursor.one_of(&PUT)?;
    cursor.one_of(&["it", "them"])?;
    placed(cursor, what)
}

/// Reads where objects are put.
fn placed(cursor: &mut Cursor, mut what: Noun) -> Option<Instruction> {
    let mut to = place(cursor, &what)?;
    // Of two places, the first is where the objects are.
    let second = cursor.attempt(|cursor| {
        let TargetPlace::Spot(spot) = &to else {
            return None;
        };
        let place = place(cursor, &what)?;
        let spot = spot.clone();
        restrict(&mut what, Restriction::Where { not: false, spot })?;
        Some(place)
    });
    if let Some(second) = second {
        to = second;
    }
    let first = order(cursor);
    Some(Instruction::Put { what, to, first })
}

/// Restricts a noun that is not restricted yet.
fn restrict(noun: &mut Noun, restriction: Restriction) -> Option<()> {
    match noun {
        Noun::Described { of, .. } if of.restriction.is_none() => {
            of.restriction = Some(restriction);
            Some(())
        }
        Noun::Described { .. } | Noun::Named { .. } => None,
    }
}

/// Reads a noun and where it is.
fn placed_noun(cursor: &mut Cursor) -> Option<Noun> {
    let mut what = nouns::noun(cursor)?;
    let _ = cursor.attempt(|cursor| {
        let spot = nouns::spot(cursor)?;
        restrict(&mut what, Restriction::Where { not: false, spot })
    });
    Some(what)
}

/// Reads the place of objects.
fn place(cursor: &mut Cursor, what: &Noun) -> Option<TargetPlace> {
    if cursor.word("aside").is_some() {
        return Some(TargetPlace::Aside);
    }
    let pattern = cursor.attempt(pattern);
    if let Some(pattern) = pattern {
        return pattern_of(what, pattern, cursor);
    }
    let place_of = cursor.attempt(|cursor| {
        cursor.word("where")?;
        let noun = nouns::noun(cursor)?;
        cursor.word("was")?;
        Some(TargetPlace::PlaceOf { noun })
    });
    place_of
        .or_else(|| cursor.attempt(location))
        .or_else(|| Some(TargetPlace::Spot(nouns::spot(cursor)?)))
}

fn pattern(cursor: &mut Cursor) -> Option<Pattern> {
    if cursor
        .phrases(&[
            "on each other",
            "onto each other",
            "on top of each other",
            "in a tower",
        ])
        .is_some()
    {
        return Some(Pattern::Tower);
    }
    if cursor.phrases(&["in a row", "in a line"]).is_some() {
        return Some(Pattern::Row);
    }
    if cursor.phrase("in a column").is_some() {
        return Some(Pattern::Column);
    }
    cursor.phrases(&["in a grid of", "in a grid with"])?;
    let columns = cursor.known("a number", &["two", "three"], number_of)?;
    cursor.word("columns")?;
    Some(Pattern::Grid(columns))
}

fn location(cursor: &mut Cursor) -> Option<TargetPlace> {
    let _ = cursor.phrase("on the table");
    cursor.word("at")?;
    cursor.word("(")?;
    let x = number(cursor)?;
    cursor.word(",")?;
    let y = number(cursor)?;
    cursor.word(")")?;
    Some(TargetPlace::Location { x, y })
}

fn number(cursor: &mut Cursor) -> Option<f32> {
    let value = |word: &str| word.parse().ok().filter(|number: &f32| number.is_finite());
    cursor.known("a number", &[], value)
}

/// Reads in which order objects are handled.
fn order(cursor: &mut Cursor) -> Option<Superlative> {
    let said = cursor.attempt(|cursor| {
        let _ = cursor.word(",");
        let _ = cursor.phrases(&["starting with the", "beginning with the", "the"]);
        let first = nouns::superlative(cursor)?;
        let _ = cursor.one_of(&["one", "ones"]);
        let _ = cursor.word("first");
        Some(first)
    });
    said.or_else(|| {
        cursor.attempt(|cursor| {
            let _ = cursor.word(",");
            let ways = [
                ("from left to right", Superlative::Leftmost),
                ("from right to left", Superlative::Rightmost),
                ("from large to small", Superlative::Largest),
                ("from small to large", Superlative::Smallest),
            ];
            let mut ways = ways.into_iter();
            ways.find_map(|(words, first)| cursor.phrase(words).map(|()| first))
        })
    })
}

fn copied(cursor: &mut Cursor) -> Option<Instruction> {
    let pattern = cursor.attempt(|cursor| {
        cursor.word("the")?;
        cursor.one_of(&["row", "pattern", "arrangement", "objects"])?;
        let spot = nouns::spot(cursor)?;
        let mut of = ObjectKind::of("object");
        of.restriction = Some(Restriction::Where { not: false, spot });
        let quantity = HowMany::Every;
        Some(Noun::Described { quantity, of })
    });
    let what = match pattern {
        Some(what) => what,
        None => nouns::noun(cursor)?,
    };
    cursor.word("to")?;
    cursor.word("the")?;
    let to = nouns::table_side(cursor)?;
    let _ = cursor.one_of(&["side", "half"]);
    let _ = cursor.phrase("of the table");
    Some(Instruction::Copy { what, to })
}

fn called(cursor: &mut Cursor) -> Option<Instruction> {
    let verbs = cursor.verbs.clone();
    let known: Vec<_> = verbs.iter().map(String::as_str).collect();
    let usual = VERBS.iter().copied().filter(|verb| *verb != "line");
    let words: Vec<_> = usual.chain(known).collect();
    let is_known = |word: &str| verbs.iter().find(|verb| *verb == word).cloned();
    let verb = cursor.known("a verb such as put", &words, is_known)?;
    let mut with: Vec<_> = nouns::noun(cursor).into_iter().collect();
    while !with.is_empty() {
        let next = cursor.attempt(|cursor| {
            cursor.word("and")?;
            nouns::noun(cursor)
        });
        match next {
            Some(next) => with.push(next),
            None => break,
        }
    }
    Some(Instruction::Call { verb, with })
}

/// The verbs of the procedures that a text defines.
pub(crate) fn defined_verbs(tokens: &[Token]) -> Vec<String> {
    let stop = |token: Option<&Token>| token.is_none_or(|token| token.word == ".");
    let starts = (0..tokens.len()).filter(|&i| {
        let before = i.checked_sub(1).and_then(|before| tokens.get(before));
        stop(before) || tokens[i].begins_line
    });
    let defines = starts.filter(|&i| tokens[i].word == "to");
    let verbs = defines.filter_map(|i| tokens.get(i + 1));
    let verbs = verbs.map(|token| token.word.clone());
    verbs.filter(|verb| is_new_verb(verb)).collect()
}

/// Whether a procedure can have this verb.
pub(crate) fn is_new_verb(verb: &str) -> bool {
    let is_word = !verb.is_empty() && verb.chars().all(|letter| letter.is_ascii_lowercase());
    is_word && !VERBS.contains(&verb) && !KEYWORDS.contains(&verb)
}

impl Instruction {
    /// The objects that it handles, as far as one noun says it.
    fn object(&self) -> Option<&Noun> {
        match self {
            Self::Put { what, .. }
            | Self::Remove { what, .. }
            | Self::Open { what }
            | Self::Close { what }
            | Self::Copy { what, .. } => Some(what),
            Self::Swap { .. } | Self::MoveTower { .. } | Self::Call { .. } => None,
        }
    }
}
