//! XML as a tree of elements of bounded size, each with its place in the text.

use std::borrow::Cow;

use quick_xml::{
    Error, Reader, XmlVersion,
    events::{BytesDecl, BytesStart, Event, attributes::Attributes},
    name::{Namespace as Uri, NamespaceResolver, ResolveResult},
};

use crate::{
    NAMESPACE,
    decode::{Decoded, is_xml_character},
    fault::{Excerpt, Faults, Place},
    syntax::{explain, explain_attribute, explain_reference, is_blank, is_declaration, is_name},
};

/// How deep elements can be nested.
const MAX_DEPTH: usize = 100;
/// How many elements a file can have.
const MAX_ELEMENTS: usize = 10_000;
/// How many attributes an element can have.
const MAX_ATTRIBUTES: usize = 100;

const INSTANCE_NAMESPACE: &str = "http://www.w3.org/2001/XMLSchema-instance";

/// An element of a file.
#[derive(Debug)]
pub(crate) struct Element<'a> {
    /// Where its tag begins.
    pub offset: usize,
    /// Its name without prefix.
    pub name: &'a str,
    /// The namespace of its name.
    pub namespace: Namespace,
    /// Its attributes, but for those that XML itself and XML Schema have a use for.
    pub attributes: Vec<Attribute<'a>>,
    /// The elements in it.
    pub children: Vec<Element<'a>>,
    /// It is not all there, and a fault says why.
    pub is_broken: bool,
}

/// An attribute of an element.
#[derive(Debug)]
pub(crate) struct Attribute<'a> {
    /// Where its name begins.
    pub offset: usize,
    /// Its name.
    pub name: &'a str,
    /// Its value; absent if it cannot be read, and a fault says why.
    pub value: Option<Cow<'a, str>>,
}

/// The namespace of an element's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Namespace {
    /// That of task files.
    Task,
    /// Some other.
    Other,
    /// None: there is no prefix and no `xmlns`.
    Absent,
    /// The prefix is not declared.
    Undeclared,
}

impl Element<'_> {
    /// Its place.
    pub fn place(&self) -> Place<'_> {
        Place {
            offset: self.offset,
            element: Some(self.name),
            attribute: None,
        }
    }
}

/// Reads the root element, with everything that is complete before the first error.
pub(crate) fn read<'a>(decoded: &Decoded<'a>, faults: &mut Faults) -> Option<Element<'a>> {
    let mut builder = Builder {
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
        faults.report(Place::outside(decoded.text.len()), problem, "<tabletop>");
    }
    root
}

/// Why reading ended.
#[derive(PartialEq, Eq)]
enum End {
    OfFile,
    Fault,
}

struct Builder<'a, 'f> {
    text: &'a str,
    faults: &'f mut Faults,
    namespaces: NamespaceResolver,
    /// The elements that are not closed yet, outermost first.
    open: Vec<Element<'a>>,
    /// How many of the open tags are not in the tree.
    left_out: usize,
    elements: usize,
    root: Option<Element<'a>>,
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

    /// Opens an element, and says whether there can be more.
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
            offset,
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
                    let place = Place {
                        offset: content_offset + offset,
                        ..element.place()
                    };
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
                offset,
                element: Some(element.name),
                attribute: Some(name),
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

    /// Whether an attribute declares a namespace or tells a validator where the schema is.
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

    /// Closes what the text leaves open.
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

    fn check_declaration(&mut self, offset: usize, declaration: &BytesDecl) {
        let place = Place::outside(offset);
        if offset > 0 {
            let problem = "the XML declaration is not at the beginning";
            self.faults.report(place, problem, "nothing before it");
        }
        if !is_declaration(declaration) {
            let problem = "the XML declaration is not complete";
            let expected = "version=\"1.0\" encoding=\"UTF-8\"";
            self.faults.report(place, problem, expected);
        } else if !matches!(declaration.version().as_deref(), Ok("1.0" | "1.1")) {
            let problem = "the XML declaration has no known version";
            self.faults.report(place, problem, "version=\"1.0\"");
        }
        if let Some(encoding) = declaration.encoding() {
            let encoding = encoding.unwrap_or_default();
            let is_known = ["utf-8", "utf8", "us-ascii", "ascii"]
                .iter()
                .any(|known| known.eq_ignore_ascii_case(&encoding));
            if !is_known && !self.text.is_ascii() {
                let problem = format_args!("the encoding is `{}`", Excerpt(&encoding));
                self.faults.report(place, problem, "UTF-8");
            }
        }
    }

    fn check_instruction(&mut self, offset: usize, target: &str) {
        if !is_name(target) || target.eq_ignore_ascii_case("xml") {
            let place = self.place(offset);
            let problem = "the processing instruction has no name";
            self.faults.report(place, problem, "<?name ...?>");
        }
    }

