//! The timeline of a recording while it is made: the tail that undo takes off its end, and redo puts there again.

use tabletop_core::{Timeline, TimelineGrip, TimelinePicture, TimelineSegment};

/// The progress of a timeline.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TimelineMark {
    segments: usize,
    pictures: usize,
    grips: usize,
}

/// The part of a timeline after a mark.
#[derive(Clone, Debug)]
pub(crate) struct TimelineTail {
    segments: Vec<TimelineSegment>,
    pictures: Vec<TimelinePicture>,
    grips: Vec<TimelineGrip>,
}

impl TimelineMark {
    /// The present end of a timeline.
    pub(crate) fn of(timeline: &Timeline) -> Self {
        Self {
            segments: timeline.segments.len(),
            pictures: timeline.pictures.len(),
            grips: timeline.grips.len(),
        }
    }

    /// Takes off everything after the mark.
    pub(crate) fn cut(self, timeline: &mut Timeline) -> TimelineTail {
        TimelineTail {
            segments: split_off(&mut timeline.segments, self.segments),
            pictures: split_off(&mut timeline.pictures, self.pictures),
            grips: split_off(&mut timeline.grips, self.grips),
        }
    }
}

impl TimelineTail {
    /// Puts it to the end of a timeline.
    pub(crate) fn append_to(self, timeline: &mut Timeline) {
        timeline.segments.extend(self.segments);
        timeline.pictures.extend(self.pictures);
        timeline.grips.extend(self.grips);
    }
}

fn split_off<T>(all: &mut Vec<T>, at: usize) -> Vec<T> {
    all.split_off(at.min(all.len()))
}
