//! An expanded task as text.

use std::{collections::BTreeMap, fmt::Write as _};

use crate::{
    NAMESPACE,
    document::{ROOT, syntax::is_name, tree::Element},
    fault::Position,
    origin::{Origin, Sources},
    write::{as_attribute, as_literal},
};

/// Writes elements as they were read, without broken ones that have no effect. Comments give the places of elements that instances
/// inserted.
pub(crate) fn write_expanded(root: Option<&Element>, sources: &Sources) -> String {
    let mut origins = Vec::new();
    root.inspect(|root| collect_origins(root, sources, &mut origins));
    let mut writer = ExpandedWriter {
        positions: sources.positions(origins),
        text: "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n".to_owned(),
        sources,
    };
    match root {
        Some(root) => writer.root(root),
        None => writer.line(0, &format!("<{ROOT} xmlns=\"{NAMESPACE}\"/>")),
    }
    writer.text
}

struct ExpandedWriter<'s, 'a> {
    text: String,
    sources: &'s Sources<'a>,
    positions: BTreeMap<(usize, usize), Position>,
}

fn collect_origins(element: &Element, sources: &Sources, origins: &mut Vec<Origin>) {
    origins.push(element.origin);
    origins.extend(sources.instances_of(element.origin));
    for child in &element.children {
        collect_origins(child, sources, origins);
    }
}

impl ExpandedWriter<'_, '_> {
    fn root(&mut self, root: &Element) {
        let tag = format!("{ROOT} xmlns=\"{NAMESPACE}\"{}", attributes(root));
        self.content(&tag, ROOT, root, 0);
    }

    fn element(&mut self, element: &Element, parent: Origin, depth: usize) {
        let is_plain = |name: &str| is_name(name) && !name.contains(':');
        let has_plain_names = is_plain(element.name)
            && element
                .attributes
                .iter()
                .all(|attribute| is_plain(attribute.name));
        if element.is_broken || !element.is_of_the_language() || !has_plain_names {
            return;
        }
        let Origin {
            source, instance, ..
        } = element.origin;
        if instance != parent.instance || source != parent.source {
            self.comment(element, depth);
        }
        let tag = format!("{}{}", element.name, attributes(element));
        self.content(&tag, element.name, element, depth);
    }

    fn content(&mut self, tag: &str, name: &str, element: &Element, depth: usize) {
        if element.children.is_empty() {
            return self.line(depth, &format!("<{tag}/>"));
        }
        self.line(depth, &format!("<{tag}>"));
        for child in &element.children {
            self.element(child, element.origin, depth + 1);
        }
        self.line(depth, &format!("</{name}>"));
    }

    /// Writes the place of an element and the instances that inserted it.
    fn comment(&mut self, element: &Element, depth: usize) {
        let place = |origin: Origin| {
            let position = self.positions.get(&(origin.source, origin.offset));
            position.map(ToString::to_string).unwrap_or_default()
        };
        let brought_by = self.sources.instances_of(element.origin);
        let places: Vec<_> = std::iter::once(element.origin)
            .chain(brought_by)
            .map(place)
            .collect();
        let mut places = as_attribute(&places.join(", brought by "));
        // Comments cannot hold two hyphens.
        while places.contains("--") {
            places = places.replace("--", "- -");
        }
        self.line(depth, &format!("<!-- {places} -->"));
    }

    fn line(&mut self, depth: usize, content: &str) {
        // Writing to a `String` does not fail.
        let _written = writeln!(self.text, "{:1$}{content}", "", 2 * depth);
    }
}

fn attributes(element: &Element) -> String {
    let mut text = String::new();
    for attribute in &element.attributes {
        let value = attribute.value.as_ref();
        if let Some(value) = value.filter(|_| !attribute.name.contains(':')) {
            let _written = write!(
                text,
                " {}=\"{}\"",
                attribute.name,
                as_attribute(&as_literal(value))
            );
        }
    }
    text
}
