//! The segments of a recording that can be undone and redone.

use std::{collections::VecDeque, sync::Arc};

use bevy::{
    ecs::{change_detection::Tick, system::SystemState},
    prelude::*,
};
use tabletop_core::{
    CommandId, History, HistoryCommand, IssuedCommand, Recording, SimFact, carry_out,
};

use crate::{
    removal::{KeepRemoved, drop_removed},
    snapshot::WorldSnapshot,
};

/// The segments of the present recording.
#[derive(Resource)]
pub(crate) struct Segments {
    /// The beginnings of those that can be undone, the oldest first.
    undoable: VecDeque<Arc<WorldSnapshot>>,
    /// Those that were undone, the last one last.
    redoable: Vec<Undone>,
    /// The last snapshot that the world was equal to, and when.
    last: Option<(Arc<WorldSnapshot>, Tick)>,
    /// Most memory in bytes.
    most_bytes: usize,
}

/// A segment that was undone.
struct Undone {
    begin: Arc<WorldSnapshot>,
    end: Arc<WorldSnapshot>,
}

impl Segments {
    pub(crate) const fn new(most_bytes: usize) -> Self {
        Self {
            undoable: VecDeque::new(),
            redoable: Vec::new(),
            last: None,
            most_bytes,
        }
    }

    /// Notes that the world is equal to a snapshot.
    fn note(&mut self, snapshot: &Arc<WorldSnapshot>, tick: Tick) {
        self.last = Some((snapshot.clone(), tick));
    }

    /// Drops the oldest ones that do not fit into the memory; the last one can always be undone.
    fn drop_oldest(&mut self) {
        while self.undoable.len() > 1 && self.bytes() > self.most_bytes {
            self.undoable.pop_front();
        }
    }

    /// The memory, in bytes, of all snapshots. Those that follow each other share what did not change.
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

/// Reports that a hand is about to act because of a command, and remembers the world before it if a recording is running, so that it can be undone. Without
/// [`HistoryPlugin`](crate::HistoryPlugin), nothing can.
pub fn begin_segment(world: &mut World, cause: CommandId) {
    world.write_message(SimFact::SegmentBegun { cause });
    if !world.resource::<Recording>().0 || !world.contains_resource::<Segments>() {
        return;
    }
    world.resource_mut::<KeepRemoved>().for_undo = true;
    let begin = snapshot(world);
    let mut segments = world.resource_mut::<Segments>();
    segments.undoable.push_back(begin);
    segments.redoable.clear();
    segments.drop_oldest();
    publish(world);
}

/// Carries out undo and redo, and forgets everything when the recording has ended.
pub(crate) fn undo_and_redo(
    world: &mut World,
    reader: &mut SystemState<MessageReader<IssuedCommand>>,
) -> Result {
    if !world.resource::<Recording>().0 {
        forget(world);
    }
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
    let Some(begin) = world.resource_mut::<Segments>().undoable.pop_back() else {
        return Err(
            "there is nothing to undo: only what was done in the present recording can be".into(),
        );
    };
    let end = snapshot(world);
    restore(world, &begin);
    let undone = Undone { begin, end };
    world.resource_mut::<Segments>().redoable.push(undone);
    Ok(SimFact::Undone { cause })
}

fn redo(world: &mut World, cause: CommandId) -> Result<SimFact, String> {
    let Some(Undone { begin, end }) = world.resource_mut::<Segments>().redoable.pop() else {
        return Err("there is nothing to redo".into());
    };
    restore(world, &end);
    world.resource_mut::<Segments>().undoable.push_back(begin);
    Ok(SimFact::Redone { cause })
}

/// The present world, sharing with the last snapshot what has not changed.
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

/// Notes that the world is now equal to a snapshot; what changes from now on has a later tick.
fn note(world: &mut World, snapshot: &Arc<WorldSnapshot>) {
    let now = world.increment_change_tick();
    world.resource_mut::<Segments>().note(snapshot, now);
}

fn publish(world: &mut World) {
    let segments = world.resource::<Segments>();
    let history = History {
        undoable: segments.undoable.len(),
        redoable: segments.redoable.len(),
        bytes: segments.bytes(),
        most_bytes: segments.most_bytes,
    };
    world.resource_mut::<History>().set_if_neq(history);
}

/// Drops the snapshots and what was kept for them.
fn forget(world: &mut World) {
    if !world.resource::<KeepRemoved>().for_undo {
        return;
    }
    world.resource_mut::<KeepRemoved>().for_undo = false;
    let mut segments = world.resource_mut::<Segments>();
    segments.undoable.clear();
    segments.redoable.clear();
    segments.last = None;
    publish(world);
    drop_removed(world);
}
