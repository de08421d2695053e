//! The events of an episode, and the segments that they begin.

use tabletop_core::{
    Act, Actor, ClockCommand, CommandId, Hand, HandCommand, HandFact, HistoryFact, Manipulator,
    MechanismFact, Paused, SceneFact, SimFact, SimTick, Timeline, TimelineGrip, TimelineSegment,
};

use crate::{
    error::RecorderError,
    files::{
        event::Event,
        segment_mark::SegmentMark,
        session::{SessionCommand, command_line},
    },
    recording::{
        episode::{Episode, history::HistoryTurn},
        objects::initialized_controls,
        progress::SegmentStart,
        stage::RecordedWorld,
        timeline_mark::TimelineMark,
    },
};

impl Episode {
    /// Writes what has happened in a tick.
    pub(crate) fn write_facts(
        &mut self,
        tick: SimTick,
        facts: &[SimFact],
        paused: Paused,
        stage: &RecordedWorld,
        timeline: &mut Timeline,
    ) -> Result<(), RecorderError> {
        let last_turn = facts
            .iter()
            .rposition(|fact| HistoryTurn::of(fact).is_some());
        let (turned, rest) = facts.split_at(last_turn.map_or(0, |last| last + 1));
        for facts in turned.split_inclusive(|fact| HistoryTurn::of(fact).is_some()) {
            let is_undo = facts.last().and_then(HistoryTurn::of) == Some(HistoryTurn::Undo);
            self.write_events(&facts[..facts.len() - 1], stage, timeline)?;
            if is_undo {
                self.undo(timeline)?;
            } else {
                self.redo(timeline)?;
            }
            self.tick = tick;
            self.logged.clear();
        }
        if self.is_paused != paused.0 {
            // A pause is not turned back with the clock.
            let pause = SessionCommand::of_app(tick, ClockCommand::SetPaused(paused.0));
            let line = command_line(&pause)?;
            self.append_commands(&line)?;
            self.is_paused = paused.0;
        }
        let unlogged = std::mem::take(&mut self.unlogged);
        self.log(&unlogged)?;
        self.write_events(rest, stage, timeline)
    }

    pub(super) fn write_events(
        &mut self,
        facts: &[SimFact],
        stage: &RecordedWorld,
        timeline: &mut Timeline,
    ) -> Result<(), RecorderError> {
        let frame = self.clock.frame(self.tick);
        let mut lines = Vec::new();
        for (index, fact) in facts.iter().enumerate() {
            self.note_act(fact, timeline);
            let event = match fact {
                SimFact::History(HistoryFact::SegmentBegun { cause }) => {
                    lines.splice(..0, self.objects.open(frame));
                    self.files
                        .text
                        .append_records(&std::mem::take(&mut lines))?;
                    let released = released_by(*cause, &facts[..index]);
                    self.begin_segment(*cause, released, timeline)?;
                    continue;
                }
                SimFact::Scene(SceneFact::ObjectCreated { object, .. }) => {
                    let Some(spec) = stage.spec(*object) else {
                        continue;
                    };
                    if !self.objects.create(spec) {
                        continue;
                    }
                    lines.push(Event::Create(spec).fields(frame));
                    lines.extend(initialized_controls(spec, frame));
                    continue;
                }
                SimFact::Scene(SceneFact::ObjectDeleted { id, .. }) => {
                    if !self.objects.delete(id) {
                        continue;
                    }
                    Event::Delete { id }
                }
                SimFact::Hand(HandFact::Grasped { hand, id, .. }) => {
                    Event::Grasp { hand: *hand, id }
                }
                SimFact::Hand(HandFact::Released { hand, .. }) => Event::Release { hand: *hand },
                SimFact::Hand(HandFact::Destroyed { hand, .. }) => Event::Destroy { hand: *hand },
                SimFact::Mechanism(MechanismFact::Triggered { by, control, .. }) => {
                    Event::Trigger { by, control }
                }
                SimFact::Mechanism(MechanismFact::ControlChanged { control, state, .. }) => {
                    Event::ChangeControlState { control, state }
                }
                SimFact::Mechanism(MechanismFact::PointedTo {
                    hand, part, object, ..
                }) => Event::PointTo {
                    hand: *hand,
                    part,
                    object,
                },
                SimFact::Mechanism(MechanismFact::Fastened { by, bond, .. }) => {
                    Event::Fasten { by, bond }
                }
                SimFact::Mechanism(MechanismFact::Loosened { by, bond, .. }) => {
                    Event::Loosen { by, bond }
                }
                SimFact::Mechanism(MechanismFact::Cut {
                    by, blade, link, ..
                }) => Event::Cut { by, blade, link },
                SimFact::Scene(SceneFact::TaskLoaded { .. })
                | SimFact::Recording(_)
                | SimFact::History(HistoryFact::Undone { .. } | HistoryFact::Redone { .. })
                | SimFact::Robot(_)
                | SimFact::Refused { .. } => continue,
            };
            lines.push(event.fields(frame));
        }
        lines.splice(..0, self.objects.open(frame));
        self.files.text.append_records(&lines)
    }

    /// Puts what hands and grippers do on the timeline.
    pub(super) fn note_act(&self, fact: &SimFact, timeline: &mut Timeline) {
        let Some(act) = Act::of(fact) else {
            return;
        };
        match (act.manipulator, &mut timeline.segments[..]) {
            (Manipulator::Gripper(_), _) => timeline.grips.push(TimelineGrip {
                tick: self.tick,
                act,
            }),
            (Manipulator::Hand(_), [_, .., last]) if last.act.is_none() => {
                last.color = act.object.as_ref().and_then(|id| self.objects.color(id));
                last.act = Some(act);
            }
            // An object that falls off the world is lost to its hand, in the middle of a segment.
            (Manipulator::Hand(_), _) => {}
        }
    }

    pub(super) fn begin_segment(
        &mut self,
        cause: CommandId,
        released: Vec<Hand>,
        timeline: &mut Timeline,
    ) -> Result<(), RecorderError> {
        let mut before = self.progress();
        let cause = self.logged.iter().find(|command| command.id == cause);
        before.files.session = cause.map_or(self.end_of_commands(), |cause| cause.before);
        let actor = cause.map_or(Actor::App, |cause| cause.actor);
        let released = released.into_iter().map(|hand| SessionCommand {
            tick: self.tick.0,
            actor,
            command: HandCommand::Release(hand).into(),
            at_once: false,
        });
        self.undoable.push(SegmentStart {
            before,
            released: released.collect(),
            tick: self.tick,
            timeline: TimelineMark::of(timeline),
        });
        timeline.segments.push(TimelineSegment {
            start: self.tick,
            act: None,
            color: None,
        });
        if !self.redoable.is_empty() {
            self.redoable.clear();
            self.files.drop_undone()?;
        }
        let mark = SegmentMark::line(self.files.segment + 1, self.tick)?;
        self.files.session.append(&mark)?;
        self.marks.extend(mark);
        self.files.begin_segment()
    }
}

/// The hands that a command has emptied by now.
fn released_by(command: CommandId, facts: &[SimFact]) -> Vec<Hand> {
    let released = facts.iter().filter_map(|fact| {
        if let SimFact::Hand(HandFact::Released {
            cause: Some(cause),
            hand,
            ..
        }) = fact
        {
            (*cause == command).then_some(*hand)
        } else {
            None
        }
    });
    released.collect()
}
