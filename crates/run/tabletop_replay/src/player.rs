//! Repetition of a recording's commands.

use std::sync::Arc;

use bevy::{ecs::message::MessageCursor, prelude::*};
use tabletop_core::{
    Actor, Agent, ClockCommand, CommandSystems, CommandWriter, HandCommand, IssuedCommand,
    MechanismSystems, Paused, RecordingCommand, Replaying, RestApp as _, RestingSystems,
    RobotCommand, ScriptEvent, SimCommand, SimFact, SimTick, TickSystems,
};
use tabletop_recorder::{Session, SessionCommand};

/// Gives the commands of a recording at their ticks, and stays in the world as a resource.
///
/// Until it [is over](Self::is_over), only the recording acts. Of all other commands, only pauses are carried out (the recording waits for
/// their end), and markers are shown. A script can watch meanwhile.
#[derive(Resource, Clone, Debug)]
pub struct Player {
    commands: Arc<[SessionCommand]>,
    /// Number of its commands that were given.
    given: usize,
    /// The first tick of the recording.
    start: SimTick,
    /// True if the recording has paused the simulation.
    has_paused: bool,
    /// True if a recording is to be made of it.
    records: bool,
    /// True if it was reported that a script watches.
    is_watched: bool,
}

const WATCHES: &str =
    "a recording is replayed: the script watches, and moves the robot when it is over";

impl Player {
    pub(crate) fn new(session: &Session) -> Self {
        let commands = session.earlier.iter().chain(&session.commands);
        let start = SimTick(session.header.start_tick);
        Self::of(commands.cloned().collect(), start)
    }

    fn of(commands: Vec<SessionCommand>, start: SimTick) -> Self {
        Self {
            commands: commands.into(),
            given: 0,
            start,
            has_paused: false,
            records: false,
            is_watched: false,
        }
    }

    /// A player that starts a recording where the recording began.
    pub(crate) fn recording(session: &Session) -> Self {
        let start = SessionCommand {
            tick: session.header.start_tick,
            actor: Actor::Replay,
            command: SimCommand::Recording(RecordingCommand::Start),
            at_once: false,
        };
        let earlier = session.earlier.iter().cloned();
        let commands = earlier
            .chain([start])
            .chain(session.commands.iter().cloned());
        Self {
            records: true,
            ..Self::of(commands.collect(), SimTick(session.header.start_tick))
        }
    }

    /// Lets it play in an app.
    pub(crate) fn play_in(self, app: &mut App) {
        app.insert_resource(self);
        plugin(app);
    }

    /// The commands that it has given.
    pub(crate) fn given(&self) -> &[SessionCommand] {
        &self.commands[..self.given]
    }

    /// True if the recording has paused the simulation.
    pub(crate) fn has_paused(&self) -> bool {
        self.has_paused
    }

    /// True if all its commands were given.
    pub fn is_over(&self) -> bool {
        self.given == self.commands.len()
    }

    /// The first tick of the recording; earlier commands have led to its state.
    pub fn start(&self) -> SimTick {
        self.start
    }

    /// Number of ticks before the next one in which it acts; `None` if it is over.
    fn waits_for(&self, tick: SimTick) -> Option<u64> {
        let begins = (tick < self.start).then_some(self.start.0);
        let next = self.commands.get(self.given).map(|next| next.tick);
        let due = begins.into_iter().chain(next).min()?;
        Some(due.saturating_sub(tick.0))
    }

    /// The commands that are due. Those of one tick that were given at several moments, in a pause or because undo has gone back in between,
    /// are given again at several moments.
    fn due(&mut self, tick: SimTick) -> Vec<SessionCommand> {
        let mut due = Vec::new();
        while let Some(next) = self.commands.get(self.given) {
            if next.tick > tick.0 {
                break;
            }
            let last = due.last().map(|last: &SessionCommand| &last.command);
            if last.is_some_and(|last| self.has_paused && begins_moment(next, last))
                || self.pauses_late(tick)
            {
                break;
            }
            if let SimCommand::Clock(ClockCommand::SetPaused(paused)) = next.command {
                self.has_paused = paused;
            }
            self.given += 1;
            if self.records || next.command != RecordingCommand::Finish.into() {
                due.push(next.clone());
            }
        }
        due
    }

