//! Edits of the open recording. Each is simulated beside the frames of the window and makes a draft, which then is opened.

mod drafts;
mod simulation;

use std::path::{Path, PathBuf};

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{
    OpenRecording, Paused, Playback, PlaybackOrder, SimTick, Timeline, TimelineStage,
};
use tabletop_user::{EditOrder, Editing, Notices, Tone};
use tabletop_xml::AllowedFolders;

use self::{
    drafts::Drafts,
    simulation::{EditSimulation, Simulated},
};

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Drafts>()
        .init_resource::<PresentEdit>()
        .add_systems(
            Update,
            (obey, take_result, warn_of_unsaved, publish).chain(),
        );
}

/// The simulation that goes on, if one does.
#[derive(Resource, Default)]
struct PresentEdit(Option<EditSimulation>);

/// Opens a recording at the moment at which the world is.
#[derive(SystemParam)]
struct Opener<'w> {
    open: MessageWriter<'w, OpenRecording>,
    orders: MessageWriter<'w, PlaybackOrder>,
    playback: Res<'w, Playback>,
    tick: Res<'w, SimTick>,
    paused: Res<'w, Paused>,
}

impl Opener<'_> {
    fn open_some(&mut self, folder: Option<&Path>) {
        if let Some(folder) = folder {
            self.open(folder);
        }
    }

    fn open(&mut self, folder: &Path) {
        let shown = SimTick(self.tick.0.saturating_sub(1));
        let moment = self.playback.goal.unwrap_or(shown);
        self.open.write(OpenRecording(folder.to_owned()));
        let stands_still = self.paused.0 || self.playback.goal.is_some();
        self.orders.write(match stands_still {
            true => PlaybackOrder::StopAt(moment),
            false => PlaybackOrder::GoTo(moment),
        });
    }
}

/// Carries out the user's orders.
fn obey(
    mut orders: MessageReader<EditOrder>,
    mut simulation: ResMut<PresentEdit>,
    mut notices: ResMut<Notices>,
    mut opener: Opener,
    drafts: Res<Drafts>,
    timeline: Res<Timeline>,
    allowed: Res<AllowedFolders>,
) {
    for order in orders.read() {
        if timeline.stage != TimelineStage::Open {
            continue;
        }
        if simulation.0.is_some() {
            let reason = "a recording is being edited; wait until that is done";
            notices.renew(Tone::Warning, reason);
            continue;
        }
        let source = &timeline.folder;
        let original = drafts.original(source);
        let mut allowed = allowed.0.clone();
        // The robot of a draft has its meshes beside the original.
        allowed.push(original.to_owned());
        match order {
            EditOrder::Edit(edit) => {
                simulation.0 = Some(EditSimulation::edit(&timeline, edit.clone(), allowed));
            }
            EditOrder::Save => {
                let place = place_beside(original);
                simulation.0 = Some(EditSimulation::save(source.clone(), place, allowed));
            }
            EditOrder::Undo => opener.open_some(drafts.before(source)),
            EditOrder::Redo => opener.open_some(drafts.after(source)),
        }
    }
}

/// The folder of an edited recording: that of the original, with another end of its name.
fn place_beside(original: &Path) -> PathBuf {
    let original = std::path::absolute(original).unwrap_or(original.to_owned());
    let mut name = original.file_name().unwrap_or_default().to_owned();
    name.push("-edited");
    original.with_file_name(name)
}

/// Opens what an edit has made, says where a recording is saved, or gives the reason why neither is so.
fn take_result(
    mut simulation: ResMut<PresentEdit>,
    mut drafts: ResMut<Drafts>,
    mut notices: ResMut<Notices>,
    mut opener: Opener,
    timeline: Res<Timeline>,
) {
    let simulation = simulation.bypass_change_detection();
    let Some(present) = &mut simulation.0 else {
        return;
    };
    let Some(result) = present.work.result() else {
        return;
    };
    let source = &present.source;
    let is_open = timeline.stage == TimelineStage::Open && timeline.folder == *source;
    match result {
        Err(reason) => {
            let reason = format!("{}: {reason}", present.refusal);
            notices.renew(Tone::Warning, &reason);
        }
        Ok(Simulated::Edited(draft)) if is_open => {
            opener.open(&draft.folder);
            drafts.add(source, draft);
        }
        Ok(Simulated::Edited(_)) => {
            let reason = "the edited recording is no longer open; the edit is given up";
            notices.renew(Tone::Warning, reason);
        }
        Ok(Simulated::Saved {
            folder,
            moved_aside,
        }) => {
            drafts.note_saved(source);
            let folder = folder.display();
            let saved = format!("the edited recording is saved in {folder}");
            notices.renew(Tone::Event, &saved);
            for moved in moved_aside {
                let (from, to) = (moved.from.display(), moved.to.display());
                let moved = format!("{from}: the earlier recording there is now {to}");
                notices.renew(Tone::Event, &moved);
            }
        }
    }
    simulation.0 = None;
}

