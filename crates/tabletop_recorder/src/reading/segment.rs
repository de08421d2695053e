//! A segment of a recording, and the act with which it begins.

use std::{collections::BTreeMap, path::PathBuf};

use tabletop_core::{
    Act, Hand, HandCommand, Manipulator, MechanismCommand, Operator, Rgb, SimCommand, SimTick,
    TimelineSegment, Verb,
};

use crate::{
    files::session::SessionCommand,
    reading::event::{Occurrence, RecordedEvent},
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
    pub picture: PathBuf,
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

/// The objects in the hands, as far as events tell.
#[derive(Debug, Default)]
pub(super) struct HandContents(BTreeMap<Hand, String>);

impl HandContents {
    /// Follows the events of a segment. Returns the first thing that a hand did, and its frame.
    pub(super) fn follow(&mut self, events: &[RecordedEvent]) -> Option<(Act, u64)> {
        let acts = events
            .iter()
            .filter_map(|event| Some((self.act(&event.what)?, event.frame)));
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
            Occurrence::Create { .. }
            | Occurrence::Delete { .. }
            | Occurrence::Move { .. }
            | Occurrence::InitializeControl { .. }
            | Occurrence::ChangeControlState { .. }
            | Occurrence::Trigger { .. }
            | Occurrence::Fasten { .. }
            | Occurrence::Loosen { .. } => return None,
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
    let created = events.filter_map(|event| match &event.what {
        Occurrence::Create { id, properties } => {
            let color = properties.iter().find(|(key, _)| key == "color")?;
            Some((id.clone(), color.1.parse().ok()?))
        }
        Occurrence::Delete { .. }
        | Occurrence::Move { .. }
        | Occurrence::Grasp { .. }
        | Occurrence::Release { .. }
        | Occurrence::Destroy { .. }
        | Occurrence::InitializeControl { .. }
        | Occurrence::ChangeControlState { .. }
        | Occurrence::Trigger { .. }
        | Occurrence::PointTo { .. }
        | Occurrence::Fasten { .. }
        | Occurrence::Loosen { .. } => None,
    });
    created.collect()
}

/// The tick in which a segment began with an act that came after one tick and not after another, and the commands after the one that
/// it came of. In the first frame, `after` is `None`.
pub(super) fn begin_of<'c>(
    act: &Act,
    after: Option<SimTick>,
    last: SimTick,
    commands: &'c [SessionCommand],
) -> (SimTick, &'c [SessionCommand]) {
    let is_here = |command: &SessionCommand| {
        let tick = SimTick(command.tick);
        after.is_none_or(|after| tick > after) && tick <= last
    };
    let of = |is_cause: fn(&Act, &SimCommand) -> bool| {
        let mut all = commands.iter();
        all.position(|command| is_here(command) && is_cause(act, &command.command))
    };
    if let Some(at) = of(is_of) {
        (SimTick(commands[at].tick), &commands[at + 1..])
    } else if let Some(at) = of(is_forced) {
        (SimTick(commands[at].tick), &commands[at..])
    } else {
        (last, commands)
    }
}

/// True if a command is to do just this.
fn is_of(act: &Act, command: &SimCommand) -> bool {
    match command {
        SimCommand::Hand(command) => is_of_hand(act, command),
        SimCommand::Mechanism(command) => is_of_mechanism(act, command),
        SimCommand::Recording(_)
        | SimCommand::Clock(_)
        | SimCommand::Scene(_)
        | SimCommand::History(_)
        | SimCommand::Robot(_) => false,
    }
}

fn is_of_mechanism(act: &Act, command: &MechanismCommand) -> bool {
    let (verb, hand) = match command {
        MechanismCommand::Trigger { hand, .. } => (Verb::Trigger, hand),
        MechanismCommand::PointTo { hand, .. } => (Verb::PointTo, hand),
        MechanismCommand::Fasten { hand, .. } => (Verb::Fasten, hand),
        MechanismCommand::Loosen { hand, .. } => (Verb::Loosen, hand),
    };
    act.verb == verb && act.manipulator == Manipulator::Hand(*hand)
}

fn is_of_hand(act: &Act, command: &HandCommand) -> bool {
    let is = |verb, hand: &Hand| act.verb == verb && act.manipulator == Manipulator::Hand(*hand);
    match command {
        HandCommand::Grasp { hand, object } => {
            is(Verb::Grasp, hand) && act.object.as_ref() == Some(object)
        }
        HandCommand::Release(hand) => is(Verb::Release, hand),
        HandCommand::Destroy(hand) => is(Verb::Destroy, hand),
        HandCommand::Select(_)
        | HandCommand::MoveTo { .. }
        | HandCommand::MoveBy { .. }
        | HandCommand::Cut(_)
        | HandCommand::Turn { .. } => false,
    }
}

/// True if a command makes a hand let go, because another one takes what it holds, or needs it.
fn is_forced(act: &Act, command: &SimCommand) -> bool {
    act.verb == Verb::Release && matches!(command, SimCommand::Hand(HandCommand::Grasp { .. }))
}
