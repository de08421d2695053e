//! Playback of recordings while the simulator runs, up to any of their moments.

use std::{
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use bevy::{app::FixedMain, ecs::system::SystemState, prelude::*};
use tabletop_core::{
    Act, Actor, ClockCommand, IssuedCommand, Manipulator, OpenRecording, Paused, Playback,
    PlaybackOrder, Recording, Replaying, RestApp as _, RestingSystems, SceneCommand, SceneFact,
    SimCommand, SimFact, SimTick, TICKS_PER_SECOND, Timeline, TimelineGrip, WriteCommand as _,
};
use tabletop_history::{KeepRemoved, WorldSnapshot, drop_removed};
use tabletop_recorder::set_earlier_commands;
use tabletop_robot::Description;
use tabletop_xml::AllowedFolders;

use super::{Player, Replay, ReplayError, player, shown, shown::ShownMotions};
use tabletop_sim::{reset, settings::Settings};

/// Time of a frame that is spent on going to a moment, so that pictures keep coming.
const BUDGET: Duration = Duration::from_millis(40);

/// Ticks from one keyframe to the next, at first.
const SPACING: u64 = 2 * TICKS_PER_SECOND as u64;

/// Largest number of keyframes; beyond it, every other one is dropped.
const MOST_KEYFRAMES: usize = 64;

/// Opens recordings on [`OpenRecording`], and plays them as [`PlaybackOrder`]s ask. The world is brought to a moment
/// by simulating the recording from the last keyframe before it, so it is the world as it was, to the bit.
/// Needs the [simulator](crate::TabletopSimPlugins); it works between the frames of a window.
#[derive(Clone, Debug)]
pub struct PlaybackPlugin {
    /// The task file to load when a recording is closed, unless another was loaded before it was opened.
    pub task: PathBuf,
}

impl Plugin for PlaybackPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(FreshTask(self.task.clone()))
            .add_plugins((player::plugin, shown::plugin))
            .add_systems(
                FixedLast,
                (note_keyframe, note_grips)
                    .in_set(RestingSystems)
                    .run_if(resource_exists::<Opened>),
            )
            .wake_while(resource_exists::<Opened>)
            .add_systems(
                RunFixedMainLoop,
                (note_task, open, make_way, obey, go_on)
                    .chain()
                    .in_set(RunFixedMainLoopSystems::AfterFixedMainLoop),
            );
    }
}

/// The task file to load when a recording is closed.
#[derive(Resource)]
struct FreshTask(PathBuf);

/// The open recording.
#[derive(Resource)]
struct Opened {
    replay: Replay,
    keyframes: Vec<Keyframe>,
    /// Ticks from one keyframe to the next.
    spacing: u64,
    /// The moment that the world is being brought to.
    goal: Option<PlayheadTarget>,
}

/// A keyframe: a moment to which the world can be restored.
struct Keyframe {
    /// Its next tick.
    tick: SimTick,
    world: WorldSnapshot,
    player: Player,
}

/// A moment that the world is being brought to.
#[derive(Clone, Copy, Debug)]
struct PlayheadTarget {
    /// Its next tick.
    tick: SimTick,
    /// True if the simulation then stands still.
    stops: bool,
}

fn note_task(mut facts: MessageReader<SimFact>, mut fresh: ResMut<FreshTask>) {
    for fact in facts.read() {
        if let SimFact::Scene(SceneFact::TaskLoaded { path, .. }) = fact {
            fresh.0.clone_from(path);
        }
    }
}

/// Opens the last requested recording, or reports why it cannot.
fn open(world: &mut World, reader: &mut SystemState<MessageReader<OpenRecording>>) -> Result {
    let Some(OpenRecording(folder)) = reader.get_mut(world)?.read().last().cloned() else {
        return Ok(());
    };
    if let Err(reason) = try_open(world, folder) {
        world.write_message(SimFact::Refused {
            cause: None,
            reason,
        });
    }
    Ok(())
}

/// Where the meshes of a recording's robot may be: where the user allows it, and beside the description of the robot that is here,
/// which must be the same.
fn allowed(world: &World) -> Vec<PathBuf> {
    let folders = world.get_resource::<AllowedFolders>();
    let mut folders = folders.map_or_else(Vec::new, |folders| folders.0.clone());
    let source = world.get_resource::<Description>();
    let source = source.and_then(|description| description.source.as_ref());
    folders.extend(source.and_then(|source| source.path.parent().map(Path::to_owned)));
    folders
}

