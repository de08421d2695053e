//! A recording while it is made: one demonstration as a sequence of segments.

use std::path::Path;

use bevy::prelude::warn;
use tabletop_core::{
    Act, Actor, Paused, Pose, SensorImage, SimCommand, SimFact, SimTick, Timeline, TimelineGrip,
    TimelinePicture, TimelineSegment, TimelineStage,
};

use crate::{
    cause::{Beginning, beginnings},
    error::RecorderError,
    files::{
        channels::Channels,
        event::Event,
        folder::Folder,
        frame::FrameClock,
        joints::{self, Joints},
        picture::{write_depth, write_ids, write_png},
        recording_files::RecordingFiles,
        session::{SessionHeader, SessionScene, command_line},
    },
    order::{in_order, is_about_recordings, turns_the_clock},
    recording::{
        earlier_commands::EarlierCommands,
        objects::RecordedObjects,
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
    /// What there was to be seen at the last frame.
    sight: Sight,
    /// The robot's joints at the end of the tick before.
    last_joints: Option<Joints>,
    /// Whether the simulation is paused where the session log ends.
    is_paused: bool,
    channels: Channels,
    /// The tick before its commands were carried out; they may turn the clock.
    tick: SimTick,
    /// The commands of this tick, each with the length of the session log before it.
    logged: Vec<(SimCommand, u64)>,
    /// Length of the session log before the first recorded command.
    head: u64,
    /// The commands of this tick that are carried out after the clock was turned.
    unlogged: Vec<SimCommand>,
    undoable: Vec<SegmentStart>,
    redoable: Vec<UndoneSegment>,
    /// How many pictures were written, also of what was undone.
    pictures: usize,
}

impl Episode {
    /// Begins a recording in a new folder.
    pub(crate) fn begin(
        folder: &Path,
        header: &SessionHeader,
        scene: &SessionScene,
        earlier: &EarlierCommands,
        channels: Channels,
    ) -> Result<Self, RecorderError> {
        let files = Folder::create(folder, |folder| {
            RecordingFiles::create(folder, header, scene, earlier.lines())
        })?;
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
            channels,
            tick: start,
            logged: Vec::new(),
            unlogged: Vec::new(),
            undoable: Vec::new(),
            redoable: Vec::new(),
            pictures: 0,
        })
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

    /// Logs the commands of a tick before they are carried out, in the order in which they are. If they turn the clock,
    /// those after that belong to another tick, and are logged when it is reached.
    pub(crate) fn log_commands(
        &mut self,
        tick: SimTick,
        commands: &[SimCommand],
    ) -> Result<(), RecorderError> {
        let (first, then) = in_order(commands);
        self.tick = tick;
        self.logged.clear();
        self.log(first)?;
        if then.iter().any(turns_the_clock) {
            self.unlogged = then;
            Ok(())
        } else {
            self.log(then)
        }
    }

    fn log(&mut self, commands: Vec<SimCommand>) -> Result<(), RecorderError> {
        let mut lines = Vec::new();
        for command in commands {
            let before = self.files.session.len() + lines.len() as u64;
            if is_about_recordings(&command) {
                continue;
            }
            if let SimCommand::SetPaused(paused) = command {
                self.is_paused = paused;
            }
            lines.extend(command_line(self.tick.0, &command).unwrap_or_default());
            self.logged.push((command, before));
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
        let is_turn = |fact: &SimFact| matches!(fact, SimFact::Undone | SimFact::Redone);
        let last_turn = facts.iter().rposition(is_turn);
        let (turned, rest) = facts.split_at(last_turn.map_or(0, |last| last + 1));
        for facts in turned.split_inclusive(is_turn) {
            let is_undo = facts.ends_with(&[SimFact::Undone]);
            let restored = if is_undo {
                self.undoable.last().map(|start| &start.before)
            } else {
                self.redoable.last().map(|segment| &segment.end)
            };
            let facts = &facts[..facts.len() - 1];
            let reported = restored.map_or(facts, |restored| restored.without_restored(facts));
            self.write_events(reported, stage, timeline)?;
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
            self.log(vec![SimCommand::SetPaused(paused.0)])?;
        }
        let unlogged = std::mem::take(&mut self.unlogged);
        self.log(unlogged)?;
        self.write_events(rest, stage, timeline)
    }

    fn write_events(
        &mut self,
        facts: &[SimFact],
        stage: &Stage,
        timeline: &mut Timeline,
    ) -> Result<(), RecorderError> {
        let frame = self.clock.frame(self.tick);
        let commands: Vec<_> = self
            .logged
            .iter()
            .map(|(command, _)| command.clone())
            .collect();
        let mut beginnings = beginnings(&commands, facts).into_iter();
        let mut lines = Vec::new();
        for fact in facts {
            self.note_act(fact, timeline);
            let event = match fact {
                SimFact::SegmentBegun => {
                    lines.splice(..0, self.objects.open(frame));
                    self.files
                        .text
                        .append_records(&std::mem::take(&mut lines))?;
                    self.begin_segment(beginnings.next().unwrap_or_default(), timeline)?;
                    continue;
                }
                SimFact::ObjectCreated { object, .. } => {
                    let Some(spec) = stage.spec(*object) else {
                        continue;
                    };
                    if !self.objects.create(spec) {
                        continue;
                    }
                    Event::Create(spec)
                }
                SimFact::ObjectDeleted { id } => {
                    if !self.objects.delete(id) {
                        continue;
                    }
                    Event::Delete { id }
                }
                SimFact::Grasped { hand, id } => Event::Grasp { hand: *hand, id },
                SimFact::Released { hand, .. } => Event::Release { hand: *hand },
                SimFact::Destroyed { hand, .. } => Event::Destroy { hand: *hand },
                _ => continue,
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
        match (act.actor, &mut timeline.segments[..]) {
            (Actor::Gripper(_), _) => timeline.grips.push(TimelineGrip {
                tick: self.tick,
                act,
            }),
            (Actor::Hand(_), [_, .., last]) if last.act.is_none() => {
                last.color = act.object.as_ref().and_then(|id| self.objects.color(id));
                last.act = Some(act);
            }
            // What falls off the world is lost to its hand, in the middle of a segment.
            (Actor::Hand(_), _) => {}
        }
    }

    fn begin_segment(
        &mut self,
        beginning: Beginning,
        timeline: &mut Timeline,
    ) -> Result<(), RecorderError> {
        let mut before = self.progress();
        if let Some(&(_, session)) = self.logged.get(beginning.before) {
            before.files.session = session;
        }
        let released = beginning.released.into_iter().map(SimCommand::Release);
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
            last_joints: self.last_joints,
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
            released.extend(command_line(start.tick.0, command).unwrap_or_default());
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
        let rows = joints::rows(tick, self.last_joints.as_ref(), stage.joints());
        self.last_joints = Some(*stage.joints());
        self.files.joints.append_records(&rows)
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
        write_png(picture, &folder.picture(segment, frame))?;
        if self.channels.depth {
            write_depth(picture, &channel("depth"))?;
        }
        if self.channels.ids {
            let shown = image.shown.iter();
            let numbers = shown.map(|&entity| self.objects.number_of(stage.shown(entity)));
            write_ids(picture, &numbers.collect::<Vec<_>>(), &channel("ids"))?;
        }
        Ok(())
    }

    /// Ends the recording with a last frame, after which every object is where its last `move` line says. If that does not fit on the
    /// disk, nothing of it stays. Returns the lines of the commands that were logged since the recording began.
    pub(crate) fn finish(
        &mut self,
        tick: SimTick,
        stage: &Stage,
        image: Option<&SensorImage>,
        timeline: &mut Timeline,
    ) -> Result<Vec<u8>, RecorderError> {
        timeline.end = tick;
        let commands = self.files.session.read_from(self.head)?;
        let text = self.files.text.len();
        let frame = self.clock.frame(tick);
        let line = command_line(tick.0, &SimCommand::FinishRecording).unwrap_or_default();
        let ended = self
            .write_frame(tick, Tracked::is_elsewhere, stage, image, timeline)
            .and_then(|()| self.files.session.append(&line));
        if let Err(error) = ended {
            // What has failed is told; more cannot be done.
            let _ = self.files.text.cut(text);
            if !self.clock.is_frame(tick) {
                let _ = self.files.folder.remove_pictures(self.files.segment, frame);
            }
            return Err(error);
        }
        if let Err(error) = self.files.drop_undone() {
            warn!("what was undone is still there: {error}");
        }
        Ok(commands)
    }
}
