//! A script with its engine: the requests to it, and the results of its answers.

use std::time::{Duration, Instant};

use bevy::prelude::*;
use tabletop_core::{Actor, Agent, RobotMode, ScriptEvent, SimBlocked, SimTick};
use tabletop_engine::{EngineError, EngineHandle, Reply};

use crate::{
    motor_commands::{command_of_motor, commands_of_init, last_command, unreachable},
    sense::SensorFields,
    settings::{ScriptSettings, Waiting},
    simulation::Simulation,
};

/// Longest time that one look for an answer takes while the simulation waits for the script anyway; the output of the script waits
/// as long to be reported.
const ONE_LOOK: Duration = Duration::from_millis(100);

/// A script with its engine.
pub(crate) struct ScriptSession {
    pub engine: EngineHandle,
    phase: Phase,
    /// The time of the request that the engine has not answered yet.
    asked: Instant,
    /// The tick of the last call, or of the init script.
    called_at: SimTick,
    /// The tick in which the init script has run.
    began_at: SimTick,
    /// The fields that it gets.
    fields: SensorFields,
    /// An answer that came in a pause, after which it counts.
    answer: Option<Reply>,
    /// The tick of a picture that the script is to get next.
    picture: Option<SimTick>,
    /// True if the note was given that nothing obeys its torques.
    torques_noted: bool,
}

/// The next answer that is expected of the engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
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

/// The outcome of an answer.
pub(crate) enum Answer {
    /// The tick can begin.
    Commands,
    /// The script is done.
    Exit,
}

impl ScriptSession {
    pub fn start(settings: &ScriptSettings, tick: SimTick) -> Result<Self, EngineError> {
        let config = settings.engine_config()?;
        let fields = SensorFields::of(&config.agent, settings);
        Ok(Self {
            engine: EngineHandle::start(config)?,
            phase: Phase::Start,
            asked: Instant::now(),
            called_at: tick,
            began_at: tick,
            fields,
            answer: None,
            picture: None,
            torques_noted: false,
        })
    }

    /// Gives the engine its request for the tick that is beginning, and waits for the answer. Returns the result; `None` if nothing
    /// is due, or the answer takes longer.
    pub fn attend(
        &mut self,
        will_be_paused: bool,
        simulation: &mut Simulation,
    ) -> Option<Result<Answer, EngineError>> {
        loop {
            if will_be_paused && matches!(self.phase, Phase::Ready | Phase::Idle) {
                return None;
            }
            self.make_due_request(simulation);
            let was_alive = self.engine.is_alive();
            match self.look(will_be_paused, simulation) {
                Some(reply @ (Reply::Init(_) | Reply::Step(_))) if will_be_paused => {
                    if let Agent::Waiting { since } = *simulation.agent {
                        *simulation.agent = Agent::Online { took: since };
                    }
                    self.answer = Some(reply);
                    return None;
                }
                Some(reply) => {
                    if let Some(answer) = self.take(reply, simulation).transpose() {
                        return Some(answer);
                    }
                }
                None if !was_alive => return Some(Err(EngineError::Stopped)),
                None if simulation.settings.waiting == Waiting::Blocking => {}
                None => {
                    self.let_wait(will_be_paused, simulation);
                    return None;
                }
            }
        }
    }

    fn make_due_request(&mut self, simulation: &Simulation) {
        match self.phase {
            Phase::Ready => {
                self.engine.init(simulation.senses.aux());
                self.expect(Phase::Init);
            }
            Phase::Idle => {
                let tick = *simulation.tick;
                let picture = self
                    .picture
                    .and_then(|tick| simulation.senses.picture_since(tick));
                self.picture.take_if(|_| picture.is_some());
                let ticks = tick.0.saturating_sub(self.called_at.0).max(1);
                self.called_at = tick;
                let sensor = simulation.senses.sensor(ticks, picture, self.fields);
                self.engine.step(sensor);
                self.expect(Phase::Step);
            }
            Phase::Start | Phase::Init | Phase::Step => {}
        }
    }

    fn expect(&mut self, phase: Phase) {
        self.phase = phase;
        self.asked = Instant::now();
    }

    /// Looks for an answer, as long as a frame may wait for it.
    fn look(&mut self, will_be_paused: bool, simulation: &mut Simulation) -> Option<Reply> {
        let look = match simulation.settings.waiting {
            Waiting::Blocking => ONE_LOOK,
            Waiting::Frame(_) if will_be_paused || self.phase == Phase::Start => Duration::ZERO,
            Waiting::Frame(most) => most,
        };
        let kept = self.answer.take();
        let reply = kept.or_else(|| self.engine.recv_timeout(look));
        simulation.events.print(&self.engine);
        reply
    }

    /// Lets the simulation wait for the script. While the engine comes up, it goes on.
    fn let_wait(&self, will_be_paused: bool, simulation: &mut Simulation) {
        if self.phase == Phase::Start {
            return;
        }
        simulation.blocked.set_if_neq(SimBlocked(!will_be_paused));
        *simulation.agent = Agent::Waiting {
            since: self.asked.elapsed(),
        };
    }

    /// Carries out an answer. Returns nothing if another one is needed before the tick can begin.
    fn take(
        &mut self,
        reply: Reply,
        simulation: &mut Simulation,
    ) -> Result<Option<Answer>, EngineError> {
        let Simulation {
            tick,
            senses,
            agent,
            commands,
            events,
            ..
        } = simulation;
        match reply {
            Reply::Started { description } => {
                events.write(ScriptEvent::Started {
                    engine: description,
                });
                self.phase = Phase::Ready;
                Ok(None)
            }
            Reply::Init(reply) => {
                commands.write_batch(Actor::Script, commands_of_init(&reply, senses.layout()));
                if let Some(note) = unreachable(&reply, senses.layout()) {
                    events.note(&note);
                }
                if reply.exit {
                    return Ok(Some(Answer::Exit));
                }
                self.called_at = **tick;
                self.began_at = **tick;
                self.phase = Phase::Idle;
                **agent = Agent::Online {
                    took: self.asked.elapsed(),
                };
                // The first call comes with the next tick, when the arms are where the init script wants them.
                Ok(Some(Answer::Commands))
            }
            Reply::Step(reply) if reply.exit => {
                commands.write_batch(Actor::Script, last_command(&reply.motor, senses.layout()));
                Ok(Some(Answer::Exit))
            }
            Reply::Step(reply) => {
                let mode = senses.mode();
                let unheeded = reply.motor.joint_torques.is_some() && mode != RobotMode::Dynamic;
                if unheeded && !self.torques_noted {
                    self.torques_noted = true;
                    events.note("motor.jointTorques has no effect without --dynamic");
                }
                let command = command_of_motor(&reply.motor, mode, senses.layout());
                commands.write(Actor::Script, command);
                self.phase = Phase::Idle;
                **agent = Agent::Online { took: reply.took };
                Ok(Some(Answer::Commands))
            }
            Reply::Failed(error) => Err(error),
        }
    }

    /// Asks for the picture that the script is to get next, if one is due.
    pub fn ask_for_picture(&mut self, simulation: &Simulation) {
        let ticks = simulation.tick.0.saturating_sub(self.began_at.0);
        if ticks.is_multiple_of(simulation.settings.ticks_per_picture.max(1)) {
            simulation.demand.ask();
            if self.fields.seen {
                simulation.perception.ask();
            }
            self.picture = Some(*simulation.tick);
        }
    }
}
