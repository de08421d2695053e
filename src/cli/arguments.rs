//! The arguments of the program.

use std::{ffi::OsString, process::ExitCode};

use clap::{ArgMatches, Error, Parser, builder::Styles, error::ErrorKind};

use super::{failure::WRONG_INPUT, terminal::say};

/// Reads the arguments. If there is nothing to carry out, help or the reason is printed, and the exit code returned.
pub(super) fn read<Line: Parser>(
    arguments: impl IntoIterator<Item = OsString>,
) -> Result<Line, ExitCode> {
    let arguments: Vec<_> = arguments.into_iter().collect();
    // Without colours, a refusal has no other escape sequences than those of the arguments.
    let uncoloured = Line::command().styles(Styles::plain());
    let read = uncoloured.clone().try_get_matches_from(&arguments);
    let read = read.and_then(|matches| match meant_line(&matches, &arguments) {
        Some(line) => Err(uncoloured.clone().error(
            ErrorKind::ArgumentConflict,
            format!("options of a command come after it: {line}"),
        )),
        None => Line::from_arg_matches(&matches),
    });
    read.map_err(|answer| match answer.use_stderr() {
        true => refuse(&answer),
        false => help::<Line>(&arguments),
    })
}

/// The line that was meant by one with options before its command, which would be those of the window.
fn meant_line(matches: &ArgMatches, arguments: &[OsString]) -> Option<String> {
    let command = matches.subcommand_name()?;
    let place = arguments.iter().position(|argument| argument == command)?;
    let (before, after) = (arguments.get(1..place)?, &arguments[place..]);
    if before.is_empty() {
        return None;
    }
    let words = after.iter().chain(before);
    let words: Vec<_> = words.map(|word| word.to_string_lossy()).collect();
    Some(format!("tabletop {}", words.join(" ")))
}

fn refuse(refusal: &Error) -> ExitCode {
    let text = refusal.render().ansi().to_string();
    say(text.trim_end());
    ExitCode::from(WRONG_INPUT)
}

/// Prints help or the version, in colours where these can be shown.
fn help<Line: Parser>(arguments: &[OsString]) -> ExitCode {
    if let Err(help) = Line::try_parse_from(arguments) {
        // The reader may have gone, as `head` does.
        let _was_read = help.print();
    }
    ExitCode::SUCCESS
}
