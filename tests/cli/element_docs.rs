//! What `docs/task-files.md` says of the elements of task files: all that the schema has, which the reader knows (`tests/schema` of `tabletop_xml`).

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

const SCHEMA: &str = "tablesetup/tabletop.xsd";
const MANUAL: &str = "docs/task-files.md";

/// Elements of which there is nothing to be seen.
const NOT_SEEN: [&str; 7] = [
    "tabletop",
    "description",
    "downstream",
    "include",
    "def",
    "instance",
    "var",
];

/// The content of a schema: elements with the names of their types, and of each type and group of attributes, the attributes and the types
/// and groups that it has besides.
#[derive(Default)]
struct Schema {
    elements: BTreeSet<(String, String)>,
    attributes: BTreeMap<String, BTreeSet<String>>,
    others: BTreeMap<String, BTreeSet<String>>,
}

impl Schema {
    fn read(text: &str) -> Self {
        let mut schema = Self::default();
        let mut holder = String::new();
        for line in text.lines() {
            // Definitions of the schema begin with the line, directly in it.
            let mut is_definition = line.starts_with("  <xs:");
            for tag in line.split('<').skip(1) {
                let kind = tag.split([' ', '>', '/']).next().unwrap();
                let name = value(tag, "name");
                if std::mem::take(&mut is_definition) {
                    holder = name.clone().unwrap_or_default();
                    if kind == "xs:element" {
                        schema.elements.insert((holder.clone(), holder.clone()));
                    }
                    continue;
                }
                match (kind, name) {
                    ("xs:attribute", Some(name)) => {
                        let attributes = schema.attributes.entry(holder.clone());
                        attributes.or_default().insert(name);
                    }
                    ("xs:attributeGroup" | "xs:extension", _) => {
                        let other = value(tag, "ref").or_else(|| value(tag, "base"));
                        let others = schema.others.entry(holder.clone());
                        others.or_default().extend(other);
                    }
                    ("xs:element", Some(name)) => {
                        // Without a type it holds its attributes itself.
                        let of_type = value(tag, "type").unwrap_or_else(|| holder.clone());
                        schema.elements.insert((name, of_type));
                    }
                    _ => {}
                }
            }
        }
        schema
    }

    /// The attributes of a type or group.
    fn attributes_of(&self, name: &str) -> BTreeSet<&str> {
        let own = self.attributes.get(name).into_iter().flatten();
        let others = self.others.get(name).into_iter().flatten();
        let inherited = others.flat_map(|other| self.attributes_of(other));
        own.map(String::as_str).chain(inherited).collect()
    }
}

/// The value of an attribute in a tag.
fn value(tag: &str, name: &str) -> Option<String> {
    let (_, rest) = tag.split_once(&format!(" {name}=\""))?;
    rest.split_once('"').map(|(value, _)| value.to_owned())
}

fn has_word(text: &str, word: &str) -> bool {
    let mut words = text.split(|c: char| !c.is_ascii_alphanumeric());
    words.any(|other| other == word)
}

#[test]
fn every_element_has_its_attributes_and_a_picture_in_the_manual() {
    let schema = Schema::read(&fs::read_to_string(SCHEMA).unwrap());
    let manual = fs::read_to_string(MANUAL).unwrap();
    let sections: Vec<_> = manual.split("\n## ").collect();
    let pictures: Vec<_> = manual
        .split("![")
        .skip(1)
        .filter_map(|rest| {
            let (shown, rest) = rest.split_once("](")?;
            Some((shown, rest.split_once(')')?.0))
        })
        .collect();
    let names: BTreeSet<_> = schema.elements.iter().map(|(name, _)| name).collect();
    assert!(names.len() > 30, "{names:?}");
    for (name, of_type) in &schema.elements {
        let element = format!("`<{name}>`");
        let all_about = |element: &str| -> String {
            let about = sections.iter().filter(|section| section.contains(element));
            about.copied().collect()
        };
        let mut about = all_about(&element);
        for other in &names {
            if about.contains(&format!("all attributes of `<{other}>`")) {
                about += &all_about(&format!("`<{other}>`"));
            }
        }
        assert!(!about.is_empty(), "{MANUAL} does not describe {element}");
        for attribute in schema.attributes_of(of_type) {
            assert!(
                has_word(&about, attribute),
                "{MANUAL} does not describe {attribute} of {element}"
            );
        }
        let is_shown = pictures.iter().any(|(shown, _)| has_word(shown, name));
        assert!(
            is_shown || NOT_SEEN.contains(&&**name),
            "{MANUAL} has no picture of {element}"
        );
    }
    for (_, path) in pictures {
        let path = Path::new("docs").join(path);
        assert!(path.exists(), "{} is not there", path.display());
    }
    for picture in fs::read_dir("docs/elements").unwrap() {
        let name = picture.unwrap().file_name().into_string().unwrap();
        assert!(
            manual.contains(&format!("](elements/{name})")),
            "{name} is in no text"
        );
    }
}
