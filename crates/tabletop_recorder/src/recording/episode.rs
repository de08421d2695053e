//! A recording while it is made: one demonstration as a sequence of segments.

use std::{collections::BTreeMap, path::Path};

use bevy::prelude::warn;
use tabletop_core::{
    Act, Actor, ObjectSpec, Paused, Pose, Rgb, SensorImage, SimCommand, SimFact, SimTick, Timeline,
    TimelineGrip, TimelinePicture, TimelineSegment, TimelineStage,
};

use crate::{
    cause::{Beginning, beginnings},
    error::RecorderError,
    files::{
        channels::Channels,
        event::Event,
        folder::{Folder, create_folder},
        frame::FrameClock,
        joints::{self, Joints},
        log_file::LogFile,
        picture::{write_depth, write_ids, write_png},
        session::{SessionHeader, SessionScene, command_line, session_line},
        states,
    },
    order::{in_order, is_about_recordings, turns_the_clock},
    recording::{
        earlier_commands::EarlierCommands,
        stage::{Shown, Sight, Stage},
        timeline_mark::{TimelineMark, TimelineTail},
        tracked::Tracked,
    },
};

/// A running recording.
#[derive(Debug)]
pub(crate) struct Episode {
    folder: Folder,
    clock: FrameClock,
    session: LogFile,
    states: LogFile,
    joints: LogFile,
    text: LogFile,
    segment: u32,
    objects: Vec<Tracked>,
    /// What there was to be seen at the last frame.
    sight: Sight,
    /// The robot's joints at the end of the tick before.
    last_joints: Option<Joints>,
    /// How many `create` lines were written.
    created: usize,
    /// Whether the simulation is paused where the session log ends.
    is_paused: bool,
    channels: Channels,
    /// The objects of the first tick, until their `create` lines are written.
    opening: Option<Vec<ObjectSpec>>,
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
    /// The colours of all objects that there were.
    colors: BTreeMap<String, Rgb>,
    /// How many pictures were written, also of what was undone.
    pictures: usize,
}

/// How far a recording had come.
#[derive(Clone, Debug)]
struct Progress {
    segment: u32,
    objects: Vec<Tracked>,
    sight: Sight,
    created: usize,
    text: u64,
    session: u64,
    states: u64,
    joints: u64,
    last_joints: Option<Joints>,
    is_paused: bool,
}

/// The moment before a segment began.
#[derive(Clone, Debug)]
struct SegmentStart {
    before: Progress,
    timeline: TimelineMark,
    /// What the session log must say more, if the recording goes on from here.
    released: Vec<SimCommand>,
    tick: SimTick,
}

