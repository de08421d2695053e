//! The files of a recording, each against its neighbours.

use std::collections::{BTreeMap, BTreeSet};

use tabletop_core::SimTick;
use tabletop_geometry::Pose;
use tabletop_recorder::{ObjectChange, RecordingReader, StateRow};
use tabletop_training::Image;

use crate::{check::finding::Findings, error::DatasetError, limits::NEAR_STATE};

/// Compares events, states, pictures and the session log of a recording.
pub(super) fn compare_files(
    recording: &RecordingReader,
    findings: &mut Findings,
) -> Result<(), DatasetError> {
    let states = recording.states()?;
    recording.joints()?;
    compare_states(recording, &states, findings);
    let segments = recording.segments()?;
    let mut there = BTreeSet::new();
    let mut frame = 0;
    let mut moved = BTreeSet::new();
    let mut cursor = StateCursor::new(&states);
    let ticks_per_frame = recording.header().ticks_per_frame;
    for segment in &segments {
        for event in &segment.events {
            if event.frame < frame {
                findings.add(format!(
                    "{}.txt: frame {} comes after frame {frame}",
                    segment.number, event.frame
                ));
            }
            frame = frame.max(event.frame);
            match event.what.object_change() {
                Some(ObjectChange::Create { id, .. }) => {
                    there.insert(id.to_owned());
                }
                Some(ObjectChange::Delete { id }) => {
                    there.remove(id);
                }
                Some(ObjectChange::Move {
                    id,
                    location,
                    degrees,
                }) => {
                    moved.insert(event.frame);
                    let first = recording.first_tick().0;
                    let tick = first.saturating_add(event.frame.saturating_mul(ticks_per_frame));
                    let tick = SimTick(tick).min(recording.last_tick());
                    let said = Pose::from_degrees(location, degrees);
                    let is_near = cursor.at(id, tick).is_some_and(|pose| is_near(pose, said));
                    if !there.contains(id) {
                        findings.add(format!(
                            "{}.txt: {id} moves before it is created",
                            segment.number
                        ));
                    } else if !is_near {
                        findings.add(format!(
                            "{}.txt: frame {}: {id} is elsewhere in states.csv",
                            segment.number, event.frame
                        ));
                    }
                }
                None => {}
            }
        }
    }
    let marks = recording.session().segments.len();
    if marks + 1 != segments.len() {
        findings.add(format!(
            "session.jsonl has {} segments, but there are {} files of events",
            marks + 1,
            segments.len()
        ));
    }
    let pictures = segments.iter().flat_map(|segment| &segment.frames);
    let pictured: BTreeSet<_> = pictures.clone().map(|frame| frame.number).collect();
    let missing = moved.difference(&pictured).count();
    if missing > 0 && recording.header().camera.is_some() {
        findings.add(format!(
            "{missing} frames in which something moves have no picture"
        ));
    }
    for frame in pictures {
        let hands = frame.hand_pictures.iter();
        let hands = hands.map(|(camera, picture)| (camera.as_str(), picture));
        for (camera, picture) in [("head", &frame.picture)].into_iter().chain(hands) {
            if let Err(error) = Image::read_sized(picture, recording.picture_size(camera)) {
                findings.add(error);
            }
        }
    }
    Ok(())
}

fn compare_states(recording: &RecordingReader, states: &[StateRow], findings: &mut Findings) {
    let range = recording.first_tick()..=recording.last_tick();
    let mut last = recording.first_tick();
    let faulty = states.iter().find(|row| {
        let is_faulty = row.tick < last || !range.contains(&row.tick);
        last = row.tick;
        is_faulty
    });
    if let Some(row) = faulty {
        findings.add(format!(
            "states.csv: tick {} is not in order, or not from {} to {}",
            row.tick.0,
            range.start().0,
            range.end().0
        ));
    }
}

fn is_near(one: Pose, other: Pose) -> bool {
    let turn = one.rotation.dot(other.rotation).abs();
    one.location.distance(other.location) <= NEAR_STATE * (1.0 + one.location.length())
        && turn >= 1.0 - NEAR_STATE
}

/// The states up to a tick that never goes far back.
struct StateCursor<'s> {
    rows: &'s [StateRow],
    next: usize,
    poses: BTreeMap<&'s str, Pose>,
}

impl<'s> StateCursor<'s> {
    fn new(rows: &'s [StateRow]) -> Self {
        Self {
            rows,
            next: 0,
            poses: BTreeMap::new(),
        }
    }

    fn at(&mut self, id: &str, tick: SimTick) -> Option<Pose> {
        while let Some(row) = self.rows.get(self.next).filter(|row| row.tick <= tick) {
            self.poses.insert(&row.id, row.pose);
            self.next += 1;
        }
        self.poses.get(id).copied()
    }
}
