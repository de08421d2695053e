//! Folders that the user allows strangers' files to name.

use std::{fs, path::PathBuf};

use crate::support::{place, scenario, shipped, stderr, tabletop};

/// A new folder with these files in it.
fn folder(name: &str, files: &[(&str, &str)]) -> PathBuf {
    let folder = place(name);
    for (path, text) in files {
        let path = folder.join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

/// Runs the program without and with the folder allowed: it refuses, says how to allow it, and does it then.
fn is_done_when_allowed(arguments: &[&str], allowed: &str) {
    let output = tabletop(arguments);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    let output = tabletop(&[arguments, &["--allow-path", allowed]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn a_checked_task_file_includes_allowed_files() {
    let tabletop = "<tabletop xmlns='http://synapse.cs.umd.edu/tabletop-xml'>";
    let task = format!("{tabletop}<include file='../parts/ball.xml'/></tabletop>");
    let ball = format!("{tabletop}<sphere location='(0,0,1)'/></tabletop>");
    let files = [("tasks/task.xml", &*task), ("parts/ball.xml", &*ball)];
    let folder = folder("checked-outside", &files);
    let [task, parts] = ["tasks/task.xml", "parts"].map(|path| folder.join(path));
    let [task, parts] = [&task, &parts].map(|path| path.to_str().unwrap());
    is_done_when_allowed(&["check", task], parts);
    is_done_when_allowed(&["check", "--expand", task], parts);
}

#[test]
fn a_recordings_robot_has_meshes_where_it_is_allowed() {
    const MESH: &str =
        "v 0 0 0\nv 0.2 0 0\nv 0 0.2 0\nv 0 0 0.2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    let baxter = fs::read_to_string(shipped("assets", "baxter/baxter.urdf")).unwrap();
    let urdf = baxter.replace("package://tabletop/wrist.shape.json", "wrist.obj");
    assert_ne!(urdf, baxter);
    let files = [("arm/arm.urdf", &*urdf), ("arm/wrist.obj", MESH)];
    let folder = folder("meshes-outside", &files);
    let [demo, arm] = ["demo", "arm"].map(|path| folder.join(path));
    let robot = arm.join("arm.urdf");
    let steps = scenario(
        "meshes_outside.ron",
        "Robot(Show), Start, Wait(0.3), Finish,",
    );
    let [demo, arm, robot, steps] =
        [&demo, &arm, &robot, &steps].map(|path| path.to_str().unwrap());
    let output = tabletop(&["run", steps, "--robot", robot, "--record", demo]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));

    is_done_when_allowed(&["replay", demo, "--verify"], arm);
    let said = stderr(&tabletop(&["replay", demo]));
    assert!(
        said.contains("arm.urdf") && said.contains("--allow-path"),
        "{said}"
    );
}
