//! A recording while it is made: one demonstration as a sequence of segments.

use std::path::{Path, PathBuf};

use bevy::prelude::warn;
use tabletop_core::{
    Act, Actor, ClockCommand, CommandId, CommandSystems, Hand, HandCommand, IssuedCommand,
    JointState, Manipulator, Paused, Pose, SensorImage, SimCommand, SimFact, SimTick, Timeline,
    TimelineGrip, TimelinePicture, TimelineSegment, TimelineStage,
};

use crate::{
    error::RecorderError,
    files::{
        channels::Channels,
        destination::Destination,
        event::Event,
        frame::FrameClock,
        joints,
        picture::{color_png, depth_png, ids_png},
        recording_files::RecordingFiles,
        session::{SessionCommand, SessionHeader, SessionScene, command_line, is_logged},
    },
    recording::{
        earlier_commands::EarlierCommands,
        objects::{RecordedObjects, initialized_controls},
        progress::{Progress, SegmentStart, UndoneSegment},
        stage::{Sight, Stage},
        timeline_mark::TimelineMark,
        tracked::Tracked,
    },
};

/// A running recording.
#[derive(Debug)]
pub(crate) struct Episode {
    files: RecordingFiles,
    clock: FrameClock,
    objects: RecordedObjects,
    /// The sight at the last frame.
    sight: Sight,
    /// The robot's joints at the end of the tick before.
    last_joints: Option<Vec<JointState>>,
    /// True if the simulation is paused where the session log ends.
    is_paused: bool,
    channels: Channels,
    /// The tick before its commands were carried out; they may turn the clock.
    tick: SimTick,
    /// The commands of this tick that are in the session log.
    logged: Vec<LoggedCommand>,
    /// Length of the session log before the first recorded command.
    head: u64,
    /// The commands of this tick that are carried out after the clock was turned.
    unlogged: Vec<IssuedCommand>,
    undoable: Vec<SegmentStart>,
    redoable: Vec<UndoneSegment>,
    /// The number of pictures that were written, also of what was undone.
    pictures: usize,
}

/// A command in the session log.
#[derive(Clone, Copy, Debug)]
struct LoggedCommand {
    id: CommandId,
    actor: Actor,
    /// Length of the session log before it.
    before: u64,
}

impl Episode {
    /// Begins a recording in a new folder.
    pub(crate) fn begin(
        destination: &Destination,
        header: &SessionHeader,
        scene: &SessionScene,
        earlier: &EarlierCommands,
    ) -> Result<Self, RecorderError> {
        let files = RecordingFiles::create(destination, header, scene, earlier.lines())?;
        let objects = scene.objects.iter().map(|object| object.spec.clone());
        let start = SimTick(header.start_tick);
        Ok(Self {
            clock: FrameClock { start },
            head: files.session.len(),
            files,
            objects: RecordedObjects::opening(objects),
            sight: Sight::default(),
            last_joints: None,
            is_paused: earlier.is_paused(),
            channels: destination.channels,
            tick: start,
            logged: Vec::new(),
            unlogged: Vec::new(),
            undoable: Vec::new(),
            redoable: Vec::new(),
            pictures: 0,
        })
    }

    /// Ends a recording that cannot go on. Returns its folder.
    pub(crate) fn abandon(self) -> PathBuf {
        let folder = self.folder().to_owned();
        self.files.abandon();
        folder
    }

    pub(crate) fn folder(&self) -> &Path {
        self.files.folder.path()
    }

    /// The timeline of a recording that begins.
    pub(crate) fn timeline(&self) -> Timeline {
        let start = self.clock.start;
        let opening = TimelineSegment {
            start,
            act: None,
            color: None,
        };
        Timeline {
            stage: TimelineStage::Running,
            folder: self.folder().to_owned(),
            start,
            end: start,
            segments: vec![opening],
            ..Timeline::default()
        }
    }

    pub(crate) fn is_frame(&self, tick: SimTick) -> bool {
        self.clock.is_frame(tick)
    }

    /// How many ticks come before a frame, from this one on.
    pub(crate) fn ticks_to_frame(&self, tick: SimTick) -> u64 {
        self.clock.tick(self.clock.frame(tick)).0 - tick.0
    }

