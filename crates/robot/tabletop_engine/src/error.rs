//! Errors of engines.

use std::{fmt, io, path::PathBuf, time::Duration};

use crate::{protocol::ProtocolError, variables::invalid_field::InvalidField};

/// The reason why an engine did not carry out a request.
#[derive(Clone, Debug, thiserror::Error)]
pub enum EngineError {
    /// There is no engine to start.
    #[error("{0}")]
    NotFound(String),
    /// The engine could not be started.
    #[error("{engine} cannot be started: {reason}")]
    Start {
        /// The engine's program.
        engine: PathBuf,
        /// The system's reason.
        reason: String,
    },
    /// The session's folder cannot be written or read.
    #[error("{path}: {reason}")]
    File {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        reason: String,
    },
    /// The script failed.
    #[error("{0}")]
    Script(ScriptError),
    /// The script set a variable to a value that cannot be used.
    #[error("{field}{}", in_script(.script.as_ref()))]
    InvalidField {
        /// The field that cannot be used.
        field: InvalidField,
        /// The script, if it is known.
        script: Option<PathBuf>,
    },
    /// There was no answer in time. The engine has been ended.
    #[error(
        "no answer from {what} within {} s; the engine was ended{}{}",
        .limit.as_secs_f64(),
        way_to_wait(what),
        locations(.stack)
    )]
    Timeout {
        /// The part that did not answer: the engine's start, the init script or the callback script.
        what: &'static str,
        /// The time for which it was waited.
        limit: Duration,
        /// The places at which the script was then, innermost first, if the engine can say them.
        stack: Vec<ScriptLocation>,
    },
    /// The engine ended by itself: it crashed, or the script called `exit`.
    #[error("the engine ended ({status}){}{}", last_errors(.stderr), way_to_end(status))]
    Died {
        /// Its exit status.
        status: String,
        /// The last lines of its standard error, unless they were already fetched from the console.
        stderr: String,
    },
    /// The engine's answer breaks the protocol.
    #[error("the engine's answer cannot be read: {0}")]
    Protocol(#[from] ProtocolError),
    /// The engine was stopped.
    #[error("the engine was stopped")]
    Stopped,
}

impl EngineError {
    /// True if the engine is gone, so that only a new one can go on.
    pub fn is_fatal(&self) -> bool {
        !matches!(self, Self::Script(_) | Self::InvalidField { .. })
    }

    pub(crate) fn file(path: impl Into<PathBuf>, error: &io::Error) -> Self {
        Self::File {
            path: path.into(),
            reason: error.to_string(),
        }
    }
}

fn in_script(script: Option<&PathBuf>) -> String {
    script.map_or(String::new(), |script| {
        format!("\n  at {}", script.display())
    })
}

fn last_errors(stderr: &str) -> String {
    if stderr.trim().is_empty() {
        String::new()
    } else {
        format!(": {}", stderr.trim())
    }
}

/// The option that lets it wait longer, if there is one.
fn way_to_wait(what: &str) -> &'static str {
    match what.ends_with("script") {
        true => " (--script-timeout sets the limit)",
        false => "",
    }
}

/// Advice for who ended the engine and may have meant something else.
fn way_to_end(status: &str) -> &'static str {
    match status {
        "exit status: 0" | "exit code: 0" => "; set aux.exit = true to end the script",
        _ => "",
    }
}

/// An error in a script, with its place.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ScriptError {
    /// The error's identifier ("Octave:undefined-function"); empty if it has none.
    pub id: String,
    /// The engine's message.
    pub message: String,
    /// The places of the error, innermost first.
    pub stack: Vec<ScriptLocation>,
}

/// The most letters of a message that are shown.
const MAX_MESSAGE: usize = 4000;

/// A line of a script.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScriptLocation {
    /// The script.
    pub file: PathBuf,
    /// The line, from 1; 0 if the engine does not know.
    pub line: u32,
}

impl fmt::Display for ScriptLocation {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        write!(formatter, "{}", self.file.display())?;
        match self.line {
            0 => Ok(()),
            line => write!(formatter, ":{line}"),
        }
    }
}

impl ScriptError {
    /// The place of the error, as far as the engine reports it.
    pub fn location(&self) -> Option<&ScriptLocation> {
        self.stack.first()
    }

    /// An error that is in no line of a script.
    pub(crate) fn plain(message: String) -> Self {
        Self {
            message,
            ..Self::default()
        }
    }

    /// An error as a driver sends it: the stack as lines of "line file".
    pub(crate) fn new(id: &str, message: &str, stack: &str) -> Self {
        let syntax = location_in_message(message);
        let stack = syntax
            .into_iter()
            .chain(stack.lines().filter_map(location_of_frame))
            .collect();
        Self {
            id: id.to_owned(),
            message: cut(message.trim_end()),
            stack,
        }
    }
}

fn cut(message: &str) -> String {
    match message.char_indices().nth(MAX_MESSAGE) {
        Some((end, _)) => format!("{}…", &message[..end]),
        None => message.to_owned(),
    }
}

impl fmt::Display for ScriptError {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        write!(formatter, "{}{}", self.message, locations(&self.stack))
    }
}

fn locations(stack: &[ScriptLocation]) -> String {
    stack
        .iter()
        .map(|location| format!("\n  at {location}"))
        .collect()
}

fn location_of_frame(frame: &str) -> Option<ScriptLocation> {
    let (line, file) = frame.trim().split_once(' ')?;
    Some(ScriptLocation {
        file: file.into(),
        // An engine that does not know the line says -1.
        line: line.parse::<i64>().ok()?.clamp(0, i64::from(u32::MAX)) as u32,
    })
}

/// The place that a message about wrong syntax names: "near line 3 of file x.m" (Octave) or "File: x.m Line: 3" (MATLAB).
fn location_in_message(message: &str) -> Option<ScriptLocation> {
    let octave = || {
        let (line, rest) = message
            .split_once("near line ")?
            .1
            .split_once(" of file ")?;
        Some((line, rest.lines().next()?))
    };
    let matlab = || {
        let (file, rest) = message.split_once("File: ")?.1.split_once(" Line: ")?;
        Some((rest.split_whitespace().next()?, file))
    };
    let (line, file) = octave().or_else(matlab)?;
    Some(ScriptLocation {
        file: file.trim().into(),
        line: line.trim().parse().ok()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn locations_are_found_in_frames_and_messages() {
        let error = ScriptError::new("a:b", "no\n", "2 /x y/helper.m\n-1 /x/top.m\n");
        assert_eq!(error.to_string(), "no\n  at /x y/helper.m:2\n  at /x/top.m");
        let octave = "parse error near line 3 of file /x/bad.m\n\n  syntax error\n";
        assert_eq!(
            ScriptError::new("", octave, "")
                .location()
                .unwrap()
                .to_string(),
            "/x/bad.m:3"
        );
        let matlab = "Error: File: C:\\x\\bad.m Line: 12 Column: 5\nUnexpected operator.";
        assert_eq!(
            ScriptError::new("", matlab, "").location().unwrap().line,
            12
        );
        assert_eq!(ScriptError::new("", "near line", "x\n\n7").location(), None);
        let long = ScriptError::new("", &"ü".repeat(9000), "").message;
        assert_eq!(long.chars().count(), MAX_MESSAGE + 1);
    }
}
