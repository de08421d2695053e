//! Building the tree of a file, of bounded size.

use quick_xml::{
    Error, Reader, XmlVersion,
    events::{BytesStart, Event, attributes::Attributes},
    name::{Namespace as Uri, NamespaceResolver, ResolveResult},
};

use crate::{
    NAMESPACE,
    document::decode::{Decoded, is_xml_character},
    document::syntax::{explain, explain_attribute, explain_reference, is_blank, is_name},
    document::tree::{Attribute, Element, Namespace},
    fault::{Excerpt, Faults, Place},
};

/// Largest depth of nested elements, before and after expansion.
pub(crate) const MAX_DEPTH: usize = 100;
/// Largest number of elements of a file, before and after expansion.
pub(crate) const MAX_ELEMENTS: usize = 100_000;
/// Largest number of attributes of an element.
const MAX_ATTRIBUTES: usize = 100;

const INSTANCE_NAMESPACE: &str = "http://www.w3.org/2001/XMLSchema-instance";

/// Reads the root element, with everything complete before the first error.
/// `source` is the index of the file.
pub(crate) fn read<'a>(
    decoded: &Decoded<'a>,
    source: usize,
    faults: &mut Faults,
) -> Option<Element<'a>> {
    let mut builder = Builder {
        source,
        text: decoded.text,
        faults,
        namespaces: NamespaceResolver::default(),
        open: Vec::new(),
        left_out: 0,
        elements: 0,
        root: None,
    };
    let end = builder.read_events(decoded.cut.is_some());
    if let Some(cut) = &decoded.cut {
        let place = builder.place(decoded.text.len());
        builder.faults.report(place, &cut.problem, cut.expected);
    }
    builder.close_all();
    let root = builder.root;
    if root.is_none() && end == End::OfFile {
        let problem = "there is no element";
        faults.report(
            Place::outside(source, decoded.text.len()),
            problem,
            "<tabletop>",
        );
    }
    root
}

/// The reason why reading ended.
#[derive(PartialEq, Eq)]
enum End {
    OfFile,
    Fault,
}

pub(crate) struct Builder<'a, 'f> {
    pub source: usize,
    pub text: &'a str,
    pub faults: &'f mut Faults,
    namespaces: NamespaceResolver,
    /// The elements that are not closed yet, outermost first.
    pub open: Vec<Element<'a>>,
    /// Number of open tags that are not in the tree.
    left_out: usize,
    elements: usize,
    pub root: Option<Element<'a>>,
}

