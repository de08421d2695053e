//! A file as a tree of elements, each with its place, of bounded size.

pub(crate) mod build;
pub(crate) mod decode;
mod prolog;
pub(crate) mod syntax;
pub(crate) mod tree;

use tabletop_core::nearest_name;

use crate::{
    NAMESPACE,
    document::{
        decode::Decoded,
        tree::{Element, Namespace},
    },
    fault::{Faults, Place},
};

/// The root of task files.
pub(crate) const ROOT: &str = "tabletop";

/// Reads the root element of a task file, with everything complete before the first error. `source` is the index of the file.
/// `None` if the file is about something else.
pub(crate) fn root<'a>(
    decoded: &Decoded<'a>,
    source: usize,
    faults: &mut Faults,
) -> Option<Element<'a>> {
    if decoded.text.trim_start().starts_with(['(', '/']) {
        let problem =
            "it is a scenario and no task file, as it looks; `tabletop run FILE` does one";
        faults.report(Place::outside(source, 0), problem, "<tabletop>");
        return None;
    }
    let mut root = build::read(decoded, source, faults)?;
    if root.name != ROOT {
        let problem = "it is not the root of a task file";
        faults.report(root.place(), problem, "<tabletop>");
        nearest_name(root.name, &[ROOT])?;
    }
    if root.namespace != Namespace::Task {
        let expected = format_args!("xmlns=\"{NAMESPACE}\" on <{ROOT}>");
        faults.report(root.place(), root.namespace.problem(), expected);
        // One fault of all the file's elements is enough.
        if root.namespace != Namespace::Undeclared {
            let namespace = root.namespace;
            adopt(&mut root, namespace);
        }
    }
    Some(root)
}

/// Treats the elements of a namespace as those of task files.
fn adopt(element: &mut Element, namespace: Namespace) {
    if element.namespace == namespace {
        element.namespace = Namespace::Task;
    }
    for child in &mut element.children {
        adopt(child, namespace);
    }
}
