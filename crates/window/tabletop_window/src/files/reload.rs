//! Reloading of the task file on the table when another program has changed it.

use std::{
    path::{Path, PathBuf},
    time::{Duration, SystemTime},
};

use bevy::{prelude::*, time::common_conditions::on_real_timer};
use tabletop_core::{
    Actor, CommandWriter, OpenRecording, Recording, Replaying, SceneCommand, SceneFact, SimFact,
};
use tabletop_gui::{Files, Preferences};

use tabletop_sim::shipped::task_reader;
use tabletop_user::{Notices, Tone};
use tabletop_xml::AllowedFolders;

/// Time between checks of the file.
const PERIOD: Duration = Duration::from_millis(700);

/// Its name in the [`Preferences`].
const CONCERN: &str = "reload";

/// The task file on the table and the files that it includes, as they were when they were loaded or saved.
#[derive(Resource, Debug, Default)]
pub(super) struct Watch {
    task: Option<PathBuf>,
    files: Vec<(PathBuf, Option<Stamp>)>,
}

/// The properties that change when a file is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Stamp {
    length: u64,
    modified: Option<SystemTime>,
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Watch>()
        .add_systems(Startup, recall_setting)
        .add_systems(
            Update,
            (note_loaded, reload.run_if(on_real_timer(PERIOD))).chain(),
        );
}

impl Stamp {
    fn of(path: &Path) -> Option<Self> {
        let file = path.metadata().ok()?;
        Some(Self {
            length: file.len(),
            modified: file.modified().ok(),
        })
    }
}

impl Watch {
    /// Begins to watch these files of the task on the table.
    fn begin(&mut self, task: &Path, files: Vec<PathBuf>) {
        self.task = Some(task.to_owned());
        let stamped = |file: PathBuf| {
            let stamp = Stamp::of(&file);
            (file, stamp)
        };
        self.files = files.into_iter().map(stamped).collect();
    }

    /// Notes that the program itself has written this file.
    pub fn note_saved(&mut self, path: &Path) {
        for (watched, stamp) in &mut self.files {
            if is_same(watched, path) {
                *stamp = Stamp::of(path);
            }
        }
    }

    /// The task file, if one of its files has changed since the last check, and it exists.
    fn take_change(&mut self) -> Option<PathBuf> {
        let mut has_changed = false;
        for (file, stamp) in &mut self.files {
            if let Some(now) = Stamp::of(file).filter(|now| Some(*now) != *stamp) {
                *stamp = Some(now);
                has_changed = true;
            }
        }
        self.task.clone().filter(|_| has_changed)
    }
}

fn is_same(one: &Path, other: &Path) -> bool {
    let there = |path: &Path| path.canonicalize().unwrap_or(path.to_owned());
    there(one) == there(other)
}

fn recall_setting(
    preferences: Res<Preferences>,
    mut files: ResMut<Files>,
    mut notices: ResMut<Notices>,
) {
    match preferences.read(CONCERN) {
        Ok(reloads) => files.reloads = reloads.unwrap_or_default(),
        Err(error) => notices.add(Tone::Warning, &error.to_string()),
    }
}

/// Keeps the user's choice.
pub(super) fn keep_setting(world: &mut World, reloads: bool) {
    world.resource_mut::<Files>().reloads = reloads;
    if let Err(error) = world.resource::<Preferences>().keep(CONCERN, &reloads) {
        let mut notices = world.resource_mut::<Notices>();
        notices.add(Tone::Warning, &error.to_string());
    }
}

fn note_loaded(
    mut facts: MessageReader<SimFact>,
    mut recordings: MessageReader<OpenRecording>,
    allowed: Res<AllowedFolders>,
    mut watch: ResMut<Watch>,
) {
    for fact in facts.read() {
        if let SimFact::Scene(SceneFact::TaskLoaded { path, .. }) = fact {
            let files = match task_reader().allowing(&allowed.0).read(path) {
                Ok(task) => task.files,
                Err(_) => vec![path.clone()],
            };
            watch.begin(path, files);
        }
    }
    if recordings.read().count() > 0 {
        *watch = Watch::default();
    }
}

/// Loads the file again if it has changed. An editor may have written only half of it, which then has a fault: the world stays.
pub(super) fn reload(
    files: Res<Files>,
    recording: Res<Recording>,
    replaying: Res<Replaying>,
    allowed: Res<AllowedFolders>,
    mut watch: ResMut<Watch>,
    mut notices: ResMut<Notices>,
    mut commands: CommandWriter,
) {
    if !files.reloads || replaying.0 {
        return;
    }
    let Some(path) = watch.take_change() else {
        return;
    };
    let fault = match task_reader().allowing(&allowed.0).read(&path) {
        Ok(task) => task.faults.first().map(ToString::to_string),
        Err(error) => Some(error.to_string()),
    };
    let name = path.display();
    match fault {
        Some(fault) => notices.renew(
            Tone::Fault,
            &format!("{name} has changed and is not loaded: {fault}"),
        ),
        None if recording.0 => notices.renew(
            Tone::Warning,
            &format!("{name} has changed; it is not loaded while a recording runs"),
        ),
        None => {
            commands.write(Actor::Panel, SceneCommand::Load(path));
        }
    }
}
