//! Commands before a recording: its replay begins with them.

use bevy::prelude::warn;
use tabletop_core::{ClockCommand, IssuedCommand, SceneCommand, SimCommand, SimTick};

use crate::files::session::{SessionCommand, command_line, is_logged};

/// A longer log is not kept: some three hours of moving something without a break.
const MOST_BYTES: usize = 64 << 20;

/// The commands since the world was last empty: since the program started, or since a scene was put on the table while no
/// hand held anything and the robot had not been used.
#[derive(Clone, Debug)]
pub(crate) struct EarlierCommands {
    /// The tick of the first command; `None` if they were too many to be kept.
    begin: Option<SimTick>,
    /// Their lines in a session log.
    lines: Vec<u8>,
    /// Their number.
    count: usize,
    is_paused: bool,
    /// The robot and its markers outlive a scene.
    has_used_robot: bool,
}

impl Default for EarlierCommands {
    fn default() -> Self {
        Self {
            begin: Some(SimTick(0)),
            lines: Vec::new(),
            count: 0,
            is_paused: false,
            has_used_robot: false,
        }
    }
}

impl EarlierCommands {
    pub(crate) fn begin(&self) -> Option<SimTick> {
        self.begin
    }

    pub(crate) fn lines(&self) -> &[u8] {
        &self.lines
    }

    /// True if the simulation was paused before the commands of this tick.
    pub(crate) fn is_paused(&self) -> bool {
        self.is_paused
    }

    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// The commands since a tick before which the world was empty.
    pub(crate) fn since(begin: SimTick, commands: &[SessionCommand]) -> Self {
        let mut earlier = Self {
            begin: Some(begin),
            ..Self::default()
        };
        for command in commands {
            earlier.append_command(command);
            earlier.note_lasting(&command.command);
        }
        earlier
    }

    /// Takes in the commands of a tick in which nothing is recorded, in the order in which they are carried out.
    pub(crate) fn note(
        &mut self,
        tick: SimTick,
        commands: &[IssuedCommand],
        hands_are_empty: bool,
    ) {
        let mut follows = false;
        for issued in commands {
            let sets_scene = match &issued.command {
                SimCommand::Scene(SceneCommand::Set(_)) => true,
                SimCommand::Scene(
                    SceneCommand::Load(_) | SceneCommand::Clear | SceneCommand::Make { .. },
                )
                | SimCommand::Recording(_)
                | SimCommand::Clock(_)
                | SimCommand::History(_)
                | SimCommand::Hand(_)
                | SimCommand::Mechanism(_)
                | SimCommand::Robot(_) => false,
            };
            if sets_scene && hands_are_empty && !self.has_used_robot {
                self.begin_at(tick);
                follows = false;
            }
            let is_scene = matches!(issued.command, SimCommand::Scene(_));
            self.append_command(&SessionCommand {
                at_once: self.is_paused && is_scene && follows,
                ..SessionCommand::of(tick, issued)
            });
            follows |= is_scene;
            self.note_lasting(&issued.command);
        }
    }

    /// Notes the effects of a command that outlive a scene. To be called for recorded commands, too.
    pub(crate) fn note_lasting(&mut self, command: &SimCommand) {
        match command {
            SimCommand::Clock(ClockCommand::SetPaused(paused)) => self.is_paused = *paused,
            SimCommand::Robot(_) => self.has_used_robot = true,
            SimCommand::Recording(_)
            | SimCommand::Scene(_)
            | SimCommand::History(_)
            | SimCommand::Hand(_)
            | SimCommand::Mechanism(_) => {}
        }
    }

    /// Adds the lines that a recording has logged since it started; `None` if they are not known.
    pub(crate) fn append_recorded(&mut self, lines: Option<&[u8]>) {
        match lines {
            Some(lines) => {
                let count = lines.iter().filter(|&&byte| byte == b'\n').count();
                self.append(lines, count);
            }
            None => self.forget(),
        }
    }

    fn begin_at(&mut self, tick: SimTick) {
        self.forget();
        self.begin = Some(tick);
        if self.is_paused {
            let pause = ClockCommand::SetPaused(true);
            self.append_command(&SessionCommand::of_app(tick, pause));
        }
    }

