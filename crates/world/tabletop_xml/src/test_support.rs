//! Short forms for tests.

use std::path::Path;

use tabletop_core::{ObjectSpec, SceneItem, SceneSpec};

use crate::{Fault, NAMESPACE, fault::Faults, origin::Sources, parse};

fn file(attributes: &str, content: &str) -> String {
    format!("<tabletop xmlns='{NAMESPACE}' {attributes}>{content}</tabletop>")
}

/// The scene of a file with this content, which may have faults.
pub(crate) fn scene_of(attributes: &str, content: &str) -> SceneSpec {
    parse(Path::new("f"), file(attributes, content).as_bytes()).scene
}

/// The items of a file with this content, which must have no faults.
pub(crate) fn items_of(content: &str) -> Vec<SceneItem> {
    let task = parse(Path::new("f"), file("", content).as_bytes());
    assert_eq!(task.faults, [], "{content}");
    task.scene.items
}

/// The only object of a file with this content.
pub(crate) fn only_object(content: &str) -> ObjectSpec {
    match items_of(content).as_slice() {
        [SceneItem::Object(object)] => object.clone(),
        other => panic!("{other:?}"),
    }
}

/// The faults of a whole file.
pub(crate) fn faults_of(text: &str) -> Vec<Fault> {
    parse(Path::new("f"), text.as_bytes()).faults
}

/// The faults of a file with this content, without their places.
pub(crate) fn lines_of(content: &str) -> Vec<String> {
    let line = |fault: &Fault| fault.to_string().splitn(4, ':').skip(3).collect::<String>();
    faults_of(&file("", content))
        .iter()
        .map(|fault| line(fault).trim_start().to_owned())
        .collect()
}

/// Faults of a text, with their places in a file named `f`.
pub(crate) fn located(faults: Faults, text: &str) -> Vec<Fault> {
    let mut sources = Sources::default();
    sources.add(Path::new("f"), text);
    faults.locate(&sources)
}
