//! Episodes, read from recordings.

use std::path::Path;

use tabletop_core::{SimTick, TICKS_PER_SECOND};
use tabletop_program::Meaning;
use tabletop_recorder::{JointRow, RecordingReader};
use tabletop_replay::Replay;
use tabletop_task::{Demonstration, Requirements, Task};

use crate::{
    action::{end_effector_motions, hand_motions},
    camera_track::{filmed_cameras, recorded_cameras},
    episode::{EncodedVideo, FrameVectors, ObjectTrack, Subtask, TrainingEpisode},
    error::EpisodeError,
    grip_track::GripTrack,
    hand_track::{HANDS, HandTrack},
    selection::{ActionKind, EpisodeSelection, StateKind},
};

impl TrainingEpisode {
    /// Reads a recording. Frames in which nothing has changed have the picture of the frame before.
    ///
    /// # Errors
    /// A file cannot be read, or the recording has no pictures.
    pub fn read(folder: &Path, selection: &EpisodeSelection) -> Result<Self, EpisodeError> {
        let recording = RecordingReader::open(folder)?;
        let shown = Demonstration::of(&recording)?;
        let mut task = Task::of(&shown);
        let requirements = Requirements::read_for(&task, folder)?;
        task.phrase(&requirements);

        let ticks_per_frame = recording.header().ticks_per_frame.max(1);
        let recorded_fps = TICKS_PER_SECOND / ticks_per_frame as u32;
        let pictures = &selection.pictures;
        let fps = pictures.fps.unwrap_or(recorded_fps);
        let ticks = frame_ticks(&recording, u64::from(TICKS_PER_SECOND / fps.max(1)));
        let rows = recording.joints()?;
        let joints = joint_positions(&rows, &ticks);
        let robot_acts = is_moved(&joints);
        let hands = HandTrack::all(&shown);
        let state = match selection.state {
            Some(kind) => kind,
            None if robot_acts => StateKind::Robot,
            None => StateKind::Objects,
        };
        let action = match selection.action {
            Some(kind) => kind,
            None if robot_acts => ActionKind::Joints,
            None => ActionKind::Hands,
        };
        let objects = object_tracks(&shown, &ticks);
        let (state, environment) = match state {
            StateKind::Robot => (joints.clone(), FrameVectors::default()),
            StateKind::Objects => {
                let poses = object_poses(&objects, ticks.len());
                let hands = hand_states(&shown, &hands, &ticks);
                (poses.beside(&hands), FrameVectors::default())
            }
            StateKind::Both => (joints.clone(), object_poses(&objects, ticks.len())),
        };
        let action_kind = action;
        let mut replay = None;
        let grips = GripTrack::of(&shown);
        let mut orders = || -> Result<FrameVectors, EpisodeError> {
            if !grips.grips() {
                return Ok(joints.clone());
            }
            let replay = replay_of(&mut replay, folder, selection)?;
            Ok(grips.orders(&joints, replay.robot().layout(), &ticks))
        };
        let action = match action {
            ActionKind::Hands => hand_motions(&shown, &hands, &ticks),
            ActionKind::Joints => shifted(&orders()?),
            ActionKind::EndEffectors => {
                let orders = orders()?;
                let replay = replay_of(&mut replay, folder, selection)?;
                end_effector_motions(replay, &joints, &orders)?
            }
        };
        let mut cameras = match &pictures.cameras {
            Some(cameras) if cameras.is_empty() => Vec::new(),
            None if pictures.are_recorded(recorded_fps) => {
                recorded_cameras(&recording, ticks.len())?
            }
            Some(_) | None => {
                let replay = replay_of(&mut replay, folder, selection)?;
                filmed_cameras(replay, &shown, pictures, &ticks)?
            }
        };
        if pictures.has_video {
            for camera in &mut cameras {
                camera.video = Some(EncodedVideo::of(&camera.images, fps)?);
            }
        }
        let frame_of = |tick: SimTick| ticks.partition_point(|at| *at < tick).min(ticks.len() - 1);
        let subtasks = task.parts(recording.first_tick());
        let subtasks = subtasks.into_iter().map(|(tick, sentence)| Subtask {
            frame: frame_of(tick),
            sentence,
        });
        let mut paraphrases = task.paraphrases();
        if selection.has_program {
            paraphrases.extend(meant(&shown, &task));
        }
        Ok(Self {
            folder: folder.to_owned(),
            fps,
            state,
            environment,
            action,
            action_kind,
            objects,
            cameras,
            paraphrases,
            task: task.instruction(),
            subtasks: subtasks.collect(),
            ticks,
        })
    }
}

