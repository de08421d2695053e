//! The recordings in a folder: read beside the frames, renamed, discarded, and worked on by child processes.

mod digest;
mod errand;
mod moves;

use std::{
    path::{self, Path, PathBuf},
    sync::mpsc::{Receiver, TryRecvError, channel},
    thread,
};

use bevy::{platform::cell::SyncCell, prelude::*};
use tabletop_core::{RecordingFact, SimFact, Timeline, TimelineStage};
use tabletop_user::{Notices, RecordingDigest, Shelf, ShelfOrder, ShelvedRecording, Tone};

use self::{
    digest::{Stamp, digest, recordings_in, stamp},
    errand::ErrandProcess,
    moves::{discard, rename},
};
use tabletop_recorder::write_notes;

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Reading>()
        .add_plugins(errand::plugin)
        .add_systems(Update, (look_after_recording, obey, take_digests).chain());
}

/// A digest, or the reason why there is none.
type DigestResult = Result<RecordingDigest, String>;

/// The reading of a shelf.
#[derive(Resource, Default)]
struct Reading {
    /// What comes of it, while it goes on.
    arriving: Option<SyncCell<Receiver<(PathBuf, DigestResult)>>>,
    /// The state of the files of which digests are known.
    stamps: Vec<(PathBuf, Stamp)>,
}

/// A recording that has just ended is on its shelf.
fn look_after_recording(
    mut facts: MessageReader<SimFact>,
    mut orders: MessageWriter<ShelfOrder>,
    shelf: Res<Shelf>,
) {
    for fact in facts.read() {
        if let SimFact::Recording(RecordingFact::Finished { folder, .. }) = fact
            && folder.parent() == Some(&shelf.folder)
        {
            orders.write(ShelfOrder::Look(shelf.folder.clone()));
        }
    }
}

fn obey(
    mut orders: MessageReader<ShelfOrder>,
    mut shelf: ResMut<Shelf>,
    mut reading: ResMut<Reading>,
    mut process: ResMut<ErrandProcess>,
    mut notices: ResMut<Notices>,
    timeline: Res<Timeline>,
) {
    for order in orders.read() {
        let result = match order {
            ShelfOrder::Look(folder) => {
                look(folder, &mut shelf, &mut reading, &timeline);
                continue;
            }
            ShelfOrder::Begin(errand) => process.begin(errand).map(|()| {
                notices.renew(Tone::Event, &errand.sentence());
            }),
            ShelfOrder::Cancel => {
                process.cancel();
                continue;
            }
            ShelfOrder::Rename(folder, name) => {
                free(folder, &timeline).and_then(|()| rename(folder, name))
            }
            ShelfOrder::Discard(folder) => free(folder, &timeline)
                .and_then(|()| discard(folder))
                .map(|place| {
                    let text = format!("{} is now {}", folder.display(), place.display());
                    notices.append(Tone::Event, &text);
                }),
            ShelfOrder::Note(folder, notes) => {
                write_notes(folder, notes.trim()).map_err(|error| error.to_string())
            }
        };
        if let Err(reason) = result {
            notices.renew(Tone::Fault, &reason);
        }
        let folder = shelf.folder.clone();
        look(&folder, &mut shelf, &mut reading, &timeline);
    }
}

/// True if two paths lead to one folder, whether they begin at the working folder or not.
fn is_same(one: &Path, other: &Path) -> bool {
    let [one, other] = [one, other].map(|path| path::absolute(path).ok());
    one.is_some() && one == other
}

/// Refuses to move a recording that is being made or is open.
fn free(folder: &Path, timeline: &Timeline) -> Result<(), String> {
    let is_in_use = match timeline.stage {
        TimelineStage::Running | TimelineStage::Open => is_same(&timeline.folder, folder),
        TimelineStage::Absent | TimelineStage::Finished => false,
    };
    match (is_in_use, timeline.stage) {
        (false, _) => Ok(()),
        (true, TimelineStage::Running) => Err(format!(
            "{} is being recorded; finish it first",
            folder.display()
        )),
        (true, _) => Err(format!(
            "{} is open; close it in Timeline first",
            folder.display()
        )),
    }
}

/// Lists the recordings of a folder, and begins to read those that are new or have changed.
fn look(folder: &Path, shelf: &mut Shelf, reading: &mut Reading, timeline: &Timeline) {
    let found = recordings_in(folder);
    shelf.folder = folder.to_owned();
    shelf.problem = found.as_ref().err().cloned();
    let running = (timeline.stage == TimelineStage::Running).then_some(&timeline.folder);
    let found = found.unwrap_or_default().into_iter();
    let is_running = |found: &PathBuf| running.is_some_and(|running| is_same(running, found));
    let found: Vec<_> = found.filter(|found| !is_running(found)).collect();
    let stamps: Vec<_> = found
        .iter()
        .map(|found| (found.clone(), stamp(found)))
        .collect();
    let known = |at: &(PathBuf, Stamp)| {
        let is_same = reading.stamps.contains(at);
        let mut known = shelf.recordings.iter().filter(|_| is_same);
        known.find(|known| known.folder == at.0)?.digest.clone()
    };
    let recordings: Vec<_> = stamps
        .iter()
        .map(|at| ShelvedRecording {
            name: at
                .0
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into(),
            folder: at.0.clone(),
            digest: known(at),
        })
        .collect();
    let unread = recordings
        .iter()
        .filter(|recording| recording.digest.is_none());
    reading.begin(unread.map(|recording| recording.folder.clone()).collect());
    reading.stamps = stamps;
    shelf.recordings = recordings;
}

