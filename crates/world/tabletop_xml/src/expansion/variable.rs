//! Variables as written: the defaults of a definition, the arguments of an instance.

use std::{borrow::Cow, collections::BTreeMap};

use crate::{
    document::tree::Element,
    elements::{
        attributes::AttributeReader,
        value::{self, ValueError, trim},
    },
    fault::{Faults, Place},
    origin::{InstanceId, Origin},
};

/// The element of a variable.
pub(crate) const VAR: &str = "var";

/// A `<var>`.
#[derive(Clone, Debug)]
pub(crate) struct Variable<'a> {
    /// Its text before its own expressions are replaced.
    pub text: Cow<'a, str>,
    /// True if its expressions use the instance's own variables.
    pub is_derived: bool,
    /// The place of its value.
    origin: Origin,
}

/// Variables by their names.
pub(crate) type Variables<'a> = BTreeMap<String, Variable<'a>>;

impl Variable<'_> {
    /// The place of its value; if it is a default, brought by an instance of its definition.
    pub fn place(&self, instance: Option<InstanceId>) -> Place<'_> {
        Place {
            origin: Origin {
                instance: self.origin.instance.or(instance),
                ..self.origin
            },
            element: Some(VAR),
            attribute: Some("value"),
        }
    }
}

/// Reads the variables among the elements in a definition or instance. Of two with the same name, the later one counts.
pub(crate) fn read_variables<'a>(parent: &Element<'a>, faults: &mut Faults) -> Variables<'a> {
    let mut variables = Variables::new();
    for element in parent.children.iter().filter(|child| is_variable(child)) {
        let Some((name, variable)) = read(element, faults) else {
            continue;
        };
        if variables.insert(name, variable).is_some() {
            let problem = "it is there twice";
            faults.report(element.place_of("name"), problem, "each variable once");
        }
    }
    variables
}

/// True if an element is a variable.
pub(crate) fn is_variable(element: &Element) -> bool {
    element.name == VAR && element.is_of_the_language()
}

fn read<'a>(element: &Element<'a>, faults: &mut Faults) -> Option<(String, Variable<'a>)> {
    for child in &element.children {
        faults.report(
            child.place(),
            "it cannot stand in <var>",
            "no element in <var>",
        );
    }
    let mut attributes = AttributeReader::of(element, faults);
    let name = attributes.require("name", String::new(), "name", word);
    attributes.require("value", (), "text", |_| Ok(()));
    let is_derived = attributes.read("derived", false, value::boolean);
    let name = attributes.finish(Some(name))?;
    let value = element.attribute("value")?;
    let variable = Variable {
        text: value.value.clone()?,
        is_derived,
        origin: element.place_at(value.offset).origin,
    };
    Some((name, variable))
}

/// Reads the name of a definition or variable: any text that is not blank.
pub(crate) fn word(text: &str) -> Result<String, ValueError> {
    match trim(text) {
        "" => Err(ValueError::new(text, "is empty", "a name")),
        name => Ok(name.to_owned()),
    }
}
