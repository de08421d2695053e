//! What a demonstration did besides moving objects: it operated mechanisms, made objects, and cleared the table.

use tabletop_core::{Hand, MechanismCommand, SceneCommand, SimCommand, SimTick};
use tabletop_recorder::Session;
use tabletop_task::{Binding, Operation, OperationDeed, Task};

/// A command to be given again, and the tick in which it was given.
#[derive(Clone, Debug)]
pub(super) struct Operated {
    pub tick: SimTick,
    pub command: SimCommand,
}

impl Operated {
    /// The commands of a session.
    pub fn in_session(session: &Session) -> Vec<Self> {
        let given = session
            .commands
            .iter()
            .filter(|given| match &given.command {
                SimCommand::Mechanism(_) => true,
                SimCommand::Scene(command) => match command {
                    SceneCommand::Make { .. } | SceneCommand::Edit(_) | SceneCommand::Clear => true,
                    SceneCommand::Load(_) | SceneCommand::Set(_) => false,
                },
                SimCommand::Recording(_)
                | SimCommand::Clock(_)
                | SimCommand::History(_)
                | SimCommand::Hand(_)
                | SimCommand::Robot(_) => false,
            });
        given
            .map(|given| Self {
                tick: SimTick(given.tick),
                command: given.command.clone(),
            })
            .collect()
    }

    /// The commands that lead to the operations of a task, where only these are known.
    pub fn in_events(task: &Task) -> Vec<Self> {
        task.operations.iter().map(Self::of).collect()
    }

    fn of(operation: &Operation) -> Self {
        let hand = Hand::Any;
        let command = match operation.deed.clone() {
            OperationDeed::Trigger { control } => MechanismCommand::Trigger {
                hand,
                control,
                part: None,
            },
            OperationDeed::PointTo { part } => MechanismCommand::PointTo { hand, target: part },
            OperationDeed::Fasten(bond) => MechanismCommand::Fasten {
                hand,
                guest: bond.guest_point,
            },
            OperationDeed::Loosen(bond) => MechanismCommand::Loosen {
                hand,
                guest: bond.guest_point,
            },
            OperationDeed::Cut { blade, .. } => MechanismCommand::Cut { hand, blade },
        };
        Self {
            tick: operation.tick,
            command: command.into(),
        }
    }

    /// The command, given to the objects that take the roles of those it names.
    pub fn bound(&self, binding: &Binding) -> SimCommand {
        let mut command = self.command.clone();
        if let SimCommand::Mechanism(mechanism) = &mut command {
            let named = match mechanism {
                MechanismCommand::Trigger { control, .. } => control,
                MechanismCommand::PointTo { target, .. } => target,
                MechanismCommand::Fasten { guest, .. } | MechanismCommand::Loosen { guest, .. } => {
                    guest
                }
                MechanismCommand::Cut { blade, .. } => blade,
            };
            if let Some(object) = binding.object(named) {
                object.clone_into(named);
            }
        }
        command
    }
}
