//! Texts as they stand in attributes.

use quick_xml::escape::escape;

use crate::{document::decode::is_xml_character, elements::value::is_id_character};

/// A text without the characters that an id cannot have.
pub(super) fn as_id(text: &str) -> String {
    text.replace(|character| !is_id_character(character), "_")
}

/// A text without expressions. A single dollar sign needs no other: older programs then read it, too.
pub(super) fn as_literal(text: &str) -> String {
    match text.matches('$').count() {
        0 | 1 => text.to_owned(),
        _ => text.replace('$', "$$"),
    }
}

/// A text as the value of an attribute; characters that XML does not allow become U+FFFD.
pub(super) fn as_attribute(text: &str) -> String {
    let allowed = text.replace(|character| !is_xml_character(character), "\u{fffd}");
    // A reader of XML takes these for blanks unless they are escaped.
    escape(allowed)
        .replace('\t', "&#9;")
        .replace('\n', "&#10;")
        .replace('\r', "&#13;")
}
