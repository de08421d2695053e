//! Files of a few lines that ask for too much.

use crate::{faults, read, scene};

/// Definitions of which each one is two of the next one.
fn doubling(last: &str) -> String {
    let mut content = format!("<def name='d30'>{last}</def><instance def='d0'/>");
    for level in 0..30 {
        let next = format!("<instance def='d{}'/>", level + 1);
        content += &format!("<def name='d{level}'>{next}{next}</def>");
    }
    content
}

#[test]
fn a_bomb_of_elements_is_a_fault() {
    for last in ["<sphere location='(0,0,1)'/>", ""] {
        let task = read(&doubling(last));
        let fault = task.faults[0].to_string();
        assert!(
            fault.contains("after expansion there are too many elements"),
            "{fault}"
        );
        assert!(
            fault.contains("at most 100000 elements (in the instance at f:2:"),
            "{fault}"
        );
        assert!(fault.len() < 400, "{fault}");
        assert!(task.scene.items.len() <= 100_000);
    }
}

#[test]
fn a_bomb_of_text_is_a_fault() {
    let mut content = String::from("<var name='v0' value='many words'/>");
    for level in 1..80 {
        content += &format!("<var name='v{level}' value='$v{0}$$v{0}$'/>", level - 1);
    }
    let content = format!(
        "<def name='d'>{content}<sphere id='$v79$' location='(0,0,1)'/></def><instance def='d'/>"
    );
    let problem = "after expansion there is too much text; the rest is left out";
    let faults_of_bomb = faults(&content);
    assert_eq!(faults_of_bomb.len(), 1, "{faults_of_bomb:?}");
    assert!(faults_of_bomb[0].contains(problem), "{faults_of_bomb:?}");

    let long = "&amp;".repeat(1_000_000);
    let content = format!(
        "<def name='d'><sphere location='(0,0,1)'><description name='a' value='{long}'/></sphere></def>{}",
        "<instance def='d'/>".repeat(10_000)
    );
    assert!(faults(&content)[0].contains(problem));
}

#[test]
fn a_bomb_of_arithmetic_is_a_fault() {
    let long = "1+".repeat(1_000_000);
    let content = format!(
        "<def name='d'><sphere location='(0,0,1)' radius='${long}1$'/></def>{}",
        "<instance def='d'/>".repeat(10_000)
    );
    let faults = faults(&content);
    assert!(
        faults.iter().any(|fault| fault.contains("too much text")),
        "{faults:?}"
    );
}

#[test]
fn deep_instances_are_faults() {
    let mut content =
        String::from("<instance def='d0'/><def name='d5000'><sphere location='(0,0,1)'/></def>");
    for level in 0..5000 {
        content += &format!(
            "<def name='d{level}'><instance def='d{}'/></def>",
            level + 1
        );
    }
    let problem = "instance, def: it is nested too deep";
    assert!(faults(&content)[0].contains(problem));

    let mut content =
        String::from("<instance def='d0'/><def name='d60'><sphere location='(0,0,1)'/></def>");
    for level in 0..60 {
        content += &format!(
            "<def name='d{level}'><composite location='(0,0,1)'><composite location='(0,0,0)'>\
             <instance def='d{}'/></composite></composite></def>",
            level + 1
        );
    }
    let faults = faults(&content);
    let problem = "composite: after expansion it is nested too deep";
    assert!(
        faults.iter().any(|fault| fault.contains(problem)),
        "{faults:?}"
    );
}

#[test]
fn long_rows_of_variables_are_faults() {
    let mut content = String::from("<var name='v0' value='1'/>");
    for level in 1..5000 {
        content += &format!("<var name='v{level}' value='$v{}$'/>", level - 1);
    }
    let of = |last: usize| {
        format!(
            "<def name='d'>{content}<sphere location='(0,0,1)' radius='$v{last}$'/></def><instance def='d'/>"
        )
    };
    assert_eq!(scene(&of(90)).items.len(), 1);
    let faults = faults(&of(4999));
    assert_eq!(faults.len(), 1);
    assert!(
        faults[0].contains("var, value: it needs too many variables in a row"),
        "{faults:?}"
    );
}

#[test]
fn ten_thousand_instances_are_read() {
    let mut content = String::from(
        "<def name='cube'><var name='side' value='1'/><var name='half' value='$side/2$'/>\
         <block id='cube$n$' location='($x$,$y$,$half$)' xspan='$side$' yspan='$side$' zspan='$side$'/></def>",
    );
    for n in 0..10_000 {
        content += &format!(
            "<instance def='cube'><var name='n' value='{n}'/><var name='x' value='{}'/><var name='y' value='{}'/></instance>",
            n % 100 * 2,
            n / 100 * 2
        );
    }
    assert_eq!(scene(&content).items.len(), 10_000);
}
