//! The life of a script: start, a call a tick, end.

use std::{
    thread,
    time::{Duration, Instant},
};

use bevy::prelude::*;
use tabletop_core::{
    Agent, AgentNews, AgentOrder, PictureDemand, RobotMode, SimCommand, SimTick, Standstill,
};
use tabletop_engine::{EngineError, EngineHandle, Reply};

use crate::{
    act::{command_of_motor, commands_of_init, last_command, unreachable},
    news::News,
    sense::{Senses, Told, aux},
    settings::{ScriptSettings, Waiting},
};

/// Longest time that one look for an answer takes while the simulation waits for the script anyway, and that what the script
/// prints meanwhile waits to be told.
const ONE_LOOK: Duration = Duration::from_millis(100);
/// How often it is looked whether an engine that is waited for has ended.
const ONE_LOOK_AT_END: Duration = Duration::from_millis(5);

/// The script that drives the robot, if there is one.
#[derive(Resource, Default)]
pub(crate) struct Agency {
    session: Option<Session>,
    /// Engines that have been told to end. They get the time that they need.
    ending: Vec<EngineHandle>,
}

impl Agency {
    /// Lets the script go, if there is one.
    fn dismiss(&mut self) -> bool {
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
    agency.dismiss();
    while !agency.ending.is_empty() {
        agency.see_off(&mut news);
        thread::sleep(ONE_LOOK_AT_END);
    }
}

/// A script with its engine.
struct Session {
    engine: EngineHandle,
    stage: Stage,
    /// When the engine was asked for what it has not answered yet.
    asked: Instant,
    /// The tick of the last call, or of the init script.
    called_at: SimTick,
    /// The tick in which the init script has run.
    began_at: SimTick,
    /// What it gets to know.
    told: Told,
    /// An answer that came in a pause, after which it counts.
    answer: Option<Reply>,
    /// The tick of a picture that the script is to get next.
    picture: Option<SimTick>,
    /// Whether it has been said that nothing obeys its torques.
    torques_noted: bool,
}

/// What is expected of the engine next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// That it comes up.
    Start,
    /// Nothing: the init script is due.
    Ready,
    /// That the init script has run.
    Init,
    /// Nothing: the callback script is due.
    Idle,
    /// That the callback script has run.
    Step,
}

/// Starts and stops the script as told, calls it for the tick that begins, and lets the simulation wait until it has answered.
pub(crate) fn call(
    In(will_be_paused): In<bool>,
    mut orders: MessageReader<AgentOrder>,
    mut agency: ResMut<Agency>,
    settings: Res<ScriptSettings>,
    tick: Res<SimTick>,
    senses: Senses,
    demand: Res<PictureDemand>,
    mut agent: ResMut<Agent>,
    mut standstill: ResMut<Standstill>,
    mut commands: MessageWriter<SimCommand>,
    mut news: News,
) {
    for order in orders.read() {
        match order {
            AgentOrder::Start if agency.session.is_none() => match start(&settings, *tick) {
                Ok(session) => {
                    agency.session = Some(session);
                    *agent = Agent::Starting;
                }
                Err(error) => fail(&error, &mut agent, &mut news),
            },
            AgentOrder::Start => {}
            AgentOrder::Stop => {
                if agency.dismiss() {
                    end(&mut commands);
                    *agent = Agent::Off;
                    news.tell(AgentNews::Stopped);
                }
            }
        }
    }
    standstill.set_if_neq(Standstill(false));
    agency.see_off(&mut news);
    let Some(session) = &mut agency.session else {
        return;
    };
    let answered = loop {
        if will_be_paused && matches!(session.stage, Stage::Ready | Stage::Idle) {
            return;
        }
        if session.stage == Stage::Ready {
            session.ask(Stage::Init, |engine| engine.init(aux()));
        }
        if session.stage == Stage::Idle {
            let picture = session.picture.and_then(|tick| senses.picture_since(tick));
            session.picture.take_if(|_| picture.is_some());
            let ticks = tick.0.saturating_sub(session.called_at.0).max(1);
            session.called_at = *tick;
            let sensor = senses.sensor(ticks, picture, session.told);
            session.ask(Stage::Step, |engine| engine.step(sensor));
        }
        let look = match settings.waiting {
            Waiting::Blocking => ONE_LOOK,
            Waiting::Frame(_) if will_be_paused || session.stage == Stage::Start => Duration::ZERO,
            Waiting::Frame(most) => most,
        };
        let was_alive = session.engine.is_alive();
        let reply = session.answer.take();
        let reply = reply.or_else(|| session.engine.recv_timeout(look));
        news.print(&session.engine);
        match reply {
            Some(reply @ (Reply::Init(_) | Reply::Step(_))) if will_be_paused => {
                if let Agent::Waiting { since } = *agent {
                    *agent = Agent::Online { took: since };
                }
                session.answer = Some(reply);
                return;
            }
            Some(reply) => {
                match session.take(reply, *tick, &senses, &mut agent, &mut commands, &mut news) {
                    Ok(Answer::None) => {}
                    answered => break answered,
                }
            }
            None if !was_alive => break Err(EngineError::Stopped),
            None if settings.waiting == Waiting::Blocking => {}
            None => {
                // The engine comes up while the simulation goes on; the script itself is waited for.
                if session.stage != Stage::Start {
                    standstill.set_if_neq(Standstill(!will_be_paused));
                    *agent = Agent::Waiting {
                        since: session.asked.elapsed(),
                    };
                }
                return;
            }
        }
    };
    match answered {
        Ok(Answer::Exit) => {
            agency.dismiss();
            end(&mut commands);
            *agent = Agent::Off;
            news.tell(AgentNews::Stopped);
        }
        Ok(_) => {
            let ticks = tick.0.saturating_sub(session.began_at.0);
            if ticks.is_multiple_of(settings.ticks_per_picture.max(1)) {
                demand.ask();
                session.picture = Some(*tick);
            }
        }
        Err(error) => {
            agency.dismiss();
            end(&mut commands);
            fail(&error, &mut agent, &mut news);
        }
    }
}

