//! An XML text as a tree of elements that know their lines.

use quick_xml::{
    Reader, XmlVersion,
    escape::resolve_xml_entity,
    events::{BytesRef, BytesStart, Event},
};

use crate::error::MeshFileError;

/// Elements may be this deep inside each other.
const DEEPEST: usize = 64;

/// Most elements of a file.
const MOST_ELEMENTS: usize = 1_000_000;

/// An element, without comments and the text between its children.
#[derive(Debug, Default)]
pub(super) struct ColladaElement {
    pub name: String,
    /// The line in which it starts, from 1.
    line: usize,
    attributes: Vec<(String, String)>,
    pub children: Vec<Self>,
    /// The text in it.
    text: String,
}

/// What is wrong, with its line.
#[derive(Debug)]
pub(super) struct ColladaFault(String);

impl From<ColladaFault> for MeshFileError {
    fn from(fault: ColladaFault) -> Self {
        Self::Collada(fault.0)
    }
}

impl ColladaElement {
    /// The root element of a text.
    pub fn read(text: &str) -> Result<Self, ColladaFault> {
        let mut reader = Reader::from_str(text);
        let mut lines = LineCount {
            text,
            at: 0,
            line: 1,
        };
        // The elements that have not ended, and above them one that holds the root.
        let mut open = vec![Self::default()];
        let mut count = 0;
        loop {
            let start = usize::try_from(reader.buffer_position()).unwrap_or(0);
            let line = lines.at(start);
            let wrong = |what: String| ColladaFault(format!("line {line}: {what}"));
            let event = reader
                .read_event()
                .map_err(|error| wrong(error.to_string()))?;
            match event {
                Event::Start(tag) => {
                    open.push(Self::begin(&tag, line).map_err(wrong)?);
                    count += 1;
                }
                Event::Empty(tag) => {
                    let element = Self::begin(&tag, line).map_err(wrong)?;
                    if let Some(parent) = open.last_mut() {
                        parent.children.push(element);
                    }
                    count += 1;
                }
                Event::End(_) => {
                    if let (Some(element), Some(parent)) = (open.pop(), open.last_mut()) {
                        parent.children.push(element);
                    }
                }
                Event::Text(text) => add(&mut open, &text),
                Event::CData(text) => add(&mut open, &text),
                Event::GeneralRef(reference) => {
                    add(&mut open, &character(&reference).map_err(wrong)?);
                }
                Event::DocType(_) => {
                    return Err(wrong("a DOCTYPE is not read: remove it".to_owned()));
                }
                Event::Comment(_) | Event::Decl(_) | Event::PI(_) => {}
                Event::Eof => break,
            }
            if open.len() > DEEPEST {
                return Err(wrong(format!(
                    "elements are nested more than {DEEPEST} deep"
                )));
            }
            if count > MOST_ELEMENTS {
                return Err(wrong(format!(
                    "there are more than {MOST_ELEMENTS} elements"
                )));
            }
        }
        match open.len() {
            1 => {}
            _ => {
                let last = open.pop().unwrap_or_default();
                return Err(last.fault("it does not end"));
            }
        }
        let root = open.pop().and_then(|all| all.children.into_iter().next());
        root.ok_or_else(|| ColladaFault("there is no element".to_owned()))
    }

    fn begin(tag: &BytesStart, line: usize) -> Result<Self, String> {
        let attributes = tag.attributes().map(|attribute| {
            let attribute = attribute.map_err(|error| error.to_string())?;
            let value = attribute.normalized_value(XmlVersion::Implicit1_0);
            let value = value.map_err(|error| error.to_string())?;
            Ok((attribute.key.0.to_owned(), value.into_owned()))
        });
        Ok(Self {
            name: tag.name().0.to_owned(),
            line,
            attributes: attributes.collect::<Result<_, String>>()?,
            ..Self::default()
        })
    }

    /// A fault of this element.
    pub fn fault(&self, what: &str) -> ColladaFault {
        ColladaFault(format!("line {}: <{}>: {what}", self.line, self.name))
    }

    /// The fault that this kind of element is not read.
    pub fn unread(&self, instead: &str) -> ColladaFault {
        ColladaFault(format!(
            "line {}: <{}> is not read: {instead}",
            self.line, self.name
        ))
    }

    pub fn attribute(&self, name: &str) -> Option<&str> {
        let found = self.attributes.iter().find(|(known, _)| known == name);
        found.map(|(_, value)| &**value)
    }

    /// The attribute that an element must have.
    pub fn required(&self, name: &str) -> Result<&str, ColladaFault> {
        let found = self.attribute(name);
        found.ok_or_else(|| self.fault(&format!("it has no {name}")))
    }

    /// The id in this file that an attribute refers to.
    pub fn reference(&self, name: &str) -> Result<&str, ColladaFault> {
        let address = self.required(name)?;
        address.strip_prefix('#').ok_or_else(|| {
            self.fault(&format!(
                "{name} {address} is in another file; only #ids of this one are read"
            ))
        })
    }

    /// The first child of this name.
    pub fn child(&self, name: &str) -> Option<&Self> {
        self.children.iter().find(|child| child.name == name)
    }

    pub fn children_called(&self, name: &'static str) -> impl Iterator<Item = &Self> {
        self.children.iter().filter(move |child| child.name == name)
    }

    /// The numbers in its text.
    pub fn numbers(&self) -> Result<Vec<f32>, ColladaFault> {
        self.parsed("number")
    }

    /// The indices in its text.
    pub fn indices(&self) -> Result<Vec<usize>, ColladaFault> {
        self.parsed("index")
    }

    /// So many numbers.
    pub fn exactly<const COUNT: usize>(&self) -> Result<[f32; COUNT], ColladaFault> {
        let numbers = self.numbers()?;
        let found = numbers.len();
        numbers
            .try_into()
            .map_err(|_| self.fault(&format!("it has {found} numbers, expected {COUNT}")))
    }

    fn parsed<T: std::str::FromStr>(&self, what: &str) -> Result<Vec<T>, ColladaFault> {
        let words = self.text.split_ascii_whitespace();
        words
            .map(|word| {
                word.parse()
                    .map_err(|_| self.fault(&format!("`{word:.20}` is no {what}")))
            })
            .collect()
    }
}

fn add(open: &mut [ColladaElement], text: &str) {
    if let Some(element) = open.last_mut()
        && !text.trim_ascii().is_empty()
    {
        element.text.push_str(text);
    }
}

/// The character that a reference such as `&lt;` means.
fn character(reference: &BytesRef) -> Result<String, String> {
    let character = match reference.resolve_char_ref() {
        Ok(Some(character)) => Some(character.to_string()),
        Ok(None) => resolve_xml_entity(reference).map(str::to_owned),
        Err(_) => None,
    };
    character.ok_or_else(|| format!("`&{};` is not known", &**reference))
}

/// The lines of a text, counted as far as it is read.
struct LineCount<'a> {
    text: &'a str,
    at: usize,
    line: usize,
}

impl LineCount<'_> {
    /// The line of a place at or after the last one.
    fn at(&mut self, place: usize) -> usize {
        let passed = self.text.get(self.at..place).unwrap_or_default();
        self.line += passed.matches('\n').count();
        self.at = self.at.max(place);
        self.line
    }
}
