//! Demonstrations: the objects, their motions, and the acts of the hands that a recording shows.

use tabletop_core::{JointSpec, Manipulator, ObjectSpec, SimTick, Table};
use tabletop_geometry::Pose;
use tabletop_recorder::{Occurrence, RecordedSegment, RecorderError, RecordingReader};

use crate::{
    arrangement::Arrangement,
    described::described,
    operation::{Operation, OperationDeed},
    track::Track,
};

/// The part of a recording that a task is inferred from.
#[derive(Clone, Debug, Default)]
pub struct Demonstration {
    /// The table.
    pub table: Table,
    /// The objects, in the order of their creation.
    pub objects: Vec<ShownObject>,
    /// Joints between objects.
    pub joints: Vec<JointSpec>,
    /// Acts of the hands and grippers, in order.
    pub acts: Vec<ShownAct>,
    /// Objects that were operated, pointed to, fastened and loosened, in order.
    pub operations: Vec<Operation>,
    /// The first tick.
    pub start: SimTick,
    /// The last tick.
    pub end: SimTick,
    /// True if only events are known, whose poses may be of a world without physics.
    pub is_poses_only: bool,
}

/// An object of a demonstration.
#[derive(Clone, Debug)]
pub struct ShownObject {
    /// Its description, with its first pose.
    pub spec: ObjectSpec,
    /// Its poses.
    pub track: Track,
    /// The tick in which it appeared.
    pub created: SimTick,
    /// The tick in which it disappeared, if it did.
    pub deleted: Option<SimTick>,
    /// True if the recording does not tell its size.
    pub(crate) is_guessed: bool,
}

/// An act of a hand or a gripper.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShownAct {
    /// The tick.
    pub tick: SimTick,
    /// The hand or gripper.
    pub by: Manipulator,
    /// The kind of act.
    pub deed: ActDeed,
}

/// A kind of act of a hand or a gripper.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ActDeed {
    /// It grasps an object.
    Grasp(String),
    /// It releases the held object; this one, if the recording names it.
    Release(Option<String>),
    /// It removes the held object from the world.
    Destroy,
}

impl Demonstration {
    /// The demonstration of a recording.
    ///
    /// # Errors
    /// A file cannot be read, or has a line that no recorder writes; the error names the file.
    pub fn of(recording: &RecordingReader) -> Result<Self, RecorderError> {
        let scene = &recording.session().scene;
        let mut shown = Self {
            table: scene.table.unwrap_or_default(),
            joints: scene.joints.clone(),
            start: recording.first_tick(),
            end: recording.last_tick(),
            ..Self::default()
        };
        for object in &scene.objects {
            let mut spec = object.spec.clone();
            spec.pose = object.pose;
            shown.add(spec, recording.first_tick());
        }
        let rows = recording.states()?;
        shown.follow(
            &recording.segments()?,
            recording.header().ticks_per_frame,
            rows.is_empty(),
        );
        for row in rows {
            if let Some(object) = shown.named_mut(&row.id) {
                object.track.push(row.tick, row.pose);
            }
        }
        Ok(shown)
    }

    /// The object of this id.
    pub fn named(&self, id: &str) -> Option<&ShownObject> {
        self.objects.iter().find(|object| object.spec.id == id)
    }

    fn named_mut(&mut self, id: &str) -> Option<&mut ShownObject> {
        self.objects.iter_mut().find(|object| object.spec.id == id)
    }

    /// The arrangement of all present objects at the end of a tick.
    pub(crate) fn at(&self, tick: SimTick) -> Arrangement {
        let there = self.objects.iter().filter(|object| {
            object.created <= tick && object.deleted.is_none_or(|deleted| tick < deleted)
        });
        Arrangement::new(there.filter_map(|object| {
            let pose = object.track.at(tick)?;
            Some((object.spec.id.as_str(), &object.spec.shape, pose))
        }))
    }

    fn add(&mut self, spec: ObjectSpec, created: SimTick) {
        self.objects.push(ShownObject {
            track: Track::default(),
            created,
            deleted: None,
            is_guessed: false,
            spec,
        });
    }