    fn check_doctype(&mut self, offset: usize, doctype: &str) {
        let place = self.place(offset);
        if !self.open.is_empty() || self.root.is_some() {
            let problem = "the DOCTYPE is not before the root element";
            self.faults.report(place, problem, "elements and comments");
        }
        if doctype.contains("<!ENTITY") {
            let problem = "entities are declared, which are not read";
            self.faults
                .report(place, problem, "a file without entities");
        }
    }

    /// A place in the innermost open element.
    fn place(&self, offset: usize) -> Place<'a> {
        Place {
            offset,
            element: self.open.last().map(|element| element.name),
            attribute: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::decode::decode;

    fn read_all(text: &str) -> (Option<Element<'_>>, Vec<String>) {
        let decoded = decode(text.as_bytes());
        let mut faults = Faults::default();
        let root = read(&decoded, &mut faults);
        let faults = faults.locate(Path::new("f"), decoded.text);
        (root, faults.iter().map(ToString::to_string).collect())
    }

    fn faults(text: &str) -> Vec<String> {
        read_all(text).1
    }

    #[test]
    fn a_tree_has_names_places_and_values() {
        let (root, faults) = read_all(
            "<?xml version='1.0' encoding='UTF-8'?>\n<!-- é -->\n\
             <r xmlns:xsi='http://www.w3.org/2001/XMLSchema-instance' xsi:schemaLocation='a b' \
             xmlns:i='http://www.w3.org/2001/XMLSchema-instance' i:nil='true'>\
             <a x='&lt;&amp;&#65;\n\t'/><b><c/></b></r>\n",
        );
        assert_eq!(faults, [""; 0]);
        let root = root.unwrap();
        assert!(root.attributes.is_empty() && !root.is_broken);
        assert_eq!(root.children[0].attributes[0].name, "x");
        assert_eq!(
            root.children[0].attributes[0].value.as_deref(),
            Some("<&A  ")
        );
        assert_eq!(root.children[1].children[0].name, "c");
    }

    #[test]
    fn namespaces_are_resolved() {
        let (root, faults) = read_all(&format!(
            "<t:r xmlns:t='{NAMESPACE}'><a/><t:a/><a xmlns='x'/><a xmlns='{NAMESPACE}'/><u:a/></t:r>"
        ).leak()[..]);
        assert_eq!(faults, [""; 0]);
        let root = root.unwrap();
        assert_eq!((root.name, root.namespace), ("r", Namespace::Task));
        let found: Vec<_> = root.children.iter().map(|child| child.namespace).collect();
        use Namespace::{Absent, Other, Task, Undeclared};
        assert_eq!(found, [Absent, Task, Other, Task, Undeclared]);
    }

    #[test]
    fn what_is_not_well_formed_is_located() {
        for (text, fault) in [
            ("", "f:1:1: there is no element, expected <tabletop>"),
            ("<r>\n<a>", "f:2:1: a: it is not closed, expected </a>"),
            (
                "<r>\n</a>",
                "f:2:1: r: `</a>` closes another element, expected </r>",
            ),
            (
                "<r/>\n </a>",
                "f:2:2: `</a>` closes no element, expected only tags that close an element",
            ),
            (
                "<r/><r/>",
                "f:1:5: there is a second element beside the root element, expected one root element",
            ),
            (
                "<r>\n é</r>",
                "f:2:2: r: there is text between the elements, expected elements and comments",
            ),
            (
                "x<r/>",
                "f:1:1: there is text between the elements, expected elements and comments",
            ),
            (
                "<r><![CDATA[x]]></r>",
                "f:1:4: r: there is text between the elements, expected elements and comments",
            ),
            (
                "<r><!-- a -- b --></r>",
                "f:1:11: r: there is a `--` in the comment, expected -->",
            ),
            (
                "<r a='1' a='2'/>",
                "f:1:10: r, a: it is there twice, expected each attribute once",
            ),
            (
                "<r a='1'b='2'/>",
                "f:1:9: r, b: it follows without a blank, expected a blank before it",
            ),
            (
                "<r a=1/>",
                "f:1:6: r: the value has no quotes, expected name=\"value\"",
            ),
            (
                "<r a/>",
                "f:1:5: r: an attribute is not complete, expected name=\"value\"",
            ),
            (
                "<r xmlns:x='a' xmlns:x='b'/>",
                "f:1:16: r, xmlns:x: it is there twice, expected each attribute once",
            ),
            (
                "<r xsi:a&='b'/>",
                "f:1:4: r, xsi:a&: it is not a name, expected the name of an attribute",
            ),
            (
                "<r xmlns:xml='b'/>",
                "f:1:1: r: it declares namespaces that XML does not allow, expected few namespaces, and none for xml and xmlns",
            ),
            (
                "<r><?XML a?></r>",
                "f:1:4: r: the processing instruction has no name, expected <?name ...?>",
            ),
            (
                "<r><!DOCTYPE r></r>",
                "f:1:4: r: the DOCTYPE is not before the root element, expected elements and comments",
            ),
            (
                "<?xml version='1.0' encoding?><r/>",
                "f:1:1: the XML declaration is not complete, expected version=\"1.0\" encoding=\"UTF-8\"",
            ),
            (
                "<r a='<'/>",
                "f:1:4: r, a: there is a `<` in it, expected &lt;",
            ),
            (
                "<r a='&'/>",
                "f:1:4: r, a: there is a lone `&`, expected &amp;",
            ),
            (
                "<r a='&#1;'/>",
                "f:1:4: r, a: character U+0001 is not allowed, expected characters of XML 1.0",
            ),
            (
                "<r a='",
                "f:1:1: the value of an attribute in this tag does not end, expected '",
            ),
            ("<r", "f:1:1: the tag does not end, expected >"),
            (
                "<r><!--",
                "f:1:4: r: the comment does not end, expected -->",
            ),
            (
                "<?xml version='1.0' encoding='latin1'?><r a='é'/>",
                "f:1:1: the encoding is `latin1`, expected UTF-8",
            ),
            (
                "<?xml version='2.0'?><r/>",
                "f:1:1: the XML declaration has no known version, expected version=\"1.0\"",
            ),
            (
                " <?xml version='1.0'?><r/>",
                "f:1:2: the XML declaration is not at the beginning, expected nothing before it",
            ),
        ] {
            assert_eq!(faults(text), [fault], "{text}");
        }
    }

    #[test]
    fn a_name_that_is_none_is_kept_whole() {
        for name in [":block", "a:b:block", "block:"] {
            let text = format!("<{name}/>");
            assert_eq!(read_all(&text).0.unwrap().name, name);
        }
    }

    #[test]
    fn what_is_complete_before_an_error_is_kept() {
        let (root, faults) = read_all("<r><a/><b><c/></b><d><e/></x>");
        assert_eq!(faults.len(), 1);
        let root = root.unwrap();
        let broken: Vec<_> = root
            .children
            .iter()
            .map(|child| (child.name, child.is_broken))
            .collect();
        assert_eq!(broken, [("a", false), ("b", false), ("d", true)]);
    }

    #[test]
    fn a_cut_text_has_one_fault_at_its_end() {
        for text in [
            &b"<r><a/>\n\xff</r>"[..],
            b"<r><a/><b x='\n\xff",
            b"<r><a/>\n\0</r>",
        ] {
            let decoded = decode(text);
            let mut faults = Faults::default();
            let root = read(&decoded, &mut faults).unwrap();
            assert_eq!(root.children.len(), 1);
            let faults = faults.locate(Path::new("f"), decoded.text);
            assert_eq!(faults.len(), 1);
            assert_eq!((faults[0].line, faults[0].column), (2, 1));
        }
    }

    #[test]
    fn ten_thousand_levels_are_one_fault() {
        let text = "<a>".repeat(10_000) + &"</a>".repeat(10_000);
        let text = format!("<r>{text}<b/></r>");
        let (root, faults) = read_all(&text);
        assert_eq!(
            faults,
            ["f:1:301: a: it is nested too deep, expected at most 100 levels"]
        );
        assert_eq!(root.unwrap().children[1].name, "b");
    }

    #[test]
    fn sizes_are_bounded() {
        let many = format!("<r>{}</r>", "<a/>".repeat(10_000));
        let (root, faults_of_many) = read_all(&many);
        assert_eq!(root.unwrap().children.len(), MAX_ELEMENTS - 1);
        assert!(faults_of_many[0].contains("too many elements"));
        let wide: String = (0..101).map(|i| format!(" a{i}=''")).collect();
        assert!(faults(&format!("<r{wide}/>"))[0].contains("too many attributes"));
    }

    #[test]
    fn entities_are_never_expanded() {
        let bomb = "<!DOCTYPE r [<!ENTITY a 'aaaaaaaaaa'><!ENTITY b '&a;&a;&a;'>]>\n<r x='&b;'/>";
        assert_eq!(
            faults(bomb),
            [
                "f:1:1: entities are declared, which are not read, expected a file without entities",
                "f:2:4: r, x: `&b;` is not a known entity, expected &amp;, &lt;, &gt;, &quot;, &apos; or &#number;"
            ]
        );
        assert_eq!(faults("<!DOCTYPE r><r/>"), [""; 0]);
    }
}
