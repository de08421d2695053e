//! The ways of the invisible hands.

use bevy::math::Vec3;
use tabletop_core::{Hand, Manipulator, SimTick};
use tabletop_geometry::Pose;
use tabletop_task::{ActDeed, Demonstration};

/// The hands of an episode, from left to right, with the places where they begin, in units. An act of both hands is one of each.
pub(crate) const HANDS: [(&str, Vec3); 2] = [
    ("left", Vec3::new(-3.0, 0.0, 5.0)),
    ("right", Vec3::new(3.0, 0.0, 5.0)),
];

/// The way of a hand. It is where the held object is; between two objects it goes straight from where it let go of one to where it grasps
/// the next, since an invisible hand is nowhere else.
#[derive(Clone, Debug, Default)]
pub(crate) struct HandTrack {
    holds: Vec<HoldSpan>,
    home: Vec3,
    start: SimTick,
}

/// A time in which a hand holds an object.
#[derive(Clone, Debug, PartialEq)]
struct HoldSpan {
    object: String,
    from: SimTick,
    to: SimTick,
}

impl HandTrack {
    /// The ways of all hands.
    pub fn all(shown: &Demonstration) -> [Self; 2] {
        let mut tracks = HANDS.map(|(_, home)| Self {
            holds: Vec::new(),
            home,
            start: shown.start,
        });
        let mut held: [Option<(Hand, String, SimTick)>; 2] = [None, None];
        for act in &shown.acts {
            let Manipulator::Hand(by) = act.by else {
                continue;
            };
            let mine = |held: &Option<(Hand, String, SimTick)>| {
                held.as_ref().is_some_and(|(hand, ..)| *hand == by)
            };
            match &act.deed {
                ActDeed::Grasp(object) => {
                    let hands: &[usize] = match by {
                        Hand::Left => &[0],
                        Hand::Right => &[1],
                        Hand::Both => &[0, 1],
                        Hand::Any if held[1].is_none() => &[1],
                        Hand::Any => &[0],
                    };
                    for &hand in hands {
                        let taken = Some((by, object.clone(), act.tick));
                        if let Some(before) = std::mem::replace(&mut held[hand], taken) {
                            tracks[hand].hold(before, act.tick);
                        }
                    }
                }
                ActDeed::Release(_) | ActDeed::Destroy => {
                    for hand in 0..2 {
                        if mine(&held[hand])
                            && let Some(before) = held[hand].take()
                        {
                            tracks[hand].hold(before, act.tick);
                        }
                    }
                }
            }
        }
        for (track, held) in tracks.iter_mut().zip(held) {
            if let Some(held) = held {
                track.hold(held, SimTick(shown.end.0 + 1));
            }
        }
        tracks
    }

    fn hold(&mut self, (_, object, from): (Hand, String, SimTick), to: SimTick) {
        self.holds.push(HoldSpan { object, from, to });
    }

    /// The object that it holds at the end of a tick.
    pub fn held(&self, tick: SimTick) -> Option<&str> {
        let hold = self
            .holds
            .iter()
            .find(|hold| hold.from <= tick && tick < hold.to);
        hold.map(|hold| hold.object.as_str())
    }

    /// 1 if it holds something at the end of a tick, otherwise 0.
    pub fn grip(&self, tick: SimTick) -> f32 {
        f32::from(u8::from(self.held(tick).is_some()))
    }

    /// Its pose at the end of a tick, level while it holds nothing.
    pub fn pose(&self, shown: &Demonstration, tick: SimTick) -> Pose {
        let of = |object: &str, tick| shown.named(object).and_then(|it| it.track.at(tick));
        if let Some(pose) = self.held(tick).and_then(|object| of(object, tick)) {
            return pose;
        }
        let before = self.holds.iter().rev().find(|hold| hold.to <= tick);
        let next = self.holds.iter().find(|hold| hold.from > tick);
        let place = |hold: &HoldSpan, tick| of(&hold.object, tick).map(|pose| pose.location);
        let (left, since) = match before {
            Some(hold) => (place(hold, hold.to).unwrap_or(self.home), hold.to),
            None => (self.home, self.start),
        };
        let there = next.and_then(|hold| Some((place(hold, hold.from)?, hold.from)));
        let (to, until) = there.unwrap_or((left, tick));
        let whole = until.0.saturating_sub(since.0).max(1) as f32;
        let gone = tick.0.saturating_sub(since.0) as f32;
        Pose::at(left.lerp(to, (gone / whole).min(1.0)))
    }
}
