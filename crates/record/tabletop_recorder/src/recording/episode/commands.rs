//! The commands of an episode, in its session log.

use tabletop_core::{ClockCommand, IssuedCommand, SimCommand};

use crate::{
    error::RecorderError,
    files::session::{SessionCommand, command_line, is_logged},
    recording::episode::{Episode, LoggedCommand},
};

impl Episode {
    /// Logs the commands of this tick, in the order in which they are carried out, before they are. Those with which a tick goes on after
    /// undo may be of earlier phases than those that undo has left of it: a pause lies between them.
    pub(crate) fn log_commands(&mut self, commands: &[IssuedCommand]) -> Result<(), RecorderError> {
        self.logged.clear();
        let mut phases = commands
            .iter()
            .filter(|issued| is_logged(&issued.command))
            .map(|issued| (self.tick, issued.command.phase()));
        let goes_back = phases.next().is_some_and(|first| Some(first) <= self.last);
        // Where a recording begins, a pause lies before the start.
        if goes_back && !self.is_paused && !self.is_beginning {
            self.log_pause(true)?;
            self.log_pause(false)?;
        }
        self.log(commands)
    }

    /// Logs that the program itself has paused or resumed the simulation.
    pub(super) fn log_pause(&mut self, paused: bool) -> Result<(), RecorderError> {
        let pause = SessionCommand {
            at_once: self.is_beginning && !paused,
            ..SessionCommand::of_app(self.tick, ClockCommand::SetPaused(paused))
        };
        let line = command_line(&pause)?;
        self.is_paused = paused;
        self.append_commands(&line)
    }

    fn log(&mut self, commands: &[IssuedCommand]) -> Result<(), RecorderError> {
        let mut lines = Vec::new();
        let is_beginning = std::mem::take(&mut self.is_beginning);
        let mut follows = is_beginning;
        for issued in commands {
            if !is_logged(&issued.command) {
                continue;
            }
            let mut resumes = false;
            if let SimCommand::Clock(ClockCommand::SetPaused(paused)) = issued.command {
                resumes = self.is_paused && !paused;
                self.is_paused = paused;
            }
            self.logged.push(LoggedCommand {
                id: issued.id,
                actor: issued.actor,
                before: self.end_of_commands() + lines.len() as u64,
                follows: self.last,
            });
            self.last = Some((self.tick, issued.command.phase()));
            let is_scene = matches!(issued.command, SimCommand::Scene(_));
            let command = SessionCommand {
                at_once: self.is_paused && is_scene && follows || resumes && is_beginning,
                ..SessionCommand::of(self.tick, issued)
            };
            follows |= is_scene;
            lines.extend(command_line(&command)?);
        }
        self.append_commands(&lines)
    }

    /// Adds lines of commands to the session log, before the marks of this tick.
    fn append_commands(&mut self, lines: &[u8]) -> Result<(), RecorderError> {
        if lines.is_empty() || self.marks.is_empty() {
            return self.files.session.append(lines);
        }
        self.files.session.cut(self.end_of_commands())?;
        self.files.session.append(&[lines, &self.marks].concat())
    }

    /// Length of the session log without the marks of this tick.
    pub(super) fn end_of_commands(&self) -> u64 {
        self.files.session.len() - self.marks.len() as u64
    }
}
