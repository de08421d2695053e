//! A recording that is opened in a window.

use std::{path::Path, time::Duration};

use bevy::{prelude::*, time::TimeUpdateStrategy};
use tabletop::{
    core::{OpenRecording, Playback, PlaybackOrder, TICK_SECONDS, Timeline},
    prelude::*,
    recorder::{RecorderPlugin, RecordingReader},
    replay::PlaybackPlugin,
    user::PacePlugin,
};

use super::road::Cell;

/// Most frames until the world is where it was to go.
const PATIENCE: usize = 20_000;

/// How far a pose may be from the recorded one: original recordings have few digits.
const NEAR: f32 = 1e-3;

/// Opens a recording in a window without a picture, and looks at its last moment, its first, and one between: the world must be as it was.
pub fn open(folder: &Path) -> Result<Cell, String> {
    let mut app = window(&folder.with_extension("window"));
    app.world_mut()
        .write_message(OpenRecording(folder.to_owned()));
    app.update();
    if let Some(reason) = refusal(app.world()) {
        let name = folder.to_str().unwrap_or_default();
        return Ok(Cell::Refused(reason.replace(name, "DIR")));
    }
    let recording = RecordingReader::open(folder).map_err(|error| error.to_string())?;
    let timeline = app.world().resource::<Timeline>();
    let (start, end) = (timeline.start.0, timeline.end.0);
    for tick in [end, start, start.midpoint(end)] {
        app.world_mut()
            .write_message(PlaybackOrder::StopAt(SimTick(tick)));
        app.update();
        arrive(&mut app)?;
        compare(app.world(), &recording, SimTick(tick))?;
    }
    Ok(Cell::Right)
}

fn window(folder: &Path) -> App {
    let recorder = RecorderPlugin {
        folder: folder.to_owned(),
        ..default()
    };
    let playback = PlaybackPlugin {
        task: "tablesetup/tower.xml".into(),
    };
    let plugins = TabletopSimPlugins.build().set(recorder);
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, plugins.add(PacePlugin).add(playback)))
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(
            TICK_SECONDS,
        )));
    app.finish();
    app.cleanup();
    app.update();
    app
}

fn refusal(world: &World) -> Option<String> {
    let facts = world.resource::<Messages<SimFact>>();
    let mut facts = facts.iter_current_update_messages();
    facts.find_map(|fact| {
        let SimFact::Refused { reason, .. } = fact else {
            return None;
        };
        Some(reason.to_string())
    })
}

fn arrive(app: &mut App) -> Result<(), String> {
    for _ in 0..PATIENCE {
        if app.world().resource::<Playback>().goal.is_none() {
            return Ok(());
        }
        app.update();
    }
    Err("the window never arrives".into())
}

fn compare(world: &World, recording: &RecordingReader, tick: SimTick) -> Result<(), String> {
    let index = world.resource::<ObjectIndex>();
    let states = recording
        .states_at(tick)
        .map_err(|error| error.to_string())?;
    for (id, row) in states {
        let shown = index
            .get(&id)
            .and_then(|object| world.get::<Transform>(object));
        let Some(shown) = shown else {
            continue;
        };
        let away = shown.translation.distance(row.pose.location);
        if away > NEAR {
            return Err(format!(
                "{id} is {away} away from where it was in tick {}",
                tick.0
            ));
        }
    }
    Ok(())
}
