//! `tabletop require`: requirements that can hold, and those that never can.

use std::{fs, path::Path};

use crate::support::{place, record_shipped, stderr, stdout, tabletop};

fn refused(arguments: &[&str]) -> String {
    let output = tabletop(arguments);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
    said
}

fn accepted(arguments: &[&str]) -> String {
    let output = tabletop(arguments);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {said}");
    stdout(&output)
}

const LENGTH: &str = "expected a number that is not negative, or a range such as 1..2";

const NEVER: [(&str, &str, &str); 18] = [
    (
        "colour",
        "red",
        "expected one of id, shape, color, size, mass",
    ),
    (
        "color",
        "vermilion",
        "`vermilion` is not a colour; expected #rrggbb or one of black",
    ),
    ("color", "", "is not a colour"),
    ("shape", "blok", "expected one of block, cylinder"),
    ("shape", "", "expected one of block"),
    ("xspan", "2..1", LENGTH),
    ("xspan", "nan", LENGTH),
    ("xspan", "inf", LENGTH),
    ("xspan", "1..nan", LENGTH),
    ("xspan", "-1", LENGTH),
    ("xspan", "-2..-1", LENGTH),
    ("xspan", "", LENGTH),
    ("xspan", "wide", LENGTH),
    ("mass", "-1", LENGTH),
    ("size", "2x2x-1", "expected one to three lengths"),
    ("id", "", "expected a text"),
    ("same", "9", "the demonstration has no step 9"),
    ("same", "first", "the demonstration has no step first"),
];

#[test]
fn impossible_requirements_are_refused() {
    let demo = record_shipped("stack_three", "require_never");
    for (name, value, words) in NEVER {
        let said = refused(&["require", &demo, "--step", "2", &format!("{name}={value}")]);
        assert!(said.contains(words), "{name}={value}: {said}");
    }
    assert!(!Path::new(&demo).join("task.json").exists());
    for can_hold in [
        "color=#FF0000",
        "color=Red",
        "shape=sphere",
        "xspan=..2",
        "xspan=0.5..",
        "xspan=-1..2",
        "size=2x2x1",
        "size=0.5",
        "mass=0",
        "id=Another",
        "same=1",
    ] {
        accepted(&["require", &demo, "--step", "2", can_hold]);
    }
}

#[test]
fn impossible_requirements_are_reported_with_their_place_in_the_file() {
    let demo = record_shipped("stack_three", "require_by_hand");
    let file = Path::new(&demo).join("task.json");
    let write = |role: &str, name: &str, value: &str| {
        let text = format!(r#"{{"roles": {{"{role}": {{"{name}": "{value}"}}}}}}"#);
        fs::write(&file, text).unwrap();
    };
    for (name, value, words) in NEVER {
        write("Red", name, value);
        for command in ["explain", "require", "imitate"] {
            let said = refused(&[command, &demo]);
            assert!(said.contains("task.json: Red: "), "{command}: {said}");
            assert!(said.contains(words), "{name}={value}: {said}");
        }
    }
    for role in ["Rde", "red"] {
        write(role, "color", "red");
        let said = refused(&["explain", &demo]);
        let words = format!(
            "task.json: the demonstration has no object `{role}`; expected one of Green, Blue, Red"
        );
        assert!(said.contains(&words), "{said}");
    }

    write("Red", "colour", "red");
    accepted(&["require", &demo, "--step", "2", "--remove", "colour"]);
    assert!(!file.exists());
}

#[test]
fn descriptions_of_the_demonstration_are_properties() {
    let folder = place("require_descriptions");
    fs::create_dir(&folder).unwrap();
    let (setup, shown) = (folder.join("tools.xml"), folder.join("tools.ron"));
    let objects = r#"
        <tabletop xmlns="http://synapse.cs.umd.edu/tabletop-xml">
          <block id="Moved" location="(-3,0,0.5)"><description name="note" value=""/></block>
          <block id="Unmoved" location="(3,0,0.5)">
            <description name="shape" value="hammer"/><description name="use" value="driving nails"/>
          </block>
        </tabletop>"#;
    let steps = r#"(setup: "tools.xml", steps: [
        WaitUntilRest(2), Start, Grasp("Moved"), Glide(to: (-3, 0, 3), seconds: 0.5), Glide(to: (0, 3, 3), seconds: 1),
        Glide(to: (0, 3, 0.5), seconds: 1), Release, WaitUntilRest(3), Finish,
    ])"#;
    fs::write(&setup, objects.trim_start()).unwrap();
    fs::write(&shown, steps).unwrap();
    let demo = folder.join("demo");
    let [shown, demo] = [&shown, &demo].map(|path| path.to_str().unwrap());
    accepted(&["run", shown, "--record", demo, "--quiet"]);
    for can_hold in ["shape=hammer", "use=sawing", "note=", "note=any"] {
        accepted(&["require", demo, "--step", "1", can_hold]);
    }
    let said = refused(&["require", demo, "--step", "1", "use="]);
    assert!(
        said.contains("no object has the use ``; expected a text"),
        "{said}"
    );
    let said = refused(&["require", demo, "--step", "1", "Use=sawing"]);
    assert!(said.contains("note, use, same"), "{said}");
}
