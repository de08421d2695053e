//! Commands on their way, and who gives them.

use bevy::{ecs::system::SystemParam, prelude::*};
use serde::{Deserialize, Serialize};

use super::{CommandId, CommandKind, SimCommand};

/// Who gives a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Actor {
    /// The user, with the mouse in the 3D view.
    Mouse,
    /// The user, with a key.
    Key,
    /// The user, with a panel, a menu or a file that was dropped onto the window.
    Panel,
    /// A scenario.
    Scenario,
    /// The script that drives the robot.
    Script,
    /// What replays a recording. The commands of the recording itself are given in the name of who gave them.
    Replay,
    /// The program around the simulation: the command line, a test, or an app of your own.
    App,
}

/// A command on its way to who carries it out. It is written by a [`CommandWriter`] or a [`WriteCommand`].
#[derive(Message, Clone, Debug, PartialEq)]
pub struct IssuedCommand {
    /// What the facts that come of it name.
    pub id: CommandId,
    /// Who gives it.
    pub actor: Actor,
    /// What is to be done.
    pub command: SimCommand,
}

impl IssuedCommand {
    /// Its id and what is to be done, if that is of one kind.
    pub fn of_kind<C: CommandKind>(&self) -> Option<(CommandId, &C)> {
        Some((self.id, C::of(&self.command)?))
    }
}

/// The id of the next command.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct NextCommandId(CommandId);

impl NextCommandId {
    fn take(&mut self) -> CommandId {
        let id = self.0;
        self.0.0 += 1;
        id
    }
}

/// Gives commands.
#[derive(SystemParam)]
pub struct CommandWriter<'w> {
    commands: MessageWriter<'w, IssuedCommand>,
    next: ResMut<'w, NextCommandId>,
}

impl CommandWriter<'_> {
    /// Gives a command.
    pub fn write(&mut self, actor: Actor, command: impl Into<SimCommand>) -> CommandId {
        let id = self.next.take();
        self.commands.write(IssuedCommand {
            id,
            actor,
            command: command.into(),
        });
        id
    }

    /// Gives commands, the first one first.
    pub fn write_batch<C: Into<SimCommand>>(
        &mut self,
        actor: Actor,
        commands: impl IntoIterator<Item = C>,
    ) {
        for command in commands {
            self.write(actor, command);
        }
    }
}

/// Gives commands where there is a whole world, in the name of the [app](Actor::App).
pub trait WriteCommand {
    /// Gives a command.
    fn write_command(&mut self, command: impl Into<SimCommand>) -> CommandId {
        self.write_command_of(Actor::App, command)
    }

    /// Gives a command in the name of somebody else.
    fn write_command_of(&mut self, actor: Actor, command: impl Into<SimCommand>) -> CommandId;
}

impl WriteCommand for World {
    fn write_command_of(&mut self, actor: Actor, command: impl Into<SimCommand>) -> CommandId {
        let id = self.resource_mut::<NextCommandId>().take();
        let command = command.into();
        self.write_message(IssuedCommand { id, actor, command });
        id
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CorePlugin, SceneCommand, StepApp as _};

    #[test]
    fn a_command_says_who_gives_it() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default()))
            .add_systems(FixedFirst, |mut commands: CommandWriter| {
                commands.write(Actor::Key, SceneCommand::Clear);
            })
            .start();
        app.world_mut().write_command(SceneCommand::Clear);
        app.step(1);
        let mut issued = app.world_mut().resource_mut::<Messages<IssuedCommand>>();
        let actors: Vec<_> = issued.drain().map(|issued| issued.actor).collect();
        assert_eq!(actors, [Actor::App, Actor::Key]);
    }
}
