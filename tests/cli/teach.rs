//! `tabletop teach`: programs from demonstrations.

use std::fs;

use crate::support::{place, record_shipped, stderr, stdout, tabletop};

/// Records what sentences say on a table.
fn told(name: &str, sentences: &str, objects: &str) -> String {
    let setup = place(&format!("{name}.xml"));
    let root = "<tabletop xmlns='http://synapse.cs.umd.edu/tabletop-xml' xspan='20' yspan='12'>";
    fs::write(&setup, format!("{root}{objects}</tabletop>")).unwrap();
    let demo = place(name);
    let (setup, demo) = (setup.to_str().unwrap(), demo.to_str().unwrap());
    let output = tabletop(&["tell", sentences, "--setup", setup, "--record", demo]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    demo.to_owned()
}

const TRAY: &str = r#"<box id="Tray" location="(4,-3,0.4)" xspan="4" yspan="3" zspan="0.8" thickness="0.1" color="blue" mass="2"/>"#;

fn block(id: &str, color: &str, x: f32, y: f32) -> String {
    format!(
        r#"<block id="{id}" location="({x},{y},0.5)" xspan="1" yspan="1" zspan="1" color="{color}"/>"#
    )
}

#[test]
fn a_second_demonstration_decides_and_the_program_is_told() {
    let said = "Put every red block into the box.";
    let red = [
        block("A", "red", -4.0, -3.0),
        block("B", "red", -2.0, -4.0),
        TRAY.into(),
    ]
    .concat();
    let first = told("teach_first", said, &red);
    let output = tabletop(&["teach", &first]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let lines = stdout(&output);
    assert!(
        lines.starts_with("Put every block into the box.\n"),
        "{lines}"
    );
    // The others, with their numbers.
    let others: Vec<_> = lines
        .lines()
        .filter_map(|line| line.strip_prefix("Or ")?.split_once(" It differs if "))
        .map(|(other, _)| other.split_once(": ").unwrap())
        .collect();
    let numbers = others.iter().zip(1..);
    assert!(
        numbers
            .clone()
            .all(|((number, _), i)| *number == i.to_string()),
        "{lines}"
    );
    let asked = others.iter().find(|(_, program)| *program == said);
    let (number, _) = asked.unwrap_or_else(|| panic!("{lines}"));
    let out = place("teach_answer.txt");
    let out = out.to_str().unwrap();
    let answered = tabletop(&["teach", &first, "--answer", number, "--out", out]);
    assert_eq!(answered.status.code(), Some(0), "{}", stderr(&answered));
    assert_eq!(stdout(&answered), format!("{said}\n"));
    let written = fs::read_to_string(out).unwrap();
    assert!(written.ends_with(&format!("\n{said}\n")), "{written}");
    let json = stdout(&tabletop(&["teach", &first, "--answer", number, "--json"]));
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["sentences"], said);
    assert_eq!(json["alternatives"], serde_json::json!([]));
    let ask = place("teach_ask.xml");
    let ask = ask.to_str().unwrap();
    let asked = tabletop(&["teach", &first, "--ask", ask]);
    assert_eq!(asked.status.code(), Some(0), "{}", stderr(&asked));
    let question = fs::read_to_string(ask).unwrap();
    let (_, other) = others[0];
    let both = format!("<!-- Which is meant? Put every block into the box. Or: {other} -->");
    assert!(question.contains(&both), "{question}");
    // There, they do not come to the same.
    let steps = |sentences: &str| {
        let told = tabletop(&["tell", sentences, "--setup", ask, "--dry-run"]);
        assert_ne!(told.status.code(), Some(2), "{}", stderr(&told));
        (stdout(&told), told.status.code())
    };
    assert_ne!(steps(other), steps("Put every block into the box."));
    if others.len() < 8 {
        let beyond = (others.len() + 1).to_string();
        let wrong = tabletop(&["teach", &first, "--answer", &beyond]);
        assert_eq!(wrong.status.code(), Some(2));
        let refusal = format!("--answer {beyond}: ");
        assert!(stderr(&wrong).contains(&refusal), "{}", stderr(&wrong));
    }

    let mixed = red + &block("C", "green", 0.0, -3.0);
    let second = told("teach_second", said, &mixed);
    let out = place("teach.txt");
    let out = out.to_str().unwrap();
    let output = tabletop(&["teach", &first, &second, "--out", out]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(
        stdout(&output).starts_with(&format!("{said}\n")),
        "{}",
        stdout(&output)
    );
    let settled = tabletop(&["teach", &second, "--ask", ask]);
    let is_open = stdout(&settled).contains("Or 1: ");
    assert_eq!(settled.status.code(), Some(i32::from(!is_open)));
    let checked = tabletop(&["tell", "--check", "--program", out]);
    assert!(
        stdout(&checked).starts_with(&format!("{said}\n{{")),
        "{}",
        stdout(&checked)
    );
}

#[test]
fn a_demonstration_is_explained_by_its_program() {
    let demo = record_shipped("swap", "teach_swap");
    let explained = stdout(&tabletop(&["explain", &demo, "--program"]));
    let program = "Swap the red block and the blue block.\n";
    assert!(explained.starts_with(program), "{explained}");
}

#[test]
fn what_was_left_alone_is_named_beside_the_steps() {
    let objects = [
        block("A", "red", -4.0, -3.0),
        block("B", "red", -2.0, -4.0),
        block("C", "green", 0.0, -3.0),
        TRAY.into(),
    ];
    let demo = told("teach_alone", "Put A into the box.", &objects.concat());
    let explained = stdout(&tabletop(&["explain", &demo, "--program"]));
    let lines: Vec<_> = explained.lines().collect();
    assert!(lines[0].starts_with("1. Put "), "{explained}");
    assert!(
        lines.contains(&"Not moved, but of every red block: B."),
        "{explained}"
    );
}

#[test]
fn a_tower_of_rings_is_moved_ring_by_ring() {
    let demo = record_shipped("hanoi_five", "teach_hanoi");
    let taught = stdout(&tabletop(&["teach", &demo]));
    let program = "Move the tower from the leftmost peg to the rightmost peg by way of PegB.\n";
    assert!(taught.starts_with(program), "{taught}");
}

#[test]
fn what_no_program_says_is_refused() {
    let turned = record_shipped("turn_over", "teach_turned");
    let output = tabletop(&["teach", &turned]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("no program says"),
        "{}",
        stderr(&output)
    );
}
