//! The commands of an episode, in its session log.

use tabletop_core::{ClockCommand, CommandSystems, IssuedCommand, SimCommand, SimTick};

use crate::{
    error::RecorderError,
    files::session::{SessionCommand, command_line, is_logged},
    recording::episode::{Episode, LoggedCommand},
};

impl Episode {
    /// Logs the commands of a tick, in the order in which they are carried out, before they are. If they turn the clock, those after
    /// that belong to another tick, and are logged when it is reached.
    pub(crate) fn log_commands(
        &mut self,
        tick: SimTick,
        commands: &[IssuedCommand],
    ) -> Result<(), RecorderError> {
        let phase = |issued: &IssuedCommand| issued.command.phase();
        let begins = commands.partition_point(|issued| phase(issued) < CommandSystems::History);
        let (first, then) = commands.split_at(begins);
        // A tick has several frames while it is paused; its marks stay behind the commands of all of them.
        if tick != self.tick {
            self.marks.clear();
        }
        self.tick = tick;
        self.logged.clear();
        self.log(first)?;
        if then
            .iter()
            .any(|issued| phase(issued) == CommandSystems::History)
        {
            self.unlogged = then.to_vec();
            Ok(())
        } else {
            self.log(then)
        }
    }

    pub(super) fn log(&mut self, commands: &[IssuedCommand]) -> Result<(), RecorderError> {
        let mut lines = Vec::new();
        let mut follows = std::mem::take(&mut self.is_beginning);
        for issued in commands {
            if !is_logged(&issued.command) {
                continue;
            }
            if let SimCommand::Clock(ClockCommand::SetPaused(paused)) = issued.command {
                self.is_paused = paused;
            }
            self.logged.push(LoggedCommand {
                id: issued.id,
                actor: issued.actor,
                before: self.end_of_commands() + lines.len() as u64,
            });
            let is_scene = matches!(issued.command, SimCommand::Scene(_));
            let command = SessionCommand {
                at_once: self.is_paused && is_scene && follows,
                ..SessionCommand::of(self.tick, issued)
            };
            follows |= is_scene;
            lines.extend(command_line(&command)?);
        }
        self.append_commands(&lines)
    }

    /// Adds lines of commands to the session log, before the marks of this tick.
    pub(super) fn append_commands(&mut self, lines: &[u8]) -> Result<(), RecorderError> {
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