    /// Follows the events; their moves only if `moves` is true, for want of anything better.
    pub(crate) fn follow(
        &mut self,
        segments: &[RecordedSegment],
        ticks_per_frame: u64,
        moves: bool,
    ) {
        for segment in segments {
            // An act shows in the first frame after it. For the first frame, the tick of the act itself is known.
            let mut begun = segment.act.is_some();
            for event in &segment.events {
                let shown = SimTick(self.start.0 + event.frame * ticks_per_frame);
                let frame = SimTick(shown.0.saturating_sub(ticks_per_frame))..=shown;
                let does = !matches!(
                    event.what,
                    Occurrence::Create { .. }
                        | Occurrence::Delete { .. }
                        | Occurrence::Move { .. }
                        | Occurrence::Grip { .. }
                        | Occurrence::LetGo { .. }
                        | Occurrence::InitializeControl { .. }
                        | Occurrence::ChangeControlState { .. }
                );
                let tick = match does && std::mem::take(&mut begun) {
                    true => segment.start,
                    false => shown,
                };
                let mut act = |tick, by, deed| self.acts.push(ShownAct { tick, by, deed });
                let mut operate = |deed| {
                    let states = Vec::new();
                    self.operations.push(Operation { tick, deed, states });
                };
                match &event.what {
                    Occurrence::Create { id, properties } => match self.named_mut(id) {
                        Some(known) => known.deleted = None,
                        None => {
                            let (spec, tells_size) = described(id, properties);
                            self.add(spec, shown);
                            if let Some(object) = self.objects.last_mut() {
                                object.is_guessed = !tells_size;
                            }
                        }
                    },
                    Occurrence::Delete { id } => {
                        if let Some(object) = self.named_mut(id) {
                            object.deleted = Some(
                                segment
                                    .start
                                    .max(SimTick(shown.0.saturating_sub(ticks_per_frame))),
                            );
                        }
                    }
                    Occurrence::Move {
                        id,
                        location,
                        degrees,
                    } if moves => {
                        if let Some(object) = self.named_mut(id) {
                            let pose = Pose::from_degrees(*location, *degrees);
                            object.track.push(shown, pose);
                        }
                    }
                    Occurrence::Move { .. } => {}
                    Occurrence::Grasp { hand, id } => {
                        act(tick, Manipulator::Hand(*hand), ActDeed::Grasp(id.clone()));
                    }
                    Occurrence::Release { hand } => {
                        act(tick, Manipulator::Hand(*hand), ActDeed::Release(None));
                    }
                    Occurrence::Destroy { hand } => {
                        act(tick, Manipulator::Hand(*hand), ActDeed::Destroy);
                    }
                    Occurrence::Grip { limb, id, tick } => {
                        let tick = *tick.clamp(frame.start(), frame.end());
                        act(
                            tick,
                            Manipulator::Gripper(*limb),
                            ActDeed::Grasp(id.clone()),
                        );
                    }
                    Occurrence::LetGo { limb, id, tick } => {
                        let tick = *tick.clamp(frame.start(), frame.end());
                        let released = ActDeed::Release(Some(id.clone()));
                        act(tick, Manipulator::Gripper(*limb), released);
                    }
                    Occurrence::ChangeControlState { control, state } => {
                        if let Some(operation) = self.operations.last_mut() {
                            operation.states.push((control.clone(), state.clone()));
                        }
                    }
                    Occurrence::Trigger { control, .. } => {
                        let control = control.clone();
                        operate(OperationDeed::Trigger { control });
                    }
                    Occurrence::PointTo { part, .. } => {
                        let part = part.clone();
                        operate(OperationDeed::PointTo { part });
                    }
                    Occurrence::Fasten { bond, .. } => {
                        operate(OperationDeed::Fasten(bond.clone()));
                    }
                    Occurrence::Loosen { bond, .. } => {
                        operate(OperationDeed::Loosen(bond.clone()));
                    }
                    Occurrence::Cut { blade, link, .. } => {
                        let (blade, link) = (blade.clone(), link.clone());
                        operate(OperationDeed::Cut { blade, link });
                    }
                    Occurrence::InitializeControl { .. } => {}
                }
            }
        }
    }
}
