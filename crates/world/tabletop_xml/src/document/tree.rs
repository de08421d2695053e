//! XML as a tree of elements, each with its place in the text.

use std::borrow::Cow;

use crate::{fault::Place, origin::Origin};

/// An element of a file.
#[derive(Clone, Debug)]
pub(crate) struct Element<'a> {
    /// The place of its tag.
    pub origin: Origin,
    /// Its name without prefix.
    pub name: &'a str,
    /// The namespace of its name.
    pub namespace: Namespace,
    /// Its attributes, except those for XML itself and XML Schema.
    pub attributes: Vec<Attribute<'a>>,
    /// The elements in it.
    pub children: Vec<Element<'a>>,
    /// True if a part of it is missing, and a fault has the reason.
    pub is_broken: bool,
}

/// An attribute of an element.
#[derive(Clone, Debug)]
pub(crate) struct Attribute<'a> {
    /// The place of its name.
    pub offset: usize,
    /// Its name.
    pub name: &'a str,
    /// Its value; absent if it cannot be read, and a fault has the reason.
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

impl Namespace {
    /// Its problem, if it is not the namespace of task files.
    pub const fn problem(self) -> &'static str {
        match self {
            Self::Undeclared => "its prefix is not declared",
            Self::Absent => "it has no namespace",
            Self::Task | Self::Other => "it is of another namespace",
        }
    }
}

impl<'a> Element<'a> {
    /// Its place.
    pub fn place(&self) -> Place<'_> {
        Place {
            origin: self.origin,
            element: Some(self.name),
            attribute: None,
        }
    }

    /// A place in its tag.
    pub fn place_at(&self, offset: usize) -> Place<'_> {
        Place {
            origin: Origin {
                offset,
                ..self.origin
            },
            ..self.place()
        }
    }

    /// The place of an attribute of this name: its own or, where it is absent, the element's.
    pub fn place_of<'p>(&'p self, name: &'p str) -> Place<'p> {
        let place = match self.attribute(name) {
            Some(attribute) => self.place_at(attribute.offset),
            None => self.place(),
        };
        Place {
            attribute: Some(name),
            ..place
        }
    }

    /// True if it belongs to the language of task files.
    pub fn is_of_the_language(&self) -> bool {
        self.namespace == Namespace::Task
    }

    /// Number of elements in it, including itself.
    pub fn count(&self) -> usize {
        1 + self.children.iter().map(Element::count).sum::<usize>()
    }

    /// The attribute of this name.
    pub fn attribute(&self, name: &str) -> Option<&Attribute<'a>> {
        self.attributes
            .iter()
            .find(|attribute| attribute.name == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        NAMESPACE,
        document::build::{MAX_ELEMENTS, read},
        document::decode::decode,
        fault::Faults,
        test_support::located,
    };

    fn read_all(text: &str) -> (Option<Element<'_>>, Vec<String>) {
        let decoded = decode(text.as_bytes());
        let mut faults = Faults::default();
        let root = read(&decoded, 0, &mut faults);
        let faults = located(faults, decoded.text);
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
    fn malformed_xml_is_located() {
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
    fn an_invalid_name_is_kept_whole() {
        for name in [":block", "a:b:block", "block:"] {
            let text = format!("<{name}/>");
            assert_eq!(read_all(&text).0.unwrap().name, name);
        }
    }

    #[test]
    fn complete_elements_before_an_error_are_kept() {
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
            let root = read(&decoded, 0, &mut faults).unwrap();
            assert_eq!(root.children.len(), 1);
            let faults = located(faults, decoded.text);
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
        let many = format!("<r>{}</r>", "<a/>".repeat(MAX_ELEMENTS));
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
