//! The files inside the program, as a list.

use std::{fmt::Write as _, path::Path, process::ExitCode};

use crate::{core::ShippedFile, shipped::shipped_files};
use clap::Args;

use super::{Failure, Output};

#[derive(Args)]
pub(super) struct ShippedArgs {
    /// Only those with this text in their path, such as scenarios or hanoi
    #[arg(value_name = "TEXT", default_value = "", hide_default_value = true)]
    part: String,
}

/// Lists the files, a line each: the path, and what the file says of itself.
pub(super) fn list(args: &ShippedArgs) -> Result<ExitCode, Failure> {
    let files: Vec<_> = shipped_files()
        .in_folder("")
        .filter(|file| file.path.contains(&args.part))
        .collect();
    if files.is_empty() {
        let part = &args.part;
        return Err(Failure::input(format!(
            "no file inside the program has {part} in its path; `tabletop shipped` lists them all"
        )));
    }
    let longest = files.iter().map(|file| file.path.len()).max();
    let width = longest.unwrap_or(0);
    let mut text = String::new();
    for file in files {
        let line = format!("{:<width$}  {}", file.path, purpose(file));
        let _infallible = writeln!(text, "{}", line.trim_end());
    }
    Output::tell(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// The first sentence of the comment with which a file begins.
fn purpose(file: &ShippedFile) -> String {
    let ending = Path::new(file.path).extension();
    let text = file.text.trim_start();
    let comment = match ending.and_then(|ending| ending.to_str()) {
        Some("ron") => lines_after(text, "//"),
        Some("m") => lines_after(text, "%"),
        Some("py") => between(text, "\"\"\"", "\"\"\""),
        Some("xml" | "xsd" | "urdf") => between(text, "<!--", "-->"),
        _ => String::new(),
    };
    let words: Vec<_> = comment.split_whitespace().collect();
    let comment = words.join(" ");
    let end = comment.find(". ").map_or(comment.len(), |end| end + 1);
    comment[..end].to_owned()
}

/// The lines at the beginning that are comments, without their marks.
fn lines_after(text: &str, mark: &str) -> String {
    let lines = text.lines().map_while(|line| line.strip_prefix(mark));
    lines.collect::<Vec<_>>().join(" ")
}

/// The text between the first two marks, if only a line or nothing is before it.
fn between(text: &str, begin: &str, end: &str) -> String {
    let Some((before, rest)) = text.split_once(begin) else {
        return String::new();
    };
    match before.lines().count() {
        0..=1 => rest.split(end).next().unwrap_or_default().to_owned(),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_say_what_they_are_for() {
        let of = |path, text| purpose(&ShippedFile { path, text });
        assert_eq!(
            of("a.ron", "// One thing\n// and more. Another.\n(steps: [])"),
            "One thing and more."
        );
        assert_eq!(of("a.xml", "<?xml?>\n<!-- A tower. -->\n<t/>"), "A tower.");
        assert_eq!(of("a.xml", "<t>\n<a/>\n<!-- inner --></t>"), "");
        assert_eq!(of("a.py", "\"\"\"Waves.\n\nLong.\"\"\""), "Waves.");
        assert_eq!(of("a.stl", "solid"), "");
    }
}
