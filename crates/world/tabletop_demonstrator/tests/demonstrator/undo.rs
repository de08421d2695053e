//! State that undo keeps. (Recordings test its exactness, at the root.)

use bevy::{ecs::entity_disabling::Disabled, prelude::*};
use tabletop_core::{History, Recording, prelude::*};

use crate::desk::{Desk, two_blocks};

#[test]
fn undo_snapshots_are_dropped_when_the_recording_ends() {
    let mut desk = Desk::new(two_blocks());
    let undoable = |desk: &Desk| desk.0.world().resource::<History>().undoable;
    desk.0.insert_resource(Recording(true));
    desk.grasp(Hand::Left, "red")
        .tell(HandCommand::Destroy(Hand::Left))
        .step(1);
    desk.tell(SceneCommand::Set(Box::default())).step(1);
    desk.tell(HistoryCommand::Undo).step(1);
    assert_eq!(undoable(&desk), 1);
    desk.0.insert_resource(Recording(false));
    desk.tell(HistoryCommand::Undo).step(1);
    assert_eq!(undoable(&desk), 0);
    let mut hidden = desk
        .0
        .world_mut()
        .query_filtered::<(), (With<ObjectSpec>, With<Disabled>)>();
    assert_eq!(hidden.iter(desk.0.world()).count(), 0);
}
