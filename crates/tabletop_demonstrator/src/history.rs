//! Undo and redo: the world as it was when a segment of a recording began, bit for bit.

use bevy::{ecs::system::SystemState, prelude::*};
use tabletop_core::{History, Recording, SimCommand, SimFact};
use tabletop_physics::{KeepRemoved, drop_removed};

use crate::snapshot::Snapshot;

/// The snapshots of the present recording.
#[derive(Resource, Default)]
pub(crate) struct Snapshots {
    undoable: Vec<Snapshot>,
    redoable: Vec<Undone>,
}

/// A segment that was undone.
struct Undone {
    begin: Snapshot,
    end: Snapshot,
}

/// Tells that a hand is about to act, and remembers the world before it if that can be undone.
pub(crate) fn begin_segment(world: &mut World) {
    world.write_message(SimFact::SegmentBegun);
    if !world.resource::<Recording>().0 {
        return;
    }
    world.resource_mut::<KeepRemoved>().for_undo = true;
    let snapshot = Snapshot::take(world);
    let mut snapshots = world.resource_mut::<Snapshots>();
    snapshots.undoable.push(snapshot);
    snapshots.redoable.clear();
    publish(world);
}

/// Carries out undo and redo, and forgets everything when the recording has ended.
pub(crate) fn undo_and_redo(
    world: &mut World,
    reader: &mut SystemState<MessageReader<SimCommand>>,
) -> Result {
    let commands = SimCommand::unread(world, reader, |command| {
        matches!(command, SimCommand::Undo | SimCommand::Redo)
    })?;
    if !world.resource::<Recording>().0 {
        forget(world);
    }
    for command in commands {
        let fact = match command {
            SimCommand::Undo => undo(world),
            _ => redo(world),
        };
        world.write_message(fact);
        publish(world);
    }
    Ok(())
}

fn undo(world: &mut World) -> SimFact {
    let Some(begin) = world.resource_mut::<Snapshots>().undoable.pop() else {
        return SimFact::Refused {
            reason: "there is nothing to undo: only what was done in the present recording can be"
                .into(),
        };
    };
    let end = Snapshot::take(world);
    begin.restore(world);
    let undone = Undone { begin, end };
    world.resource_mut::<Snapshots>().redoable.push(undone);
    SimFact::Undone
}

fn redo(world: &mut World) -> SimFact {
    let Some(Undone { begin, end }) = world.resource_mut::<Snapshots>().redoable.pop() else {
        return SimFact::Refused {
            reason: "there is nothing to redo".into(),
        };
    };
    end.restore(world);
    world.resource_mut::<Snapshots>().undoable.push(begin);
    SimFact::Redone
}

fn publish(world: &mut World) {
    let snapshots = world.resource::<Snapshots>();
    let history = History {
        undoable: snapshots.undoable.len(),
        redoable: snapshots.redoable.len(),
    };
    world.resource_mut::<History>().set_if_neq(history);
}

/// Drops the snapshots and what was kept for them.
fn forget(world: &mut World) {
    if !world.resource::<KeepRemoved>().for_undo {
        return;
    }
    world.resource_mut::<KeepRemoved>().for_undo = false;
    *world.resource_mut::<Snapshots>() = Snapshots::default();
    publish(world);
    drop_removed(world);
}
