//! Still beginnings and ends, cut off.

use std::path::Path;

use tabletop_core::{Actor, RecordingCommand, SimCommand, SimTick};
use tabletop_recorder::{
    RecorderPlugin, RecordingReader, Session, SessionCommand, TICKS_PER_FRAME,
};
use tabletop_replay::Replay;
use tabletop_storage::Storage;
use tabletop_training::TrainingEpisode;

use crate::{
    composition::write_dataset,
    error::DatasetError,
    folder::{DatasetContent, DatasetFolder, inner_name},
    limits::{MARGIN_FRAMES, STILL},
    new_folder::make_folder,
};

/// The numbers of a trim.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Trim {
    /// Number of episodes.
    pub episodes: usize,
    /// Number of frames that were cut off, of all of them.
    pub frames: u64,
}

/// Makes a dataset without the still beginnings and ends of another's episodes. Recordings are simulated again, with what was done before the
/// new beginning in front of them.
///
/// # Errors
/// Another program writes to it and the storage is not to wait for that; a recording cannot be simulated again, or something cannot be read or written. Then there is no new folder.
pub fn trim(dataset: &DatasetFolder, out: &Path, storage: &Storage) -> Result<Trim, DatasetError> {
    let mut trimmed = Trim::default();
    make_folder(out, storage, |place| match &dataset.content {
        DatasetContent::Recordings(recordings) => {
            for folder in recordings {
                let to = inner_name(folder)?.below(place);
                trimmed.frames += trim_recording(folder, &to, storage)?;
                trimmed.episodes += 1;
            }
            Ok(())
        }
        DatasetContent::LeRobot(reader) => {
            let all = vec![true; reader.episodes()];
            write_dataset(
                place.to_owned(),
                vec![(&**reader, all)],
                storage,
                |episode| {
                    let before = episode.len();
                    let episode = trim_episode(episode);
                    trimmed.frames += (before - episode.len()) as u64;
                    trimmed.episodes += 1;
                    Ok(Some(episode))
                },
            )
        }
    })?;
    Ok(trimmed)
}

/// Records a recording again without its still ends. Returns the number of frames that it lost.
fn trim_recording(folder: &Path, to: &Path, storage: &Storage) -> Result<u64, DatasetError> {
    let replay = Replay::read(folder)?;
    let recording = replay.recording();
    let (first, last) = (recording.first_tick(), recording.last_tick());
    let margin = MARGIN_FRAMES * TICKS_PER_FRAME;
    let (from, until) = active_ticks(recording)?.unwrap_or((first, last));
    let from = SimTick(from.0.saturating_sub(margin)).clamp(first, last);
    let until = SimTick(until.0.saturating_add(margin)).clamp(from, last);
    if (from, until) == (first, last) {
        let copied = storage.copy_folder(folder, to);
        return copied.map_err(DatasetError::io(to)).map(|()| 0);
    }
    let trimmed = replay.with_session(between(replay.session(), from, until));
    let recorder = RecorderPlugin {
        folder: to.to_owned(),
        ..RecorderPlugin::default()
    };
    trimmed.record(recorder, replay.camera())?;
    Ok(((last.0 - first.0) - (until.0 - from.0)) / TICKS_PER_FRAME)
}

/// The session of a recording that begins and ends in other ticks.
fn between(session: &Session, from: SimTick, until: SimTick) -> Session {
    let mut session = session.clone();
    let is_before = |command: &SessionCommand| command.tick < from.0;
    let before = session
        .commands
        .iter()
        .take_while(|it| is_before(it))
        .count();
    session.earlier.extend(session.commands.drain(..before));
    session.commands.retain(|command| {
        command.tick <= until.0 && command.command != RecordingCommand::Finish.into()
    });
    session.commands.push(SessionCommand {
        tick: until.0,
        actor: Actor::Replay,
        command: RecordingCommand::Finish.into(),
        at_once: false,
    });
    session.header.start_tick = from.0;
    session.header.earlier_commands = session.earlier.len();
    session
}

