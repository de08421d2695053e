//! The arguments of the program.

use std::{ffi::OsString, process::ExitCode};

use clap::{Error, Parser, builder::Styles};

use super::{failure::WRONG_INPUT, terminal::say};

/// Reads the arguments. If there is nothing to carry out, help or the reason is printed, and the exit code returned.
pub(super) fn read<Line: Parser>(
    arguments: impl IntoIterator<Item = OsString>,
) -> Result<Line, ExitCode> {
    let arguments: Vec<_> = arguments.into_iter().collect();
    // Without colours, a refusal has no other escape sequences than those of the arguments.
    let uncoloured = Line::command().styles(Styles::plain());
    let read = uncoloured.try_get_matches_from(&arguments);
    let read = read.and_then(|matches| Line::from_arg_matches(&matches));
    read.map_err(|answer| match answer.use_stderr() {
        true => refuse(&answer),
        false => help::<Line>(&arguments),
    })
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
