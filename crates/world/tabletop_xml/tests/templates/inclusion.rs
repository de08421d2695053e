//! Files that others include.

use std::{fs, path::Path, process::Command};

use tabletop_core::{ShippedFile, ShippedFiles};
use tabletop_xml::{NAMESPACE, TaskReader, read_task};

use crate::{folder::Folder, lines, objects, read};

const BALL: &str = "<sphere id='ball' location='(0,0,1)'/>";

/// The ids of the objects of a task file, and the faults, without the folder.
fn loaded(folder: &Folder, path: &Path) -> (Vec<String>, Vec<String>) {
    let task = read_task(path).unwrap();
    let ids = objects(&task.scene)
        .iter()
        .map(|object| object.id.clone())
        .collect();
    let folder = format!("{}/", folder.display());
    let faults = lines(&task)
        .iter()
        .map(|line| line.replace(&folder, ""))
        .collect();
    (ids, faults)
}

#[test]
fn included_elements_stand_in_place_of_the_include() {
    let folder = Folder::new("place");
    folder.write(
        "middle.xml",
        "<sphere id='b' location='(0,0,1)'/><include file='sub/inner.xml'/>",
    );
    folder.write(
        "sub/inner.xml",
        "<sphere id='c' location='(0,0,1)'/><include file='beside.xml'/>",
    );
    folder.write(
        "sub/beside.xml",
        "<def name='ball'><sphere id='$id$' location='(0,0,1)'/></def>",
    );
    let task = folder.write(
        "task.xml",
        "<sphere id='a' location='(0,0,1)'/><include file='middle.xml'/>\
         <instance def='ball'><var name='id' value='d'/></instance>",
    );
    let (ids, faults) = loaded(&folder, &task);
    assert_eq!(faults, [""; 0]);
    assert_eq!(ids, ["a", "b", "c", "d"]);
    let files = read_task(&task).unwrap().files;
    let names = ["task.xml", "middle.xml", "sub/inner.xml", "sub/beside.xml"];
    assert_eq!(files, names.map(|name| folder.join(name)));
}

#[test]
fn the_table_is_that_of_the_task_file() {
    let folder = Folder::new("table");
    let text = format!("<tabletop xmlns='{NAMESPACE}' xspan='99'>{BALL}</tabletop>");
    fs::write(folder.join("other.xml"), text).unwrap();
    let task = read_task(&folder.write("task.xml", "<include file='other.xml'/>")).unwrap();
    assert_eq!((task.scene.table.xspan, task.scene.items.len()), (20.0, 1));
}

#[test]
fn paths_of_the_later_program_begin_at_its_working_folder() {
    let folder = Folder::new("working");
    folder.write("tablesetup/def-lid.xml", BALL);
    folder.write(
        "tablesetup/def-box.xml",
        "<include file='tablesetup/def-lid.xml'/>",
    );
    let task = folder.write(
        "tablesetup/box.xml",
        "<include file='tablesetup/def-box.xml'/>",
    );
    assert_eq!(loaded(&folder, &task), (vec!["ball".into()], vec![]));
    let elsewhere = folder.write(
        "mine/box.xml",
        "<include file=' .\\tablesetup\\def-box.xml '/>",
    );
    folder.write("mine/def-box.xml", BALL);
    assert_eq!(loaded(&folder, &elsewhere), (vec!["ball".into()], vec![]));
}

#[test]
fn a_file_is_included_once() {
    let folder = Folder::new("once");
    folder.write("ball.xml", BALL);
    folder.write(
        "both.xml",
        "<include file='ball.xml'/><include file='./ball.xml'/>",
    );
    let task = folder.write(
        "task.xml",
        "<include file='both.xml'/><include file='ball.xml'/>",
    );
    assert_eq!(loaded(&folder, &task), (vec!["ball".into()], vec![]));
}