/// Says how edits are found again whose recording is no longer open.
fn warn_of_unsaved(
    timeline: Res<Timeline>,
    drafts: Res<Drafts>,
    mut last: Local<Option<PathBuf>>,
    mut notices: ResMut<Notices>,
) {
    let open = (timeline.stage == TimelineStage::Open).then_some(&timeline.folder);
    if last.as_ref() == open {
        return;
    }
    let left = std::mem::replace(&mut *last, open.cloned());
    let Some(left) = left.filter(|left| drafts.is_unsaved(left)) else {
        return;
    };
    let original = drafts.original(&left);
    if open.is_none_or(|open| drafts.original(open) != original) {
        let original = original.display();
        let warning = format!(
            "{original}: its edits are not saved; open it and redo them, before you edit another recording, to save them"
        );
        notices.renew(Tone::Warning, &warning);
    }
}

/// Publishes the state of the edits for the panels.
fn publish(
    simulation: Res<PresentEdit>,
    drafts: Res<Drafts>,
    timeline: Res<Timeline>,
    mut editing: ResMut<Editing>,
) {
    let is_open = timeline.stage == TimelineStage::Open;
    let (undoable, redoable) = match is_open {
        true => drafts.undoable_and_redoable(&timeline.folder),
        false => (0, 0),
    };
    editing.set_if_neq(Editing {
        present: simulation.0.as_ref().map(|present| present.present.clone()),
        undoable,
        redoable,
        is_unsaved: is_open && drafts.is_unsaved(&timeline.folder),
    });
}

#[cfg(test)]
mod tests {
    use std::{fs, thread, time::Duration};

    use bevy::time::TimeUpdateStrategy;
    use tabletop_core::{
        Hand, HandCommand, HeadCamera, RecordingCommand, SceneCommand, SimCommand, TICK_SECONDS,
        WriteCommand as _,
    };
    use tabletop_recorder::RecorderPlugin;
    use tabletop_replay::{PlaybackPlugin, Replay};
    use tabletop_user::{TimelineEdit, UserPlugin};

    use super::*;
    use tabletop_sim::TabletopSimPlugins;

    use crate::test_folder::TestFolder;

    /// A window without a picture, in which a recording of two blocks is open that are lifted and let go, one after the other.
    struct Desk {
        app: App,
        folder: TestFolder,
    }