/// A segment that can be brought back.
#[derive(Clone, Debug)]
struct UndoneSegment {
    start: SegmentStart,
    end: Progress,
    timeline: TimelineTail,
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
        Folder::create(folder, |folder| {
            Self::begin_in(folder, header, scene, earlier, channels)
        })
    }

    fn begin_in(
        folder: Folder,
        header: &SessionHeader,
        scene: &SessionScene,
        earlier: &EarlierCommands,
        channels: Channels,
    ) -> Result<Self, RecorderError> {
        let mut session = LogFile::create(folder.session())?;
        session.lock();
        for line in [session_line(header), session_line(scene)] {
            let line =
                line.map_err(|error| RecorderError::write(&folder.session())(error.into()))?;
            session.append(&line)?;
        }
        session.append(earlier.lines())?;
        let mut states = LogFile::create(folder.states())?;
        states.append_records(&[states::header()])?;
        let mut joints = LogFile::create(folder.joints())?;
        joints.append_records(&[joints::header()])?;
        create_folder(&folder.pictures(0))?;
        let text = LogFile::create(folder.text(0))?;
        let objects = scene.objects.iter().map(|object| object.spec.clone());
        let start = SimTick(header.start_tick);
        Ok(Self {
            folder,
            clock: FrameClock { start },
            head: session.len(),
            session,
            states,
            joints,
            text,
            segment: 0,
            objects: Vec::new(),
            sight: Sight::default(),
            last_joints: None,
            created: 0,
            is_paused: earlier.is_paused(),
            channels,
            opening: Some(objects.collect()),
            tick: start,
            logged: Vec::new(),
            unlogged: Vec::new(),
            undoable: Vec::new(),
            redoable: Vec::new(),
            colors: BTreeMap::new(),
            pictures: 0,
        })
    }

    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
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
            let before = self.session.len() + lines.len() as u64;
            if is_about_recordings(&command) {
                continue;
            }
            if let SimCommand::SetPaused(paused) = command {
                self.is_paused = paused;
            }
            lines.extend(command_line(self.tick.0, &command).unwrap_or_default());
            self.logged.push((command, before));
        }
        self.session.append(&lines)
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
            let told = without_restored(&facts[..facts.len() - 1], restored);
            self.write_events(told, stage, timeline)?;
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
                    lines.splice(..0, self.open(frame));
                    self.text.append_records(&std::mem::take(&mut lines))?;
                    self.begin_segment(beginnings.next().unwrap_or_default(), timeline)?;
                    continue;
                }
                SimFact::ObjectCreated { id, object } => {
                    let Some(spec) = stage.spec(*object) else {
                        continue;
                    };
                    if let Some(opening) = &mut self.opening {
                        if opening.iter().all(|known| known.id != *id) {
                            opening.push(spec.clone());
                        }
                        continue;
                    }
                    if self.is_tracked(id) {
                        continue;
                    }
                    self.track(spec);
                    Event::Create(spec)
                }
                SimFact::ObjectDeleted { id } => {
                    if let Some(opening) = &mut self.opening {
                        opening.retain(|known| known.id != *id);
                        continue;
                    }
                    if !self.is_tracked(id) {
                        continue;
                    }
                    self.objects.retain(|object| object.id != *id);
                    Event::Delete { id }
                }
                SimFact::Grasped { hand, id } => Event::Grasp { hand: *hand, id },
                SimFact::Released { hand, .. } => Event::Release { hand: *hand },
                SimFact::Destroyed { hand, .. } => Event::Destroy { hand: *hand },
                _ => continue,
            };
            lines.push(event.fields(frame));
        }
        lines.splice(..0, self.open(frame));
        self.text.append_records(&lines)
    }

    /// The `create` lines of the objects that are there at the beginning.
    fn open(&mut self, frame: u64) -> Vec<Vec<String>> {
        let objects = self.opening.take().unwrap_or_default();
        objects.iter().for_each(|spec| self.track(spec));
        objects
            .iter()
            .map(|spec| Event::Create(spec).fields(frame))
            .collect()
    }

    fn track(&mut self, spec: &ObjectSpec) {
        self.created += 1;
        self.objects.push(Tracked::new(&spec.id, self.created));
        if let Some(solid) = spec.shape.drawn().first() {
            self.colors.insert(spec.id.clone(), solid.color);
        }
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
                let color = |id| self.colors.get(id).copied();
                last.color = act.object.as_ref().and_then(color);
                last.act = Some(act);
            }
            // What falls off the world is lost to its hand, in the middle of a segment.
            (Actor::Hand(_), _) => {}
        }
    }

    fn is_tracked(&self, id: &str) -> bool {
        self.objects.iter().any(|object| object.id == id)
    }

    fn begin_segment(
        &mut self,
        beginning: Beginning,
        timeline: &mut Timeline,
    ) -> Result<(), RecorderError> {
        let mut before = self.progress();
        if let Some(&(_, session)) = self.logged.get(beginning.before) {
            before.session = session;
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
            self.drop_undone()?;
        }
        let segment = self.segment + 1;
        create_folder(&self.folder.pictures(segment))?;
        self.text = LogFile::create(self.folder.text(segment))?;
        self.segment = segment;
        Ok(())
    }

    fn progress(&self) -> Progress {
        Progress {
            segment: self.segment,
            objects: self.objects.clone(),
            sight: self.sight.clone(),
            created: self.created,
            text: self.text.len(),
            session: self.session.len(),
            states: self.states.len(),
            joints: self.joints.len(),
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
        let away = self.folder.undone_segment(end.segment);
        create_folder(away.path())?;
        self.session
            .cut_to_file(start.before.session, away.session())?;
        self.states
            .cut_to_file(start.before.states, away.states())?;
        self.joints
            .cut_to_file(start.before.joints, away.joints())?;
        self.folder.move_segment(end.segment, &away)?;
        for command in &start.released {
            let line = command_line(start.tick.0, command).unwrap_or_default();
            self.session.append(&line)?;
        }
        self.resume(start.before.clone())?;
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
        let away = self.folder.undone_segment(end.segment);
        self.folder
            .remove_pictures(start.before.segment, self.clock.frame(start.tick))?;
        self.text.cut(start.before.text)?;
        self.session.cut(start.before.session)?;
        self.session.append_file(&away.session())?;
        self.states.cut(start.before.states)?;
        self.states.append_file(&away.states())?;
        self.joints.cut(start.before.joints)?;
        self.joints.append_file(&away.joints())?;
        away.move_segment(end.segment, &self.folder)?;
        away.remove()?;
        self.resume(end)?;
        self.undoable.push(start);
        Ok(())
    }

    fn resume(&mut self, progress: Progress) -> Result<(), RecorderError> {
        self.text = LogFile::reopen(self.folder.text(progress.segment), progress.text)?;
        self.segment = progress.segment;
        self.objects = progress.objects;
        self.sight = progress.sight;
        self.created = progress.created;
        self.last_joints = progress.last_joints;
        self.is_paused = progress.is_paused;
        Ok(())
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
        let mut rows = Vec::new();
        for object in &mut self.objects {
            if let Some(state) = stage.state(&object.id)
                && object.note(state)
            {
                rows.push(states::row(tick, &object.id, state));
            }
        }
        self.states.append_records(&rows)?;
        let rows = joints::rows(tick, self.last_joints.as_ref(), stage.joints());
        self.last_joints = Some(*stage.joints());
        self.joints.append_records(&rows)
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
        for object in &mut self.objects {
            if let Some(state) = stage.state(&object.id)
                && is_told(object, state.pose)
            {
                object.report(state.pose);
                let (id, pose) = (&object.id, state.pose);
                moves.push(Event::Move { id, pose }.fields(frame));
            }
        }
        let sight = stage.sight(&self.objects);
        let is_another = sight != self.sight;
        self.sight = sight;
        if (is_another || !moves.is_empty())
            && let Some(image) = image
        {
            self.write_image(frame, image, stage)?;
            self.pictures += 1;
            let path = self.folder.picture(self.segment, frame);
            timeline.pictures.pop_if(|last| last.path == path);
            timeline.pictures.push(TimelinePicture {
                tick,
                path,
                serial: self.pictures,
            });
        }
        self.text.append_records(&moves)
    }

    fn write_image(
        &self,
        frame: u64,
        image: &SensorImage,
        stage: &Stage,
    ) -> Result<(), RecorderError> {
        let channel = |name| self.folder.channel(self.segment, frame, name);
        let picture = &image.picture;
        write_png(picture, &self.folder.picture(self.segment, frame))?;
        if self.channels.depth {
            write_depth(picture, &channel("depth"))?;
        }
        if self.channels.ids {
            let shown = image.shown.iter();
            let numbers = shown.map(|&entity| self.number_of(stage.shown(entity)));
            write_ids(picture, &numbers.collect::<Vec<_>>(), &channel("ids"))?;
        }
        Ok(())
    }

    /// What stands for something in an image of ids.
    fn number_of(&self, shown: Shown) -> u16 {
        let number = match shown {
            Shown::Table => Some(1),
            Shown::Object(spec) => {
                let object = self.objects.iter().find(|object| object.id == spec.id);
                object.and_then(|object| u16::try_from(object.number + 1).ok())
            }
            Shown::Other => None,
        };
        number.unwrap_or(u16::MAX)
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
        let commands = self.session.read_from(self.head)?;
        let text = self.text.len();
        let frame = self.clock.frame(tick);
        let line = command_line(tick.0, &SimCommand::FinishRecording).unwrap_or_default();
        let ended = self
            .write_frame(tick, Tracked::is_elsewhere, stage, image, timeline)
            .and_then(|()| self.session.append(&line));
        if let Err(error) = ended {
            // What has failed is told; more cannot be done.
            let _ = self.text.cut(text);
            if !self.clock.is_frame(tick) {
                let _ = self.folder.remove_pictures(self.segment, frame);
            }
            return Err(error);
        }
        if let Err(error) = self.drop_undone() {
            warn!("what was undone is still there: {error}");
        }
        Ok(commands)
    }

    /// Removes for good what was undone.
    fn drop_undone(&self) -> Result<(), RecorderError> {
        self.folder.undone().remove()
    }
}

/// The facts without those at their end that only tell what turning the clock has brought back or taken away.
fn without_restored<'f>(facts: &'f [SimFact], restored: Option<&Progress>) -> &'f [SimFact] {
    let Some(restored) = restored else {
        return facts;
    };
    let is_there = |id: &str| restored.objects.iter().any(|object| object.id == id);
    let told = facts.iter().rposition(|fact| match fact {
        SimFact::ObjectCreated { id, .. } => !is_there(id),
        SimFact::ObjectDeleted { id } => is_there(id),
        _ => true,
    });
    &facts[..told.map_or(0, |last| last + 1)]
}
