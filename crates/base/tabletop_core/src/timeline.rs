//! The timeline of a recording: its segments, pictures and grips.

use std::{fmt, path::PathBuf};

use bevy::prelude::*;
use tabletop_geometry::Rgb;

use crate::{HandFact, Manipulator, MechanismFact, Operator, RobotFact, SimFact, SimTick};

/// The timeline of the recording that is being made, was made last, or is open. The recorder or the replayer fills it in.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Timeline {
    /// The stage of the recording.
    pub stage: TimelineStage,
    /// The recording's folder.
    pub folder: PathBuf,
    /// Its first tick.
    pub start: SimTick,
    /// Its last tick, so far.
    pub end: SimTick,
    /// Its segments, the first one first.
    pub segments: Vec<TimelineSegment>,
    /// Its pictures, the first one first.
    pub pictures: Vec<TimelinePicture>,
    /// The grips that are known.
    pub grips: Vec<TimelineGrip>,
}

/// The stage of the recording of a [`Timeline`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TimelineStage {
    /// There is none.
    #[default]
    Absent,
    /// The recording is running.
    Running,
    /// The recording has ended.
    Finished,
    /// A recording is open: [`PlaybackOrder`](crate::PlaybackOrder)s control it.
    Open,
}

/// A segment of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct TimelineSegment {
    /// Its first tick.
    pub start: SimTick,
    /// The act that it begins with; none in the first one.
    pub act: Option<Act>,
    /// Colour of the act's object.
    pub color: Option<Rgb>,
}

/// A picture of a recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TimelinePicture {
    /// The tick at whose end it was taken.
    pub tick: SimTick,
    /// The file.
    pub path: PathBuf,
    /// Number of pictures taken before it, including undone ones: when a file gets another picture, this number changes.
    pub serial: usize,
}

/// The moment of a grip or a release by a gripper.
#[derive(Clone, Debug, PartialEq)]
pub struct TimelineGrip {
    /// The tick.
    pub tick: SimTick,
    /// The grip or release.
    pub act: Act,
}

/// An act on an object.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Act {
    /// The hand or gripper that did it.
    pub manipulator: Manipulator,
    /// The kind of act.
    pub verb: Verb,
    /// Id of the object, if it is known.
    pub object: Option<String>,
}

/// A kind of act on an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verb {
    /// The object is grasped.
    Grasp,
    /// The object is released.
    Release,
    /// The object is removed from the world.
    Destroy,
    /// The control is operated.
    Trigger,
    /// The object is pointed to.
    PointTo,
    /// The object is fastened to another one, or tightened.
    Fasten,
    /// The object is loosened.
    Loosen,
    /// It is cut.
    Cut,
}

impl Timeline {
    /// The segment that a tick belongs to.
    pub fn segment_at(&self, tick: SimTick) -> Option<usize> {
        let begun = self
            .segments
            .partition_point(|segment| segment.start <= tick);
        begun.checked_sub(1)
    }

    /// The last picture of a tick or of one before it.
    pub fn picture_at(&self, tick: SimTick) -> Option<&TimelinePicture> {
        let shown = self
            .pictures
            .partition_point(|picture| picture.tick <= tick);
        self.pictures.get(shown.checked_sub(1)?)
    }

    /// The last tick of a segment.
    pub fn end_of(&self, segment: usize) -> SimTick {
        let next = self.segments.get(segment + 1);
        next.map_or(self.end, |next| SimTick(next.start.0.saturating_sub(1)))
    }

    /// Number of ticks of a segment; none if the next one begins in the same tick, or if there is no such segment.
    pub fn ticks_of(&self, segment: usize) -> u64 {
        let start = self.segments.get(segment).map(|segment| segment.start.0);
        let next = self.segments.get(segment + 1).map(|next| next.start.0);
        let end = next.unwrap_or(self.end.0 + 1);
        start.map_or(0, |start| end.saturating_sub(start))
    }
}

