//! What happens in a recording, along its time.

use std::{fmt, path::PathBuf};

use bevy::prelude::*;

use crate::{Hand, LimbName, Operator, Rgb, SimFact, SimTick};

/// The recording that is being made, was made last, or is open. The recorder fills it in, or whoever replays a recording.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Timeline {
    /// What becomes of the recording.
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
    /// What the grippers took and let go of, as far as is known.
    pub grips: Vec<TimelineGrip>,
}

/// What becomes of the recording of a [`Timeline`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TimelineStage {
    /// There is none.
    #[default]
    Absent,
    /// It is being made.
    Running,
    /// It was made.
    Finished,
    /// It is open, and its [`Playback`](crate::Playback) can be told.
    Open,
}

/// A segment of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct TimelineSegment {
    /// Its first tick.
    pub start: SimTick,
    /// What it begins with; nothing in the first one.
    pub act: Option<Act>,
    /// The colour of the object of that.
    pub color: Option<Rgb>,
}

/// A picture of a recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TimelinePicture {
    /// The tick whose end it shows.
    pub tick: SimTick,
    /// The file.
    pub path: PathBuf,
    /// How many pictures were taken before it, also of what was undone: another picture in the same file has another number.
    pub serial: usize,
}

/// A moment in which a gripper took something or let go of it.
#[derive(Clone, Debug, PartialEq)]
pub struct TimelineGrip {
    /// The tick.
    pub tick: SimTick,
    /// What happened.
    pub act: Act,
}

/// What was done to which object, and with what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Act {
    /// With what.
    pub manipulator: Manipulator,
    /// What.
    pub verb: Verb,
    /// Id of the object, if it is known.
    pub object: Option<String>,
}

/// What takes objects and lets go of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manipulator {
    /// A hand of the demonstrator.
    Hand(Hand),
    /// A gripper of the robot.
    Gripper(LimbName),
}

/// What is done to an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verb {
    /// It is taken.
    Grasp,
    /// It is let go of.
    Release,
    /// It is removed from the world.
    Destroy,
    /// It is operated.
    Trigger,
    /// It is pointed to.
    PointTo,
    /// It is fastened to another one, or tighter.
    Fasten,
    /// It is loosened.
    Loosen,
}

impl Timeline {
    /// The segment of a tick.
    pub fn segment_at(&self, tick: SimTick) -> Option<usize> {
        let begun = self
            .segments
            .partition_point(|segment| segment.start <= tick);
        begun.checked_sub(1)
    }

    /// The last picture that shows a tick or one before it.
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
}

impl Act {
    /// What somebody has done to an object, if that is what has happened.
    pub fn of(fact: &SimFact) -> Option<Self> {
        let (manipulator, verb, id) = match fact {
            SimFact::Grasped { hand, id, .. } => (Manipulator::Hand(*hand), Verb::Grasp, id),
            SimFact::Released { hand, id, .. } => (Manipulator::Hand(*hand), Verb::Release, id),
            SimFact::Destroyed { hand, id, .. } => (Manipulator::Hand(*hand), Verb::Destroy, id),
            SimFact::Triggered {
                by: Operator::Hand(hand),
                control,
                ..
            } => (Manipulator::Hand(*hand), Verb::Trigger, control),
            SimFact::PointedTo { hand, part, .. } => {
                (Manipulator::Hand(*hand), Verb::PointTo, part)
            }
            SimFact::Fastened {
                by: Operator::Hand(hand),
                bond,
                ..
            } => (Manipulator::Hand(*hand), Verb::Fasten, &bond.guest),
            SimFact::Loosened {
                by: Operator::Hand(hand),
                bond,
                ..
            } => (Manipulator::Hand(*hand), Verb::Loosen, &bond.guest),
            SimFact::GripMade { arm, id } => (Manipulator::Gripper(*arm), Verb::Grasp, id),
            SimFact::GripReleased { arm, id } => (Manipulator::Gripper(*arm), Verb::Release, id),
            SimFact::TaskLoaded { .. }
            | SimFact::Triggered { .. }
            | SimFact::ControlChanged { .. }
            | SimFact::Fastened { .. }
            | SimFact::Loosened { .. }
            | SimFact::ObjectCreated { .. }
            | SimFact::ObjectDeleted { .. }
            | SimFact::SegmentBegun { .. }
            | SimFact::RecordingStarted { .. }
            | SimFact::RecordingFinished { .. }
            | SimFact::RecordingFailed { .. }
            | SimFact::Undone { .. }
            | SimFact::Redone { .. }
            | SimFact::RobotShown { .. }
            | SimFact::GripRefused { .. }
            | SimFact::ArmBlocked { .. }
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
    /// As a word for a short text.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Grasp => "grasps",
            Self::Release => "releases",
            Self::Destroy => "destroys",
            Self::Trigger => "triggers",
            Self::PointTo => "points to",
            Self::Fasten => "fastens",
            Self::Loosen => "loosens",
        }
    }
}

impl fmt::Display for Manipulator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Hand(hand) => write!(f, "{hand}"),
            Self::Gripper(arm) => write!(f, "{} gripper", arm),
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
