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
        self.tick = tick;
        self.logged.clear();
        self.marks.clear();
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
                before: self.files.session.len() + lines.len() as u64,
            });
            let is_scene = matches!(issued.command, SimCommand::Scene(_));
            let command = SessionCommand {
                at_once: self.is_paused && is_scene && follows,
                ..SessionCommand::of(self.tick, issued)
            };
            follows |= is_scene;
            lines.extend(command_line(&command)?);
        }
        self.files.session.append(&lines)
    }
}