    /// Logs the commands of a tick, in the order in which they are carried out, before they are. If they turn the clock, those after
    /// that belong to another tick, and are logged when it is reached.
    pub(crate) fn log_commands(
        &mut self,
        tick: SimTick,
        commands: &[IssuedCommand],
    ) -> Result<(), RecorderError> {
        let phase = |issued: &IssuedCommand| issued.command.phase();
        let begins = commands.partition_point(|issued| phase(issued) < CommandSystems::History);
        let (first, then) = commands.split_at(begins);
        self.tick = tick;
        self.logged.clear();
        self.log(first)?;
        if then
            .iter()
            .any(|issued| phase(issued) == CommandSystems::History)
        {
            self.unlogged = then.to_vec();
            Ok(())
        } else {
            self.log(then)
        }
    }

    fn log(&mut self, commands: &[IssuedCommand]) -> Result<(), RecorderError> {
        let mut lines = Vec::new();
        for issued in commands {
            if !is_logged(&issued.command) {
                continue;
            }
            if let SimCommand::Clock(ClockCommand::SetPaused(paused)) = issued.command {
                self.is_paused = paused;
            }
            self.logged.push(LoggedCommand {
                id: issued.id,
                actor: issued.actor,
                before: self.files.session.len() + lines.len() as u64,
            });
            let command = SessionCommand::of(self.tick, issued);
            lines.extend(command_line(&command)?);
        }
        self.files.session.append(&lines)
    }

    /// Writes what has happened in a tick.
    pub(crate) fn write_facts(
        &mut self,
        tick: SimTick,
        facts: &[SimFact],
        paused: Paused,
        stage: &Stage,
        timeline: &mut Timeline,
    ) -> Result<(), RecorderError> {
        let last_turn = facts.iter().rposition(|fact| Turn::of(fact).is_some());
        let (turned, rest) = facts.split_at(last_turn.map_or(0, |last| last + 1));
        for facts in turned.split_inclusive(|fact| Turn::of(fact).is_some()) {
            let is_undo = facts.last().and_then(Turn::of) == Some(Turn::Undo);
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
            self.files.session.append(&line)?;
            self.is_paused = paused.0;
        }
        let unlogged = std::mem::take(&mut self.unlogged);
        self.log(&unlogged)?;
        self.write_events(rest, stage, timeline)
    }

    fn write_events(
        &mut self,
        facts: &[SimFact],
        stage: &Stage,
        timeline: &mut Timeline,
    ) -> Result<(), RecorderError> {
        let frame = self.clock.frame(self.tick);
        let mut lines = Vec::new();
        for (index, fact) in facts.iter().enumerate() {
            self.note_act(fact, timeline);
            let event = match fact {
                SimFact::SegmentBegun { cause } => {
                    lines.splice(..0, self.objects.open(frame));
                    self.files
                        .text
                        .append_records(&std::mem::take(&mut lines))?;
                    let released = released_by(*cause, &facts[..index]);
                    self.begin_segment(*cause, released, timeline)?;
                    continue;
                }
                SimFact::ObjectCreated { object, .. } => {
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
                SimFact::ObjectDeleted { id, .. } => {
                    if !self.objects.delete(id) {
                        continue;
                    }
                    Event::Delete { id }
                }
                SimFact::Grasped { hand, id, .. } => Event::Grasp { hand: *hand, id },
                SimFact::Released { hand, .. } => Event::Release { hand: *hand },
                SimFact::Destroyed { hand, .. } => Event::Destroy { hand: *hand },
                SimFact::Triggered { by, control, .. } => Event::Trigger { by, control },
                SimFact::ControlChanged { control, state, .. } => {
                    Event::ChangeControlState { control, state }
                }
                SimFact::PointedTo {
                    hand, part, object, ..
                } => Event::PointTo {
                    hand: *hand,
                    part,
                    object,
                },
                SimFact::Fastened { by, bond, .. } => Event::Fasten { by, bond },
                SimFact::Loosened { by, bond, .. } => Event::Loosen { by, bond },
                SimFact::TaskLoaded { .. }
                | SimFact::RecordingStarted { .. }
                | SimFact::RecordingFinished { .. }
                | SimFact::RecordingFailed { .. }
                | SimFact::Undone { .. }
                | SimFact::Redone { .. }
                | SimFact::RobotShown { .. }
                | SimFact::GripMade { .. }
                | SimFact::GripRefused { .. }
                | SimFact::GripReleased { .. }
                | SimFact::ArmBlocked { .. }
                | SimFact::Refused { .. } => continue,
            };
            lines.push(event.fields(frame));
        }
        lines.splice(..0, self.objects.open(frame));
        self.files.text.append_records(&lines)
    }

    /// Puts what hands and grippers do on the timeline.
    fn note_act(&self, fact: &SimFact, timeline: &mut Timeline) {
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
            // What falls off the world is lost to its hand, in the middle of a segment.
            (Manipulator::Hand(_), _) => {}
        }
    }