    /// True if a pause begins in this tick after commands that are not carried out in pauses. Undo leaves it there: it goes back to between
    /// the commands of a tick, and the pause in which it was given goes on.
    fn pauses_late(&self, tick: SimTick) -> bool {
        let last = self.given.checked_sub(1);
        let Some([last, next]) = last.and_then(|last| self.commands.get(last..last + 2)) else {
            return false;
        };
        !self.has_paused
            && [last.tick, next.tick] == [tick.0; 2]
            && next.command == ClockCommand::SetPaused(true).into()
            && next.command.phase() < last.command.phase()
    }
}

/// True if a command that follows another one in a pause was given at another moment of it: otherwise it would be carried out first.
fn begins_moment(next: &SessionCommand, last: &SimCommand) -> bool {
    match &next.command {
        SimCommand::Recording(RecordingCommand::Start) => true,
        SimCommand::Clock(ClockCommand::SetPaused(false)) => {
            let is_beginning = *last == RecordingCommand::Start.into();
            !(next.at_once && is_beginning)
        }
        SimCommand::Scene(_) => !next.at_once,
        SimCommand::Recording(RecordingCommand::Finish) => false,
        SimCommand::Clock(ClockCommand::SetPaused(true))
        | SimCommand::History(_)
        | SimCommand::Hand(_)
        | SimCommand::Mechanism(_)
        | SimCommand::Robot(_) => next.command.phase() < last.phase(),
    }
}

/// Lets the [`Player`] of an app play, if it has one.
pub(crate) fn plugin(app: &mut App) {
    app.add_systems(
        FixedUpdate,
        (
            play.before(CommandSystems::History),
            pause_late
                .after(MechanismSystems::Obey)
                .before(MechanismSystems::React),
        )
            .run_if(resource_exists::<Player>)
            .in_set(TickSystems)
            .in_set(RestingSystems),
    )
    .wake_after(|player: Option<Res<Player>>, tick: Res<SimTick>| player?.waits_for(*tick));
}

/// Begins a pause after the tick's commands were carried out: undo leaves only commands to the scene, hands and mechanisms of a tick.
fn pause_late(mut player: ResMut<Player>, mut paused: ResMut<Paused>, tick: Res<SimTick>) {
    if player.pauses_late(*tick) {
        player.given += 1;
        player.has_paused = true;
        paused.0 = true;
    }
}

fn play(
    mut player: ResMut<Player>,
    mut commands: ParamSet<(ResMut<Messages<IssuedCommand>>, CommandWriter)>,
    mut seen: Local<MessageCursor<IssuedCommand>>,
    mut facts: MessageWriter<SimFact>,
    mut news: MessageWriter<ScriptEvent>,
    mut replaying: ResMut<Replaying>,
    agent: Res<Agent>,
    tick: Res<SimTick>,
    paused: Res<Paused>,
) {
    let is_replaying = !player.is_over() && *tick >= player.start;
    replaying.set_if_neq(Replaying(is_replaying));
    if player.is_over() {
        return;
    }
    let mut is_held_up = paused.0 && !player.has_paused;
    let mut kept = Vec::new();
    let given: Vec<_> = seen.read(&commands.p0()).cloned().collect();
    for issued in given {
        match issued.command {
            SimCommand::Clock(ClockCommand::SetPaused(pause)) => {
                is_held_up = pause;
                kept.push(issued);
            }
            // Where a real robot is, nobody asks for.
            SimCommand::Hand(HandCommand::Select(_))
            | SimCommand::Robot(RobotCommand::Mirror(_)) => {}
            SimCommand::Robot(RobotCommand::ShowMarkers(_)) => kept.push(issued),
            SimCommand::Robot(RobotCommand::Drive(_)) if agent.is_on() => {
                if !std::mem::replace(&mut player.is_watched, true) {
                    let line = WATCHES.into();
                    news.write(ScriptEvent::Noted { line });
                }
            }
            SimCommand::Recording(_)
            | SimCommand::Scene(_)
            | SimCommand::History(_)
            | SimCommand::Hand(_)
            | SimCommand::Mechanism(_)
            | SimCommand::Robot(_) => {
                facts.write(SimFact::Refused {
                    cause: Some(issued.id),
                    reason: "a recording is replayed; only it can act until it is over".into(),
                });
            }
        }
    }
    let mut waiting = commands.p0();
    waiting.clear();
    waiting.write_batch(kept);
    if !is_held_up {
        let mut writer = commands.p1();
        for SessionCommand { actor, command, .. } in player.due(*tick) {
            writer.replay(actor, command);
        }
    }
    seen.clear(&commands.p0());
}

