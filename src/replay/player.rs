//! Giving the commands of a recording again.

use std::collections::VecDeque;

use bevy::prelude::*;
use tabletop_core::{Paused, SimCommand, SimFact, SimSystems, SimTick};
use tabletop_recorder::{Session, SessionCommand};

/// Gives the commands of a recording at their ticks, and stays in the world as a resource.
///
/// Until it [is over](Self::is_over), only the recording acts: of all other commands only pauses are carried out, and the
/// recording waits for their end.
#[derive(Resource, Clone, Debug)]
pub struct Player {
    commands: VecDeque<SessionCommand>,
    /// The first tick of the recording.
    start: SimTick,
    /// Whether the recording has paused the simulation.
    has_paused: bool,
}

impl Player {
    pub(crate) fn new(session: &Session) -> Self {
        let commands = session.earlier.iter().chain(&session.commands);
        Self {
            commands: commands.cloned().collect(),
            start: SimTick(session.header.start_tick),
            has_paused: false,
        }
    }

    /// A player that starts a recording where the recording began.
    pub(crate) fn recording(session: &Session) -> Self {
        let mut player = Self::new(session);
        let start = SessionCommand {
            tick: player.start.0,
            command: SimCommand::StartRecording,
        };
        player.commands.insert(session.earlier.len(), start);
        player
    }

    /// Lets it play in an app.
    pub(crate) fn play_in(self, app: &mut App) {
        app.insert_resource(self)
            .add_systems(FixedUpdate, play.before(SimSystems::Load));
    }

    /// Whether all its commands were given.
    pub fn is_over(&self) -> bool {
        self.commands.is_empty()
    }

    /// The first tick of the recording: what comes before it has led there.
    pub fn start(&self) -> SimTick {
        self.start
    }

    /// The commands that are due. What was told in one tick at several moments of a pause is told at several moments.
    fn due(&mut self, tick: SimTick) -> Vec<SimCommand> {
        let mut due = Vec::new();
        while let Some(next) = self.commands.front() {
            let ends_moment = matches!(
                next.command,
                SimCommand::StartRecording | SimCommand::SetPaused(false)
            );
            if next.tick > tick.0 || ends_moment && self.has_paused && !due.is_empty() {
                break;
            }
            if let SimCommand::SetPaused(paused) = next.command {
                self.has_paused = paused;
            }
            due.extend(self.commands.pop_front().map(|next| next.command));
        }
        due
    }
}

fn play(
    mut player: ResMut<Player>,
    mut commands: ResMut<Messages<SimCommand>>,
    mut facts: MessageWriter<SimFact>,
    tick: Res<SimTick>,
    paused: Res<Paused>,
) {
    if player.is_over() {
        return;
    }
    let mut is_held_up = paused.0 && !player.has_paused;
    let mut kept = Vec::new();
    for command in commands.drain() {
        match command {
            SimCommand::SetPaused(pause) => {
                is_held_up = pause;
                kept.push(command);
            }
            SimCommand::SelectHand(_) => {}
            _ => {
                facts.write(SimFact::Refused {
                    reason: "a recording is replayed; only it can act until it is over".into(),
                });
            }
        }
    }
    commands.write_batch(kept);
    if !is_held_up {
        commands.write_batch(player.due(*tick));
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::Hand;

    use super::*;

    fn player(commands: &[(u64, SimCommand)]) -> Player {
        let commands = commands.iter().cloned();
        Player {
            commands: commands
                .map(|(tick, command)| SessionCommand { tick, command })
                .collect(),
            start: SimTick(0),
            has_paused: false,
        }
    }

    #[test]
    fn commands_are_due_at_their_tick() {
        let [left, right] = [Hand::Left, Hand::Right].map(SimCommand::Release);
        let mut player = player(&[(1, left.clone()), (1, right.clone()), (3, left.clone())]);
        let given: Vec<_> = (0..5).map(|tick| player.due(SimTick(tick)).len()).collect();
        assert_eq!(given, [0, 2, 0, 1, 0]);
        assert!(player.is_over());
    }

    #[test]
    fn what_was_told_in_a_pause_is_told_in_a_pause() {
        let mut player = player(&[
            (1, SimCommand::SetPaused(true)),
            (1, SimCommand::Release(Hand::Left)),
            (1, SimCommand::SetPaused(false)),
            (1, SimCommand::Release(Hand::Right)),
        ]);
        assert_eq!(player.due(SimTick(1)).len(), 2);
        assert_eq!(player.due(SimTick(1)).len(), 2);
        assert!(player.is_over());
    }
}