    fn begin_segment(
        &mut self,
        cause: CommandId,
        released: Vec<Hand>,
        timeline: &mut Timeline,
    ) -> Result<(), RecorderError> {
        let mut before = self.progress();
        let cause = self.logged.iter().find(|command| command.id == cause);
        if let Some(cause) = cause {
            before.files.session = cause.before;
        }
        let actor = cause.map_or(Actor::App, |cause| cause.actor);
        let released = released.into_iter().map(|hand| SessionCommand {
            tick: self.tick.0,
            actor,
            command: HandCommand::Release(hand).into(),
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
        self.files.begin_segment()
    }

    fn progress(&self) -> Progress {
        Progress {
            files: self.files.lengths(),
            objects: self.objects.clone(),
            sight: self.sight.clone(),
            last_joints: self.last_joints.clone(),
            is_paused: self.is_paused,
        }
    }

    /// Goes back to the moment before the present segment began, and puts its files away.
    fn undo(&mut self, timeline: &mut Timeline) -> Result<(), RecorderError> {
        let Some(start) = self.undoable.pop() else {
            warn!("the world was set back to before the recording; the recording goes on");
            return Ok(());
        };
        let end = self.progress();
        let mut released = Vec::new();
        for command in &start.released {
            released.extend(command_line(command)?);
        }
        self.files.put_away(start.before.files, &released)?;
        self.resume(start.before.clone());
        let timeline = start.timeline.cut(timeline);
        self.redoable.push(UndoneSegment {
            start,
            end,
            timeline,
        });
        Ok(())
    }

    /// Brings back the segment that was undone last, in the place of what was recorded since.
    fn redo(&mut self, timeline: &mut Timeline) -> Result<(), RecorderError> {
        let Some(undone) = self.redoable.pop() else {
            warn!("the world was set to what the recording does not know; the recording goes on");
            return Ok(());
        };
        let UndoneSegment { start, end, .. } = undone;
        start.timeline.cut(timeline);
        undone.timeline.append_to(timeline);
        let first_frame = self.clock.frame(start.tick);
        self.files
            .bring_back(start.before.files, first_frame, end.files)?;
        self.resume(end);
        self.undoable.push(start);
        Ok(())
    }

    fn resume(&mut self, progress: Progress) {
        self.objects = progress.objects;
        self.sight = progress.sight;
        self.last_joints = progress.last_joints;
        self.is_paused = progress.is_paused;
    }

    /// Writes what the end of a tick brings: a row for each object that has moved, and at a frame the moves and a picture.
    pub(crate) fn write_tick(
        &mut self,
        tick: SimTick,
        stage: &Stage,
        image: Option<&SensorImage>,
        timeline: &mut Timeline,
    ) -> Result<(), RecorderError> {
        timeline.end = tick;
        if self.clock.is_frame(tick) {
            self.write_frame(tick, Tracked::is_news, stage, image, timeline)?;
        }
        let rows = self.objects.moved_rows(tick, stage);
        self.files.states.append_records(&rows)?;
        let rows = joints::rows(
            tick,
            &stage.layout,
            self.last_joints.as_deref(),
            stage.joints(),
        );
        self.last_joints = Some(stage.joints().to_vec());
        self.files.joints.append_records(&rows)?;
        self.files.end_tick()
    }

    /// Writes a frame: a line for each object of which this is so, and a picture if there is such a line, or something else to be
    /// seen than at the frame before.
    fn write_frame(
        &mut self,
        tick: SimTick,
        is_told: impl Fn(&Tracked, Pose) -> bool,
        stage: &Stage,
        image: Option<&SensorImage>,
        timeline: &mut Timeline,
    ) -> Result<(), RecorderError> {
        let frame = self.clock.frame(tick);
        let mut moves = Vec::new();
        for object in self.objects.tracked_mut() {
            if let Some(state) = stage.state(&object.id)
                && is_told(object, state.pose)
            {
                object.report(state.pose);
                let (id, pose) = (&object.id, state.pose);
                moves.push(Event::Move { id, pose }.fields(frame));
            }
        }
        let sight = stage.sight(self.objects.tracked());
        let is_another = sight != self.sight;
        self.sight = sight;
        if (is_another || !moves.is_empty())
            && let Some(image) = image
        {
            self.write_image(frame, image, stage)?;
            self.pictures += 1;
            let path = self.files.folder.picture(self.files.segment, frame);
            timeline.pictures.pop_if(|last| last.path == path);
            timeline.pictures.push(TimelinePicture {
                tick,
                path,
                serial: self.pictures,
            });
        }
        self.files.text.append_records(&moves)
    }

    fn write_image(
        &self,
        frame: u64,
        image: &SensorImage,
        stage: &Stage,
    ) -> Result<(), RecorderError> {
        let (folder, segment) = (&self.files.folder, self.files.segment);
        let channel = |name| folder.channel(segment, frame, name);
        let picture = &image.picture;
        self.files
            .write_picture(&folder.picture(segment, frame), color_png(picture))?;
        if self.channels.depth {
            self.files
                .write_picture(&channel("depth"), depth_png(picture))?;
        }
        if self.channels.ids {
            let shown = image.shown.iter();
            let numbers = shown.map(|&entity| self.objects.number_of(stage.shown(entity)));
            let encoded = ids_png(picture, &numbers.collect::<Vec<_>>());
            self.files.write_picture(&channel("ids"), encoded)?;
        }
        Ok(())
    }

    /// Ends the recording with a last frame, after which every object is where its last `move` line says. If that does not fit on the
    /// disk, nothing of it stays. Returns the lines of the commands that were logged since the recording began.
    pub(crate) fn finish(
        &mut self,
        tick: SimTick,
        finish: &IssuedCommand,
        stage: &Stage,
        image: Option<&SensorImage>,
        timeline: &mut Timeline,
    ) -> Result<Vec<u8>, RecorderError> {
        timeline.end = tick;
        let commands = self.files.session.read_from(self.head)?;
        let frame = self.clock.frame(tick);
        // The picture of a frame that is at its tick anyway stays.
        let first_frame = frame + u64::from(self.clock.is_frame(tick));
        let line = command_line(&SessionCommand::of(tick, finish))?;
        let intent = self.files.begin_end(first_frame, &line)?;
        self.write_frame(tick, Tracked::is_elsewhere, stage, image, timeline)?;
        self.files.finish(&line, &intent)?;
        if let Err(error) = self.files.drop_undone() {
            warn!("what was undone is still there: {error}");
        }
        Ok(commands)
    }
}

/// The hands that a command has emptied by now.
fn released_by(command: CommandId, facts: &[SimFact]) -> Vec<Hand> {
    let released = facts.iter().filter_map(|fact| {
        if let SimFact::Released {
            cause: Some(cause),
            hand,
            ..
        } = fact
        {
            (*cause == command).then_some(*hand)
        } else {
            None
        }
    });
    released.collect()
}

/// A change of the clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Turn {
    Undo,
    Redo,
}

impl Turn {
    fn of(fact: &SimFact) -> Option<Self> {
        if let SimFact::Undone { .. } = fact {
            Some(Self::Undo)
        } else if let SimFact::Redone { .. } = fact {
            Some(Self::Redo)
        } else {
            None
        }
    }
}
