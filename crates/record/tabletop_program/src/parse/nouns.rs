//! Nouns and spots.

use tabletop_task::RelativeSide;

use crate::{
    noun::{
        Feature, HowMany, Noun, ObjectKind, Preposition, RelativeSize, Restriction, Spot,
        Superlative, TableSide,
    },
    parse::cursor::Cursor,
    words::{COLORS, KINDS, SHADES, canonical, is_plain_id, kind_of, number_of, plural},
};

/// The most nouns that may be within each other.
const DEEPEST: usize = 16;

/// Words for sides of other objects; the first of each is canonical, and longer ones come first.
const SIDES: [(RelativeSide, &[&str]); 8] = [
    (RelativeSide::FrontLeft, &["in front and to the left of"]),
    (RelativeSide::FrontRight, &["in front and to the right of"]),
    (RelativeSide::BehindLeft, &["behind and to the left of"]),
    (RelativeSide::BehindRight, &["behind and to the right of"]),
    (RelativeSide::Left, &["to the left of", "left of"]),
    (
        RelativeSide::Right,
        &["to the right of", "right of", "beside", "next to"],
    ),
    (RelativeSide::Front, &["in front of"]),
    (RelativeSide::Behind, &["behind"]),
];

/// Reads a noun.
pub(crate) fn noun(cursor: &mut Cursor) -> Option<Noun> {
    if cursor.depth >= DEEPEST {
        cursor.expect("a shorter description", &[]);
        return None;
    }
    cursor.depth += 1;
    let found = cursor
        .attempt(pronoun)
        .or_else(|| cursor.attempt(described))
        .or_else(|| named(cursor));
    cursor.depth -= 1;
    found
}

fn pronoun(cursor: &mut Cursor) -> Option<Noun> {
    let it = cursor.it.clone()?;
    cursor.one_of(&["it", "them"])?;
    Some(it)
}

/// Reads an object's id.
pub(crate) fn named(cursor: &mut Cursor) -> Option<Noun> {
    let token = cursor.token();
    let found = token.filter(|token| token.is_quoted() || is_plain_id(&token.text));
    match found {
        Some(token) => {
            cursor.at += 1;
            Some(Noun::named(token.text.clone()))
        }
        None => {
            cursor.expect("an object's id", &[]);
            None
        }
    }
}