    fn append_command(&mut self, command: &SessionCommand) {
        if is_logged(&command.command) {
            match command_line(command) {
                Ok(line) => self.append(&line, 1),
                Err(error) => {
                    warn!("no recording can be replayed until a scene is set: {error}");
                    self.forget();
                }
            }
        }
    }

    fn append(&mut self, lines: &[u8], count: usize) {
        if self.lines.len() + lines.len() > MOST_BYTES {
            self.forget();
        } else if self.begin.is_some() {
            self.count += count;
            self.lines.extend_from_slice(lines);
        }
    }

    fn forget(&mut self) {
        self.begin = None;
        self.count = 0;
        self.lines = Vec::new();
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::{Actor, CommandId, Hand, HandCommand, RecordingCommand, RobotCommand};

    use super::*;

    fn scene() -> IssuedCommand {
        issued(SceneCommand::Set(Box::default()))
    }

    fn issued(command: impl Into<SimCommand>) -> IssuedCommand {
        IssuedCommand {
            id: CommandId(0),
            actor: Actor::Key,
            command: command.into(),
        }
    }

    fn lines_of(earlier: &EarlierCommands) -> Vec<String> {
        let lines = std::str::from_utf8(earlier.lines()).unwrap();
        let reported: Vec<_> = lines.lines().map(str::to_owned).collect();
        assert_eq!(reported.len(), earlier.count());
        reported
    }

    #[test]
    fn it_goes_back_to_the_last_scene_that_empties_the_world() {
        let mut earlier = EarlierCommands::default();
        assert_eq!(earlier.begin(), Some(SimTick(0)));
        earlier.note(
            SimTick(3),
            &[scene(), issued(HandCommand::Release(Hand::Left))],
            true,
        );
        assert_eq!(earlier.begin(), Some(SimTick(3)));
        let first = lines_of(&earlier);
        assert!(first[0].contains("Scene") && first[1].contains("Release"));
        earlier.note(SimTick(5), &[scene()], false);
        assert_eq!(earlier.begin(), Some(SimTick(3)));
        assert_eq!(earlier.count(), 3);
        earlier.note(
            SimTick(9),
            &[issued(RecordingCommand::Start), scene()],
            true,
        );
        assert_eq!((earlier.begin(), earlier.count()), (Some(SimTick(9)), 1));
    }

    #[test]
    fn earlier_commands_are_reported_as_noted() {
        let commands = [
            (3, scene()),
            (4, issued(RobotCommand::Show(true))),
            (5, scene()),
            (6, issued(ClockCommand::SetPaused(true))),
        ];
        let mut noted = EarlierCommands::default();
        for (tick, command) in &commands {
            noted.note(SimTick(*tick), std::slice::from_ref(command), true);
        }
        let commands = commands.map(|(tick, command)| SessionCommand::of(SimTick(tick), &command));
        let again = EarlierCommands::since(SimTick(3), &commands);
        assert_eq!(again.begin(), noted.begin());
        assert_eq!(lines_of(&again), lines_of(&noted));
        assert_eq!(again.is_paused(), noted.is_paused());
        assert_eq!(again.has_used_robot, noted.has_used_robot);
    }

    #[test]
    fn a_pause_and_the_robot_outlive_a_scene() {
        let mut earlier = EarlierCommands::default();
        earlier.note(SimTick(1), &[issued(ClockCommand::SetPaused(true))], true);
        earlier.note(SimTick(1), &[scene()], true);
        assert!(lines_of(&earlier)[0].contains("SetPaused"));
        earlier.note(SimTick(2), &[issued(RobotCommand::Show(true))], true);
        earlier.note(SimTick(3), &[scene()], true);
        assert_eq!((earlier.begin(), earlier.count()), (Some(SimTick(1)), 4));
    }

    #[test]
    fn too_long_a_log_is_dropped_until_the_next_scene() {
        let mut earlier = EarlierCommands::default();
        earlier.append_recorded(Some(&vec![b'\n'; MOST_BYTES + 1]));
        earlier.note(SimTick(8), &[issued(SceneCommand::Clear)], true);
        assert_eq!((earlier.begin(), earlier.count()), (None, 0));
        earlier.note(SimTick(9), &[scene()], true);
        assert_eq!((earlier.begin(), earlier.count()), (Some(SimTick(9)), 1));
        earlier.append_recorded(None);
        assert_eq!(earlier.begin(), None);
    }
}
