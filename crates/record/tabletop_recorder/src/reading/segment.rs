//! A segment of a recording, and the act with which it begins.

use std::collections::BTreeMap;

use tabletop_core::{Act, Hand, Manipulator, Operator, SimTick, TimelineSegment, Verb};
use tabletop_geometry::Rgb;
use tabletop_storage::InnerFile;

use crate::reading::{
    event::{Occurrence, RecordedEvent},
    object_change::ObjectChange,
};

/// A segment of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedSegment {
    /// Its number, from 0.
    pub number: u32,
    /// Its first tick.
    pub start: SimTick,
    /// The hand's act with which it begins; the first one has none.
    pub act: Option<Act>,
    /// Its events in their order.
    pub events: Vec<RecordedEvent>,
    /// Its frames that have pictures, in their order.
    pub frames: Vec<RecordedFrame>,
}

/// A frame that has a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordedFrame {
    /// Its number.
    pub number: u64,
    /// The tick whose end it shows.
    pub tick: SimTick,
    /// The file of its picture.
    pub picture: InnerFile,
    /// The files of the hand cameras' pictures, by the names of these.
    pub hand_pictures: BTreeMap<String, InnerFile>,
}

impl RecordedSegment {
    pub(super) fn on_timeline(&self, colors: &BTreeMap<String, Rgb>) -> TimelineSegment {
        let object = self.act.as_ref().and_then(|act| act.object.as_ref());
        TimelineSegment {
            start: self.start,
            act: self.act.clone(),
            color: object.and_then(|id| colors.get(id)).copied(),
        }
    }
}

/// The objects in the hands, as known from events.
#[derive(Debug, Default)]
pub(super) struct HandContents(BTreeMap<Hand, String>);

impl HandContents {
    /// Follows the events of a segment. Returns the first thing that a hand did.
    pub(super) fn follow(&mut self, events: &[RecordedEvent]) -> Option<Act> {
        let acts = events.iter().filter_map(|event| self.act(&event.what));
        acts.collect::<Vec<_>>().into_iter().next()
    }

    fn act(&mut self, what: &Occurrence) -> Option<Act> {
        let (hand, verb, object) = match what {
            Occurrence::Grasp { hand, id } => {
                self.0.insert(*hand, id.clone());
                (hand, Verb::Grasp, Some(id.clone()))
            }
            Occurrence::Release { hand } => (hand, Verb::Release, self.0.remove(hand)),
            Occurrence::Destroy { hand } => (hand, Verb::Destroy, self.0.remove(hand)),
            Occurrence::Trigger {
                by: Operator::Hand(hand),
                control,
            } => (hand, Verb::Trigger, Some(control.clone())),
            Occurrence::PointTo { hand, part, .. } => (hand, Verb::PointTo, Some(part.clone())),
            Occurrence::Fasten {
                by: Operator::Hand(hand),
                bond,
            } => (hand, Verb::Fasten, Some(bond.guest.clone())),
            Occurrence::Loosen {
                by: Operator::Hand(hand),
                bond,
            } => (hand, Verb::Loosen, Some(bond.guest.clone())),
            Occurrence::Cut {
                by: Operator::Hand(hand),
                link,
                ..
            } => (hand, Verb::Cut, Some(link.clone())),
            Occurrence::Create { .. }
            | Occurrence::Delete { .. }
            | Occurrence::Move { .. }
            | Occurrence::Grip { .. }
            | Occurrence::LetGo { .. }
            | Occurrence::InitializeControl { .. }
            | Occurrence::ChangeControlState { .. }
            | Occurrence::Trigger { .. }
            | Occurrence::Fasten { .. }
            | Occurrence::Loosen { .. }
            | Occurrence::Cut { .. } => return None,
        };
        Some(Act {
            manipulator: Manipulator::Hand(*hand),
            verb,
            object,
        })
    }
}

/// The colours of all objects, by id.
pub(super) fn colors(segments: &[RecordedSegment]) -> BTreeMap<String, Rgb> {
    let events = segments.iter().flat_map(|segment| &segment.events);
    let created = events.filter_map(|event| {
        let ObjectChange::Create { id, properties } = event.what.object_change()? else {
            return None;
        };
        let color = properties.iter().find(|(key, _)| key == "color")?;
        Some((id.to_owned(), color.1.parse().ok()?))
    });
    created.collect()
}