    impl Desk {
        fn new(name: &str) -> Self {
            let folder = TestFolder::new(&format!("editing-{name}"));
            let recorder = RecorderPlugin {
                folder: folder.join("demo"),
                ..default()
            };
            let mut app = App::new();
            app.add_plugins((
                MinimalPlugins,
                TabletopSimPlugins.build().set(recorder),
                UserPlugin,
                PlaybackPlugin {
                    task: "tablesetup/default.xml".into(),
                },
                plugin,
            ))
            .init_resource::<AllowedFolders>()
            .init_resource::<Notices>()
            .insert_resource(HeadCamera {
                width: 40,
                height: 30,
                ..default()
            })
            .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(
                TICK_SECONDS,
            )));
            app.finish();
            app.cleanup();
            let mut desk = Self { app, folder };
            desk.give(SceneCommand::Load("tablesetup/default.xml".into()), 30);
            desk.give(RecordingCommand::Start, 20);
            desk.handle("RedBlock", Vec3::new(2.0, 2.0, 2.0));
            desk.handle("GreenBlock", Vec3::new(-2.0, 2.0, 2.0));
            desk.give(RecordingCommand::Finish, 2);
            desk.app
                .world_mut()
                .write_message(OpenRecording(desk.folder.join("demo")));
            desk.arrive();
            desk
        }

        fn give(&mut self, command: impl Into<SimCommand>, frames: usize) {
            self.app.world_mut().write_command(command);
            self.frames(frames);
        }

        fn handle(&mut self, object: &str, location: Vec3) {
            let hand = Hand::Right;
            let object = object.to_owned();
            self.give(HandCommand::Grasp { hand, object }, 5);
            self.give(HandCommand::MoveTo { hand, location }, 40);
            self.give(HandCommand::Release(hand), 60);
        }

        fn frames(&mut self, frames: usize) {
            (0..frames).for_each(|_| self.app.update());
        }

        /// Waits until a recording is open and the world is where it was to go.
        fn arrive(&mut self) {
            self.frames(3);
            while self.app.world().resource::<Playback>().goal.is_some() {
                self.app.update();
            }
        }

        /// Gives an order, and waits until it is carried out.
        fn order(&mut self, order: EditOrder) {
            self.app.world_mut().write_message(order);
            self.app.update();
            while self.editing().present.is_some() {
                self.app.update();
                thread::sleep(Duration::from_millis(1));
            }
            self.arrive();
        }

        fn edit(&mut self, edit: TimelineEdit) {
            self.order(EditOrder::Edit(edit));
        }

        fn editing(&self) -> Editing {
            self.app.world().resource::<Editing>().clone()
        }

        fn timeline(&self) -> Timeline {
            self.app.world().resource::<Timeline>().clone()
        }

        /// The acts of the open recording, in words.
        fn acts(&self) -> Vec<String> {
            let segments = self.timeline().segments;
            let acts = segments.into_iter().filter_map(|segment| segment.act);
            acts.map(|act| act.to_string()).collect()
        }

        fn notices(&self) -> Vec<String> {
            let notices = self.app.world().resource::<Notices>();
            notices.iter().map(str::to_owned).collect()
        }
    }

    const RED: [&str; 2] = ["RightHand grasps RedBlock", "RightHand releases RedBlock"];
    const GREEN: [&str; 2] = [
        "RightHand grasps GreenBlock",
        "RightHand releases GreenBlock",
    ];

    #[test]
    fn an_edited_recording_is_saved_beside_the_original_and_replays() {
        let mut desk = Desk::new("saved");
        assert_eq!(desk.acts(), [RED, GREEN].concat());
        let original = fs::read(desk.folder.join("demo/session.jsonl")).unwrap();
        desk.edit(TimelineEdit::Swap(3..=4, 1..=2));
        assert_eq!(desk.acts(), [GREEN, RED].concat());
        let ticks = desk.timeline().ticks_of(1);
        desk.edit(TimelineEdit::Retime {
            segment: 1,
            ticks: 2 * ticks,
        });
        assert_eq!(desk.timeline().ticks_of(1), 2 * ticks);
        desk.edit(TimelineEdit::Delete(3..=4));
        assert_eq!(desk.acts(), GREEN);
        assert!(desk.editing().is_unsaved);
        let saved = desk.folder.join("demo-edited");
        assert!(!saved.exists());
        desk.order(EditOrder::Save);
        let notice = format!("the edited recording is saved in {}", saved.display());
        assert_eq!(desk.notices(), [notice]);
        assert!(!desk.editing().is_unsaved);
        let replay = Replay::read(&saved).unwrap();
        assert_eq!(replay.verify(|_| true).unwrap(), None);
        let now = fs::read(desk.folder.join("demo/session.jsonl")).unwrap();
        assert_eq!(now, original, "the original stays");
        desk.order(EditOrder::Undo);
        desk.order(EditOrder::Save);
        let earlier = desk.folder.join("demo-edited-1");
        assert_eq!(
            desk.notices()[1..],
            [format!(
                "{}: the earlier recording there is now {}",
                saved.display(),
                earlier.display()
            )],
            "and it is said where the recording is now"
        );
    }

    #[test]
    fn edits_are_undone_and_redone_at_the_same_moment() {
        let mut desk = Desk::new("undone");
        let moment = SimTick(desk.timeline().start.0 + 25);
        let stop = PlaybackOrder::StopAt(moment);
        desk.app.world_mut().write_message(stop);
        desk.arrive();
        desk.frames(3);
        let counts = |desk: &Desk| {
            let editing = desk.editing();
            (editing.undoable, editing.redoable)
        };
        desk.edit(TimelineEdit::Delete(3..=4));
        assert_eq!(
            (desk.acts(), counts(&desk)),
            (RED.map(str::to_owned).into(), (1, 0))
        );
        for (order, acts, expected) in [
            (EditOrder::Undo, 4, (0, 1)),
            (EditOrder::Undo, 4, (0, 1)),
            (EditOrder::Redo, 2, (1, 0)),
            (EditOrder::Redo, 2, (1, 0)),
        ] {
            desk.order(order);
            assert_eq!((desk.acts().len(), counts(&desk)), (acts, expected));
            assert_eq!(desk.app.world().resource::<SimTick>().0, moment.0 + 1);
        }
    }

    #[test]
    fn a_refused_edit_gives_its_reason_and_changes_nothing() {
        let mut desk = Desk::new("refused");
        let before = desk.timeline();
        for (edit, reason) in [
            (
                TimelineEdit::Delete(1..=1),
                "segment 2: the release of RedBlock does not happen any more",
            ),
            (
                TimelineEdit::Delete(7..=7),
                "there is no segment 7 to edit; the recording has segments 1 to 4",
            ),
            (
                TimelineEdit::Retime {
                    segment: 2,
                    ticks: 1_000_000,
                },
                "expected 0.01 to 100",
            ),
        ] {
            desk.edit(edit);
            let notices = desk.notices();
            let last = notices.last().unwrap();
            assert!(last.starts_with("the edit is refused: "), "{last}");
            assert!(last.ends_with(reason), "{last}");
            assert_eq!(desk.timeline(), before);
            assert_eq!(desk.editing(), Editing::default());
        }
    }

    #[test]
    fn unsaved_edits_are_found_again_after_the_recording_was_closed() {
        let mut desk = Desk::new("closed");
        desk.edit(TimelineEdit::Delete(3..=4));
        desk.order(EditOrder::Undo);
        assert_eq!(desk.notices().len(), 0);
        desk.order(EditOrder::Redo);
        desk.app.world_mut().write_message(PlaybackOrder::Close);
        desk.frames(3);
        let [warning] = &desk.notices()[..] else {
            panic!("{:?}", desk.notices());
        };
        assert!(
            warning.contains("demo: its edits are not saved"),
            "{warning}"
        );
        let original = OpenRecording(desk.folder.join("demo"));
        desk.app.world_mut().write_message(original);
        desk.arrive();
        desk.order(EditOrder::Redo);
        assert_eq!(desk.acts(), RED);
    }
}
