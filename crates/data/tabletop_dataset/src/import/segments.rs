//! The segments of an imported recording: those of the original one, and one for every further act of a hand.

use tabletop_core::{Manipulator, SimTick};
use tabletop_geometry::Pose;
use tabletop_recorder::{Event, Occurrence, RecordedEvent, RecordedSegment, TICKS_PER_FRAME};
use tabletop_task::{ActDeed, Demonstration, ShownAct};

use crate::import::act_source::ActSource;

/// A segment of an imported recording.
#[derive(Clone, Debug)]
pub(super) struct ImportedSegment {
    pub(super) start: SimTick,
    pub(super) events: Vec<RecordedEvent>,
    /// True if an act of a hand is in it.
    acts: bool,
}

/// Whether a hand takes hold, lets go or removes.
pub(super) fn is_of_hand(what: &Occurrence) -> bool {
    match what {
        Occurrence::Grasp { .. } | Occurrence::Release { .. } | Occurrence::Destroy { .. } => true,
        Occurrence::Create { .. }
        | Occurrence::Delete { .. }
        | Occurrence::Move { .. }
        | Occurrence::Grip { .. }
        | Occurrence::LetGo { .. }
        | Occurrence::InitializeControl { .. }
        | Occurrence::ChangeControlState { .. }
        | Occurrence::Trigger { .. }
        | Occurrence::PointTo { .. }
        | Occurrence::Fasten { .. }
        | Occurrence::Loosen { .. }
        | Occurrence::Cut { .. } => false,
    }
}

/// The segments of a recording, with its acts, or with those inferred.
pub(super) fn segments_of(
    segments: &[RecordedSegment],
    shown: &Demonstration,
    source: ActSource,
) -> Vec<ImportedSegment> {
    let mut inferred = match source {
        ActSource::Recorded => [].iter(),
        ActSource::Inferred => shown.acts.iter(),
    }
    .peekable();
    let mut made = Segmentation::default();
    for segment in segments {
        let first = segment.events.first().map_or(0, |event| event.frame);
        while let Some(act) = inferred.next_if(|act| frame_of(act.tick) < first) {
            made.act(act);
        }
        if segment.number > 0 {
            made.begin(segment.start);
        }
        for event in &segment.events {
            while let Some(act) = inferred.next_if(|act| frame_of(act.tick) <= event.frame) {
                made.act(act);
            }
            made.event(event);
        }
    }
    inferred.for_each(|act| made.act(act));
    made.segments
}

/// The first frame that shows a tick.
fn frame_of(tick: SimTick) -> u64 {
    tick.0.div_ceil(TICKS_PER_FRAME)
}

/// Segments that are being made.
#[derive(Debug)]
struct Segmentation {
    segments: Vec<ImportedSegment>,
}

impl Default for Segmentation {
    fn default() -> Self {
        let first = ImportedSegment {
            start: SimTick(0),
            events: Vec::new(),
            acts: false,
        };
        Self {
            segments: vec![first],
        }
    }
}

impl Segmentation {
    fn last(&mut self) -> &mut ImportedSegment {
        let last = self.segments.len() - 1;
        &mut self.segments[last]
    }

    fn begin(&mut self, start: SimTick) {
        let start = start.max(self.last().start);
        self.segments.push(ImportedSegment {
            start,
            events: Vec::new(),
            acts: false,
        });
    }

    /// Begins a segment for an act, unless the present one has just begun.
    fn begin_act(&mut self, start: SimTick) {
        let is_first = self.segments.len() == 1;
        let last = self.last();
        if is_first || last.acts || !last.events.is_empty() {
            self.begin(start);
        } else {
            last.start = start.max(last.start);
        }
        self.last().acts = true;
    }

    fn event(&mut self, event: &RecordedEvent) {
        let is_first = self.segments.len() == 1;
        let last = self.last();
        if is_of_hand(&event.what) && (last.acts || is_first) {
            // What a hand removes is deleted before, in the same segment.
            let removes = matches!(event.what, Occurrence::Destroy { .. });
            let is_deleted = |last: &mut RecordedEvent| {
                removes && matches!(last.what, Occurrence::Delete { .. })
            };
            let removed = last.events.pop_if(is_deleted);
            let before = event.frame.checked_sub(1);
            self.begin(SimTick(before.map_or(0, |it| it * TICKS_PER_FRAME + 1)));
            self.last().events.extend(removed);
        }
        let last = self.last();
        last.acts |= is_of_hand(&event.what);
        last.events.push(event.clone());
    }

    fn act(&mut self, act: &ShownAct) {
        let what = match (act.by, &act.deed) {
            (Manipulator::Hand(hand), ActDeed::Grasp(id)) => Occurrence::Grasp {
                hand,
                id: id.clone(),
            },
            (Manipulator::Hand(hand), ActDeed::Release(_)) => Occurrence::Release { hand },
            (Manipulator::Hand(hand), ActDeed::Destroy) => Occurrence::Destroy { hand },
            // Only acts of hands are inferred.
            (
                Manipulator::Gripper(_),
                ActDeed::Grasp(_) | ActDeed::Release(_) | ActDeed::Destroy,
            ) => return,
        };
        self.begin_act(act.tick);
        let frame = frame_of(act.tick);
        self.last().events.push(RecordedEvent { frame, what });
    }
}

/// The event as a recorder writes it; none if its object is not in the demonstration.
pub(super) fn event_of<'a>(
    event: &'a RecordedEvent,
    shown: &'a Demonstration,
) -> Option<Event<'a>> {
    Some(match &event.what {
        Occurrence::Create { id, .. } => Event::Create(&shown.named(id)?.spec),
        Occurrence::Delete { id } => Event::Delete {
            id: &shown.named(id)?.spec.id,
        },
        Occurrence::Move {
            id,
            location,
            degrees,
        } => Event::Move {
            id: &shown.named(id)?.spec.id,
            pose: Pose::from_degrees(*location, *degrees),
        },
        Occurrence::Grasp { hand, id } => Event::Grasp { hand: *hand, id },
        Occurrence::Release { hand } => Event::Release { hand: *hand },
        Occurrence::Destroy { hand } => Event::Destroy { hand: *hand },
        Occurrence::Grip { limb, id, tick } => Event::Grip {
            limb: *limb,
            id,
            tick: *tick,
        },
        Occurrence::LetGo { limb, id, tick } => Event::LetGo {
            limb: *limb,
            id,
            tick: *tick,
        },
        Occurrence::InitializeControl {
            control,
            kind,
            object,
            state,
        } => Event::InitializeControl {
            control,
            kind,
            object,
            state,
        },
        Occurrence::ChangeControlState { control, state } => {
            Event::ChangeControlState { control, state }
        }
        Occurrence::Trigger { by, control } => Event::Trigger { by, control },
        Occurrence::PointTo { hand, part, object } => Event::PointTo {
            hand: *hand,
            part,
            object,
        },
        Occurrence::Fasten { by, bond } => Event::Fasten { by, bond },
        Occurrence::Loosen { by, bond } => Event::Loosen { by, bond },
        Occurrence::Cut { by, blade, link } => Event::Cut { by, blade, link },
    })
}
