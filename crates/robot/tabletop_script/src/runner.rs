//! The life of a script: start, a call a tick, end.

use std::{thread, time::Duration};

use bevy::prelude::*;
use tabletop_core::{Actor, Agent, RobotCommand, ScriptCommand, ScriptEvent, SimBlocked};
use tabletop_engine::{EngineError, EngineHandle};

use crate::{
    events::ScriptEvents,
    session::{Answer, ScriptSession},
    simulation::Simulation,
};

/// Time between two looks at whether an engine has ended.
const END_CHECK_INTERVAL: Duration = Duration::from_millis(5);

/// Runs the script that drives the robot, if there is one.
#[derive(Resource, Default)]
pub(crate) struct ScriptRunner {
    session: Option<ScriptSession>,
    /// Engines that were asked to end. They get the time that they need.
    ending: Vec<EngineHandle>,
}

impl ScriptRunner {
    fn carry_out(&mut self, command: ScriptCommand, simulation: &mut Simulation) {
        match command {
            ScriptCommand::Start if self.session.is_none() => {
                match ScriptSession::start(&simulation.settings, *simulation.tick) {
                    Ok(session) => {
                        self.session = Some(session);
                        *simulation.agent = Agent::Starting;
                    }
                    Err(error) => self.fail(&error, simulation),
                }
            }
            ScriptCommand::Stop if self.session.is_some() => self.stop(simulation),
            ScriptCommand::Start | ScriptCommand::Stop => {}
        }
    }

    /// Ends the script on command, or because it is done.
    fn stop(&mut self, simulation: &mut Simulation) {
        self.clear(simulation);
        *simulation.agent = Agent::Off;
        simulation.events.write(ScriptEvent::Stopped);
    }

    /// Ends the script because it cannot go on.
    fn fail(&mut self, error: &EngineError, simulation: &mut Simulation) {
        self.clear(simulation);
        *simulation.agent = Agent::Failed;
        let reason = error.to_string();
        simulation.events.write(ScriptEvent::Failed { reason });
    }

    /// Ends the script, if there is one, and removes its markers.
    fn clear(&mut self, simulation: &mut Simulation) {
        if self.end_session() {
            let no_markers = RobotCommand::ShowMarkers(Vec::new());
            simulation.commands.write(Actor::Script, no_markers);
        }
    }

    /// Asks the engine to end. Returns whether there was one.
    fn end_session(&mut self) -> bool {
        let Some(session) = self.session.take() else {
            return false;
        };
        session.engine.stop();
        self.ending.push(session.engine);
        true
    }

    /// Passes on the last output of ending engines, and forgets those that have ended.
    fn reap(&mut self, events: &mut ScriptEvents) {
        self.ending.retain(|engine| {
            let is_alive = engine.is_alive();
            events.print(engine);
            is_alive
        });
    }
}

/// Ends the script, and waits until its engine has ended. Its last output becomes events.
pub(crate) fn shut_down(mut runner: ResMut<ScriptRunner>, mut events: ScriptEvents) {
    runner.end_session();
    while !runner.ending.is_empty() {
        runner.reap(&mut events);
        thread::sleep(END_CHECK_INTERVAL);
    }
}

/// True if there is a script, or the remains of one.
pub(crate) fn is_running(runner: Res<ScriptRunner>) -> bool {
    runner.session.is_some() || !runner.ending.is_empty()
}

/// Starts and stops the script on command, calls it for the tick that begins, and blocks the simulation until it has answered.
pub(crate) fn call(
    In(will_be_paused): In<bool>,
    mut script_commands: MessageReader<ScriptCommand>,
    mut runner: ResMut<ScriptRunner>,
    mut simulation: Simulation,
) {
    for command in script_commands.read() {
        runner.carry_out(*command, &mut simulation);
    }
    simulation.blocked.set_if_neq(SimBlocked(false));
    runner.reap(&mut simulation.events);
    let Some(session) = &mut runner.session else {
        return;
    };
    match session.attend(will_be_paused, &mut simulation) {
        None => {}
        Some(Ok(Answer::Exit)) => runner.stop(&mut simulation),
        Some(Ok(Answer::Commands)) => session.ask_for_picture(&simulation),
        Some(Err(error)) => runner.fail(&error, &mut simulation),
    }
}
