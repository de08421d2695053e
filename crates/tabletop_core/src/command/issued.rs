//! Commands on their way: who gives them, and how they are told apart.

use bevy::{
    ecs::system::{SystemParam, SystemState},
    prelude::*,
};
use serde::{Deserialize, Serialize};

use super::{CommandKind, SimCommand};
use crate::SimFact;

/// Tells a command from all others of an app. Of two commands, the one that was written later has the larger id.
///
/// A recording keeps no ids: a demonstration without what was undone is the same to the byte as one in which nothing was.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CommandId(pub u64);

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

/// The command that is being carried out.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cause(pub Option<CommandId>);

/// Carries out the commands of one kind that a system has not read yet, one after the other, each on the world that the one
/// before has left. Meanwhile [`Cause`] names the command. If it says why it cannot, that is [refused](SimFact::Refused).
///
/// # Errors
///
/// The world has no commands: [`CorePlugin`](crate::CorePlugin) is missing.
pub fn carry_out<C: CommandKind>(
    world: &mut World,
    reader: &mut SystemState<MessageReader<IssuedCommand>>,
    mut each: impl FnMut(&mut World, CommandId, C) -> Result<(), String>,
) -> Result {
    let mut issued = reader.get_mut(world)?;
    let commands = issued.read().filter_map(IssuedCommand::of_kind);
    let commands: Vec<_> = commands
        .map(|(id, command): (_, &C)| (id, command.clone()))
        .collect();
    for (id, command) in commands {
        world.insert_resource(Cause(Some(id)));
        let refusal = each(world, id, command).err();
        world.insert_resource(Cause(None));
        if let Some(reason) = refusal {
            world.write_message(SimFact::Refused {
                cause: Some(id),
                reason,
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CommandSystems, CorePlugin, Hand, HandCommand, SceneCommand, StepApp as _};

    #[derive(Resource, Default)]
    struct CarriedOut(Vec<(CommandId, Cause)>);

    fn carry_out_hands(
        world: &mut World,
        reader: &mut SystemState<MessageReader<IssuedCommand>>,
    ) -> Result {
        carry_out(world, reader, |world, id, command| {
            let cause = *world.resource::<Cause>();
            world.resource_mut::<CarriedOut>().0.push((id, cause));
            match command {
                HandCommand::Release(hand) => Err(format!("{hand} holds nothing")),
                HandCommand::Select(_)
                | HandCommand::Grasp { .. }
                | HandCommand::MoveTo { .. }
                | HandCommand::MoveBy { .. }
                | HandCommand::Turn { .. }
                | HandCommand::Destroy(_) => Ok(()),
            }
        })
    }

    #[test]
    fn a_refusal_names_its_command_and_the_next_one_is_carried_out() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default()))
            .init_resource::<CarriedOut>()
            .add_systems(FixedUpdate, carry_out_hands.in_set(CommandSystems::Hands))
            .start();
        let world = app.world_mut();
        let release = world.write_command(HandCommand::Release(Hand::Left));
        let clear = world.write_command(SceneCommand::Clear);
        let select = world.write_command(HandCommand::Select(Hand::Left));
        assert!(release < clear && clear < select);
        app.step(1);
        let carried_out = &app.world().resource::<CarriedOut>().0;
        assert_eq!(
            *carried_out,
            [release, select].map(|id| (id, Cause(Some(id))))
        );
        assert_eq!(*app.world().resource::<Cause>(), Cause(None));
        let facts: Vec<_> = app
            .world_mut()
            .resource_mut::<Messages<SimFact>>()
            .drain()
            .collect();
        let refused = SimFact::Refused {
            cause: Some(release),
            reason: "LeftHand holds nothing".into(),
        };
        assert_eq!(facts, [refused]);
    }

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
