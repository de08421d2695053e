//! The motions of objects between the frames of an imported recording.

use std::collections::{BTreeMap, BTreeSet};

use bevy::math::{Quat, Vec3};
use tabletop_core::{SimTick, TICKS_PER_SECOND};
use tabletop_geometry::{Pose, Twist};
use tabletop_recorder::{
    ObjectChange, RecordedSegment, RecorderError, RecordingWriter, StateRow, TICKS_PER_FRAME,
};
use tabletop_task::{Demonstration, ShownObject};

/// The poses of all objects at the frames that tell them. An object that a frame tells of was still until the frame before, and goes
/// straight from there.
#[derive(Clone, Debug, Default)]
pub(super) struct Motions {
    ids: Vec<String>,
    /// By frame, then by the object's place.
    keys: BTreeMap<u64, BTreeMap<usize, FramePose>>,
    /// Frames and places of objects that are gone.
    gone: BTreeSet<(u64, usize)>,
    last_frame: u64,
}

/// The pose of an object at a frame.
#[derive(Clone, Copy, Debug)]
struct FramePose {
    pose: Pose,
    /// Its pose before, if it was there.
    before: Option<Pose>,
}

impl Motions {
    pub(super) fn of(segments: &[RecordedSegment], shown: &Demonstration) -> Self {
        let ids: Vec<_> = shown.objects.iter().map(|it| it.spec.id.clone()).collect();
        let places: BTreeMap<_, _> = ids.iter().cloned().zip(0..).collect();
        let mut motions = Self {
            ids,
            ..Self::default()
        };
        let mut last = BTreeMap::<usize, Pose>::new();
        for event in segments.iter().flat_map(|segment| &segment.events) {
            motions.last_frame = motions.last_frame.max(event.frame);
            match event.what.object_change() {
                Some(ObjectChange::Move {
                    id,
                    location,
                    degrees,
                }) => {
                    if let Some(&place) = places.get(id) {
                        let pose = Pose::from_degrees(location, degrees);
                        let before = last.insert(place, pose);
                        let keys = motions.keys.entry(event.frame).or_default();
                        let before = keys.get(&place).map_or(before, |first| first.before);
                        keys.insert(place, FramePose { pose, before });
                    }
                }
                Some(ObjectChange::Delete { id }) => {
                    if let Some(&place) = places.get(id) {
                        last.remove(&place);
                        motions.gone.insert((event.frame, place));
                    }
                }
                Some(ObjectChange::Create { .. }) | None => {}
            }
        }
        let frames = segments.iter().flat_map(|segment| &segment.frames);
        let pictured = frames.map(|frame| frame.number).max();
        motions.last_frame = motions.last_frame.max(pictured.unwrap_or(0));
        motions.begin(shown);
        motions
    }

    /// Objects that are there from the beginning have their first pose in the first frame.
    fn begin(&mut self, shown: &Demonstration) {
        let first: Vec<_> = self
            .at_beginning(shown)
            .map(|(it, pose)| (it.spec.id.clone(), pose))
            .collect();
        for (id, pose) in first {
            if let Some(place) = self.ids.iter().position(|known| *known == id) {
                let keys = self.keys.entry(0).or_default();
                keys.entry(place)
                    .or_insert(FramePose { pose, before: None });
            }
        }
    }