impl Act {
    /// The act that a fact reports, if it reports one.
    pub fn of(fact: &SimFact) -> Option<Self> {
        let (manipulator, verb, id) = match fact {
            SimFact::Hand(HandFact::Grasped { hand, id, .. }) => {
                (Manipulator::Hand(*hand), Verb::Grasp, id)
            }
            SimFact::Hand(HandFact::Released { hand, id, .. }) => {
                (Manipulator::Hand(*hand), Verb::Release, id)
            }
            SimFact::Hand(HandFact::Destroyed { hand, id, .. }) => {
                (Manipulator::Hand(*hand), Verb::Destroy, id)
            }
            SimFact::Mechanism(MechanismFact::Triggered {
                by: Operator::Hand(hand),
                control,
                ..
            }) => (Manipulator::Hand(*hand), Verb::Trigger, control),
            SimFact::Mechanism(MechanismFact::PointedTo { hand, part, .. }) => {
                (Manipulator::Hand(*hand), Verb::PointTo, part)
            }
            SimFact::Mechanism(MechanismFact::Fastened {
                by: Operator::Hand(hand),
                bond,
                ..
            }) => (Manipulator::Hand(*hand), Verb::Fasten, &bond.guest),
            SimFact::Mechanism(MechanismFact::Loosened {
                by: Operator::Hand(hand),
                bond,
                ..
            }) => (Manipulator::Hand(*hand), Verb::Loosen, &bond.guest),
            SimFact::Mechanism(MechanismFact::Cut {
                by: Operator::Hand(hand),
                link,
                ..
            }) => (Manipulator::Hand(*hand), Verb::Cut, link),
            SimFact::Robot(RobotFact::GripMade { arm, id }) => {
                (Manipulator::Gripper(*arm), Verb::Grasp, id)
            }
            SimFact::Robot(RobotFact::GripReleased { arm, id }) => {
                (Manipulator::Gripper(*arm), Verb::Release, id)
            }
            SimFact::Scene(_)
            | SimFact::Mechanism(
                MechanismFact::Triggered { .. }
                | MechanismFact::ControlChanged { .. }
                | MechanismFact::Fastened { .. }
                | MechanismFact::Loosened { .. }
                | MechanismFact::Cut { .. },
            )
            | SimFact::History(_)
            | SimFact::Recording(_)
            | SimFact::Robot(
                RobotFact::Shown { .. }
                | RobotFact::GripRefused { .. }
                | RobotFact::ArmBlocked { .. },
            )
            | SimFact::Refused { .. } => return None,
        };
        Some(Self {
            manipulator,
            verb,
            object: Some(id.clone()),
        })
    }
}

impl Verb {
    /// Its word in short texts.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Grasp => "grasps",
            Self::Release => "releases",
            Self::Destroy => "destroys",
            Self::Trigger => "triggers",
            Self::PointTo => "points to",
            Self::Fasten => "fastens",
            Self::Loosen => "loosens",
            Self::Cut => "cuts",
        }
    }
}

impl fmt::Display for Act {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let object = self.object.as_deref().unwrap_or("what it held");
        write!(f, "{} {} {object}", self.manipulator, self.verb.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Hand, LimbName};

    fn timeline() -> Timeline {
        let segment = |start| TimelineSegment {
            start: SimTick(start),
            act: None,
            color: None,
        };
        let picture = |tick| TimelinePicture {
            tick: SimTick(tick),
            path: format!("{tick}.png").into(),
            serial: 0,
        };
        Timeline {
            start: SimTick(10),
            end: SimTick(100),
            segments: [10, 20, 20, 50].map(segment).into(),
            pictures: [10, 25, 70].map(picture).into(),
            ..default()
        }
    }

    #[test]
    fn a_tick_is_in_the_last_segment_that_has_begun() {
        let timeline = timeline();
        let found = [9, 10, 19, 20, 49, 50, 1000].map(|tick| timeline.segment_at(SimTick(tick)));
        assert_eq!(
            found,
            [None, Some(0), Some(0), Some(2), Some(2), Some(3), Some(3)]
        );
        let ends = [0, 1, 2, 3].map(|segment| timeline.end_of(segment).0);
        assert_eq!(ends, [19, 19, 49, 100]);
        let ticks = [0, 1, 2, 3, 4].map(|segment| timeline.ticks_of(segment));
        assert_eq!(ticks, [10, 0, 30, 51, 0]);
    }

    #[test]
    fn a_tick_is_shown_by_the_last_picture_before_it() {
        let timeline = timeline();
        let shown = [9, 10, 24, 25, 99].map(|tick| {
            let picture = timeline.picture_at(SimTick(tick));
            picture.map(|picture| picture.tick.0)
        });
        assert_eq!(shown, [None, Some(10), Some(10), Some(25), Some(70)]);
    }

    #[test]
    fn an_act_is_a_sentence() {
        let act = |manipulator, verb, object: Option<&str>| {
            let object = object.map(str::to_owned);
            Act {
                manipulator,
                verb,
                object,
            }
            .to_string()
        };
        let left = Manipulator::Hand(Hand::Left);
        assert_eq!(act(left, Verb::Grasp, Some("red")), "LeftHand grasps red");
        assert_eq!(
            act(left, Verb::Release, None),
            "LeftHand releases what it held"
        );
        let gripper = Manipulator::Gripper(LimbName::from_static("right"));
        assert_eq!(
            act(gripper, Verb::Destroy, Some("a")),
            "right gripper destroys a"
        );
    }
}