#[cfg(test)]
mod tests {
    use std::{slice, time::Duration};

    use tabletop_core::{
        CorePlugin, Hand, SceneCommand, SimSystems, StepApp as _, WriteCommand as _,
    };

    use super::*;

    fn player(commands: &[(u64, SimCommand)]) -> Player {
        let commands = commands.iter().cloned();
        let commands = commands.map(|(tick, command)| SessionCommand {
            tick,
            actor: Actor::Mouse,
            command,
            at_once: false,
        });
        Player::of(commands.collect(), SimTick(0))
    }

    #[test]
    fn commands_are_due_at_their_tick() {
        let [left, right] =
            [Hand::Left, Hand::Right].map(|hand| SimCommand::from(HandCommand::Release(hand)));
        let mut player = player(&[
            (1, left.clone()),
            (1, right.clone()),
            (3, left.clone()),
            (4, SimCommand::Recording(RecordingCommand::Finish)),
        ]);
        let given: Vec<_> = (0..4).map(|tick| player.due(SimTick(tick)).len()).collect();
        assert_eq!(given, [0, 2, 0, 1]);
        assert!(!player.is_over());
        assert_eq!(player.due(SimTick(4)), [], "nothing is recorded");
        assert!(player.is_over());
    }

    /// Simulates a tick in which the user gives commands, and returns those that were carried out.
    fn tick(app: &mut App, given: &[SimCommand]) -> Vec<SimCommand> {
        for command in given {
            app.world_mut().write_command(command.clone());
        }
        app.step(1);
        let mut carried_out = app.world_mut().resource_mut::<SeenCommands>();
        std::mem::take(&mut carried_out.0)
    }

    #[derive(Resource, Default)]
    struct SeenCommands(Vec<SimCommand>);

    fn note_carried_out(
        mut commands: MessageReader<IssuedCommand>,
        mut carried_out: ResMut<SeenCommands>,
    ) {
        let issued = commands.read();
        carried_out
            .0
            .extend(issued.map(|issued| issued.command.clone()));
    }

