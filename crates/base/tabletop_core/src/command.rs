//! Commands: requests for the next tick, each with the one who gives it.
//!
//! A [`SimCommand`] is nested by the part of the simulator that carries it out, and exactly one system matches each kind. A command is
//! given with [`CommandWriter`] or [`WriteCommand`], and travels as an [`IssuedCommand`]: with its [id](CommandId), which the resulting
//! [facts](crate::SimFact) name, and with the [`Actor`] who gave it.

mod carry_out;
mod clock;
mod hand;
mod history;
mod id;
mod issued;
mod mechanism;
mod recording;
mod robot;
mod scene;

pub use carry_out::{Cause, carry_out};
pub use clock::ClockCommand;
pub use hand::HandCommand;
pub use history::HistoryCommand;
pub use id::CommandId;
pub(crate) use issued::NextCommandId;
pub use issued::{Actor, CommandWriter, IssuedCommand, WriteCommand};
pub use mechanism::MechanismCommand;
pub use recording::RecordingCommand;
pub use robot::RobotCommand;
pub use scene::SceneCommand;

use serde::{Deserialize, Serialize};

use crate::CommandSystems;

/// A request to the simulation for its next tick.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum SimCommand {
    /// To the recorder.
    Recording(RecordingCommand),
    /// To the clock.
    Clock(ClockCommand),
    /// To the scene, which puts objects on the table.
    Scene(SceneCommand),
    /// To the history, which undoes and redoes.
    History(HistoryCommand),
    /// To the demonstrator's hands.
    Hand(HandCommand),
    /// To mechanisms: everything that can be operated or fastened.
    Mechanism(MechanismCommand),
    /// To the robot.
    Robot(RobotCommand),
}

impl SimCommand {
    /// The phase of a tick in which it is carried out. Of two commands in a tick, the one with the earlier phase comes first; within
    /// a phase, the one that was written first.
    pub const fn phase(&self) -> CommandSystems {
        match self {
            Self::History(_) => CommandSystems::History,
            Self::Recording(_) => CommandSystems::Recording,
            Self::Clock(_) => CommandSystems::Clock,
            Self::Scene(_) => CommandSystems::Scene,
            Self::Hand(_) => CommandSystems::Hands,
            Self::Mechanism(_) => CommandSystems::Mechanisms,
            Self::Robot(_) => CommandSystems::Robot,
        }
    }
}

/// A kind of command: those that one part of the simulator carries out.
pub trait CommandKind: Clone + Into<SimCommand> {
    /// This kind's part of a command; `None` if the command is of another kind.
    fn of(command: &SimCommand) -> Option<&Self>;
}

macro_rules! command_kinds {
    ($($kind:ident($command:ty),)*) => {$(
        impl From<$command> for SimCommand {
            fn from(command: $command) -> Self {
                Self::$kind(command)
            }
        }

        impl CommandKind for $command {
            fn of(command: &SimCommand) -> Option<&Self> {
                if let SimCommand::$kind(command) = command {
                    Some(command)
                } else {
                    None
                }
            }
        }
    )*};
}

command_kinds! {
    Recording(RecordingCommand),
    Clock(ClockCommand),
    Scene(SceneCommand),
    History(HistoryCommand),
    Hand(HandCommand),
    Mechanism(MechanismCommand),
    Robot(RobotCommand),
}

#[cfg(test)]
mod tests {
    use bevy::prelude::*;

    use super::*;
    use crate::{CorePlugin, StepApp as _};

    #[derive(Resource, Default)]
    struct Phases(Vec<CommandSystems>);

    #[test]
    fn phases_come_in_the_order_in_which_they_compare() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default()))
            .init_resource::<Phases>();
        let phases = [
            CommandSystems::History,
            CommandSystems::Recording,
            CommandSystems::Clock,
            CommandSystems::Scene,
            CommandSystems::Hands,
            CommandSystems::Mechanisms,
            CommandSystems::Robot,
        ];
        for phase in phases.into_iter().rev() {
            let note = move |mut noted: ResMut<Phases>| noted.0.push(phase);
            app.add_systems(FixedUpdate, note.in_set(phase));
        }
        app.start().step(1);
        assert_eq!(app.world().resource::<Phases>().0, phases);
        assert!(phases.is_sorted());
    }
}