fn try_open(world: &mut World, folder: PathBuf) -> Result<(), String> {
    if world.resource::<Recording>().0 {
        return Err(format!(
            "{}: a recording is running; finish it before another is opened",
            folder.display()
        ));
    }
    let (replay, motions) = match Replay::read_allowing(&folder, &allowed(world)) {
        Err(ReplayError::Imported { folder, .. }) => ShownMotions::read(&folder)
            .map(|(replay, motions)| (replay, Some(motions)))
            .map_err(|error| error.to_string())?,
        replay => (replay.map_err(|error| error.to_string())?, None),
    };
    let timeline = replay.recording().timeline();
    let timeline = timeline.map_err(|error| error.to_string())?;
    let difference = replay.settings.first_difference(&Settings::of(world));
    if let Some(difference) = difference.filter(|_| motions.is_none()) {
        let folder = replay.folder().display();
        return Err(format!(
            "{folder}: {difference}; `tabletop replay {folder} --window` plays it with its own settings"
        ));
    }
    begin_anew(world);
    world.insert_resource(replay.begin);
    world.insert_resource(replay.camera());
    set_earlier_commands(world, replay.begin, &[]);
    let player = Player::new(&replay.session);
    let goal = PlayheadTarget {
        tick: player.start(),
        stops: false,
    };
    world.insert_resource(player);
    world.insert_resource(timeline);
    if let Some(motions) = motions {
        world.insert_resource(motions);
    }
    world.resource_mut::<KeepRemoved>().for_playback = true;
    world.insert_resource(Opened {
        replay,
        keyframes: Vec::new(),
        spacing: SPACING,
        goal: Some(goal),
    });
    keep_keyframe(world);
    publish(world);
    Ok(())
}

/// Restores the world to before its first tick, and closes the open recording.
fn begin_anew(world: &mut World) {
    put_away(world);
    reset(world);
}

/// Forgets the open recording, and leaves the world unchanged.
fn put_away(world: &mut World) {
    if world.remove_resource::<Opened>().is_none() {
        return;
    }
    world.remove_resource::<Player>();
    world.remove_resource::<ShownMotions>();
    world.insert_resource(Replaying(false));
    world.insert_resource(Playback::default());
    world.resource_mut::<Time<Virtual>>().unpause();
    world.resource_mut::<KeepRemoved>().for_playback = false;
    drop_removed(world);
}

/// Closes the open recording when another one is being made.
fn make_way(world: &mut World) {
    if world.resource::<Recording>().0 {
        put_away(world);
    }
}

/// Carries out the user's requests about the open recording.
fn obey(world: &mut World, reader: &mut SystemState<MessageReader<PlaybackOrder>>) -> Result {
    let orders: Vec<_> = reader.get_mut(world)?.read().copied().collect();
    for order in orders {
        let is_paused = world.resource::<Paused>().0;
        let Some(mut opened) = world.get_resource_mut::<Opened>() else {
            continue;
        };
        match order {
            PlaybackOrder::GoTo(tick) => {
                let stops = opened.goal.map_or(is_paused, |goal| goal.stops);
                opened.aim_at(tick, stops);
            }
            PlaybackOrder::StopAt(tick) => opened.aim_at(tick, true),
            PlaybackOrder::Loop(loops) => world.resource_mut::<Playback>().loops = loops,
            PlaybackOrder::Close => {
                begin_anew(world);
                world.insert_resource(Timeline::default());
                let task = world.resource::<FreshTask>().0.clone();
                world.write_command_of(Actor::Replay, SceneCommand::Load(task));
            }
        }
    }
    Ok(())
}

impl Opened {
    /// Makes the end of a tick the goal.
    fn aim_at(&mut self, tick: SimTick, stops: bool) {
        let recording = self.replay.recording();
        let tick = tick.clamp(recording.first_tick(), recording.last_tick());
        self.goal = Some(PlayheadTarget {
            tick: SimTick(tick.0 + 1),
            stops,
        });
    }

    /// True if the recording has been played to its end, which may be in a pause.
    fn is_over(&self, player: &Player, next: SimTick) -> bool {
        let last = self.replay.recording().last_tick();
        player.is_over() && (next > last || player.has_paused())
    }
}

/// True if the open recording has been played to its end.
fn is_over(world: &World) -> bool {
    let opened = world.get_resource::<Opened>();
    let player = world.get_resource::<Player>();
    let next = *world.resource::<SimTick>();
    opened
        .zip(player)
        .is_some_and(|(opened, player)| opened.is_over(player, next))
}

/// Brings the world towards its goal, as far as a frame allows, and begins again at the end of a looping recording.
fn go_on(world: &mut World) {
    let begins_again = is_over(world) && world.resource::<Playback>().loops;
    let Some(mut opened) = world.get_resource_mut::<Opened>() else {
        return;
    };
    if opened.goal.is_none() && begins_again {
        let start = opened.replay.recording().first_tick();
        opened.goal = Some(PlayheadTarget {
            tick: start,
            stops: false,
        });
    }
    if let Some(goal) = opened.goal {
        approach(world, goal);
    }
    publish(world);
}

