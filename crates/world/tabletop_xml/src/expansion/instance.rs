//! Instances: copies of definitions, with variables.

use tabletop_core::nearest_name;

use crate::{
    document::{
        build::MAX_DEPTH,
        tree::{Attribute, Element},
    },
    elements::attributes::AttributeReader,
    expansion::{
        definition::{DEF, Definition, Definitions},
        inclusion::INCLUDE,
        scope::{Context, Scope},
        variable::{VAR, is_variable, read_variables, word},
    },
    fault::{Excerpt, Faults, Place},
    origin::{Origin, Sources},
};

/// The element of an instance.
const INSTANCE: &str = "instance";

/// Copies a tree and inserts the content of definitions in place of their instances.
pub(crate) struct Expander<'d, 'a, 'f> {
    definitions: &'d Definitions<'a>,
    sources: &'f mut Sources<'a>,
    context: Context<'f>,
    /// Names of the definitions that are being inserted, the outermost first.
    open: Vec<&'d str>,
}

impl<'d, 'a, 'f> Expander<'d, 'a, 'f> {
    pub fn new(
        definitions: &'d Definitions<'a>,
        sources: &'f mut Sources<'a>,
        faults: &'f mut Faults,
    ) -> Self {
        Self {
            definitions,
            sources,
            context: Context::new(faults),
            open: Vec::new(),
        }
    }

    /// Copies the root.
    pub fn root(mut self, root: &Element<'a>) -> Element<'a> {
        self.element(root, &Scope::of_file(), 1)
    }

    fn element(
        &mut self,
        template: &Element<'a>,
        scope: &Scope<'_, 'a>,
        depth: usize,
    ) -> Element<'a> {
        let mut element = self.tag(template, scope);
        element.children = self.content(&template.children, template.name, scope, depth);
        element
    }

    /// A copy without its content.
    fn tag(&mut self, template: &Element<'a>, scope: &Scope<'_, 'a>) -> Element<'a> {
        let mut element = Element {
            origin: Origin {
                instance: scope.instance,
                ..template.origin
            },
            attributes: Vec::with_capacity(template.attributes.len()),
            children: Vec::new(),
            ..*template
        };
        for attribute in &template.attributes {
            let place = Place {
                attribute: Some(attribute.name),
                ..element.place_at(attribute.offset)
            };
            let text = attribute.value.as_ref();
            let value = text.and_then(|text| scope.substitute(text, place, &mut self.context));
            element.is_broken |= value.is_none();
            element.attributes.push(Attribute {
                value,
                ..*attribute
            });
        }
        element
    }

    /// Copies the content of an element of a name, at a depth.
    fn content(
        &mut self,
        children: &[Element<'a>],
        parent: &str,
        scope: &Scope<'_, 'a>,
        depth: usize,
    ) -> Vec<Element<'a>> {
        let mut copies = Vec::new();
        for child in children {
            let place = Place {
                origin: Origin {
                    instance: scope.instance,
                    ..child.origin
                },
                ..child.place()
            };
            if self.context.is_exhausted() || !self.context.accept_element(place) {
                break;
            }
            let misplaced = match child.name {
                _ if !child.is_of_the_language() => None,
                INSTANCE => {
                    copies.extend(self.instance(child, scope, depth));
                    continue;
                }
                DEF | INCLUDE => Some("<tabletop>"),
                VAR => Some("<def> or <instance>"),
                _ => None,
            };
            if let Some(right_parent) = misplaced {
                let problem = format_args!("it cannot stand in <{}>", Excerpt(parent));
                let expected = format_args!("it directly in {right_parent}");
                self.context.faults.report(place, problem, expected);
            } else if depth >= MAX_DEPTH {
                let problem = "after expansion it is nested too deep";
                let expected = format_args!("at most {MAX_DEPTH} levels");
                self.context.faults.report(place, problem, expected);
            } else {
                copies.push(self.element(child, scope, depth + 1));
            }
        }
        copies
    }

    /// The content that replaces an instance.
    fn instance(
        &mut self,
        template: &Element<'a>,
        scope: &Scope<'_, 'a>,
        depth: usize,
    ) -> Vec<Element<'a>> {
        let mut element = self.tag(template, scope);
        self.copy_variables(template, &mut element);
        let Some((name, definition)) = self.definition_of(&element) else {
            return Vec::new();
        };
        let arguments = read_variables(&element, self.context.faults);
        let id = self.sources.add_instance(element.origin);
        let defaults = &definition.defaults;
        let scope = Scope::of_instance(scope, id, arguments, defaults, &mut self.context);
        self.open.push(name);
        let copies = self.content(&definition.content, DEF, &scope, depth);
        self.open.pop();
        copies
    }

    /// Gives an instance its variables as written; nothing else may stand in it.
    fn copy_variables(&mut self, template: &Element<'a>, instance: &mut Element<'a>) {
        for child in &template.children {
            let mut child = child.clone();
            child.origin.instance = instance.origin.instance;
            if !is_variable(&child) {
                let problem = "it cannot stand in <instance>";
                self.context.faults.report(child.place(), problem, "<var>");
            } else if self.context.accept_element(child.place()) {
                instance.children.push(child);
            }
        }
    }

    /// The definition of an instance, if it can be inserted.
    fn definition_of(&mut self, element: &Element) -> Option<(&'d str, &'d Definition<'a>)> {
        let mut attributes = AttributeReader::of(element, self.context.faults);
        let name = attributes.require(DEF, String::new(), "name", word);
        let name = attributes.finish(Some(name))?;
        let place = element.place_of(DEF);
        let Some((name, definition)) = self.definitions.get(&name) else {
            let names = self.definitions.names();
            let expected = match nearest_name(&name, &names) {
                Some(known) => known.to_owned(),
                None => "the name of a <def>".to_owned(),
            };
            let problem = format_args!("`{}` is not defined", Excerpt(&name));
            self.context.faults.report(place, problem, expected);
            return None;
        };
        if self.open.contains(&name) {
            let problem = format_args!("`{}` is put into itself", Excerpt(name));
            let expected = "definitions that do not need each other";
            self.context.faults.report(place, problem, expected);
            return None;
        }
        if self.open.len() >= MAX_DEPTH {
            let expected = format_args!("at most {MAX_DEPTH} instances in each other");
            self.context
                .faults
                .report(place, "it is nested too deep", expected);
            return None;
        }
        Some((name, definition))
    }
}
