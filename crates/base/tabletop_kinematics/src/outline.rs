//! The places of the elements of an XML text, found without understanding them.
//!
//! The URDF reader keeps no places and descends by recursion; with the outline, faults get a line and a text that would
//! exhaust the stack is refused before.

use crate::ModelError;

/// Elements may be this deep inside each other. URDF itself needs six.
pub(crate) const DEEPEST: usize = 64;

/// An element that stands directly inside the root element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Child<'a> {
    /// `link`, `joint`, ...
    pub tag: &'a str,
    /// The line in which it starts, from 1.
    pub line: usize,
    /// All of it, with its own tags.
    pub text: &'a str,
}

impl Child<'_> {
    /// Its tag and name, as a message calls it: `joint left_s0`.
    pub fn named(&self) -> String {
        let tag = self.text.split('>').next().unwrap_or_default();
        let name = tag.split_once("name=").and_then(|(_, rest)| {
            let quote = rest.chars().next().filter(|c| matches!(c, '"' | '\''))?;
            rest[1..].split(quote).next()
        });
        match name {
            Some(name) => format!("{} {name}", self.tag),
            None => self.tag.to_owned(),
        }
    }
}

/// The elements that were found in a text.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Outline<'a> {
    /// The children of the root element.
    pub children: Vec<Child<'a>>,
    /// The first element that does not end where it should: its tag, its line, and its fault.
    pub unbalanced: Option<(&'a str, usize, String)>,
}

/// Finds the beginnings and ends of elements. Anything that is not XML is passed over: the reader will report it.
pub(crate) fn outline(text: &str) -> Result<Outline<'_>, ModelError> {
    let mut outline = Outline::default();
    // Elements that have not ended yet: tag, line, place.
    let mut open: Vec<(&str, usize, usize)> = Vec::new();
    let (mut at, mut next_line) = (0, 1);
    while let Some(found) = text[at..].find('<') {
        let start = at + found;
        let line = next_line + lines(&text[at..start]);
        let markup = &text[start..start + length(&text[start..])];
        at = start + markup.len();
        next_line = line + lines(markup);
        if markup.starts_with("<!") || markup.starts_with("<?") {
            continue;
        }
        let is_end = markup.starts_with("</");
        let tag = tag(markup);
        if let Some(found) = xacro(tag, markup) {
            return Err(ModelError::Xacro { line, found });
        }
        if is_end {
            if let Some(&(opened, since, _)) = open.last()
                && opened != tag
                && outline.unbalanced.is_none()
            {
                let fault = format!("it has not ended where </{tag}> stands in line {line}");
                outline.unbalanced = Some((opened, since, fault));
            }
        } else {
            open.push((tag, line, start));
            if open.len() > DEEPEST {
                return Err(ModelError::TooDeep {
                    line,
                    deepest: DEEPEST,
                });
            }
        }
        if is_end || markup.ends_with("/>") {
            let ended = open.pop();
            if let (Some((tag, line, start)), 1) = (ended, open.len()) {
                outline.children.push(Child {
                    tag,
                    line,
                    text: &text[start..at],
                });
            }
        }
    }
    if let (Some(&(tag, line, _)), None) = (open.last(), &outline.unbalanced) {
        outline.unbalanced = Some((tag, line, "it does not end".to_owned()));
    }
    Ok(outline)
}

/// What in a tag is of xacro and not of URDF: the element itself, or an expression in an attribute.
fn xacro(tag: &str, markup: &str) -> Option<String> {
    if tag.starts_with("xacro:") {
        return Some(format!("<{tag}>"));
    }
    let mut values = markup.split(['"', '\'']).skip(1).step_by(2);
    let is_expression = |value: &&str| {
        ["${", "$(arg ", "$(find "]
            .iter()
            .any(|it| value.contains(it))
    };
    values.find(is_expression).map(str::to_owned)
}

/// The name in a tag.
fn tag(markup: &str) -> &str {
    let name = markup.trim_start_matches(['<', '/']);
    let end = name.find(|c: char| c.is_whitespace() || matches!(c, '/' | '>'));
    &name[..end.unwrap_or(name.len())]
}

/// The length of the tag, comment or other markup that this text starts with; all of it if it does not end.
fn length(markup: &str) -> usize {
    for (start, end) in [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")] {
        if markup.starts_with(start) {
            return markup.find(end).map_or(markup.len(), |i| i + end.len());
        }
    }
    let mut quote = None;
    for (i, c) in markup.char_indices() {
        match (c, quote) {
            ('>', None) => return i + 1,
            ('"' | '\'', None) => quote = Some(c),
            (_, Some(open)) if c == open => quote = None,
            _ => {}
        }
    }
    markup.len()
}

fn lines(text: &str) -> usize {
    text.matches('\n').count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn children_are_found_among_comments_and_quoted_brackets() {
        let text = "<?xml version='1.0'?>\n<!-- <a> -->\n<robot name='>'>\n<link name=\"/>\"/>\n\
            <!-- <no/> --><joint name='j'>\n<parent/></joint></robot>";
        let found = outline(text).unwrap();
        let expected = [
            Child {
                tag: "link",
                line: 4,
                text: "<link name=\"/>\"/>",
            },
            Child {
                tag: "joint",
                line: 5,
                text: "<joint name='j'>\n<parent/></joint>",
            },
        ];
        assert_eq!(found.children, expected);
        assert_eq!(found.unbalanced, None);
    }

    #[test]
    fn a_tower_of_elements_is_refused_where_it_gets_too_high() {
        let text = "<a>\n".repeat(100_000);
        assert_eq!(
            outline(&text).unwrap_err(),
            ModelError::TooDeep {
                line: 65,
                deepest: 64
            }
        );
    }
}