    /// The objects that are there from the beginning, with their first poses.
    pub(super) fn at_beginning<'s>(
        &self,
        shown: &'s Demonstration,
    ) -> impl Iterator<Item = (&'s ShownObject, Pose)> {
        let first = shown.objects.iter().map(|object| object.created).min();
        let there = shown
            .objects
            .iter()
            .filter(move |it| Some(it.created) == first);
        there.filter_map(|it| Some((it, it.track.at(it.created)?)))
    }

    pub(super) const fn last_frame(&self) -> u64 {
        self.last_frame
    }

    /// The frames in which an object is seen to be elsewhere, and the first one.
    pub(super) fn frames(&self) -> BTreeSet<u64> {
        self.keys.keys().copied().chain([0]).collect()
    }

    /// Hands over the poses of the objects that are there at each of these frames, in order; none for objects that are not.
    pub(super) fn visit<E>(
        &self,
        frames: &BTreeSet<u64>,
        mut at: impl FnMut(u64, &[Option<Pose>]) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut poses = vec![None; self.ids.len()];
        let mut keys = self.keys.iter().peekable();
        let mut gone = self.gone.iter().peekable();
        for &frame in frames {
            while let Some((_, here)) = keys.next_if(|(key, _)| **key <= frame) {
                here.iter()
                    .for_each(|(&it, key)| poses[it] = Some(key.pose));
            }
            while let Some(&(_, it)) = gone.next_if(|(key, _)| *key <= frame) {
                poses[it] = None;
            }
            at(frame, &poses)?;
        }
        Ok(())
    }

    /// Writes the states of every tick up to the last one.
    pub(super) fn write(
        &self,
        writer: &mut RecordingWriter<'_>,
        last_tick: SimTick,
    ) -> Result<(), RecorderError> {
        let frames: BTreeSet<_> = self.keys.keys().flat_map(|&it| [it, it + 1]).collect();
        for frame in frames {
            let mut rows = self.rows_to(frame);
            rows.retain(|row| row.tick <= last_tick);
            writer.states(&rows)?;
        }
        Ok(())
    }

    /// The states from the frame before to this one.
    fn rows_to(&self, frame: u64) -> Vec<StateRow> {
        let nothing = BTreeMap::new();
        let here = self.keys.get(&frame).unwrap_or(&nothing);
        let before = frame.checked_sub(1).and_then(|it| self.keys.get(&it));
        let before = before.unwrap_or(&nothing);
        let places: BTreeSet<_> = here.keys().chain(before.keys()).copied().collect();
        let mut rows = Vec::new();
        let end = frame * TICKS_PER_FRAME;
        let begin = end.saturating_sub(TICKS_PER_FRAME - 1);
        for tick in begin..=end {
            for place in &places {
                let state = match (here.get(place), before.get(place)) {
                    (
                        Some(FramePose {
                            pose,
                            before: Some(from),
                        }),
                        _,
                    ) => {
                        let share = 1.0 - (end - tick) as f32 / TICKS_PER_FRAME as f32;
                        Some((between(*from, *pose, share), twist(*from, *pose)))
                    }
                    (Some(FramePose { pose, before: None }), _) if tick == end => {
                        Some((*pose, Twist::default()))
                    }
                    (
                        None,
                        Some(FramePose {
                            pose,
                            before: Some(_),
                        }),
                    ) if tick == begin && !self.gone.contains(&(frame, *place)) => {
                        Some((*pose, Twist::default()))
                    }
                    _ => None,
                };
                rows.extend(state.map(|(pose, twist)| StateRow {
                    tick: SimTick(tick),
                    id: self.ids[*place].clone(),
                    pose,
                    twist,
                }));
            }
        }
        rows
    }
}

/// The pose at a share of the way from one to another.
fn between(from: Pose, to: Pose, share: f32) -> Pose {
    if share >= 1.0 {
        return to;
    }
    let near = nearer(from.rotation, to.rotation);
    let rotation = from.rotation * (1.0 - share) + near * share;
    Pose::new(from.location.lerp(to.location, share), rotation.normalize())
}

/// The rotation, written so that the way to it from another is the short one.
fn nearer(from: Quat, to: Quat) -> Quat {
    match from.dot(to) < 0.0 {
        true => -to,
        false => to,
    }
}

/// The speed that leads from one pose to another within a frame, in units/s and rad/s.
fn twist(from: Pose, to: Pose) -> Twist {
    let frames_a_second = TICKS_PER_SECOND as f32 / TICKS_PER_FRAME as f32;
    let turn = nearer(from.rotation, to.rotation) * from.rotation.inverse();
    let axis = Vec3::new(turn.x, turn.y, turn.z);
    let sine = axis.length();
    let angle = 2.0 * libm::atan2f(sine, turn.w);
    Twist {
        linear: (to.location - from.location) * frames_a_second,
        angular: axis.normalize_or_zero() * (angle * frames_a_second),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_object_goes_straight_and_turns_the_short_way() {
        let from = Pose::from_degrees(Vec3::ZERO, Vec3::Z * 170.0);
        let to = Pose::from_degrees(Vec3::X * 3.0, Vec3::Z * -170.0);
        let middle = between(from, to, 0.5);
        assert!((middle.location - Vec3::X * 1.5).length() < 1e-6);
        assert!(
            (middle.degrees().z.abs() - 180.0).abs() < 1e-3,
            "{middle:?}"
        );
        assert_eq!(between(from, to, 1.0), to);
        let Twist { linear, angular } = twist(from, to);
        assert!((linear - Vec3::X * 12.0).length() < 1e-5);
        let expected = 20.0_f32.to_radians() * 4.0;
        assert!((angular - Vec3::Z * expected).length() < 1e-4, "{angular}");
    }
}