#[test]
fn files_in_a_circle_are_refused() {
    let folder = Folder::new("circle");
    folder.write("b.xml", &format!("{BALL}<include file='a.xml'/>"));
    let task = folder.write("a.xml", "<include file='b.xml'/>");
    let (ids, faults) = loaded(&folder, &task);
    assert_eq!(ids, ["ball"]);
    assert_eq!(
        faults,
        ["b.xml:2:48: include, file: `a.xml` includes itself"]
    );
    let own = folder.write("own.xml", "<include file='own.xml'/>");
    assert_eq!(
        loaded(&folder, &own).1,
        ["own.xml:2:10: include, file: `own.xml` includes itself"]
    );
}

#[test]
fn faults_of_an_included_file_are_located_in_it() {
    let folder = Folder::new("located");
    folder.write("def.xml", "<def name='d'>\n<block/></def>\n<cube/>");
    let task = folder.write(
        "task.xml",
        "<include file='def.xml'/>\n\n<instance def='d'/><cube/>",
    );
    assert_eq!(
        loaded(&folder, &task).1,
        [
            "task.xml:4:20: cube: it is not known",
            "def.xml:3:1: block, location: it is missing (in the instance at task.xml:4:1)",
            "def.xml:4:1: cube: it is not known",
        ]
    );
    fs::write(folder.join("def.xml"), "<html/>").unwrap();
    assert_eq!(
        loaded(&folder, &task).1[..1],
        ["task.xml:4:11: instance, def: `d` is not defined"]
    );
}

#[test]
fn files_outside_the_folder_are_refused_and_not_read() {
    let folder = Folder::new("outside");
    folder.write("secret.xml", BALL);
    folder.write("inside/folder/x.xml", BALL);
    let outside = "leads out of the folder of the task file";
    for (written, problem) in [
        ("../secret.xml", outside),
        ("folder/../../secret.xml", outside),
        ("/etc/passwd", outside),
        ("/", outside),
        ("missing.xml", "is not there"),
        ("", "is not there"),
        (" ", "is not there"),
        ("folder", "is not a file"),
    ] {
        let task = folder.write("inside/task.xml", &format!("<include file='{written}'/>"));
        let fault = format!("inside/task.xml:2:10: include, file: `{written}` {problem}");
        assert_eq!(loaded(&folder, &task), (vec![], vec![fault]));
    }
    let task = folder.write(
        "inside/task.xml",
        "<include file='folder/../folder/x.xml'/><include/>",
    );
    assert_eq!(
        loaded(&folder, &task),
        (
            vec!["ball".into()],
            vec!["inside/task.xml:2:41: include, file: it is missing".into()]
        )
    );
}

#[cfg(unix)]
#[test]
fn links_out_pipes_and_devices_are_refused() {
    use std::os::unix::fs::symlink;

    let folder = Folder::new("links");
    folder.write("secret.xml", BALL);
    folder.write("inside/real.xml", BALL);
    let inside = folder.join("inside");
    symlink("../secret.xml", inside.join("link.xml")).unwrap();
    symlink("..", inside.join("up")).unwrap();
    symlink("/dev/zero", inside.join("zero.xml")).unwrap();
    symlink("loop.xml", inside.join("loop.xml")).unwrap();
    symlink("real.xml", inside.join("other.xml")).unwrap();
    let made = Command::new("mkfifo").arg(inside.join("pipe.xml")).status();
    assert!(made.unwrap().success());
    let outside = "leads out of the folder of the task file";
    for (written, problem) in [
        ("link.xml", outside),
        ("up/secret.xml", outside),
        ("zero.xml", outside),
        ("loop.xml", "is not there"),
        ("pipe.xml", "is not a file"),
    ] {
        let task = folder.write("inside/task.xml", &format!("<include file='{written}'/>"));
        let fault = format!("inside/task.xml:2:10: include, file: `{written}` {problem}");
        assert_eq!(loaded(&folder, &task), (vec![], vec![fault]));
    }
    let task = folder.write(
        "inside/task.xml",
        "<include file='other.xml'/><include file='real.xml'/>",
    );
    assert_eq!(loaded(&folder, &task), (vec!["ball".into()], vec![]));
}

