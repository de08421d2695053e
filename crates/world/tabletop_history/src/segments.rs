//! The segments of a recording that can be undone and redone.

use std::{collections::VecDeque, sync::Arc};

use bevy::{
    ecs::{change_detection::Tick, system::SystemState},
    prelude::*,
};
use tabletop_core::{
    CommandId, History, HistoryCommand, HistoryFact, IssuedCommand, Recording, Replaying, SimFact,
    carry_out,
};

use crate::{
    removal::{KeepRemoved, drop_removed},
    snapshot::WorldSnapshot,
};

/// The segments of the present recording.
#[derive(Resource)]
pub(crate) struct Segments {
    /// Beginnings of the segments that can be undone, the oldest first.
    undoable: VecDeque<Arc<WorldSnapshot>>,
    /// Undone segments, the last one last.
    redoable: Vec<Undone>,
    /// The last snapshot that equalled the world, and its tick.
    last: Option<(Arc<WorldSnapshot>, Tick)>,
    /// Limit on the memory, in bytes.
    most_bytes: usize,
    /// Number of segments that could not be kept.
    dropped: usize,
    /// True if segments are kept outside recordings, too.
    keeps_always: bool,
    /// True if those that are kept are of a recording.
    are_of_recording: bool,
}

/// A segment that was undone.
struct Undone {
    begin: Arc<WorldSnapshot>,
    end: Arc<WorldSnapshot>,
}

impl Segments {
    pub(crate) const fn new(most_bytes: usize, keeps_always: bool) -> Self {
        Self {
            undoable: VecDeque::new(),
            redoable: Vec::new(),
            last: None,
            most_bytes,
            dropped: 0,
            keeps_always,
            are_of_recording: false,
        }
    }

    /// Notes that the world is equal to a snapshot.
    fn note(&mut self, snapshot: &Arc<WorldSnapshot>, tick: Tick) {
        self.last = Some((snapshot.clone(), tick));
    }

    /// Drops the oldest ones that exceed the memory; the last one can always be undone.
    fn drop_oldest(&mut self) {
        while self.undoable.len() > 1 && self.bytes() > self.most_bytes {
            self.undoable.pop_front();
            self.dropped += 1;
        }
    }

    /// Memory of all snapshots, in bytes. Neighbours share unchanged state.
    fn bytes(&self) -> usize {
        let undone = self.redoable.iter().rev();
        let undone = undone.flat_map(|segment| [&segment.begin, &segment.end]);
        let mut bytes = 0;
        let mut before: Option<&WorldSnapshot> = None;
        for snapshot in self.undoable.iter().chain(undone) {
            bytes += snapshot.bytes(before);
            before = Some(snapshot);
        }
        bytes
    }
}

/// Reports that a hand is about to act because of a command. While a recording runs, or always, the world before the act is kept, so that it can be
/// undone. Without [`HistoryPlugin`](crate::HistoryPlugin), nothing is kept.
pub fn begin_segment(world: &mut World, cause: CommandId) {
    world.write_message(SimFact::History(HistoryFact::SegmentBegun { cause }));
    if world.contains_resource::<Segments>() && is_kept(world) {
        keep(world, cause);
    }
}

/// Keeps the world before a change that no hand makes, such as that of a whole scene, so that it can be undone. In a recording, it belongs to a segment.
pub fn begin_change(world: &mut World, cause: CommandId) {
    if world.contains_resource::<Segments>() && is_kept(world) && !world.resource::<Recording>().0 {
        keep(world, cause);
    }
}

fn keep(world: &mut World, cause: CommandId) {
    world.resource_mut::<KeepRemoved>().for_undo = true;
    let begin = snapshot(world);
    let mut segments = world.resource_mut::<Segments>();
    segments.undoable.push_back(begin);
    segments.redoable.clear();
    segments.drop_oldest();
    publish(world);
    if !world.resource::<Recording>().0 {
        world.write_message(SimFact::History(HistoryFact::Kept { cause }));
    }
}

/// True if segments are kept now. Forgets those from before a recording that has begun or is replayed, and those of one that has ended.
fn is_kept(world: &mut World) -> bool {
    let is_recording = world.resource::<Recording>().0;
    let is_replaying = world.resource::<Replaying>().0;
    let segments = world.resource::<Segments>();
    let is_kept = is_recording || (segments.keeps_always && !is_replaying);
    if !is_kept || segments.are_of_recording != is_recording {
        forget(world);
        world.resource_mut::<Segments>().are_of_recording = is_recording;
    }
    is_kept
}

