//! What objects look like, and what they are called.

use tabletop_core::ObjectSpec;
use tabletop_geometry::Rgb;
use tabletop_task::{color_name, property};

use crate::words::KINDS;

/// The name of an object's colour, if it has just one.
pub(crate) fn color_of(object: &ObjectSpec) -> Option<String> {
    let color: Rgb = property(object, "color")?.parse().ok()?;
    Some(color_name(color).to_owned())
}

/// True if a word names an object: its shape, the value of a description, or the last word of its id.
pub(crate) fn is_called(object: &ObjectSpec, kind: &str) -> bool {
    let words = KINDS.iter().find(|words| words.first() == Some(&kind));
    let is_meant = |name: &str| {
        let name = name.to_lowercase();
        words.map_or(name == kind, |words| words.contains(&name.as_str()))
    };
    let mut described = object
        .all_descriptions()
        .into_iter()
        .map(|(_, value)| value);
    described.any(is_meant) || last_word_of(&object.id).is_some_and(|word| is_meant(&word))
}

/// The last word of an id: `RedBlock2` has `Block`, `PegA` has `Peg`.
fn last_word_of(id: &str) -> Option<String> {
    let mut words = vec![String::new()];
    for letter in id.chars() {
        if letter.is_uppercase() || !letter.is_alphabetic() {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut().filter(|_| letter.is_alphabetic()) {
            word.push(letter);
        }
    }
    words.into_iter().rfind(|word| word.chars().count() > 1)
}

/// The volume of an object.
pub(crate) fn volume(object: &ObjectSpec) -> f32 {
    let solids = object.shape.colliding();
    solids.iter().map(|solid| solid.solid.volume()).sum()
}
