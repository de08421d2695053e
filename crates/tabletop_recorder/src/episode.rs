//! A recording while it is made: one demonstration as a sequence of segments.

use std::path::Path;

use bevy::prelude::{Entity, warn};
use tabletop_core::{ObjectSpec, Paused, SensorImage, SimCommand, SimFact, SimTick};

use crate::{
    Channels, RecorderError, SessionHeader, SessionScene,
    cause::{Beginning, beginnings},
    change::Tracked,
    event::Event,
    folder::{Folder, create_folder},
    frame::FrameClock,
    joints::{self, Joints},
    log_file::LogFile,
    order::{in_order, is_about_recordings, turns_the_clock},
    picture::{write_depth, write_ids, write_png},
    prelude::Prelude,
    session::{command_line, session_line},
    states::{self, State},
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
}

/// What an image shows.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Shown<'w> {
    Table,
    Object(&'w ObjectSpec),
    Other,
}

/// How far a recording had come.
#[derive(Clone, Debug)]
struct Progress {
    segment: u32,
    objects: Vec<Tracked>,
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
    /// What the session log must say more, if the recording goes on from here.
    released: Vec<SimCommand>,
    tick: SimTick,
}

/// A segment that can be brought back.
#[derive(Clone, Debug)]
struct UndoneSegment {
    start: SegmentStart,
    end: Progress,
}

impl Episode {
    /// Begins a recording in a new folder.
    pub(crate) fn begin(
        folder: &Path,
        header: &SessionHeader,
        scene: &SessionScene,
        earlier: &Prelude,
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
        earlier: &Prelude,
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
        })
    }

    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
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
    pub(crate) fn write_facts<'w>(
        &mut self,
        tick: SimTick,
        facts: &[SimFact],
        paused: Paused,
        spec: impl Fn(Entity) -> Option<&'w ObjectSpec>,
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
            self.write_events(told, &spec)?;
            if is_undo {
                self.undo()?;
            } else {
                self.redo()?;
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
        self.write_events(rest, &spec)
    }

    fn write_events<'w>(
        &mut self,
        facts: &[SimFact],
        spec: &impl Fn(Entity) -> Option<&'w ObjectSpec>,
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
            let event = match fact {
                SimFact::SegmentBegun => {
                    lines.splice(..0, self.open(frame));
                    self.text.append_records(&std::mem::take(&mut lines))?;
                    self.begin_segment(beginnings.next().unwrap_or_default())?;
                    continue;
                }
                SimFact::ObjectCreated { id, object } => {
                    let Some(spec) = spec(*object) else { continue };
                    if let Some(opening) = &mut self.opening {
                        if opening.iter().all(|known| known.id != *id) {
                            opening.push(spec.clone());
                        }
                        continue;
                    }
                    if self.is_tracked(id) {
                        continue;
                    }
                    self.track(id);
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
        objects.iter().for_each(|spec| self.track(&spec.id));
        objects
            .iter()
            .map(|spec| Event::Create(spec).fields(frame))
            .collect()
    }

    fn track(&mut self, id: &str) {
        self.created += 1;
        self.objects.push(Tracked::new(id, self.created));
    }

    fn is_tracked(&self, id: &str) -> bool {
        self.objects.iter().any(|object| object.id == id)
    }

    fn begin_segment(&mut self, beginning: Beginning) -> Result<(), RecorderError> {
        let mut before = self.progress();
        if let Some(&(_, session)) = self.logged.get(beginning.before) {
            before.session = session;
        }
        let released = beginning.released.into_iter().map(SimCommand::Release);
        self.undoable.push(SegmentStart {
            before,
            released: released.collect(),
            tick: self.tick,
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
    fn undo(&mut self) -> Result<(), RecorderError> {
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
        self.redoable.push(UndoneSegment { start, end });
        Ok(())
    }

    /// Brings back the segment that was undone last, in the place of what was recorded since.
    fn redo(&mut self) -> Result<(), RecorderError> {
        let Some(UndoneSegment { start, end }) = self.redoable.pop() else {
            warn!("the world was set to what the recording does not know; the recording goes on");
            return Ok(());
        };
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
        self.created = progress.created;
        self.last_joints = progress.last_joints;
        self.is_paused = progress.is_paused;
        Ok(())
    }

    /// Writes what the end of a tick brings: a row for each object that has moved, and at a frame the moves and a picture.
    pub(crate) fn write_tick<'w>(
        &mut self,
        tick: SimTick,
        state: impl Fn(&str) -> Option<State>,
        joints: &Joints,
        image: Option<&SensorImage>,
        what: impl Fn(Entity) -> Shown<'w>,
    ) -> Result<(), RecorderError> {
        let is_frame = self.clock.is_frame(tick);
        let frame = self.clock.frame(tick);
        let mut moves = Vec::new();
        let mut rows = Vec::new();
        for object in &mut self.objects {
            let Some(state) = state(&object.id) else {
                continue;
            };
            let pose = state.pose;
            if is_frame && object.is_news(pose) {
                object.report(pose);
                let id = &object.id;
                moves.push(Event::Move { id, pose }.fields(frame));
            }
            if object.note(state) {
                rows.push(states::row(tick, &object.id, state));
            }
        }
        if !moves.is_empty()
            && let Some(image) = image
        {
            self.write_image(frame, image, what)?;
        }
        self.text.append_records(&moves)?;
        self.states.append_records(&rows)?;
        let rows = joints::rows(tick, self.last_joints.as_ref(), joints);
        self.last_joints = Some(*joints);
        self.joints.append_records(&rows)
    }

    fn write_image<'w>(
        &self,
        frame: u64,
        image: &SensorImage,
        what: impl Fn(Entity) -> Shown<'w>,
    ) -> Result<(), RecorderError> {
        let channel = |name| self.folder.channel(self.segment, frame, name);
        let picture = &image.picture;
        write_png(picture, &self.folder.picture(self.segment, frame))?;
        if self.channels.depth {
            write_depth(picture, &channel("depth"))?;
        }
        if self.channels.ids {
            let numbers = image
                .shown
                .iter()
                .map(|&entity| self.number_of(what(entity)));
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

    /// The lines of the commands that were logged since the recording began.
    pub(crate) fn commands(&self) -> Result<Vec<u8>, RecorderError> {
        self.session.read_from(self.head)
    }

    /// Ends the recording.
    pub(crate) fn finish(&mut self, tick: SimTick) -> Result<(), RecorderError> {
        let line = command_line(tick.0, &SimCommand::FinishRecording).unwrap_or_default();
        self.session.append(&line)?;
        if let Err(error) = self.drop_undone() {
            warn!("what was undone is still there: {error}");
        }
        Ok(())
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