/// Carries out undo and redo, and forgets everything when the recording has ended.
pub(crate) fn undo_and_redo(
    world: &mut World,
    reader: &mut SystemState<MessageReader<IssuedCommand>>,
) -> Result {
    is_kept(world);
    carry_out(world, reader, |world, cause, command| {
        let fact = match command {
            HistoryCommand::Undo => undo(world, cause),
            HistoryCommand::Redo => redo(world, cause),
        }?;
        world.write_message(fact);
        publish(world);
        Ok(())
    })
}

fn undo(world: &mut World, cause: CommandId) -> Result<SimFact, String> {
    let mut segments = world.resource_mut::<Segments>();
    let Some(begin) = segments.undoable.pop_back() else {
        return Err(match segments.keeps_always {
            true => "there is nothing to undo".into(),
            false => {
                "there is nothing to undo: only acts of the present recording can be undone".into()
            }
        });
    };
    let end = snapshot(world);
    restore(world, &begin);
    let undone = Undone { begin, end };
    world.resource_mut::<Segments>().redoable.push(undone);
    Ok(SimFact::History(HistoryFact::Undone { cause }))
}

fn redo(world: &mut World, cause: CommandId) -> Result<SimFact, String> {
    let Some(Undone { begin, end }) = world.resource_mut::<Segments>().redoable.pop() else {
        return Err("there is nothing to redo".into());
    };
    restore(world, &end);
    world.resource_mut::<Segments>().undoable.push_back(begin);
    Ok(SimFact::History(HistoryFact::Redone { cause }))
}

/// The present world, sharing unchanged state with the last snapshot.
fn snapshot(world: &mut World) -> Arc<WorldSnapshot> {
    let last = world.resource::<Segments>().last.clone();
    let last = last.as_ref().map(|(snapshot, tick)| (&**snapshot, *tick));
    let snapshot = Arc::new(WorldSnapshot::take_sharing(world, last));
    note(world, &snapshot);
    snapshot
}

fn restore(world: &mut World, snapshot: &Arc<WorldSnapshot>) {
    snapshot.restore(world);
    note(world, snapshot);
}

/// Notes that the world now equals a snapshot; later changes have a later tick.
fn note(world: &mut World, snapshot: &Arc<WorldSnapshot>) {
    let now = world.increment_change_tick();
    world.resource_mut::<Segments>().note(snapshot, now);
}

fn publish(world: &mut World) {
    let segments = world.resource::<Segments>();
    let history = History {
        undoable: segments.undoable.len(),
        redoable: segments.redoable.len(),
        dropped: segments.dropped,
        bytes: segments.bytes(),
        most_bytes: segments.most_bytes,
    };
    world.resource_mut::<History>().set_if_neq(history);
}

/// Drops the snapshots and the entities kept for them.
fn forget(world: &mut World) {
    if !world.resource::<KeepRemoved>().for_undo {
        return;
    }
    world.resource_mut::<KeepRemoved>().for_undo = false;
    let mut segments = world.resource_mut::<Segments>();
    segments.undoable.clear();
    segments.redoable.clear();
    segments.last = None;
    segments.dropped = 0;
    publish(world);
    drop_removed(world);
}

#[cfg(test)]
mod tests {
    use tabletop_core::{CorePlugin, Rollback, StepApp as _, WriteCommand as _};

    use super::*;
    use crate::{HistoryPlugin, RollbackApp as _, is_rolling_back};

    #[derive(Component, Clone, Copy, Debug, PartialEq)]
    struct Lamp([u8; 1000]);

    /// An app with lamps, and a history limited to this many bytes.
    fn app(most_bytes: usize) -> (App, Vec<Entity>) {
        let mut app = App::new();
        let history = HistoryPlugin {
            most_bytes,
            ..HistoryPlugin::DEFAULT
        };
        app.add_plugins((MinimalPlugins, CorePlugin::default(), history))
            .rollback_component::<Lamp>()
            .start();
        app.insert_resource(Recording(true));
        let lamps = (0..160).map(|_| app.world_mut().spawn((Rollback, Lamp([0; 1000]))).id());
        let lamps = lamps.collect();
        (app, lamps)
    }

    fn begin(app: &mut App) -> History {
        let cause = app.world_mut().write_command(HistoryCommand::Redo);
        begin_segment(app.world_mut(), cause);
        *app.world().resource::<History>()
    }

    fn tell(app: &mut App, command: HistoryCommand) {
        app.world_mut().write_command(command);
        app.step(1);
    }