impl<'a> Builder<'a, '_> {
    fn read_events(&mut self, is_cut: bool) -> End {
        let mut reader = Reader::from_str(self.text);
        reader.config_mut().check_comments = true;
        loop {
            let offset = reader.buffer_position() as usize;
            match reader.read_event() {
                Ok(Event::Start(tag)) => {
                    if !self.open_element(offset, &tag) {
                        return End::Fault;
                    }
                }
                Ok(Event::Empty(tag)) => {
                    if !self.open_element(offset, &tag) {
                        return End::Fault;
                    }
                    self.close_element();
                }
                Ok(Event::End(_)) => self.close_element(),
                Ok(Event::Text(text)) => self.check_text(offset, &text),
                Ok(Event::CData(_) | Event::GeneralRef(_)) => self.reject_text(offset),
                Ok(Event::Decl(declaration)) => self.check_declaration(offset, &declaration),
                Ok(Event::DocType(doctype)) => self.check_doctype(offset, &doctype),
                Ok(Event::PI(instruction)) => self.check_instruction(offset, instruction.target()),
                Ok(Event::Comment(_)) => {}
                Ok(Event::Eof) if is_cut => return End::Fault,
                Ok(Event::Eof) => return self.check_end(),
                Err(Error::Syntax(_)) if is_cut => return End::Fault,
                Err(error) => {
                    let place = self.place(reader.error_position() as usize);
                    let (problem, expected) = explain(&error);
                    self.faults.report(place, problem, expected);
                    return End::Fault;
                }
            }
        }
    }

    /// Opens an element; true if there may be more.
    fn open_element(&mut self, offset: usize, tag: &BytesStart) -> bool {
        if self.left_out > 0 {
            self.left_out += 1;
            return true;
        }
        if self.open.is_empty() && self.root.is_some() {
            let place = self.place(offset);
            let problem = "there is a second element beside the root element";
            self.faults.report(place, problem, "one root element");
            self.left_out = 1;
            return true;
        }
        self.elements += 1;
        if self.elements > MAX_ELEMENTS {
            let problem = "there are too many elements; the rest is not read";
            let expected = format_args!("at most {MAX_ELEMENTS} elements");
            self.faults.report(self.place(offset), problem, expected);
            return false;
        }
        if self.open.len() >= MAX_DEPTH {
            let problem = "it is nested too deep";
            let expected = format_args!("at most {MAX_DEPTH} levels");
            self.faults.report(self.place(offset), problem, expected);
            self.left_out = 1;
            return true;
        }
        let element = self.read_element(offset, tag);
        self.open.push(element);
        true
    }

    fn read_element(&mut self, offset: usize, tag: &BytesStart) -> Element<'a> {
        let content_offset = offset + 1;
        let content = &self.text[content_offset..content_offset + tag.len()];
        let name_length = tag.name().as_ref().len();
        let full_name = &content[..name_length];
        let local_name = match is_name(full_name) {
            true => full_name.rsplit(':').next(),
            false => None,
        };
        let mut element = Element {
            origin: Place::outside(self.source, offset).origin,
            name: local_name.unwrap_or(full_name),
            namespace: Namespace::Absent,
            attributes: Vec::new(),
            children: Vec::new(),
            is_broken: false,
        };
        if self.namespaces.push(tag).is_err() {
            element.is_broken = true;
            let problem = "it declares namespaces that XML does not allow";
            self.faults.report(
                element.place(),
                problem,
                "few namespaces, and none for xml and xmlns",
            );
        }
        element.namespace = match self.namespaces.resolve_element(tag.name()).0 {
            ResolveResult::Bound(Uri(NAMESPACE)) => Namespace::Task,
            ResolveResult::Bound(Uri("")) | ResolveResult::Unbound => Namespace::Absent,
            ResolveResult::Bound(_) => Namespace::Other,
            ResolveResult::Unknown(_) => Namespace::Undeclared,
        };
        let attributes = Attributes::new(content, name_length);
        self.read_attributes(&mut element, attributes, content_offset);
        element
    }

    fn read_attributes(
        &mut self,
        element: &mut Element<'a>,
        mut attributes: Attributes<'a>,
        content_offset: usize,
    ) {
        let mut names = Vec::new();
        for (index, attribute) in attributes.with_checks(false).enumerate() {
            if index == MAX_ATTRIBUTES {
                element.is_broken = true;
                let expected = format_args!("at most {MAX_ATTRIBUTES} attributes");
                self.faults
                    .report(element.place(), "there are too many attributes", expected);
                break;
            }
            match attribute {
                Ok(attribute) => {
                    self.read_attribute(element, &attribute, &names);
                    names.push(attribute.key.0);
                }
                Err(error) => {
                    element.is_broken = true;
                    let (offset, problem, expected) = explain_attribute(&error);
                    let place = element.place_at(content_offset + offset);
                    self.faults.report(place, problem, expected);
                    break;
                }
            }
        }
    }

    fn read_attribute(
        &mut self,
        element: &mut Element<'a>,
        attribute: &quick_xml::events::attributes::Attribute<'a>,
        names_before: &[&str],
    ) {
        let name: &'a str = attribute.key.0;
        let offset = name.as_ptr().addr() - self.text.as_ptr().addr();
        let mut faults_of_syntax = Vec::new();
        if !is_name(name) {
            faults_of_syntax.push(("it is not a name".into(), "the name of an attribute"));
        }
        if !self.text[..offset].ends_with(is_blank) {
            faults_of_syntax.push(("it follows without a blank".into(), "a blank before it"));
        }
        if names_before.contains(&name) {
            faults_of_syntax.push(("it is there twice".into(), "each attribute once"));
        }
        if attribute.value.contains('<') {
            faults_of_syntax.push(("there is a `<` in it".into(), "&lt;"));
        }
        let value = attribute.normalized_value(XmlVersion::Implicit1_0);
        match &value {
            Err(Error::Escape(error)) => faults_of_syntax.push(explain_reference(error)),
            Err(error) => faults_of_syntax.push((error.to_string(), "text")),
            Ok(value) => {
                if let Some(character) = value.chars().find(|&c| !is_xml_character(c)) {
                    let code = u32::from(character);
                    let problem = format!("character U+{code:04X} is not allowed");
                    faults_of_syntax.push((problem, "characters of XML 1.0"));
                }
            }
        }
        for (problem, expected) in &faults_of_syntax {
            let place = Place {
                attribute: Some(name),
                ..element.place_at(offset)
            };
            self.faults.report(place, problem, expected);
        }
        element.is_broken |= !faults_of_syntax.is_empty();
        if is_name(name) && !self.is_for_xml_itself(attribute) {
            element.attributes.push(Attribute {
                offset,
                name,
                value: value.ok().filter(|_| faults_of_syntax.is_empty()),
            });
        }
    }

    /// True if an attribute declares a namespace or points a validator to the schema.
    fn is_for_xml_itself(&self, attribute: &quick_xml::events::attributes::Attribute<'a>) -> bool {
        let name = attribute.key;
        let namespace = self.namespaces.resolve_attribute(name).0;
        name.as_namespace_binding().is_some()
            || namespace == ResolveResult::Bound(Uri(INSTANCE_NAMESPACE))
            || name.0.starts_with("xsi:")
    }

    fn close_element(&mut self) {
        if self.left_out > 0 {
            self.left_out -= 1;
            return;
        }
        let Some(element) = self.open.pop() else {
            return;
        };
        self.namespaces.pop();
        match self.open.last_mut() {
            Some(parent) => parent.children.push(element),
            None => self.root = Some(element),
        }
    }

    /// Closes the elements that the text leaves open.
    fn close_all(&mut self) {
        self.left_out = 0;
        while let Some(element) = self.open.last_mut() {
            element.is_broken = true;
            self.close_element();
        }
    }

    fn check_end(&mut self) -> End {
        let Some(innermost) = self.open.last() else {
            return End::OfFile;
        };
        let expected = format_args!("</{}>", Excerpt(innermost.name));
        self.faults
            .report(innermost.place(), "it is not closed", expected);
        End::Fault
    }

    fn check_text(&mut self, offset: usize, text: &str) {
        if let Some(blanks) = text.find(|character| !is_blank(character)) {
            self.reject_text(offset + blanks);
        }
    }

    fn reject_text(&mut self, offset: usize) {
        if self.left_out == 0 {
            let place = self.place(offset);
            let problem = "there is text between the elements";
            self.faults.report(place, problem, "elements and comments");
        }
    }

    /// A place in the innermost open element.
    pub fn place(&self, offset: usize) -> Place<'a> {
        Place {
            element: self.open.last().map(|element| element.name),
            ..Place::outside(self.source, offset)
        }
    }
}
