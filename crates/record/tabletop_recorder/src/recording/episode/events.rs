//! The events of an episode, and the segments that they begin.

use tabletop_core::{
    Act, Actor, CommandId, Hand, HandCommand, HandFact, HistoryFact, Manipulator, MechanismFact,
    RobotFact, SceneFact, SimFact, Timeline, TimelineGrip, TimelineSegment,
};

use crate::{
    error::RecorderError,
    files::{event::Event, segment_mark::SegmentMark, session::SessionCommand},
    recording::{
        episode::Episode, objects::initialized_controls, progress::SegmentStart,
        released::released_by, stage::RecordedWorld, timeline_mark::TimelineMark,
    },
};

impl Episode {
    /// Writes what has happened in this tick.
    pub(crate) fn write_events(
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
                SimFact::Robot(RobotFact::GripMade { arm, id }) => Event::Grip {
                    limb: *arm,
                    id,
                    tick: self.tick,
                },
                SimFact::Robot(RobotFact::GripReleased { arm, id }) => Event::LetGo {
                    limb: *arm,
                    id,
                    tick: self.tick,
                },
                SimFact::Scene(SceneFact::TaskLoaded { .. })
                | SimFact::Recording(_)
                | SimFact::History(
                    HistoryFact::Undone { .. }
                    | HistoryFact::Redone { .. }
                    | HistoryFact::Kept { .. },
                )
                | SimFact::Robot(
                    RobotFact::Shown { .. }
                    | RobotFact::GripRefused { .. }
                    | RobotFact::ArmBlocked { .. },
                )
                | SimFact::Refused { .. } => continue,
            };
            lines.push(event.fields(frame));
        }
        lines.splice(..0, self.objects.open(frame));
        self.files.text.append_records(&lines)
    }

    /// Puts the acts of hands and grippers on the timeline.
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
        before.last = cause.map_or(self.last, |cause| cause.follows);
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
