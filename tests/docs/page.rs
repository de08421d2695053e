//! A page of docs, and the commands on it.

use std::{
    fs,
    path::{Path, PathBuf},
};

/// A page.
pub struct Page {
    pub file: PathBuf,
    pub commands: Vec<Documented>,
}

/// A command on a page.
#[derive(Debug)]
pub struct Documented {
    /// The number of its line, from 1.
    pub line: usize,
    pub text: String,
    /// The lines that it prints, as the page shows them.
    pub claims: Vec<String>,
}

/// Options whose numbers decide how long a command takes, and the numbers that are enough here.
const SMALL: [(&str, &str); 6] = [
    ("--count", "2"),
    ("--trials", "2"),
    ("--samples", "16"),
    ("--seeds", "0..2"),
    ("--seconds", "1"),
    ("--shard", "1/2"),
];

/// Options with which a command needs a window, a robot, a program of the reader's own, or a policy that has learned for long, and the commands that serve for ever and open
/// a browser.
const ELSEWHERE: [&str; 9] = [
    "--window",
    "--real",
    "--shadow",
    "--engine",
    "--against",
    "--desktop",
    "--policy",
    "serve-policy",
    "docs",
];

impl Page {
    pub fn read(file: &Path) -> Self {
        Self::parse(file, &fs::read_to_string(file).unwrap())
    }

    pub fn parse(file: &Path, text: &str) -> Self {
        let mut commands: Vec<Documented> = Vec::new();
        let mut block: Option<&str> = None;
        // The lines of prose since the last block of commands; none before the first.
        let mut prose: Option<usize> = None;
        let mut had_command = false;
        for (number, line) in text.lines().enumerate() {
            let line_number = number + 1;
            if let Some(info) = line.strip_prefix("```") {
                match block.take() {
                    None => {
                        block = Some(info);
                        had_command = false;
                    }
                    Some(_) => {
                        if had_command {
                            prose = Some(0);
                        }
                    }
                }
                continue;
            }
            let Some(info) = block else {
                if !line.trim().is_empty() {
                    prose = prose.map(|lines| lines + 1);
                }
                if line.starts_with('|') && file.ends_with("README.md") {
                    let spans = line.split('`').skip(1).step_by(2);
                    let named = spans.filter(|span| span.starts_with("tabletop "));
                    commands.extend(named.map(|text| Documented::new(line_number, text)));
                    prose = None;
                }
                continue;
            };
            if !["", "sh"].contains(&info) {
                prose = None;
                continue;
            }
            let command = line.split("  #").next().unwrap_or(line).trim_end();
            let is_command = command.starts_with("tabletop ") || command.contains("| tabletop ");
            let is_of_another = ["python ", "pip "].iter().any(|it| command.starts_with(it));
            if is_command {
                commands.push(Documented::new(line_number, command));
                had_command = true;
            } else if !line.trim().is_empty() && !line.starts_with('#') && !is_of_another {
                let follows = had_command || prose.is_some_and(|lines| lines <= 1);
                if let Some(last) = commands.last_mut().filter(|_| follows) {
                    last.claims.push(line.to_owned());
                }
            }
        }
        Self {
            file: file.to_owned(),
            commands,
        }
    }
}

impl Documented {
    fn new(line: usize, text: &str) -> Self {
        Self {
            line,
            text: text.to_owned(),
            claims: Vec::new(),
        }
    }

    /// True if it is shown with the words of a refusal.
    pub fn fails(&self) -> bool {
        self.claims
            .iter()
            .any(|claim| claim.starts_with("tabletop: "))
    }

    /// False for what opens a window, moves a real robot, or has a name that the reader is to replace.
    pub fn can_be_run(&self) -> bool {
        let arguments = self.text.split("tabletop ").nth(1).unwrap_or_default();
        let is_name = |word: &str| {
            let letters = word.chars().filter(|letter| letter.is_alphabetic());
            let all = letters.clone().count();
            all > 1 && letters.filter(|letter| letter.is_uppercase()).count() == all
        };
        let is_elsewhere = |word: &str| ELSEWHERE.contains(&word) || word.contains('…');
        let opens_window = arguments.starts_with("--") || arguments.starts_with('…');
        let quoted = self.text.contains(['"', '{']);
        let words: Vec<_> = arguments.split_whitespace().collect();
        !opens_window
            && !words.iter().any(|word| is_elsewhere(word))
            && (quoted || !words.iter().any(|word| is_name(word)))
    }

    /// The command with numbers with which it takes seconds.
    pub fn made_small(&self) -> String {
        let mut words: Vec<_> = self.text.split(' ').collect();
        for at in 1..words.len() {
            let small = SMALL.iter().find(|(option, _)| words[at - 1] == *option);
            if let Some((_, number)) = small {
                words[at] = number;
            }
        }
        let small = words.join(" ");
        // All of its experiments are a test of their own.
        if let Some(options) = small.strip_prefix("tabletop validate")
            && (options.is_empty() || options.starts_with(" --"))
        {
            return format!("tabletop validate bounce{options}");
        }
        // By itself it takes minutes.
        match small.contains("tabletop learn ") && !small.contains("--samples ") {
            true => small.replace("tabletop learn ", "tabletop learn --samples 16 --trials 2 "),
            false => small,
        }
    }
}