impl Reading {
    /// Reads these recordings on a thread of their own. What was being read before is not read on.
    fn begin(&mut self, folders: Vec<PathBuf>) {
        self.arriving = None;
        if folders.is_empty() {
            return;
        }
        let (sender, arriving) = channel();
        let read = move || {
            for folder in folders {
                let digest = digest(&folder);
                if sender.send((folder, digest)).is_err() {
                    return;
                }
            }
        };
        if thread::Builder::new().spawn(read).is_ok() {
            self.arriving = Some(SyncCell::new(arriving));
        }
    }
}

fn take_digests(mut reading: ResMut<Reading>, mut shelf: ResMut<Shelf>) {
    let reading = reading.bypass_change_detection();
    while let Some(arriving) = &mut reading.arriving {
        match arriving.get().try_recv() {
            Ok((folder, digest)) => {
                let mut recordings = shelf.recordings.iter_mut();
                if let Some(read) = recordings.find(|recording| recording.folder == folder) {
                    read.digest = Some(digest);
                }
            }
            Err(TryRecvError::Empty) => return,
            Err(TryRecvError::Disconnected) => reading.arriving = None,
        }
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::CorePlugin;
    use tabletop_user::UserPlugin;

    use super::*;
    use crate::test_folder::TestFolder;

    struct Desk {
        app: App,
        folder: TestFolder,
    }

    impl Desk {
        /// A shelf with these recordings, none of which can be read.
        fn new(name: &str, recordings: &[&str]) -> Self {
            let folder = TestFolder::new(&format!("desk-{name}"));
            for recording in recordings {
                folder.write(&format!("{recording}/session.jsonl"), "nothing");
            }
            folder.write("no recording/notes.txt", "");
            let mut app = App::new();
            app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin, plugin))
                .init_resource::<Notices>();
            let mut desk = Self { app, folder };
            let look = ShelfOrder::Look(desk.folder.to_owned());
            desk.order(look);
            desk
        }

        fn order(&mut self, order: ShelfOrder) {
            self.app.world_mut().write_message(order);
            self.app.update();
            while self.shelf().recordings.iter().any(|it| it.digest.is_none()) {
                thread::yield_now();
                self.app.update();
            }
        }

        fn shelf(&self) -> &Shelf {
            self.app.world().resource()
        }

        fn names(&self) -> Vec<&str> {
            let recordings = self.shelf().recordings.iter();
            let mut names: Vec<_> = recordings.map(|it| it.name.as_str()).collect();
            names.sort_unstable();
            names
        }

        fn notices(&self) -> Vec<String> {
            let notices = self.app.world().resource::<Notices>();
            notices.iter().map(str::to_owned).collect()
        }
    }

    #[test]
    fn recordings_are_listed_renamed_and_discarded() {
        let mut desk = Desk::new("moved", &["a-01", "a-02", ".hidden"]);
        assert_eq!(desk.names(), ["a-01", "a-02"]);
        let unreadable = desk.shelf().recordings[0].digest.as_ref().unwrap();
        let fault = unreadable.as_ref().unwrap_err();
        assert!(fault.contains("session.jsonl"), "{fault}");
        let first = desk.folder.join("a-01");
        desk.order(ShelfOrder::Rename(first.clone(), "a-02".into()));
        assert_eq!(desk.names(), ["a-01", "a-02"]);
        assert!(desk.notices()[0].contains("exists already"));
        desk.order(ShelfOrder::Rename(first, "best".into()));
        assert_eq!(desk.names(), ["a-02", "best"]);
        let best = desk.folder.join("best");
        desk.order(ShelfOrder::Discard(best));
        assert_eq!(desk.names(), ["a-02"]);
        assert!(desk.folder.join("trash/best/session.jsonl").is_file());
    }

    #[test]
    fn a_recording_in_use_stays_where_it_is() {
        let mut desk = Desk::new("used", &["a-01"]);
        let folder = desk.folder.join("a-01");
        for stage in [TimelineStage::Open, TimelineStage::Running] {
            let mut timeline = desk.app.world_mut().resource_mut::<Timeline>();
            timeline.stage = stage;
            timeline.folder.clone_from(&folder);
            desk.order(ShelfOrder::Discard(folder.clone()));
            assert!(folder.join("session.jsonl").is_file());
        }
        assert_eq!(desk.notices().len(), 2);
    }

    #[test]
    fn a_path_from_the_working_folder_on_leads_to_the_same_folder() {
        let whole = std::env::current_dir().unwrap().join("a-01");
        assert!(is_same("a-01".as_ref(), &whole));
        assert!(is_same(&whole, "./a-01".as_ref()));
        assert!(!is_same("a-02".as_ref(), &whole));
    }

    #[test]
    fn a_folder_that_cannot_be_read_says_so() {
        let mut desk = Desk::new("absent", &[]);
        let absent = desk.folder.join("absent");
        desk.order(ShelfOrder::Look(absent));
        let problem = desk.shelf().problem.as_ref().unwrap();
        assert!(problem.contains("cannot be read"), "{problem}");
    }
}