fn approach(world: &mut World, mut goal: PlayheadTarget) {
    let deadline = Instant::now() + BUDGET;
    world.resource_mut::<Time<Virtual>>().pause();
    for issued in world.resource_mut::<Messages<IssuedCommand>>().drain() {
        if let SimCommand::Clock(ClockCommand::SetPaused(pause)) = issued.command {
            goal.stops = pause;
        }
    }
    world.resource_mut::<Opened>().goal = Some(goal);
    jump(world, goal.tick);
    let is_there = |world: &World| *world.resource::<SimTick>() >= goal.tick || is_over(world);
    while !is_there(world) && Instant::now() < deadline {
        let has_paused = world.resource::<Player>().has_paused();
        if world.resource::<Paused>().0 && !has_paused {
            world.write_command_of(Actor::Replay, ClockCommand::SetPaused(false));
        }
        world.run_schedule(FixedMain);
        world.resource_mut::<Messages<IssuedCommand>>().update();
        world.resource_mut::<Messages<SimFact>>().update();
    }
    if is_there(world) {
        world.resource_mut::<Opened>().goal = None;
        world.resource_mut::<Time<Virtual>>().unpause();
        if goal.stops != world.resource::<Paused>().0 {
            world.write_command_of(Actor::Replay, ClockCommand::SetPaused(goal.stops));
        }
    }
}

/// Goes to the last keyframe before a tick, unless the way there from here is shorter.
fn jump(world: &mut World, tick: SimTick) {
    let now = *world.resource::<SimTick>();
    world.resource_scope(|world, opened: Mut<Opened>| {
        let before = opened
            .keyframes
            .partition_point(|keyframe| keyframe.tick <= tick);
        let keyframe = before
            .checked_sub(1)
            .and_then(|last| opened.keyframes.get(last));
        let Some(keyframe) = keyframe.filter(|keyframe| now > tick || keyframe.tick > now) else {
            return;
        };
        world.resource_mut::<Messages<IssuedCommand>>().clear();
        keyframe.world.restore(world);
        world.insert_resource(Paused(false));
        set_earlier_commands(world, opened.replay.begin, keyframe.player.given());
        world.insert_resource(keyframe.player.clone());
    });
}

/// Keeps a keyframe when it is time for one.
fn note_keyframe(world: &mut World) {
    let next = *world.resource::<SimTick>();
    let opened = world.resource::<Opened>();
    let last = opened.keyframes.last().map_or(0, |last| last.tick.0);
    let is_due = next.0 >= last + opened.spacing && !is_over(world);
    if is_due && !world.resource::<Paused>().0 {
        keep_keyframe(world);
    }
}

fn keep_keyframe(world: &mut World) {
    let keyframe = Keyframe {
        tick: *world.resource::<SimTick>(),
        world: WorldSnapshot::take(world),
        player: world.resource::<Player>().clone(),
    };
    let mut opened = world.resource_mut::<Opened>();
    opened.keyframes.push(keyframe);
    if opened.keyframes.len() > MOST_KEYFRAMES {
        let mut number = 0;
        opened.keyframes.retain(|_| {
            number += 1;
            number % 2 == 1
        });
        opened.spacing *= 2;
    }
}

/// Adds grips to the timeline when they are seen for the first time.
fn note_grips(
    mut facts: MessageReader<SimFact>,
    opened: Res<Opened>,
    next: Res<SimTick>,
    mut timeline: ResMut<Timeline>,
) {
    let tick = SimTick(next.0.saturating_sub(1));
    let recording = opened.replay.recording();
    let is_recorded = (recording.first_tick()..=recording.last_tick()).contains(&tick);
    for act in facts.read().filter_map(Act::of) {
        if !is_recorded || is_of_hand(&act) {
            continue;
        }
        let grip = TimelineGrip { tick, act };
        if !timeline.grips.contains(&grip) {
            let place = timeline.grips.partition_point(|other| other.tick <= tick);
            timeline.grips.insert(place, grip);
        }
    }
}

fn is_of_hand(act: &Act) -> bool {
    match act.manipulator {
        Manipulator::Hand(_) => true,
        Manipulator::Gripper(_) => false,
    }
}

/// Publishes the state of the playback.
fn publish(world: &mut World) {
    let Some(opened) = world.get_resource::<Opened>() else {
        return;
    };
    let playback = Playback {
        goal: opened
            .goal
            .map(|goal| SimTick(goal.tick.0.saturating_sub(1))),
        is_over: is_over(world),
        loops: world.resource::<Playback>().loops,
    };
    world.resource_mut::<Playback>().set_if_neq(playback);
}
