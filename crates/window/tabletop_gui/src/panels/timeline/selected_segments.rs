//! The segments that the user has selected.

use std::{ops::RangeInclusive, path::PathBuf};

use tabletop_core::{Manipulator, Timeline, TimelineSegment, TimelineStage, Verb};

/// A run of segments of the open recording that the user has selected.
#[derive(Debug, Default)]
pub(super) struct SelectedSegments {
    folder: PathBuf,
    segments: Option<RangeInclusive<usize>>,
}

impl SelectedSegments {
    /// To be called before it is asked for: segments of another recording are not selected.
    pub fn begin_frame(&mut self, timeline: &Timeline) {
        if self.folder != timeline.folder || timeline.stage != TimelineStage::Open {
            self.folder.clone_from(&timeline.folder);
            self.segments = None;
        }
    }

    /// Selects a segment with those that it goes together with; if they are selected already, it alone.
    pub fn choose(&mut self, timeline: &Timeline, number: usize) {
        let together = together_with(timeline, number);
        let is_selected = self.segments.as_ref() == Some(&together);
        self.segments = Some(match is_selected {
            true => number..=number,
            false => together,
        });
    }

    pub fn contains(&self, number: usize) -> bool {
        let segments = self.segments.as_ref();
        segments.is_some_and(|segments| segments.contains(&number))
    }

    pub fn segments(&self) -> Option<RangeInclusive<usize>> {
        self.segments.clone()
    }

    /// The selected segments, unless one of them is the beginning, which stays where it is.
    pub fn movable(&self) -> Option<RangeInclusive<usize>> {
        self.segments().filter(|segments| *segments.start() > 0)
    }

    /// The segments after the selected ones, or before them, with which they can change places: as many as go together, if the
    /// selected ones do.
    pub fn neighbours(&self, timeline: &Timeline, is_later: bool) -> Option<RangeInclusive<usize>> {
        let selected = self.movable()?;
        let next = match is_later {
            true => selected.end() + 1,
            false => selected.start() - 1,
        };
        timeline.segments.get(next)?;
        let neighbours = match together_with(timeline, *selected.start()) == selected {
            true => together_with(timeline, next),
            false => next..=next,
        };
        Some(neighbours).filter(|neighbours| *neighbours.start() > 0)
    }
}

/// The segments that a segment goes together with: from one in which a hand takes something to the one after which no hand holds anything.
fn together_with(timeline: &Timeline, number: usize) -> RangeInclusive<usize> {
    let segments = &timeline.segments;
    let mut start = 0;
    let mut holding = Vec::new();
    for (i, segment) in segments.iter().enumerate() {
        note(&mut holding, segment);
        let next = segments.get(i + 1);
        let is_apart = next.is_none_or(|next| next.start > segment.start);
        if holding.is_empty() && is_apart {
            if number <= i {
                return start..=i;
            }
            start = i + 1;
        }
    }
    start.min(number)..=segments.len().saturating_sub(1).max(number)
}

/// Notes whether the hand of a segment holds something from then on.
fn note(holding: &mut Vec<Manipulator>, segment: &TimelineSegment) {
    let Some(act) = &segment.act else { return };
    match act.verb {
        Verb::Grasp if !holding.contains(&act.manipulator) => holding.push(act.manipulator),
        Verb::Release | Verb::Destroy => holding.retain(|other| *other != act.manipulator),
        Verb::Grasp | Verb::Trigger | Verb::PointTo | Verb::Fasten | Verb::Loosen | Verb::Cut => {}
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::{Act, Hand, SimTick};

    use super::*;

    /// An open recording of acts, each with its tick.
    fn timeline(acts: &[(u64, Hand, Verb)]) -> Timeline {
        let acts = acts.iter().map(|&(start, hand, verb)| TimelineSegment {
            start: SimTick(start),
            act: Some(Act {
                manipulator: Manipulator::Hand(hand),
                verb,
                object: None,
            }),
            color: None,
        });
        let beginning = TimelineSegment {
            start: SimTick(0),
            act: None,
            color: None,
        };
        Timeline {
            stage: TimelineStage::Open,
            segments: [beginning].into_iter().chain(acts).collect(),
            ..Timeline::default()
        }
    }

    /// Three handlings, of which the second one is a hand-over, and a grasp that has no end.
    fn handlings() -> Timeline {
        use Hand::{Left, Right};
        timeline(&[
            (10, Left, Verb::Grasp),
            (20, Left, Verb::Release),
            (30, Left, Verb::Grasp),
            (40, Left, Verb::Release),
            (40, Right, Verb::Grasp),
            (50, Right, Verb::Destroy),
            (60, Left, Verb::Trigger),
            (70, Right, Verb::Grasp),
            (80, Right, Verb::Cut),
        ])
    }

    #[test]
    fn a_grasp_is_selected_with_its_release() {
        let timeline = handlings();
        let found: Vec<_> = (0..10)
            .map(|number| together_with(&timeline, number))
            .collect();
        let expected = [
            0..=0,
            1..=2,
            1..=2,
            3..=6,
            3..=6,
            3..=6,
            3..=6,
            7..=7,
            8..=9,
            8..=9,
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn a_second_click_selects_a_segment_alone() {
        let timeline = handlings();
        let mut selection = SelectedSegments::default();
        selection.begin_frame(&timeline);
        for expected in [1..=2, 2..=2, 1..=2] {
            selection.choose(&timeline, 2);
            assert_eq!(selection.segments(), Some(expected));
        }
        selection.begin_frame(&Timeline {
            folder: "other".into(),
            ..timeline
        });
        assert_eq!(selection.segments(), None);
    }

    #[test]
    fn what_goes_together_changes_places_with_what_goes_together() {
        let timeline = handlings();
        let mut selection = SelectedSegments::default();
        let mut neighbours = |number| {
            selection.choose(&timeline, number);
            [false, true].map(|is_later| selection.neighbours(&timeline, is_later))
        };
        assert_eq!(neighbours(0), [None, None]);
        assert_eq!(neighbours(1), [None, Some(3..=6)]);
        assert_eq!(neighbours(3), [Some(1..=2), Some(7..=7)]);
        assert_eq!(neighbours(8), [Some(7..=7), None]);
        assert_eq!(neighbours(8), [Some(7..=7), Some(9..=9)], "it alone");
    }
}
