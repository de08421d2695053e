//! `tabletop run --seeds`: a scenario with many seeds, and shards of the work.

use std::{fs, path::Path};

use crate::support::{files, place, record_shipped, scenario, stderr, stdout, tabletop};

/// A short scenario with random places.
const STEPS: &str = r#"Load(file: "shipped:tablesetup/default.xml", place: [
        (object: "RedBlock", x: (-8, 8), y: (-4, 4), turn: (0, 360)),
        (object: "GreenBlock", x: (-8, 8), y: (-4, 4)),
    ]), Start, Grasp("RedBlock"), MoveBy((0, 0, 2)), Wait(0.5), Release, WaitUntilRest(5), Finish"#;

fn run(scenario: &Path, out: &Path, options: &[&str]) -> (Option<i32>, String) {
    let paths = [scenario, out].map(|path| path.to_str().unwrap());
    let output = tabletop(&[&["run", paths[0], "--record", paths[1]], options].concat());
    (output.status.code(), stdout(&output) + &stderr(&output))
}

#[test]
fn each_seed_is_recorded_as_it_is_alone() {
    let scenario = scenario("seeds_bytes", STEPS);
    let [many, alone] = ["seeds_bytes_many", "seeds_bytes_alone"].map(place);
    let (code, reported) = run(&scenario, &many, &["--seeds", "3..6", "--jobs", "2"]);
    assert_eq!(code, Some(0), "{reported}");
    assert!(reported.contains("3 of 3 done"), "{reported}");
    for seed in ["3", "4", "5"] {
        let one = alone.join(seed);
        assert_eq!(run(&scenario, &one, &["--seed", seed]).0, Some(0));
        assert_eq!(files(&one), files(&many.join(format!("000{seed}"))));
    }
}

#[test]
fn recordings_that_are_there_stay_and_shards_share_the_rest() {
    let scenario = scenario("seeds_shards", STEPS);
    let [whole, shards] = ["seeds_shards_whole", "seeds_shards_parts"].map(place);
    assert_eq!(run(&scenario, &whole, &["--seeds", "0..4"]).0, Some(0));
    let (_, first) = run(&scenario, &shards, &["--seeds", "0..4", "--shard", "0/2"]);
    assert!(first.contains("2 of 2 done"), "{first}");
    assert!(!shards.join("0001").exists());
    let (code, rest) = run(&scenario, &shards, &["--seeds", "0..4"]);
    assert_eq!(code, Some(0), "{rest}");
    assert!(rest.contains("2 were there\n2 of 2 done"), "{rest}");
    assert_eq!(files(&whole), files(&shards));

    fs::write(&scenario, "(steps: [Start, Finish])").unwrap();
    let (code, other) = run(&scenario, &shards, &["--seeds", "0..4"]);
    assert_eq!(code, Some(2), "{other}");
    assert!(other.contains("of something else"), "{other}");
}

#[test]
fn a_seed_that_fails_is_named_with_the_command_that_repeats_it() {
    let scenario = scenario(
        "seeds_failing",
        &format!("{STEPS}, Expect(Gone(\"RedBlock\"))"),
    );
    let out = place("seeds_failing_out");
    let (code, reported) = run(&scenario, &out, &["--seeds", "7..8", "--show-robot"]);
    assert_eq!(code, Some(1), "{reported}");
    assert!(reported.contains("seed 7: "), "{reported}");
    assert!(
        reported.contains("expected no `RedBlock`, found it"),
        "{reported}"
    );
    let again = reported
        .lines()
        .find_map(|line| line.strip_prefix("tabletop: again: tabletop "));
    let again: Vec<_> = again.unwrap().split(' ').collect();
    let output = tabletop(&again);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("expected no `RedBlock`, found it"));
    assert!(!out.join("0007").exists());
}

#[test]
fn shards_of_demonstrations_are_those_of_one_machine() {
    let demo = record_shipped("red_on_blue", "shards_multiply");
    let [whole, shards] = ["shards_multiply_whole", "shards_multiply_parts"].map(place);
    let multiply = |out: &Path, options: &[&str]| {
        let words = [
            "multiply",
            &demo,
            "--out",
            out.to_str().unwrap(),
            "--count",
            "3",
        ];
        let output = tabletop(&[&words[..], options].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    };
    multiply(&whole, &[]);
    multiply(&shards, &["--shard", "1/2"]);
    assert!(!shards.join("0000").exists() && shards.join("0001").exists());
    multiply(&shards, &["--shard", "0/2"]);
    assert_eq!(files(&whole), files(&shards));
    let output = tabletop(&["imitate", &demo, "--trials", "3", "--shard", "2/3"]);
    assert!(stdout(&output).contains("of 1\n"), "{}", stdout(&output));
    let output = tabletop(&["imitate", &demo, "--shard", "0/2"]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    let output = tabletop(&["multiply", &demo, "--out", "x", "--shard", "2/2"]);
    assert!(
        stderr(&output).contains("expected I/N"),
        "{}",
        stderr(&output)
    );
}
