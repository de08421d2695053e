//! Commands on their way, each with the one who gives it.

use bevy::{ecs::system::SystemParam, prelude::*};
use serde::{Deserialize, Serialize};

use super::{CommandId, CommandKind, SimCommand};

/// The giver of a command.
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
    /// The controller that acts for the robot, such as its planner.
    Controller,
    /// The script that drives the robot.
    Script,
    /// The replay of a recording. The commands of the recording itself keep the actor who gave them.
    Replay,
    /// The program around the simulation: the command line, a test, or an app of your own.
    App,
    /// A real robot that is connected: it tells what was measured of it.
    RealRobot,
}

impl Actor {
    /// True if it may drive a real robot: it wants something now. A replay repeats what was wanted of another robot, and the real robot itself
    /// wants nothing.
    pub const fn may_drive(self) -> bool {
        match self {
            Self::Mouse
            | Self::Key
            | Self::Panel
            | Self::Scenario
            | Self::Controller
            | Self::Script
            | Self::App => true,
            Self::Replay | Self::RealRobot => false,
        }
    }
}

/// A command on its way to the system that carries it out. A [`CommandWriter`] or a [`WriteCommand`] writes it.
#[derive(Message, Clone, Debug, PartialEq)]
pub struct IssuedCommand {
    /// The id that the resulting facts name.
    pub id: CommandId,
    /// The one who gives it.
    pub actor: Actor,
    /// True if it was given when a recording was made, and is repeated now.
    pub is_replayed: bool,
    /// The command.
    pub command: SimCommand,
}

impl IssuedCommand {
    /// True if it may drive a real robot: somebody who [may](Actor::may_drive) gives it now.
    pub const fn may_drive(&self) -> bool {
        !self.is_replayed && self.actor.may_drive()
    }

    /// The id and the command, if the command is of kind `C`.
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

/// The system parameter that gives commands.
#[derive(SystemParam)]
pub struct CommandWriter<'w> {
    commands: MessageWriter<'w, IssuedCommand>,
    next: ResMut<'w, NextCommandId>,
}

impl CommandWriter<'_> {
    /// Gives a command.
    pub fn write(&mut self, actor: Actor, command: impl Into<SimCommand>) -> CommandId {
        self.issue(actor, false, command.into())
    }

    /// Gives a command of a recording again, in the name of the one who gave it when it was made.
    pub fn replay(&mut self, actor: Actor, command: impl Into<SimCommand>) -> CommandId {
        self.issue(actor, true, command.into())
    }

    fn issue(&mut self, actor: Actor, is_replayed: bool, command: SimCommand) -> CommandId {
        let id = self.next.take();
        self.commands.write(IssuedCommand {
            id,
            actor,
            is_replayed,
            command,
        });
        id
    }

    /// Gives several commands, in order.
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

/// Gives commands with access to the whole world, in the name of the [app](Actor::App).
pub trait WriteCommand {
    /// Gives a command.
    fn write_command(&mut self, command: impl Into<SimCommand>) -> CommandId {
        self.write_command_of(Actor::App, command)
    }

    /// Gives a command in the name of another actor.
    fn write_command_of(&mut self, actor: Actor, command: impl Into<SimCommand>) -> CommandId;
}

impl WriteCommand for World {
    fn write_command_of(&mut self, actor: Actor, command: impl Into<SimCommand>) -> CommandId {
        let id = self.resource_mut::<NextCommandId>().take();
        self.write_message(IssuedCommand {
            id,
            actor,
            is_replayed: false,
            command: command.into(),
        });
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
