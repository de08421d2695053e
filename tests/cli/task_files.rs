//! Task files: checked, and simulated without a window.

use std::{fs, path::PathBuf};

use crate::support::{place, shipped, stderr, stdout, tabletop};

fn file(name: &str, text: &str) -> PathBuf {
    let path = place(name);
    fs::write(&path, text).unwrap();
    path
}

/// Asserts that this is the table of `default.xml`, with both blocks where they were put.
fn is_default_state(csv: &str) {
    let lines: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    let put = [
        ("RedBlock", [2.0, 0.0, 1.0, 0.0, 0.0, -15.0]),
        ("GreenBlock", [-2.0, 0.0, 1.0, 0.0, 0.0, 45.0]),
    ];
    assert_eq!(lines.len(), put.len(), "{csv}");
    for (line, (id, numbers)) in lines.iter().zip(put) {
        assert_eq!(line[0], id);
        assert_eq!(line.len(), 7, "{line:?}");
        for (i, (text, expected)) in line[1..].iter().zip(numbers).enumerate() {
            let number: f64 = text.parse().unwrap();
            let tolerance = if i < 3 { 0.005 } else { 0.05 };
            assert!((number - expected).abs() < tolerance, "{id}: {line:?}");
        }
    }
}

#[test]
fn the_default_blocks_stay_where_they_are_put() {
    let output = tabletop(&[
        "run",
        "--setup",
        "tablesetup/default.xml",
        "--seconds",
        "10",
        "--final-state",
        "-",
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    is_default_state(&stdout(&output));
}

#[test]
fn the_final_state_is_saved_as_a_new_task_file() {
    let path = place("final_state.xml");
    let name = path.to_str().unwrap();
    let setup = "tablesetup/chain.xml";
    let arguments = ["run", "--setup", setup, "--seconds", "1", "--save", name];
    let output = tabletop(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("cannot express how a chain hangs"));
    let output = tabletop(&["check", name]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));

    let saved = fs::read(&path).unwrap();
    let output = tabletop(&arguments);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(stderr(&output).contains("it exists"));
    assert_eq!(fs::read(&path).unwrap(), saved);
}

#[test]
fn the_final_state_goes_to_a_file() {
    let path = place("final.csv");
    let output = tabletop(&[
        "run",
        "--seconds",
        "1",
        "--final-state",
        path.to_str().unwrap(),
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(stdout(&output), "");
    is_default_state(&fs::read_to_string(path).unwrap());
}

#[test]
fn every_shipped_file_is_accepted() {
    let files: Vec<_> = fs::read_dir(shipped("tablesetup", ""))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "xml"))
        .collect();
    assert!(files.len() >= 10);
    let mut arguments = vec!["check"];
    arguments.extend(files.iter().map(|path| path.to_str().unwrap()));
    let output = tabletop(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(stderr(&output), "");
}

#[test]
fn five_faults_give_five_located_messages() {
    let path = file(
        "five.xml",
        r#"<tabletop xmlns="http://synapse.cs.umd.edu/tabletop-xml" xspan="20" yspan="12">
  <block id="a" location="(0,0)"/>
  <block id="b" location="(0,0,1)" color="vermilion"/>
  <sphere id="c"/>
  <pyramid location="(0,0,1)"/>
  <cylinder id="d" location="(0,0,1)" radius="-1"/>
  <block id="good" location="(5,0,.5)"/>
</tabletop>
"#,
    );
    let path = path.to_str().unwrap();
    let output = tabletop(&["check", path]);
    assert_eq!(output.status.code(), Some(2));
    let messages = stderr(&output);
    let lines: Vec<_> = messages.lines().collect();
    assert_eq!(lines.len(), 5, "{messages}");
    for (message, (line, names)) in lines.iter().zip([
        (2, "block, location"),
        (3, "block, color"),
        (4, "sphere, location"),
        (5, "pyramid"),
        (6, "cylinder, radius"),
    ]) {
        assert!(message.starts_with(&format!("{path}:{line}:")), "{message}");
        assert!(message.contains(names), "{message}");
        assert!(message.contains("expected"), "{message}");
    }

    let run = tabletop(&[
        "run",
        "--quiet",
        "--setup",
        path,
        "--seconds",
        "0.5",
        "--final-state",
        "-",
    ]);
    assert_eq!(run.status.code(), Some(2));
    assert_eq!(stderr(&run), format!("tabletop: {messages}"));
    assert_eq!(stdout(&run), "");
}

#[test]
fn the_dump_holds_the_content_of_the_file() {
    let path = file(
        "dump.xml",
        r##"<tabletop xmlns="http://synapse.cs.umd.edu/tabletop-xml" xspan="8" yspan="6">
  <composite id="T" location="(1,2,3)" rotation="(0,0,90)" mass="2">
    <block id="bar" xspan="3" location="(0,0,1)" color="red"/>
    <composite location="(1,0,0)"><sphere id="ball" radius=".25" location="(0,1,0)" color="#0a0b0c"/></composite>
  </composite>
  <chain id="c" start="(0,0,4)" end="(0,2,4)"/>
</tabletop>
"##,
    );
    let output = tabletop(&["check", "--dump", path.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let dump: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(dump["table"]["xspan"], 8.0);
    let ids: Vec<_> = dump["objects"]
        .as_array()
        .unwrap()
        .iter()
        .map(|object| object["id"].as_str().unwrap())
        .collect();
    assert_eq!(ids, ["T", "c-start", "c-link0", "c-link1", "c-end"]);
    assert_eq!(dump["joints"].as_array().unwrap().len(), 3);
    let composite = &dump["objects"][0];
    assert_eq!(composite["mass"], 2.0);
    assert_eq!(composite["rotation"][2], 90.0);
    assert_eq!(composite["descriptions"][0]["value"], "composite");
    let ball = &composite["parts"][1];
    assert_eq!(ball["shape"], "sphere");
    assert_eq!(ball["radius"], 0.25);
    assert_eq!(ball["color"], "#0a0b0c");
    assert_eq!(ball["location"], serde_json::json!([1.0, 1.0, 0.0]));
}

#[test]
fn the_dump_holds_controls_bond_points_and_bonds() {
    let path = shipped("tablesetup", "panel.xml");
    let output = tabletop(&["check", "--dump", path.to_str().unwrap()]);
    let dump: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let panel = &dump["objects"][0];
    let [power, lights] = [0, 1].map(|control| &panel["controls"][control]);
    assert_eq!(
        power,
        &serde_json::json!({
            "id": "power", "type": "toggleSwitch", "location": [-3.0, 0.0, 0.0], "rotation": [0.0, 0.0, 0.0],
            "state": 0, "stateName": "0", "states": 3, "downstream": ["lights"],
        })
    );
    assert_eq!(
        (&lights["stateName"], &lights["states"]),
        (&"red".into(), &3.into())
    );
    let hole = &panel["bondPoints"][0];
    assert_eq!(
        (&hole["id"], &hole["end"]),
        (&"hole".into(), &"host".into())
    );
    assert_eq!(hole["downstreamOverride"], serde_json::Value::Null);
    assert_eq!(hole["tightness"][2]["downstreamLock"], true);
    assert_eq!(hole["tightness"][1]["rotation"][2], -90.0);
    let tip = &dump["objects"][1]["bondPoints"][0];
    assert_eq!(
        (&tip["id"], &tip["end"]),
        (&"screwTip".into(), &"guest".into())
    );
    assert_eq!(
        dump["bonds"],
        serde_json::json!([{
            "hostPoint": "hole", "host": "panel", "guestPoint": "screwTip", "guest": "screw", "tightness": 1,
        }])
    );
}

#[test]
fn unreadable_input_is_one_line_and_exit_code_2() {
    for arguments in [
        &["check", "no such file.xml"][..],
        &["run", "--setup", "no such file.xml"],
    ] {
        let output = tabletop(arguments);
        assert_eq!(output.status.code(), Some(2));
        assert_eq!(stderr(&output).lines().count(), 1, "{}", stderr(&output));
        assert!(stderr(&output).contains("no such file.xml"));
    }
    let output = tabletop(&["run", "--seconds", "-3"]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn unwritable_output_is_one_line_and_exit_code_1() {
    let output = tabletop(&[
        "run",
        "--seconds",
        "0",
        "--final-state",
        "/no/such/folder/state.csv",
    ]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(stderr(&output).lines().count(), 1, "{}", stderr(&output));
}

#[test]
fn without_a_display_the_table_is_simulated_without_a_window() {
    let output = tabletop(&[]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    is_default_state(&stdout(&output));
    assert!(stderr(&output).lines().count() <= 2, "{}", stderr(&output));
}

#[test]
fn without_time_all_is_where_it_is_put() {
    let output = tabletop(&["run", "--seconds", "0", "--final-state", "-"]);
    assert_eq!(
        stdout(&output),
        "RedBlock,2.0,0.0,1.0,0.0,0.0,-14.999999\nGreenBlock,-2.0,0.0,1.0,0.0,0.0,45.0\n"
    );
}
