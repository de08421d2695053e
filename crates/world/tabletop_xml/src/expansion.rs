//! Expansion of templates: a task of files, definitions and instances becomes one tree without these, in which every element knows its
//! [`Origin`](crate::origin::Origin).

mod arithmetic;
mod definition;
mod effort;
mod expression;
mod inclusion;
mod instance;
mod scope;
mod variable;

pub(crate) use inclusion::Inclusion;

use crate::{
    document::tree::Element, expansion::definition::Definitions, expansion::instance::Expander,
    fault::Faults, origin::Sources,
};

/// Expands everything: returns the root without definitions, instances and variables.
pub(crate) fn expand<'a>(
    mut root: Element<'a>,
    sources: &mut Sources<'a>,
    faults: &mut Faults,
) -> Element<'a> {
    let definitions = Definitions::take_from(&mut root, faults);
    Expander::new(&definitions, sources, faults).root(&root)
}
