//! Carrying out commands.

use bevy::{ecs::system::SystemState, prelude::*};

use super::{CommandId, CommandKind, IssuedCommand};
use crate::SimFact;

/// The command that is being carried out.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cause(pub Option<CommandId>);

/// Carries out all unread commands of one kind in turn, each on the world that the previous one left. Meanwhile [`Cause`] names the
/// command. One that cannot be carried out is [refused](SimFact::Refused).
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
        *world.resource_mut() = Cause(Some(id));
        let refusal = each(world, id, command).err();
        *world.resource_mut() = Cause(None);
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
    use crate::{
        CommandSystems, CorePlugin, Hand, HandCommand, SceneCommand, StepApp as _,
        WriteCommand as _,
    };

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
}
