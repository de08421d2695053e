//! Tracks: poses of an object, tick by tick.

use tabletop_core::SimTick;
use tabletop_geometry::Pose;

use crate::rotation::angle_between;

/// Number of ticks for which something that is at rest has stayed in place.
const STILL_TICKS: u64 = 15;
/// Largest displacement of something that stays in place, in units.
const STILL_LENGTH: f32 = 0.01;
/// Largest turn of something that stays in place, in rad.
const STILL_ANGLE: f32 = 0.01;

/// The poses of an object over time; each holds until the next one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Track(Vec<(SimTick, Pose)>);

impl Track {
    /// Adds the pose from a tick on. Ticks must ascend.
    pub fn push(&mut self, tick: SimTick, pose: Pose) {
        match self.0.last_mut() {
            Some(last) if last.0 == tick => last.1 = pose,
            _ => self.0.push((tick, pose)),
        }
    }

    /// The pose at the end of a tick; before the first pose, that one. `None` if there are no poses.
    pub fn at(&self, tick: SimTick) -> Option<Pose> {
        let known = self.0.partition_point(|(since, _)| *since <= tick);
        let (_, pose) = self.0.get(known.max(1) - 1)?;
        Some(*pose)
    }

    /// The pose at the end of a tick on an even way from each pose to the next, which takes at most this many ticks.
    pub fn smooth_at(&self, tick: SimTick, most: u64) -> Option<Pose> {
        let known = self.0.partition_point(|(since, _)| *since <= tick);
        let now = self.at(tick)?;
        let Some((next, to)) = self.0.get(known).filter(|_| known > 0) else {
            return Some(now);
        };
        let begun = self.0[known - 1].0.0.max(next.0.saturating_sub(most));
        if tick.0 <= begun {
            return Some(now);
        }
        let part = (tick.0 - begun) as f32 / (next.0 - begun) as f32;
        Some(Pose::new(
            now.location.lerp(to.location, part),
            now.rotation.slerp(to.rotation, part).normalize(),
        ))
    }

    /// The length of the way, in units.
    pub fn length(&self) -> f32 {
        let places = self.0.windows(2);
        places
            .map(|pair| pair[0].1.location.distance(pair[1].1.location))
            .sum()
    }

    /// Its poses, and from when on it had each.
    pub(crate) fn entries(&self) -> impl Iterator<Item = (SimTick, Pose)> {
        self.0.iter().copied()
    }

    /// The poses from one tick to another, both included.
    pub fn between(&self, from: SimTick, to: SimTick) -> impl Iterator<Item = Pose> {
        let first = self.at(from);
        let inner = self
            .0
            .iter()
            .filter(move |(tick, _)| *tick > from && *tick <= to);
        first.into_iter().chain(inner.map(|(_, pose)| *pose))
    }

    /// The first tick, not before `from`, after which the object stays in place for a quarter of a second; `until` at the latest.
    pub fn rest_after(&self, from: SimTick, until: SimTick) -> SimTick {
        let mut rest = from;
        let changes = self
            .0
            .iter()
            .filter(|(tick, _)| *tick > from && *tick <= until);
        let Some(mut still) = self.at(from) else {
            return until;
        };
        for (tick, pose) in changes {
            if tick.0 > rest.0 + STILL_TICKS {
                break;
            }
            if !is_near(*pose, still) {
                (rest, still) = (*tick, *pose);
            }
        }
        SimTick(rest.0 + STILL_TICKS).min(until)
    }

    /// True if the object has stayed in place for a quarter of a second.
    pub(crate) fn is_still_at(&self, tick: SimTick) -> bool {
        let before = self.at(SimTick(tick.0.saturating_sub(STILL_TICKS)));
        let pair = before.zip(self.at(tick));
        pair.is_some_and(|(before, now)| is_near(before, now))
    }
}

fn is_near(a: Pose, b: Pose) -> bool {
    a.location.distance(b.location) <= STILL_LENGTH
        && angle_between(a.rotation, b.rotation) <= STILL_ANGLE
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;

    use super::*;

    #[test]
    fn a_pose_holds_until_the_next_one() {
        let mut track = Track::default();
        for (tick, x) in [(10, 1.0), (20, 2.0), (20, 3.0)] {
            track.push(SimTick(tick), Pose::at(Vec3::X * x));
        }
        let found =
            [0, 10, 19, 20, 99].map(|tick| track.at(SimTick(tick)).map(|pose| pose.location.x));
        assert_eq!(found, [1.0, 1.0, 1.0, 3.0, 3.0].map(Some));
        assert_eq!(Track::default().at(SimTick(0)), None);
    }

    #[test]
    fn a_smooth_way_takes_no_longer_than_a_frame() {
        let mut track = Track::default();
        for (tick, x) in [(0, 0.0), (30, 1.5), (45, 3.0)] {
            track.push(SimTick(tick), Pose::at(Vec3::X * x));
        }
        for (tick, x) in [
            (0, 0.0),
            (15, 0.0),
            (20, 0.5),
            (30, 1.5),
            (35, 2.0),
            (99, 3.0),
        ] {
            let found = track.smooth_at(SimTick(tick), 15).unwrap().location.x;
            assert!((found - x).abs() < 1e-5, "{tick}: {found}");
        }
    }

    #[test]
    fn a_falling_object_is_at_rest_once_it_has_landed() {
        let mut track = Track::default();
        for tick in 0..=30_u64 {
            let height = 30_u64.saturating_sub(tick) as f32 / 10.0;
            track.push(SimTick(tick), Pose::at(Vec3::Z * height));
        }
        assert_eq!(track.rest_after(SimTick(5), SimTick(100)), SimTick(45));
        assert_eq!(track.rest_after(SimTick(5), SimTick(40)), SimTick(40));
        assert_eq!(track.rest_after(SimTick(60), SimTick(100)), SimTick(75));
    }
}