fn described(cursor: &mut Cursor) -> Option<Noun> {
    if cursor.phrases(&["the rest", "the others"]).is_some() {
        let mut of = ObjectKind::of("object");
        of.other = true;
        return Some(Noun::Described {
            quantity: HowMany::Every,
            of,
        });
    }
    let article = article(cursor);
    let number = cursor.known("a number", &[], number_of);
    let superlative = superlative(cursor);
    let (mut of, is_plural) = bare_kind(cursor)?;
    let is_another = article == Some(Article::Another);
    of.other |= is_another;
    let quantity = match (article, number, superlative) {
        (Some(Article::The) | None, number, Some(most)) => {
            let count = number.unwrap_or(1);
            HowMany::Most { count, of: most }
        }
        (_, _, Some(_)) => return None,
        (_, Some(1), None) => HowMany::Any,
        (_, Some(count), None) => HowMany::Count(count),
        (Some(Article::Both), None, None) => HowMany::Count(2),
        (Some(Article::The), None, None) if !is_plural => HowMany::The,
        (Some(Article::The | Article::Every), None, None) => HowMany::Every,
        (Some(Article::Any | Article::Another), None, None) => HowMany::Any,
        (None, None, None) if is_plural => cursor.bare,
        (None, None, None) => return None,
    };
    of.restriction = restriction(cursor, is_plural);
    Some(Noun::Described { quantity, of })
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Article {
    The,
    Any,
    Every,
    Both,
    Another,
}

fn article(cursor: &mut Cursor) -> Option<Article> {
    const WORDS: [&str; 10] = [
        "the", "every", "each", "any", "all", "a", "an", "some", "both", "another",
    ];
    let found = cursor.known("the, any, every or all", &WORDS, |word| match word {
        "the" => Some(Article::The),
        "any" | "a" | "an" | "some" => Some(Article::Any),
        "every" | "each" | "all" => Some(Article::Every),
        "both" => Some(Article::Both),
        "another" => Some(Article::Another),
        _ => None,
    })?;
    if matches!(found, Article::Every | Article::Any | Article::Both) {
        let _ = cursor.phrases(&["of the", "the"]);
    }
    Some(found)
}

pub(crate) fn superlative(cursor: &mut Cursor) -> Option<Superlative> {
    let words = Superlative::ALL.map(Superlative::word);
    cursor.known("a superlative such as largest", &words, |word| {
        let known = Superlative::ALL.into_iter().find(|it| it.word() == word);
        known.or(match word {
            "biggest" | "greatest" | "widest" => Some(Superlative::Largest),
            "littlest" | "tiniest" => Some(Superlative::Smallest),
            "closest" | "frontmost" => Some(Superlative::Nearest),
            "furthest" | "hindmost" | "rearmost" => Some(Superlative::Farthest),
            "highest" | "uppermost" | "top" => Some(Superlative::Topmost),
            _ => None,
        })
    })
}

/// Reads a kind of object with what is known of it, in the singular or in the plural.
pub(crate) fn kind(cursor: &mut Cursor) -> Option<(ObjectKind, bool)> {
    cursor.attempt(|cursor| {
        let (mut of, is_plural) = bare_kind(cursor)?;
        of.restriction = restriction(cursor, is_plural);
        Some((of, is_plural))
    })
}

fn bare_kind(cursor: &mut Cursor) -> Option<(ObjectKind, bool)> {
    let other = cursor.word("other").is_some();
    let size = cursor.known("a size", &["small", "large"], |word| match word {
        "small" | "little" | "tiny" => Some(RelativeSize::Small),
        "large" | "big" | "great" => Some(RelativeSize::Large),
        _ => None,
    });
    let color = color(cursor);
    let Some((is, is_plural)) = kind_of(cursor.peek()) else {
        let names = KINDS.map(|words| plural(words[0]));
        let singular = KINDS.iter().map(|words| words[0]);
        let words: Vec<_> = singular.chain(names.iter().map(String::as_str)).collect();
        cursor.expect("a kind of object", &words);
        return None;
    };
    cursor.at += 1;
    let kind = ObjectKind {
        other,
        size,
        color,
        is: is.to_owned(),
        restriction: None,
    };
    Some((kind, is_plural))
}

fn color(cursor: &mut Cursor) -> Option<String> {
    cursor.attempt(|cursor| {
        let shade = SHADES.into_iter().find(|shade| *shade == cursor.peek());
        cursor.at += usize::from(shade.is_some());
        let words = COLORS.map(|words| words[0]);
        let color = cursor.known("a colour", &words, |word| canonical(&COLORS, word))?;
        Some(shade.map_or_else(|| color.to_owned(), |shade| format!("{shade} {color}")))
    })
}

fn restriction(cursor: &mut Cursor, is_plural: bool) -> Option<Restriction> {
    let is = if is_plural { "are" } else { "is" };
    cursor
        .attempt(|cursor| {
            cursor.one_of(&["that", "which"])?;
            cursor.word(is)?;
            let not = cursor.word("not").is_some();
            let spot = spot(cursor)?;
            Some(Restriction::Where { not, spot })
        })
        .or_else(|| cursor.attempt(from))
        .or_else(|| {
            cursor.attempt(|cursor| {
                cursor.phrases(&["except for", "except", "but", "other than"])?;
                let others = Box::new(noun(cursor)?);
                Some(Restriction::Except { others })
            })
        })
        .or_else(|| cursor.attempt(of_its))
        .or_else(|| cursor.attempt(whose))
}

fn from(cursor: &mut Cursor) -> Option<Restriction> {
    cursor.word("from")?;
    if cursor.phrase("the table").is_some() {
        let spot = Spot::TABLE;
        return Some(Restriction::Where { not: false, spot });
    }
    let whole = Box::new(noun(cursor)?);
    Some(Restriction::From { whole })
}

fn of_its(cursor: &mut Cursor) -> Option<Restriction> {
    cursor.phrases(&[
        "of its",
        "of their",
        "of the same",
        "with the same",
        "in its",
    ])?;
    let words = ["colour", "shape", "size"];
    let feature = cursor.known("colour, shape or size", &words, |word| match word {
        "colour" | "color" | "colours" | "colors" => Some(Feature::Color),
        "shape" | "kind" => Some(Feature::Shape),
        "size" => Some(Feature::Size),
        _ => None,
    })?;
    Some(Restriction::OfIts { feature })
}

fn whose(cursor: &mut Cursor) -> Option<Restriction> {
    cursor.word("whose")?;
    let property = text(cursor, "a property")?;
    cursor.word("is")?;
    let value = text(cursor, "a value")?;
    Some(Restriction::Whose { property, value })
}

/// Reads a word, a number or a quoted text.
fn text(cursor: &mut Cursor, name: &str) -> Option<String> {
    let is_text = |text: &str| {
        text.chars()
            .all(|letter| letter.is_ascii_alphanumeric() || letter == '.')
    };
    let token = cursor
        .token()
        .filter(|token| token.is_quoted() || is_text(&token.text) && token.text != ".");
    match token {
        Some(token) => {
            cursor.at += 1;
            Some(token.text.clone())
        }
        None => {
            cursor.expect(name, &[]);
            None
        }
    }
}

/// Reads where something is.
pub(crate) fn spot(cursor: &mut Cursor) -> Option<Spot> {
    cursor
        .attempt(on_table)
        .or_else(|| cursor.attempt(at_object))
}

fn on_table(cursor: &mut Cursor) -> Option<Spot> {
    let is_to = cursor.word("to").is_some();
    if !is_to {
        cursor.one_of(&["on", "onto", "at"])?;
    }
    cursor.word("the")?;
    if !is_to && cursor.word("table").is_some() {
        return Some(Spot::TABLE);
    }
    let side = table_side(cursor)?;
    let has_word = cursor.one_of(&["side", "half"]).is_some();
    match cursor.phrase("of the table") {
        Some(()) => {}
        // "to the left of the plate" means another side.
        None if cursor.peek() == "of" => return None,
        None if has_word || is_to || !is_kind_next(cursor) => {}
        None => return None,
    }
    Some(Spot::Table { side: Some(side) })
}

fn is_kind_next(cursor: &Cursor) -> bool {
    kind_of(cursor.peek()).is_some() || canonical(&COLORS, cursor.peek()).is_some()
}

pub(crate) fn table_side(cursor: &mut Cursor) -> Option<TableSide> {
    let words = TableSide::ALL.map(TableSide::word);
    cursor.known("a side of the table", &words, |word| {
        let known = TableSide::ALL.into_iter().find(|it| it.word() == word);
        known.or(match word {
            "near" => Some(TableSide::Front),
            "far" | "rear" => Some(TableSide::Back),
            _ => None,
        })
    })
}

fn at_object(cursor: &mut Cursor) -> Option<Spot> {
    let preposition = preposition(cursor)?;
    Some(Spot::at(preposition, noun(cursor)?))
}

fn preposition(cursor: &mut Cursor) -> Option<Preposition> {
    for (side, phrases) in SIDES {
        if cursor.phrases(phrases).is_some() {
            return Some(Preposition::Beside(side));
        }
    }
    if cursor
        .phrases(&["on top of", "on to", "onto", "on", "upon"])
        .is_some()
    {
        return Some(Preposition::On);
    }
    if cursor.phrases(&["into", "inside", "in"]).is_some() {
        return Some(Preposition::Inside);
    }
    cursor.phrases(&["around", "over"])?;
    Some(Preposition::Around)
}