/// The sentences of the program that a demonstration means, if that is more than its steps.
fn meant(shown: &Demonstration, task: &Task) -> Option<String> {
    let program = Meaning::beyond_steps(shown, task)?.program?;
    Some(program.in_a_line())
}

/// The recording to be simulated again, read once.
fn replay_of<'r>(
    replay: &'r mut Option<Replay>,
    folder: &Path,
    selection: &EpisodeSelection,
) -> Result<&'r Replay, EpisodeError> {
    match replay {
        Some(replay) => Ok(replay),
        None => Ok(replay.insert(Replay::read_allowing(folder, &selection.allowed)?)),
    }
}

/// The ticks whose ends the frames show: at equal intervals, and the last one.
fn frame_ticks(recording: &RecordingReader, step: u64) -> Vec<SimTick> {
    let (first, last) = (recording.first_tick().0, recording.last_tick().0);
    let step = step.max(1);
    let frames = last.saturating_sub(first).div_ceil(step);
    (0..=frames)
        .map(|frame| SimTick((first + frame * step).min(last)))
        .collect()
}

/// The positions of all joints at each frame.
fn joint_positions(rows: &[JointRow], ticks: &[SimTick]) -> FrameVectors {
    let first = rows.first().map(|row| row.tick);
    let names = rows.iter().take_while(|row| Some(row.tick) == first);
    let names: Vec<_> = names.map(|row| row.joint).collect();
    let mut signal = FrameVectors::new(names.iter().map(ToString::to_string).collect());
    let mut positions = vec![0.0_f32; names.len()];
    let mut rows = rows.iter().peekable();
    for tick in ticks {
        while let Some(row) = rows.next_if(|row| row.tick <= *tick) {
            if let Some(place) = names.iter().position(|name| *name == row.joint) {
                positions[place] = row.state.position as f32;
            }
        }
        signal.values.extend(&positions);
    }
    signal
}

/// True if a number changes from frame to frame.
fn is_moved(signal: &FrameVectors) -> bool {
    let mut frames = signal.frames();
    let first = frames.next();
    frames.any(|frame| Some(frame) != first)
}

/// The signal one frame later; the last frame stays.
fn shifted(signal: &FrameVectors) -> FrameVectors {
    let frames: Vec<_> = signal.frames().collect();
    let later = frames.iter().skip(1).chain(frames.last());
    FrameVectors {
        names: signal.names.clone(),
        values: later.flat_map(|frame| frame.iter().copied()).collect(),
    }
}

/// The pose of every object, in the order of their creation. An object that is not there has no rotation: all of its numbers are 0.
fn object_poses(objects: &[ObjectTrack], frames: usize) -> FrameVectors {
    let parts = ["x", "y", "z", "qx", "qy", "qz", "qw"];
    let names = objects
        .iter()
        .flat_map(|object| parts.map(|part| format!("{}.{part}", object.spec.id)));
    let mut signal = FrameVectors::new(names.collect());
    for frame in 0..frames {
        for object in objects {
            match object.poses[frame] {
                Some(pose) => {
                    signal.values.extend(pose.location.to_array());
                    signal.values.extend(pose.rotation.to_array());
                }
                None => signal.values.extend([0.0; 7]),
            }
        }
    }
    signal
}

/// Place and grip of each hand.
fn hand_states(shown: &Demonstration, hands: &[HandTrack; 2], ticks: &[SimTick]) -> FrameVectors {
    let names = HANDS
        .iter()
        .flat_map(|(hand, _)| ["x", "y", "z", "grip"].map(|part| format!("{hand}_hand.{part}")));
    let mut signal = FrameVectors::new(names.collect());
    for &tick in ticks {
        for hand in hands {
            let location = hand.pose(shown, tick).location;
            signal.values.extend(location.to_array());
            signal.values.push(hand.grip(tick));
        }
    }
    signal
}

/// Every object with its pose at each frame.
fn object_tracks(shown: &Demonstration, ticks: &[SimTick]) -> Vec<ObjectTrack> {
    let tracks = shown.objects.iter().map(|object| {
        let poses = ticks.iter().map(|&tick| {
            let is_there =
                object.created <= tick && object.deleted.is_none_or(|deleted| tick < deleted);
            object.track.at(tick).filter(|_| is_there)
        });
        ObjectTrack {
            spec: object.spec.clone(),
            poses: poses.collect(),
        }
    });
    tracks.collect()
}