/// The first and the last tick in which something moves or is done.
fn active_ticks(recording: &RecordingReader) -> Result<Option<(SimTick, SimTick)>, DatasetError> {
    let first = recording.first_tick();
    let moved = recording
        .states()?
        .into_iter()
        .filter(|row| row.twist.linear.length() > STILL || row.twist.angular.length() > STILL);
    let driven = recording
        .joints()?
        .into_iter()
        .filter(|row| row.tick > first && row.state.velocity.abs() > f64::from(STILL));
    let given = recording.session().commands.iter();
    let given = given.filter(|given| acts(&given.command));
    let ticks = moved
        .map(|row| row.tick)
        .chain(driven.map(|row| row.tick))
        .chain(given.map(|given| SimTick(given.tick)));
    Ok(ticks.fold(None, |span: Option<(SimTick, SimTick)>, tick| {
        let (from, until) = span.unwrap_or((tick, tick));
        Some((from.min(tick), until.max(tick)))
    }))
}

/// True of a command that changes the world.
fn acts(command: &SimCommand) -> bool {
    match command {
        SimCommand::Recording(_) | SimCommand::History(_) => false,
        SimCommand::Clock(_)
        | SimCommand::Scene(_)
        | SimCommand::Hand(_)
        | SimCommand::Mechanism(_)
        | SimCommand::Robot(_) => true,
    }
}

/// An episode without the frames at its ends that are like their neighbours.
fn trim_episode(episode: TrainingEpisode) -> TrainingEpisode {
    let state = episode.whole_state();
    let frames: Vec<_> = state.frames().collect();
    let changes: Vec<_> = (1..frames.len())
        .filter(|&frame| frames[frame] != frames[frame - 1])
        .collect();
    let margin = MARGIN_FRAMES as usize;
    let (Some(first), Some(last)) = (changes.first(), changes.last()) else {
        return episode;
    };
    let from = decodable(&episode, first.saturating_sub(margin + 1));
    let until = (last + margin).min(episode.len().saturating_sub(1));
    sliced(episode, from, until + 1)
}

/// The last frame up to this one from which on every video of an episode can be decoded.
fn decodable(episode: &TrainingEpisode, frame: usize) -> usize {
    let videos = || episode.cameras.iter().filter_map(|it| it.video.as_ref());
    let is_key = |&frame: &usize| {
        let mut packets = videos().map(|video| video.packets.get(frame));
        packets.all(|packet| packet.is_some_and(|packet| packet.is_key))
    };
    (0..=frame).rev().find(is_key).unwrap_or(0)
}

/// The frames of an episode from one to before another.
fn sliced(mut episode: TrainingEpisode, from: usize, until: usize) -> TrainingEpisode {
    let first = episode.ticks.get(from).copied().unwrap_or_default();
    episode.ticks = episode.ticks[from..until]
        .iter()
        .map(|tick| SimTick(tick.0 - first.0))
        .collect();
    for signal in [
        &mut episode.state,
        &mut episode.environment,
        &mut episode.action,
    ] {
        let width = signal.names.len();
        signal.values = signal.values[from * width..until * width].to_vec();
    }
    for camera in &mut episode.cameras {
        camera.images = between_frames(&camera.images, from, until);
        camera.depths = between_frames(&camera.depths, from, until);
        camera.ids = between_frames(&camera.ids, from, until);
        if let Some(video) = &mut camera.video {
            video.packets = between_frames(&video.packets, from, until);
        }
    }
    for object in &mut episode.objects {
        object.poses = object.poses[from..until].to_vec();
    }
    for part in &mut episode.subtasks {
        part.frame = part.frame.saturating_sub(from).min(until - from - 1);
    }
    episode
}

/// The values of these frames, if there are any.
fn between_frames<T: Clone>(values: &[T], from: usize, until: usize) -> Vec<T> {
    values.get(from..until).unwrap_or_default().to_vec()
}
