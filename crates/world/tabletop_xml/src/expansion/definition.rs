//! Definitions: the templates of instances.

use std::collections::BTreeMap;

use crate::{
    document::tree::Element,
    elements::attributes::AttributeReader,
    expansion::variable::{Variables, is_variable, read_variables, word},
    fault::{Excerpt, Faults},
};

/// The element of a definition.
pub(crate) const DEF: &str = "def";

/// A `<def>`.
#[derive(Debug)]
pub(crate) struct Definition<'a> {
    /// Its variables, with their defaults.
    pub defaults: Variables<'a>,
    /// The content that an instance inserts.
    pub content: Vec<Element<'a>>,
}

/// The definitions of a task by name.
#[derive(Debug, Default)]
pub(crate) struct Definitions<'a>(BTreeMap<String, Definition<'a>>);

impl<'a> Definitions<'a> {
    /// Takes the definitions out of the root. Of two with the same name, the later one counts.
    pub fn take_from(root: &mut Element<'a>, faults: &mut Faults) -> Self {
        let mut definitions = Self::default();
        let is_definition = |child: &Element| child.name == DEF && child.is_of_the_language();
        let children = std::mem::take(&mut root.children);
        let (taken, left): (Vec<_>, _) = children.into_iter().partition(is_definition);
        root.children = left;
        for element in taken {
            definitions.add(element, faults);
        }
        definitions
    }

    /// The definition of this name, with the name.
    pub fn get(&self, name: &str) -> Option<(&str, &Definition<'a>)> {
        let (name, definition) = self.0.get_key_value(name)?;
        Some((name, definition))
    }

    /// Their names.
    pub fn names(&self) -> Vec<&str> {
        self.0.keys().map(String::as_str).collect()
    }

    fn add(&mut self, mut element: Element<'a>, faults: &mut Faults) {
        let defaults = read_variables(&element, faults);
        let mut attributes = AttributeReader::of(&element, faults);
        let name = attributes.require("name", String::new(), "name", word);
        let Some(name) = attributes.finish(Some(name)) else {
            return;
        };
        if self.0.contains_key(&name) {
            let problem = format_args!("`{}` is defined again", Excerpt(&name));
            faults.report(element.place_of("name"), problem, "each definition once");
        }
        let mut content = std::mem::take(&mut element.children);
        content.retain(|child| !is_variable(child));
        self.0.insert(name, Definition { defaults, content });
    }
}
