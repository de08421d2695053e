//! The rules of XML that its reader leaves to us, with messages for files that break them.

use quick_xml::{
    Error,
    errors::{IllFormedError, SyntaxError},
    escape::EscapeError,
    events::attributes::{AttrError, Attributes},
};

use crate::fault::Excerpt;

/// True if a text is the name of an element or an attribute, with or without a prefix.
pub(crate) fn is_name(text: &str) -> bool {
    let mut parts = text.split(':');
    let is_plain_name = |part: &str| {
        let is_other = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.' | '·');
        part.starts_with(|c: char| c.is_alphabetic() || c == '_') && part.chars().all(is_other)
    };
    parts.by_ref().take(2).all(is_plain_name) && parts.next().is_none()
}

/// True if the content of an XML declaration is correct: `version`, then perhaps `encoding` and `standalone`.
pub(crate) fn is_declaration(content: &str) -> bool {
    let mut allowed = ["version", "encoding", "standalone"].iter();
    Attributes::new(content, "xml".len()).all(|attribute| {
        attribute.is_ok_and(|attribute| {
            let offset = attribute.key.0.as_ptr().addr() - content.as_ptr().addr();
            content[..offset].ends_with(is_blank) && allowed.any(|&name| name == attribute.key.0)
        })
    })
}

/// True if XML treats the character as a blank.
pub(crate) const fn is_blank(character: char) -> bool {
    matches!(character, ' ' | '\t' | '\r' | '\n')
}

/// The problem of a file that is not well formed, and the expectation.
pub(crate) fn explain(error: &Error) -> (String, String) {
    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "the reader has errors without number, and words for them"
    )]
    let (problem, expected) = match error {
        Error::IllFormed(IllFormedError::MismatchedEndTag { expected, found }) => {
            return (
                format!("`</{}>` closes another element", Excerpt(found)),
                format!("</{}>", Excerpt(expected)),
            );
        }
        Error::IllFormed(IllFormedError::UnmatchedEndTag(name)) => {
            return (
                format!("`</{}>` closes no element", Excerpt(name)),
                "only tags that close an element".into(),
            );
        }
        Error::IllFormed(IllFormedError::DoubleHyphenInComment) => {
            ("there is a `--` in the comment", "-->")
        }
        Error::IllFormed(IllFormedError::UnclosedReference) => ("there is a lone `&`", "&amp;"),
        Error::Syntax(SyntaxError::UnclosedComment) => ("the comment does not end", "-->"),
        Error::Syntax(SyntaxError::UnclosedCData) => ("the CDATA section does not end", "]]>"),
        Error::Syntax(SyntaxError::UnclosedTag) => ("the tag does not end", ">"),
        Error::Syntax(SyntaxError::UnclosedSingleQuotedAttributeValue) => {
            ("the value of an attribute in this tag does not end", "'")
        }
        Error::Syntax(SyntaxError::UnclosedDoubleQuotedAttributeValue) => {
            ("the value of an attribute in this tag does not end", "\"")
        }
        Error::Syntax(SyntaxError::UnclosedDoctype) => ("the DOCTYPE does not end", ">"),
        Error::Syntax(SyntaxError::UnclosedPI | SyntaxError::UnclosedXmlDecl) => {
            ("the processing instruction does not end", "?>")
        }
        other => return (other.to_string(), "well-formed XML".into()),
    };
    (problem.into(), expected.into())
}

/// The place of a malformed attribute in its tag, its problem, and the expectation.
pub(crate) fn explain_attribute(error: &AttrError) -> (usize, &'static str, &'static str) {
    match *error {
        AttrError::UnquotedValue(offset) => (offset, "the value has no quotes", "name=\"value\""),
        AttrError::ExpectedEq(offset)
        | AttrError::ExpectedValue(offset)
        | AttrError::ExpectedQuote(offset, _)
        | AttrError::Duplicated(offset, _) => {
            (offset, "an attribute is not complete", "name=\"value\"")
        }
    }
}

/// The problem of a reference in an attribute, and the expectation.
pub(crate) fn explain_reference(error: &EscapeError) -> (String, &'static str) {
    match error {
        EscapeError::UnrecognizedEntity(_, name) => (
            format!("`&{};` is not a known entity", Excerpt(name)),
            "&amp;, &lt;, &gt;, &quot;, &apos; or &#number;",
        ),
        EscapeError::UnterminatedEntity(_) => ("there is a lone `&`".into(), "&amp;"),
        other @ (EscapeError::InvalidCharRef(_) | EscapeError::TooManyNestedEntities) => {
            (other.to_string(), "&#number; of a character of XML 1.0")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_have_at_most_one_prefix() {
        for name in ["a", "_a-1.b", "é", "xmlns:xsi"] {
            assert!(is_name(name), "{name}");
        }
        for name in ["", "1a", "-a", "a:", ":a", "a:b:c", "a&b", "a b", "a'"] {
            assert!(!is_name(name), "{name}");
        }
    }

    #[test]
    fn declarations_have_three_attributes_in_order() {
        for content in [
            "xml version='1.0'",
            "xml version='1.0' encoding='a' standalone='no' ",
            "xml version='1.0' standalone='yes'",
        ] {
            assert!(is_declaration(content), "{content}");
        }
        for content in [
            "xml version='1.0' version='1.0'",
            "xml version='1.0'encoding='a'",
            "xml encoding='a' version='1.0'",
            "xml version='1.0' x='a'",
            "xml version=1.0",
            "xml version='1.0' encoding",
        ] {
            assert!(!is_declaration(content), "{content}");
        }
    }
}
