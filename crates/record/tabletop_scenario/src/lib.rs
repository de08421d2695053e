//! Scripted demonstrations: files of steps and checks.
//!
//! A [`Scenario`] is a file that does with the hands what a person does with the mouse, waits, and checks
//! the result; `docs/scenarios.md` is its reference. A [`Program`] is a scenario together with all files that it names, and
//! [`ScenarioPlugin`] runs it: it writes the [commands](tabletop_core::SimCommand) of the steps as they are due.
//!
//! ```
//! use bevy::prelude::*;
//! use tabletop_core::prelude::*;
//! use tabletop_scenario::{Outcome, Program, Scenario, ScenarioPlugin, ScenarioRun};
//!
//! let scenario = Scenario::parse("half_a_second.ron", "(steps: [Select(Left), Wait(0.5)])")?;
//! let program = Program::new(&scenario, |_| Ok(SceneSpec::default()), 0)?;
//!
//! let mut app = App::new();
//! app.add_plugins((MinimalPlugins, CorePlugin::default(), ScenarioPlugin))
//!     .insert_resource(ScenarioRun::new(program))
//!     .start()
//!     .step(32);
//! assert_eq!(*app.world().resource::<ScenarioRun>().outcome(), Outcome::Done);
//! # Ok::<_, tabletop_scenario::ScenarioError>(())
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod act;
mod check;
mod due;
mod error;
mod fault;
mod judge;
mod performer;
mod place;
mod program;
mod reach;
mod rest;
mod robot;
mod run;
mod scenario;
mod seen;
mod sight;
mod source;
mod step;
mod telling;
#[cfg(test)]
mod test_stage;

pub use check::Check;
pub use error::ScenarioError;
pub use judge::{Gap, Judge, Verdict};
pub use performer::Performer;
pub use place::RandomPlace;
pub use program::Program;
pub use robot::{RobotCheck, RobotStep};
pub use run::{Outcome, ScenarioRun};
pub use scenario::{LocatedStep, Scenario};
pub use sight::table_scene;
pub use source::SourceLocation;
pub use step::{Axis, Step};

/// The names that most users of this crate need.
pub mod prelude {
    #[doc(hidden)]
    pub use crate::{Check, Outcome, Program, Scenario, ScenarioPlugin, ScenarioRun, Step};
}

use bevy::prelude::*;
use tabletop_core::{OrderSystems, RestApp as _, RestingSystems};

/// Runs the [`ScenarioRun`] in the world, if there is one. Needs [`CorePlugin`](tabletop_core::CorePlugin).
///
/// A tick's command is written before [`SimSystems::Load`](tabletop_core::SimSystems::Load), from the state after the previous tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct ScenarioPlugin;

impl Plugin for ScenarioPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            FixedUpdate,
            due::take_due_steps
                .in_set(OrderSystems::Scenario)
                .in_set(RestingSystems)
                .run_if(resource_exists::<ScenarioRun>),
        )
        .wake_after(|run: Option<Res<ScenarioRun>>| run.and_then(|run| run.waits_for()))
        .at_rest(pass_over);
    }
}

fn pass_over(world: &mut World, ticks: u64) -> Result {
    if let Some(mut run) = world.get_resource_mut::<ScenarioRun>() {
        run.pass_over(ticks);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use tabletop_core::{
        CommandId, CommandSystems, CorePlugin, IssuedCommand, SceneSpec, SimFact, StepApp as _,
    };

    use super::*;

    /// True if a scenario continues after a refusal of its own command or of another actor's.
    fn goes_on_after(refuses_own: bool) -> bool {
        let scenario = Scenario::parse("s.ron", "(steps: [Select(Left), Wait(9)])").unwrap();
        let program = Program::new(&scenario, |_| Ok(SceneSpec::default()), 0).unwrap();
        let refuse = move |mut issued: MessageReader<IssuedCommand>,
                           mut facts: MessageWriter<SimFact>| {
            for IssuedCommand { id, .. } in issued.read() {
                let other = CommandId(id.0 + 1);
                facts.write(SimFact::Refused {
                    cause: Some(if refuses_own { *id } else { other }),
                    reason: "no".into(),
                });
            }
        };
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), ScenarioPlugin))
            .insert_resource(ScenarioRun::new(program))
            .add_systems(FixedUpdate, refuse.in_set(CommandSystems::Hands))
            .start()
            .step(5);
        *app.world().resource::<ScenarioRun>().outcome() == Outcome::Running
    }

    #[test]
    fn a_scenario_fails_if_one_of_its_own_commands_is_refused() {
        assert!(!goes_on_after(true));
        assert!(goes_on_after(false), "another's command was refused");
    }
}