#[test]
fn the_user_can_allow_further_folders() {
    let folder = Folder::new("allowed");
    folder.write("library/def.xml", "<include file='deep/ball.xml'/>");
    folder.write("library/deep/ball.xml", BALL);
    folder.write("other/ball.xml", BALL);
    let library = folder.join("library");
    for written in [
        "../library/def.xml",
        library.join("def.xml").to_str().unwrap(),
    ] {
        let content = format!("<include file='{written}'/><include file='../other/ball.xml'/>");
        let path = folder.write("tasks/task.xml", &content);
        let allowed = [library.clone()];
        let task = TaskReader::default()
            .allowing(&allowed)
            .read(&path)
            .unwrap();
        assert_eq!(objects(&task.scene).len(), 1);
        assert_eq!(task.faults.len(), 1, "{:?}", task.faults);
    }
}

#[test]
fn a_text_without_a_folder_includes_nothing() {
    let task = read("<include file='Cargo.toml'/><sphere location='(0,0,1)'/>");
    assert_eq!(
        lines(&task),
        ["f:2:10: include, file: `Cargo.toml` cannot be read by a text without a folder"]
    );
    assert_eq!(task.scene.items.len(), 1);
}

#[test]
fn files_inside_of_the_program_include_each_other() {
    let shipped = ShippedFiles::new([
        ShippedFile {
            path: "tablesetup/plain.xml",
            text: "<tabletop xmlns='http://synapse.cs.umd.edu/tabletop-xml'><include file='sub/def.xml'/>\
                   <include file='tablesetup/ball.xml'/><include file='../../Cargo.toml'/>\
                   <include file='/etc/passwd'/></tabletop>",
        },
        ShippedFile {
            path: "tablesetup/sub/def.xml",
            text: "<tabletop xmlns='http://synapse.cs.umd.edu/tabletop-xml'><include file='../ball.xml'/></tabletop>",
        },
        ShippedFile {
            path: "tablesetup/ball.xml",
            text: "<tabletop xmlns='http://synapse.cs.umd.edu/tabletop-xml'><sphere location='(0,0,1)'/></tabletop>",
        },
    ]);
    let reader = TaskReader::with_shipped(&shipped);
    for path in ["tablesetup/plain.xml", "shipped:tablesetup/plain.xml"] {
        let task = reader.read(Path::new(path)).unwrap();
        assert_eq!(task.scene.items.len(), 1, "{:?}", task.faults);
        assert_eq!(task.faults.len(), 2, "{:?}", task.faults);
        assert_eq!(task.files.len(), 3);
        assert!(
            task.files
                .iter()
                .all(|file| file.starts_with("shipped:tablesetup"))
        );
    }
}

#[test]
fn files_have_limits_together() {
    let folder = Folder::new("together");
    let mut content = String::new();
    for index in 0..120 {
        folder.write(&format!("{index}.xml"), "");
        content += &format!("<include file='{index}.xml'/>");
    }
    let task = folder.write("task.xml", &content);
    let (_, faults) = loaded(&folder, &task);
    assert_eq!(faults.len(), 21);
    assert!(
        faults[0].ends_with("too many files are included"),
        "{faults:?}"
    );

    let blanks = " ".repeat(9 << 20);
    folder.write("a.xml", &blanks);
    folder.write("b.xml", &blanks);
    let task = folder.write("task.xml", "<include file='a.xml'/><include file='b.xml'/>");
    let (_, faults) = loaded(&folder, &task);
    assert_eq!(
        faults,
        ["task.xml:2:33: include, file: the files are too large together"]
    );

    for file in ["a", "b"] {
        let defs = (0..60_000).map(|index| format!("<def name='{file}{index}'/>"));
        folder.write(&format!("{file}.xml"), &defs.collect::<String>());
    }
    let (_, faults) = loaded(&folder, &task);
    let left_out = "b.xml:1:1: tabletop: the files have too many elements; this one is left out";
    assert_eq!(faults.last().map(String::as_str), Some(left_out));
}
