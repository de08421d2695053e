//! The life of a script: start, a call a tick, end.

use std::{thread, time::Duration};

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{Agent, AgentNews, AgentOrder, PictureDemand, SimCommand, SimTick, Standstill};
use tabletop_engine::{EngineError, EngineHandle};

use crate::{
    news::News,
    sense::Senses,
    session::{Answer, Session},
    settings::ScriptSettings,
};

/// How often it is looked whether an engine that is waited for has ended.
const ONE_LOOK_AT_END: Duration = Duration::from_millis(5);

/// What a script has to do with.
#[derive(SystemParam)]
pub(crate) struct Simulation<'w, 's> {
    pub settings: Res<'w, ScriptSettings>,
    pub tick: Res<'w, SimTick>,
    pub senses: Senses<'w, 's>,
    pub demand: Res<'w, PictureDemand>,
    pub agent: ResMut<'w, Agent>,
    pub standstill: ResMut<'w, Standstill>,
    pub commands: MessageWriter<'w, SimCommand>,
    pub news: News<'w>,
}

/// The script that drives the robot, if there is one.
#[derive(Resource, Default)]
pub(crate) struct Agency {
    session: Option<Session>,
    /// Engines that have been told to end. They get the time that they need.
    ending: Vec<EngineHandle>,
}

impl Agency {
    fn obey(&mut self, order: &AgentOrder, simulation: &mut Simulation) {
        match order {
            AgentOrder::Start if self.session.is_none() => {
                match Session::start(&simulation.settings, *simulation.tick) {
                    Ok(session) => {
                        self.session = Some(session);
                        *simulation.agent = Agent::Starting;
                    }
                    Err(error) => self.fail(&error, simulation),
                }
            }
            AgentOrder::Start => {}
            AgentOrder::Stop if self.session.is_some() => self.stop(simulation),
            AgentOrder::Stop => {}
        }
    }

    /// Ends the script as it was told to, or wants.
    fn stop(&mut self, simulation: &mut Simulation) {
        self.dismiss(simulation);
        *simulation.agent = Agent::Off;
        simulation.news.tell(AgentNews::Stopped);
    }

    /// Ends the script because it cannot go on.
    fn fail(&mut self, error: &EngineError, simulation: &mut Simulation) {
        self.dismiss(simulation);
        *simulation.agent = Agent::Failed;
        let reason = error.to_string();
        simulation.news.tell(AgentNews::Failed { reason });
    }

    /// Lets the script go, if there is one. Nothing remains of it.
    fn dismiss(&mut self, simulation: &mut Simulation) {
        if self.let_go() {
            let no_markers = SimCommand::ShowMarkers(Vec::new());
            simulation.commands.write(no_markers);
        }
    }

    fn let_go(&mut self) -> bool {
        let Some(session) = self.session.take() else {
            return false;
        };
        session.engine.stop();
        self.ending.push(session.engine);
        true
    }

    /// Passes on what engines that end still have to say, and forgets those that have ended.
    fn see_off(&mut self, news: &mut News) {
        self.ending.retain(|engine| {
            let is_alive = engine.is_alive();
            news.print(engine);
            is_alive
        });
    }
}

/// Ends the script, and waits until its engine has ended. What it still prints is told.
pub(crate) fn see_off(mut agency: ResMut<Agency>, mut news: News) {
    agency.let_go();
    while !agency.ending.is_empty() {
        agency.see_off(&mut news);
        thread::sleep(ONE_LOOK_AT_END);
    }
}

/// Starts and stops the script as told, calls it for the tick that begins, and lets the simulation wait until it has answered.
pub(crate) fn call(
    In(will_be_paused): In<bool>,
    mut orders: MessageReader<AgentOrder>,
    mut agency: ResMut<Agency>,
    mut simulation: Simulation,
) {
    for order in orders.read() {
        agency.obey(order, &mut simulation);
    }
    simulation.standstill.set_if_neq(Standstill(false));
    agency.see_off(&mut simulation.news);
    let Some(session) = &mut agency.session else {
        return;
    };
    match session.attend(will_be_paused, &mut simulation) {
        None => {}
        Some(Ok(Answer::Exit)) => agency.stop(&mut simulation),
        Some(Ok(Answer::Orders)) => session.ask_for_picture(&simulation),
        Some(Err(error)) => agency.fail(&error, &mut simulation),
    }
}