    #[test]
    fn what_is_kept_always_is_undone_without_a_recording_and_forgotten_when_one_begins() {
        let (mut app, lamps) = app(usize::MAX);
        app.insert_resource(Recording(false));
        app.step(1);
        begin_change(app.world_mut(), CommandId::default());
        assert_eq!(app.world().resource::<History>().undoable, 0);
        app.world_mut().resource_mut::<Segments>().keeps_always = true;
        begin_change(app.world_mut(), CommandId::default());
        assert_eq!(app.world().resource::<History>().undoable, 1);
        app.world_mut().entity_mut(lamps[3]).insert(Lamp([1; 1000]));
        tell(&mut app, HistoryCommand::Undo);
        assert_eq!(app.world().get(lamps[3]), Some(&Lamp([0; 1000])));
        tell(&mut app, HistoryCommand::Redo);
        assert_eq!(app.world().get(lamps[3]), Some(&Lamp([1; 1000])));
        app.insert_resource(Replaying(true));
        assert_eq!(begin(&mut app).undoable, 0, "nobody but the recording acts");
        app.insert_resource(Replaying(false));
        assert_eq!(begin(&mut app).undoable, 1);
        app.insert_resource(Recording(true));
        assert_eq!(begin(&mut app).undoable, 1);
        begin_change(app.world_mut(), CommandId::default());
        assert_eq!(app.world().resource::<History>().undoable, 1);
        app.insert_resource(Recording(false));
        app.step(1);
        assert_eq!(app.world().resource::<History>().undoable, 0);
    }

    #[test]
    fn snapshots_share_unchanged_state() {
        let (mut app, lamps) = app(usize::MAX);
        let first = begin(&mut app).bytes;
        assert!(first > 160_000, "{first}");
        app.world_mut().entity_mut(lamps[7]).insert(Lamp([1; 1000]));
        let second = begin(&mut app).bytes - first;
        assert!((16_000..40_000).contains(&second), "{second}");
        let third = begin(&mut app).bytes - first - second;
        assert!(third < 20_000, "{third}");
    }

    #[test]
    fn shared_state_comes_back_as_it_was() {
        let (mut app, lamps) = app(usize::MAX);
        for number in 1..5 {
            begin(&mut app);
            for lamp in lamps.iter().skip(number).step_by(29) {
                app.world_mut()
                    .entity_mut(*lamp)
                    .insert(Lamp([number as u8; 1000]));
            }
        }
        let lit = |app: &App| -> Vec<_> {
            lamps
                .iter()
                .map(|lamp| app.world().get::<Lamp>(*lamp).unwrap().0[0])
                .collect()
        };
        let end = lit(&app);
        for number in (1..5).rev() {
            tell(&mut app, HistoryCommand::Undo);
            let expected = end
                .iter()
                .map(|&by| if usize::from(by) < number { by } else { 0 });
            assert_eq!(lit(&app), expected.collect::<Vec<_>>(), "before {number}");
        }
        for _ in 1..5 {
            tell(&mut app, HistoryCommand::Redo);
        }
        assert_eq!(lit(&app), end);
    }

    #[test]
    fn the_oldest_go_when_there_is_no_memory_left_and_the_last_one_stays() {
        let (mut app, lamps) = app(1_000_000);
        for _ in 0..20 {
            for lamp in &lamps {
                app.world_mut().entity_mut(*lamp).insert(Lamp([1; 1000]));
            }
            begin(&mut app);
        }
        let history = *app.world().resource::<History>();
        assert!(history.bytes <= 1_000_000, "{history:?}");
        assert!(history.undoable >= 4, "{history:?}");
        assert_eq!(history.undoable + history.dropped, 20);

        let (mut app, _) = self::app(1);
        begin(&mut app);
        assert_eq!(begin(&mut app).undoable, 1);
    }

    #[test]
    fn observers_are_silent_while_the_world_is_put_back() {
        #[derive(Resource, Default)]
        struct Heard(usize);
        let (mut app, lamps) = app(usize::MAX);
        app.init_resource::<Heard>().add_observer(
            (|_: On<Remove, Lamp>, mut heard: ResMut<Heard>| heard.0 += 1)
                .run_if(not(is_rolling_back)),
        );
        app.world_mut().entity_mut(lamps[0]).remove::<Lamp>();
        begin(&mut app);
        app.world_mut().entity_mut(lamps[0]).insert(Lamp([1; 1000]));
        tell(&mut app, HistoryCommand::Undo);
        assert_eq!(app.world().get::<Lamp>(lamps[0]), None);
        assert_eq!(app.world().resource::<Heard>().0, 1);
    }
}