    #[test]
    fn only_the_recording_acts_and_the_user_can_hold_it_up() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default()))
            .init_resource::<SeenCommands>()
            .add_systems(FixedUpdate, note_carried_out.in_set(SimSystems::Ingest))
            .start();
        let [left, right] =
            [Hand::Left, Hand::Right].map(|hand| SimCommand::from(HandCommand::Release(hand)));
        let pause = |pause| SimCommand::from(ClockCommand::SetPaused(pause));
        player(&[
            (0, left.clone()),
            (1, pause(true)),
            (1, pause(false)),
            (1, right.clone()),
            (2, left.clone()),
        ])
        .play_in(&mut app);
        assert_eq!(
            tick(&mut app, &[SimCommand::Scene(SceneCommand::Clear)]),
            slice::from_ref(&left)
        );
        assert_eq!(tick(&mut app, &[pause(true)]), [pause(true)]);
        assert_eq!(tick(&mut app, &[]), []);
        assert_eq!(tick(&mut app, &[pause(false)]), [pause(false), pause(true)]);
        assert_eq!(tick(&mut app, &[]), [pause(false), right.clone()]);
        assert_eq!(app.world().resource::<SimTick>().0, 2);
        assert_eq!(tick(&mut app, slice::from_ref(&right)), [left]);
        assert_eq!(tick(&mut app, slice::from_ref(&right)), [right]);
    }

    #[test]
    fn commands_are_given_in_the_name_of_who_gave_them() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default()))
            .start();
        player(&[(0, HandCommand::Select(Hand::Left).into())]).play_in(&mut app);
        app.step(1);
        let mut issued = app.world_mut().resource_mut::<Messages<IssuedCommand>>();
        let actors: Vec<_> = issued.drain().map(|issued| issued.actor).collect();
        assert_eq!(actors, [Actor::Mouse]);
    }

    #[test]
    fn a_script_watches_and_then_acts() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default()))
            .init_resource::<SeenCommands>()
            .add_systems(FixedUpdate, note_carried_out.in_set(SimSystems::Ingest))
            .start();
        let left = SimCommand::Hand(HandCommand::Release(Hand::Left));
        let mut player = player(&[
            (0, SimCommand::Scene(SceneCommand::Clear)),
            (2, left.clone()),
        ]);
        player.start = SimTick(1);
        player.play_in(&mut app);
        app.insert_resource(Agent::Online {
            took: Duration::ZERO,
        });
        let drive = SimCommand::Robot(RobotCommand::Drive(Vec::new()));
        let markers = SimCommand::Robot(RobotCommand::ShowMarkers(vec![Vec3::Z]));
        let orders = [drive.clone(), markers.clone()];
        let mut news = Vec::new();
        for (carried_out, is_replaying) in [
            (
                [SimCommand::Scene(SceneCommand::Clear), markers.clone()].to_vec(),
                false,
            ),
            (vec![markers.clone()], true),
            ([markers.clone(), left].to_vec(), true),
            (orders.to_vec(), false),
        ] {
            let mut found = tick(&mut app, &orders);
            news.extend(
                app.world_mut()
                    .resource_mut::<Messages<ScriptEvent>>()
                    .drain(),
            );
            found.sort_by_key(|command| carried_out.iter().position(|other| other == command));
            assert_eq!(found, carried_out);
            assert_eq!(app.world().resource::<Replaying>().0, is_replaying);
        }
        assert_eq!(
            news,
            [ScriptEvent::Noted {
                line: WATCHES.into()
            }]
        );
    }

    #[test]
    fn commands_given_in_a_pause_are_replayed_in_the_pause() {
        let mut player = player(&[
            (1, SimCommand::Clock(ClockCommand::SetPaused(true))),
            (1, SimCommand::Hand(HandCommand::Release(Hand::Left))),
            (1, SimCommand::Clock(ClockCommand::SetPaused(false))),
            (1, SimCommand::Hand(HandCommand::Release(Hand::Right))),
        ]);
        assert_eq!(player.due(SimTick(1)).len(), 2);
        assert_eq!(player.due(SimTick(1)).len(), 2);
        assert!(player.is_over());
    }

    #[test]
    fn a_recording_starts_in_the_moment_in_which_a_pause_ends_or_before() {
        let resume = SimCommand::Clock(ClockCommand::SetPaused(false));
        for (at_once, moments) in [(false, [1, 1]), (true, [2, 0])] {
            let mut player = player(&[
                (1, SimCommand::Recording(RecordingCommand::Start)),
                (1, resume.clone()),
            ]);
            player.has_paused = true;
            if let [_, resume] = Arc::make_mut(&mut player.commands) {
                resume.at_once = at_once;
            }
            let given = moments.map(|_| player.due(SimTick(1)).len());
            assert_eq!(given, moments, "{at_once}");
        }
    }
}
