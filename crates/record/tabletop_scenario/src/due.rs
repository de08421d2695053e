//! The steps that are due in a tick, from the state after the previous one.

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{Actor, CommandId, CommandWriter, RecordingFact, SimFact};

use crate::{ScenarioRun, sight::ScenarioSight};

/// Takes the steps that are due of the run in the world.
pub(crate) fn take_due_steps(
    mut run: ResMut<ScenarioRun>,
    commands: CommandWriter,
    news: News,
    sight: ScenarioSight,
) {
    take_due(&mut run, commands, news, &sight);
}

/// Takes the steps that are due of a run that is not in the world.
pub(crate) fn take_due_steps_of(
    InMut(run): InMut<ScenarioRun>,
    commands: CommandWriter,
    news: News,
    sight: ScenarioSight,
) {
    take_due(run, commands, news, &sight);
}

fn take_due(
    run: &mut ScenarioRun,
    mut commands: CommandWriter,
    mut news: News,
    sight: &ScenarioSight,
) {
    let mut refusal = None;
    for fact in news.facts.read() {
        if let SimFact::Recording(RecordingFact::Failed { reason, .. }) = fact {
            run.give_up(reason.clone());
        }
        if let SimFact::Refused {
            cause: Some(cause),
            reason,
        } = fact
            && news.issued.contains(cause)
        {
            refusal = Some(reason.as_str());
        }
    }
    let due = run.tick(&sight.seen(), refusal).into_iter();
    let given = due.map(|command| commands.write(Actor::Scenario, command));
    *news.issued = given.collect();
}

/// The facts since the last commands of a run.
#[derive(SystemParam)]
pub(crate) struct News<'w, 's> {
    facts: MessageReader<'w, 's, SimFact>,
    issued: Local<'s, Vec<CommandId>>,
}
