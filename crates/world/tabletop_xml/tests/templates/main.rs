//! Templates: files made of files, definitions, instances and variables, rule by rule.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on panics")]

mod expanded;
mod folder;
mod inclusion;
mod instances;
mod limits;
mod variables;

use std::path::Path;

use tabletop_core::{ObjectSpec, SceneItem, SceneSpec, Shape};
use tabletop_xml::{NAMESPACE, ParsedTask, parse};

fn file(content: &str) -> String {
    format!("<tabletop xmlns='{NAMESPACE}'>\n{content}\n</tabletop>")
}

fn read(content: &str) -> ParsedTask {
    parse(Path::new("f"), file(content).as_bytes())
}

/// The scene of a file with this content, which must have no faults.
fn scene(content: &str) -> SceneSpec {
    let task = read(content);
    assert_eq!(task.faults, [], "{content}");
    task.scene
}

fn objects(scene: &SceneSpec) -> Vec<&ObjectSpec> {
    let items = scene.items.iter();
    items
        .filter_map(|item| match item {
            SceneItem::Object(object) => Some(object),
            SceneItem::Chain(_) | SceneItem::LidBox(_) | SceneItem::Jointed(_) => None,
        })
        .collect()
}

/// The ids of the objects that a file with this content has, in their order.
fn ids(content: &str) -> Vec<String> {
    let scene = scene(content);
    let objects = objects(&scene);
    objects.iter().map(|object| object.id.clone()).collect()
}

fn only_object(content: &str) -> ObjectSpec {
    let scene = scene(content);
    match objects(&scene)[..] {
        [object] => object.clone(),
        ref other => panic!("{other:?}"),
    }
}

/// The extents of the only object of a file, which is a block.
fn span(content: &str) -> [f32; 3] {
    let shape = only_object(content).shape;
    let Shape::Block { span, .. } = shape else {
        panic!("{shape:?}");
    };
    span.to_array()
}

/// The faults of a file with this content, without their expectations.
fn faults(content: &str) -> Vec<String> {
    lines(&read(content))
}

fn lines(task: &ParsedTask) -> Vec<String> {
    let line = |fault: &tabletop_xml::Fault| {
        let line = fault.to_string();
        let (problem, rest) = line.split_once(", expected ").unwrap();
        let instances = rest
            .find(" (in the instance")
            .map_or("", |start| &rest[start..]);
        format!("{problem}{instances}")
    };
    task.faults.iter().map(line).collect()
}
