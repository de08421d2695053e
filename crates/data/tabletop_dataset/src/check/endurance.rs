//! Whether what was done lasts: the recording is simulated to its end and on.

use std::collections::BTreeMap;

use bevy::prelude::*;
use tabletop_core::{
    ClockCommand, ObjectIndex, ObjectSpec, StepApp as _, TICKS_PER_SECOND, WriteCommand as _,
};
use tabletop_geometry::Pose;
use tabletop_recorder::{RecorderPlugin, RecordingReader, UnrecordedPlugin};
use tabletop_replay::{Player, Replay};
use tabletop_sim::headless_app_with;
use tabletop_task::{Arrangement, Demonstration, Task};

use crate::{
    check::finding::Findings,
    error::DatasetError,
    limits::{SECONDS_AFTER, STILL_THERE},
};

/// Finds steps of a recording's task that no longer hold some seconds after its end.
pub(super) fn outlived(
    recording: &RecordingReader,
    findings: &mut Findings,
) -> Result<(), DatasetError> {
    let task = Task::of(&Demonstration::of(recording)?);
    if task.steps.is_empty() {
        return Ok(());
    }
    let replay = Replay::read(recording.folder())?;
    let plugins = replay.plugins().disable::<RecorderPlugin>();
    let mut app = headless_app_with(plugins.add(UnrecordedPlugin));
    replay.play_in(&mut app);
    while !app.world().resource::<Player>().is_over() {
        app.step(1);
    }
    let end = StandingObjects::of(&mut app);
    app.world_mut()
        .write_command(ClockCommand::SetPaused(false));
    app.step(SECONDS_AFTER * u64::from(TICKS_PER_SECOND));
    let later = StandingObjects::of(&mut app);
    for step in task.steps.iter().filter(|step| step.goal.is_some()) {
        if end.stands(&step.object) != later.stands(&step.object)
            || end.way(&later, &step.object) > STILL_THERE
        {
            findings.add(format!(
                "step {} no longer holds {SECONDS_AFTER} s after the end: {}",
                step.number, step.sentence
            ));
        }
    }
    Ok(())
}

/// The objects of a world, with their poses.
struct StandingObjects(BTreeMap<String, (ObjectSpec, Pose)>);

/// What an object stands on, in and around, by ids; and whether it is on the table.
type Standing = ([Vec<String>; 3], bool);

impl StandingObjects {
    fn of(app: &mut App) -> Self {
        let world = app.world();
        let index = world.resource::<ObjectIndex>();
        let objects = index.ids().filter_map(|id| {
            let entity = world.get_entity(index.get(id)?).ok()?;
            let pose = Pose::from(entity.get::<Transform>()?);
            Some((id.to_owned(), (entity.get::<ObjectSpec>()?.clone(), pose)))
        });
        Self(objects.collect())
    }

    fn stands(&self, id: &str) -> Option<Standing> {
        self.0.get(id)?;
        let objects = self.0.iter();
        let arrangement =
            Arrangement::new(objects.map(|(id, (spec, pose))| (id.as_str(), &spec.shape, *pose)));
        let owned = |mut ids: Vec<&str>| {
            ids.sort_unstable();
            ids.into_iter().map(str::to_owned).collect()
        };
        let around = [
            owned(arrangement.supports(id)),
            owned(arrangement.containers(id)),
            owned(arrangement.posts(id)),
        ];
        Some((around, arrangement.is_on_table(id)))
    }

    /// How far an object is from where it is later, in units.
    fn way(&self, later: &Self, id: &str) -> f32 {
        match (self.0.get(id), later.0.get(id)) {
            (Some((_, here)), Some((_, there))) => here.location.distance(there.location),
            (None, _) | (_, None) => 0.0,
        }
    }
}
