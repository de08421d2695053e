//! The manual page.

use std::{fs, process::Command};

use crate::support::{place, stdout, tabletop};

/// The page as it is typed, without its escapes of hyphens.
fn page() -> String {
    let output = tabletop(&["man"]);
    assert_eq!(output.status.code(), Some(0));
    stdout(&output).replace("\\-", "-")
}

fn help(command: &[&str]) -> String {
    stdout(&tabletop(&[command, &["--help"]].concat()))
}

/// The commands in a help text.
fn commands(help: &str) -> Vec<&str> {
    let (_, listed) = help.split_once("Commands:\n").unwrap();
    let listed = listed.lines().take_while(|line| !line.is_empty());
    let names = listed.filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
    names
        .filter(|name| !name.is_empty() && *name != "help")
        .collect()
}

/// The long options in a help text, and the ranges of numbers.
fn options_and_ranges(help: &str) -> Vec<String> {
    let words: Vec<_> = help.split_whitespace().collect();
    let options = words.iter().filter(|word| word.starts_with("--"));
    let options = options.map(|word| word.trim_end_matches([',', '.', ';', ')']).to_owned());
    let is_range = |words: &&[&str]| {
        let is_number = |word: &str| word.starts_with(|letter: char| letter.is_ascii_digit());
        words[0] == "from" && is_number(words[1]) && words[2] == "to"
    };
    let ranges = words.windows(4).filter(is_range);
    options.chain(ranges.map(|words| words.join(" "))).collect()
}

#[test]
fn it_has_all_commands_with_their_options_and_ranges() {
    let page = page();
    let program = help(&[]);
    let commands = commands(&program);
    assert!(commands.len() >= 12, "{commands:?}");
    for command in [vec!["robot", "fk"], vec!["robot", "ik"], vec![]]
        .into_iter()
        .chain(commands.into_iter().map(|command| vec![command]))
    {
        let named = [&["tabletop"], &command[..]].concat().join(" ");
        let chapter = format!(".SH \"{named}\"\n");
        assert!(command.is_empty() || page.contains(&chapter), "{chapter}");
        for said in options_and_ranges(&help(&command)) {
            assert!(page.contains(&said), "{named}: {said}");
        }
    }
    let version = env!("CARGO_PKG_VERSION");
    let title = format!(".TH tabletop 1 \" \" \"tabletop {version}\" \"User Commands\"\n");
    assert!(page.contains(&title), "{title}");
    for section in ["EXAMPLES", "FILES", "EXIT CODES"] {
        assert!(page.contains(section), "{section}");
    }
}

#[test]
fn man_shows_it_without_a_warning() {
    let file = place("tabletop.1");
    fs::write(&file, tabletop(&["man"]).stdout).unwrap();
    let mut man = Command::new("man");
    man.args(["--warnings", "-E", "UTF-8", "-l"])
        .arg(&file)
        .env("LC_ALL", "C.UTF-8");
    // Not every machine has it.
    let Ok(shown) = man.output() else {
        return;
    };
    assert_eq!(String::from_utf8_lossy(&shown.stderr), "");
    assert_eq!(shown.status.code(), Some(0));
}
