//! Expanded tasks as text.

use std::{fs, path::Path};

use tabletop_xml::{TaskReader, expand, parse, read_task};

use crate::{file, folder::Folder};

/// Asserts that the expanded text has the same meaning, and returns it.
fn assert_same(content: &str) -> String {
    let text = file(content);
    let task = parse(Path::new("f"), text.as_bytes());
    let expanded = expand(Path::new("f"), text.as_bytes());
    assert_eq!(expanded.faults, task.faults);
    let again = parse(Path::new("e"), expanded.text.as_bytes());
    assert_eq!(again.scene, task.scene, "{}", expanded.text);
    expanded.text
}

#[test]
fn everything_is_put_in() {
    let text = assert_same(
        "<def name='cube'><block id='$id$' location='(0,0,$1/2$)'>\
         <description name='d' value='&lt;\"&#10;$id$'/></block></def>\n\
         <sphere location='(0,0,1)'/><instance def='cube'><var name='id' value='a'/></instance>",
    );
    assert_eq!(
        text,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <tabletop xmlns=\"http://synapse.cs.umd.edu/tabletop-xml\">\n  \
         <sphere location=\"(0,0,1)\"/>\n  \
         <!-- f:2:18, brought by f:3:29 -->\n  \
         <block id=\"a\" location=\"(0,0,0.5)\">\n    \
         <description name=\"d\" value=\"&lt;&quot;&#10;a\"/>\n  </block>\n</tabletop>\n"
    );
}

#[test]
fn broken_elements_are_left_out() {
    for content in [
        "<block location='(0,0,1)' id='&x;'/><sphere location='(0,0,1)'/>",
        "<block location='(0,0,1)' xspan='$nothing$'/><sphere location='(0,0,1)'/>",
        "<block location='(0,0,1)' x:y='1'/><x:block location='(0,0,1)'/><:block/>",
        "<block location='(0,0,1)' location='(0,0,2)'/><composite location='(0,0,1)'><block/></composite>",
        "<block location='(0,0,1)'><description name='a'/></block><cube/>",
        "<composite location='(0,0,1)'><sphere location='(0,0,0)'/></composite><block",
    ] {
        assert_same(content);
    }
}

#[test]
fn no_file_gives_an_empty_table() {
    let expanded = expand(Path::new("f"), b"<html/>");
    let task = parse(Path::new("e"), expanded.text.as_bytes());
    assert_eq!((task.scene, task.faults.len()), (Default::default(), 0));
}

#[test]
fn shipped_files_are_the_same() {
    let folder = Folder::new("shipped");
    for entry in fs::read_dir("../../../tablesetup").unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap();
        if path.extension().is_some_and(|extension| extension == "stl") {
            fs::copy(&path, folder.join(name.to_str().unwrap())).unwrap();
        }
    }
    for entry in fs::read_dir("../../../tablesetup").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "xml") {
            let expanded = TaskReader::default().expand(&path).unwrap();
            let copy = folder.join("expanded.xml");
            fs::write(&copy, &expanded.text).unwrap();
            let task = read_task(&copy).unwrap();
            assert_eq!(task.faults, [], "{}", expanded.text);
            assert_eq!(task.scene, read_task(&path).unwrap().scene);
        }
    }
}

#[test]
fn names_of_files_cannot_end_comments() {
    let folder = Folder::new("comment");
    folder.write("a---b--.xml", "<sphere location='(0,0,1)'/>");
    let path = folder.write("task.xml", "<include file='a---b--.xml'/>");
    let expanded = TaskReader::default().expand(&path).unwrap();
    assert_eq!(expanded.faults, []);
    let task = parse(Path::new("e"), expanded.text.as_bytes());
    assert_eq!(
        (task.scene.items.len(), task.faults),
        (1, vec![]),
        "{}",
        expanded.text
    );
}