/// What came of an answer.
enum Answer {
    /// Another one is needed before the tick can begin.
    None,
    /// The tick can begin.
    Orders,
    /// The script is done.
    Exit,
}

fn start(settings: &ScriptSettings, tick: SimTick) -> Result<Session, EngineError> {
    let config = settings.engine_config()?;
    let told = Told::to(&config.agent, settings);
    Ok(Session {
        engine: EngineHandle::start(config)?,
        stage: Stage::Start,
        asked: Instant::now(),
        called_at: tick,
        began_at: tick,
        told,
        answer: None,
        picture: None,
        torques_noted: false,
    })
}

impl Session {
    fn ask(&mut self, stage: Stage, request: impl FnOnce(&EngineHandle)) {
        request(&self.engine);
        self.stage = stage;
        self.asked = Instant::now();
    }

    /// Does what an answer calls for.
    fn take(
        &mut self,
        reply: Reply,
        tick: SimTick,
        senses: &Senses,
        agent: &mut Agent,
        commands: &mut MessageWriter<SimCommand>,
        news: &mut News,
    ) -> Result<Answer, EngineError> {
        match reply {
            Reply::Started { description } => {
                news.tell(AgentNews::Started {
                    engine: description,
                });
                self.stage = Stage::Ready;
                Ok(Answer::None)
            }
            Reply::Init(reply) => {
                commands.write_batch(commands_of_init(&reply));
                if let Some(note) = unreachable(&reply) {
                    news.note(&note);
                }
                self.called_at = tick;
                self.began_at = tick;
                self.stage = Stage::Idle;
                *agent = Agent::Online {
                    took: self.asked.elapsed(),
                };
                // The first call comes with the next tick, when the arms are where the init script wants them.
                Ok(Answer::Orders)
            }
            Reply::Step(reply) if reply.exit => {
                commands.write_batch(last_command(&reply.motor));
                Ok(Answer::Exit)
            }
            Reply::Step(reply) => {
                let mode = senses.mode();
                let unheeded = reply.motor.joint_torques.is_some() && mode != RobotMode::Dynamic;
                if unheeded && !self.torques_noted {
                    self.torques_noted = true;
                    news.note("motor.jointTorques has no effect without --dynamic");
                }
                commands.write(command_of_motor(&reply.motor, mode));
                self.stage = Stage::Idle;
                *agent = Agent::Online { took: reply.took };
                Ok(Answer::Orders)
            }
            Reply::Failed(error) => Err(error),
        }
    }
}

/// What remains of a script when it has ended: nothing.
fn end(commands: &mut MessageWriter<SimCommand>) {
    commands.write(SimCommand::ShowMarkers(Vec::new()));
}

fn fail(error: &EngineError, agent: &mut Agent, news: &mut News) {
    *agent = Agent::Failed;
    news.tell(AgentNews::Failed {
        reason: error.to_string(),
    });
}
