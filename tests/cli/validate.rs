//! Measurements of the physics.

use std::fs;

use serde_json::Value;

use crate::support::{place, stderr, stdout, tabletop};

#[test]
fn measurements_are_a_table_a_chart_and_json() {
    let [plot, json] = ["validation.svg", "validation.json"].map(place);
    let files = [plot.to_str().unwrap(), json.to_str().unwrap()];
    let output = tabletop(&["validate", "fall", "--plot", files[0], "--json", files[1]]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let table = stdout(&output);
    assert!(table.starts_with("| experiment"), "{table}");
    assert_eq!(table.lines().count(), 2 + 5, "{table}");
    let rows: Value = serde_json::from_slice(&fs::read(json).unwrap()).unwrap();
    let names = rows.as_array().unwrap().iter().map(|row| &row["name"]);
    let named = [
        "fall-ball: way",
        "fall-ball: speed",
        "fall-cube: way",
        "fall-cube: speed",
        "fall-past-edge: speed aside",
    ];
    assert!(names.eq(&named), "{rows}");
    let svg = fs::read_to_string(plot).unwrap();
    assert_eq!(svg.matches("class=\"held\"").count(), 5, "{svg}");
}

#[test]
fn unknown_experiments_are_refused() {
    let output = tabletop(&["validate", "fall", "levitate"]);
    assert_eq!(output.status.code(), Some(2));
    let refusal = stderr(&output);
    assert!(
        refusal.contains("levitate: no experiment's name"),
        "{refusal}"
    );
    assert!(refusal.contains("fall, throw, slide"), "{refusal}");
}
