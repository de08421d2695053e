//! Commands before a recording: its replay begins with them.

use std::mem;

use bevy::prelude::warn;
use tabletop_core::{
    Actor, ClockCommand, CommandId, CommandSystems, Hand, HandCommand, HistoryFact, IssuedCommand,
    Paused, SceneCommand, SimCommand, SimFact, SimTick,
};

use crate::{
    files::session::{SessionCommand, command_line, is_logged},
    recording::released::released_by,
};

/// A longer log is not kept: some three hours of moving something without a break.
const MOST_BYTES: usize = 64 << 20;

/// The commands since the world was last empty: since the program started, or since a scene was put on the table while no
/// hand held anything and the robot had not been used. It follows undo and redo, as the world does.
#[derive(Clone, Debug, Default)]
pub(crate) struct EarlierCommands {
    log: EarlierLog,
    /// The commands of the last tick, each with the log before it.
    noted: Vec<Noted>,
    /// The changes that can be undone, the oldest first.
    undoable: Vec<EarlierChange>,
    /// Undone changes, the last one last.
    redoable: Vec<UndoneChange>,
}

/// A log of commands, and what the next one needs to know of them.
#[derive(Clone, Debug)]
struct EarlierLog {
    /// The lines of a session log.
    lines: Vec<u8>,
    course: EarlierCourse,
}

/// What is known of the world after the commands of a log.
#[derive(Clone, Copy, Debug)]
struct EarlierCourse {
    /// The tick of the first command; `None` if they were too many to be kept.
    begin: Option<SimTick>,
    /// Their number.
    count: usize,
    /// Tick and phase of the last one.
    last: Option<(SimTick, CommandSystems)>,
    is_paused: bool,
    /// The robot and its markers outlive a scene.
    has_used_robot: bool,
}

/// A command, and the log before it.
#[derive(Clone, Debug)]
struct Noted {
    id: CommandId,
    actor: Actor,
    before: LogMark,
}

/// An earlier state of a log.
#[derive(Clone, Debug)]
struct LogMark {
    /// The number of bytes that the lines had.
    len: usize,
    course: EarlierCourse,
    /// The lines themselves, if others have taken their place since.
    replaced: Option<Vec<u8>>,
}

/// A change of the world that can be undone.
#[derive(Clone, Debug)]
struct EarlierChange {
    before: LogMark,
    /// The releases that came before it because of the same command, and stay.
    released: Vec<SessionCommand>,
}

/// A change that was undone.
#[derive(Clone, Debug)]
struct UndoneChange {
    change: EarlierChange,
    taken: TakenLines,
    course: EarlierCourse,
}

/// Lines that undo has taken away.
#[derive(Clone, Debug)]
enum TakenLines {
    /// Those behind the mark.
    End(Vec<u8>),
    /// All of them: those of the mark are back in their place.
    All(Vec<u8>),
}

impl Default for EarlierLog {
    fn default() -> Self {
        Self {
            lines: Vec::new(),
            course: EarlierCourse {
                begin: Some(SimTick(0)),
                count: 0,
                last: None,
                is_paused: false,
                has_used_robot: false,
            },
        }
    }
}

impl EarlierCommands {
    pub(crate) fn begin(&self) -> Option<SimTick> {
        self.log.course.begin
    }

    pub(crate) fn lines(&self) -> &[u8] {
        &self.log.lines
    }

    /// Tick and phase of the last command.
    pub(crate) fn last(&self) -> Option<(SimTick, CommandSystems)> {
        self.log.course.last
    }

    /// True if the simulation was paused before the commands of this tick.
    pub(crate) fn is_paused(&self) -> bool {
        self.log.course.is_paused
    }

    pub(crate) fn count(&self) -> usize {
        self.log.course.count
    }

    /// The commands since a tick before which the world was empty.
    pub(crate) fn since(begin: SimTick, commands: &[SessionCommand]) -> Self {
        let mut earlier = Self::default();
        earlier.log.course.begin = Some(begin);
        for command in commands {
            earlier.log.append_command(command);
            earlier.note_lasting(&command.command);
        }
        earlier
    }

    /// Takes in the commands of a tick in which nothing is recorded, in the order in which they are carried out.
    pub(crate) fn note(
        &mut self,
        tick: SimTick,
        commands: &[IssuedCommand],
        hands_are_empty: bool,
    ) {
        self.noted.clear();
        let mut logged = commands.iter().filter(|issued| is_logged(&issued.command));
        let goes_back = |first: &IssuedCommand| self.log.goes_back(tick, first.command.phase());
        if logged.next().is_some_and(goes_back) {
            self.log.append_pause(tick, true);
            self.log.append_pause(tick, false);
        }
        let mut follows = false;
        for issued in commands {
            let mut before = self.log.mark();
            let sets_scene = match &issued.command {
                SimCommand::Scene(SceneCommand::Set(_)) => true,
                SimCommand::Scene(
                    SceneCommand::Load(_)
                    | SceneCommand::Clear
                    | SceneCommand::Make { .. }
                    | SceneCommand::Edit(_),
                )
                | SimCommand::Recording(_)
                | SimCommand::Clock(_)
                | SimCommand::History(_)
                | SimCommand::Hand(_)
                | SimCommand::Mechanism(_)
                | SimCommand::Robot(_) => false,
            };
            if sets_scene && hands_are_empty && !self.log.course.has_used_robot {
                before.replaced = Some(self.log.begin_at(tick));
                follows = false;
            }
            let is_scene = matches!(issued.command, SimCommand::Scene(_));
            self.log.append_command(&SessionCommand {
                at_once: self.log.course.is_paused && is_scene && follows,
                ..SessionCommand::of(tick, issued)
            });
            follows |= is_scene;
            self.note_lasting(&issued.command);
            self.noted.push(Noted {
                id: issued.id,
                actor: issued.actor,
                before,
            });
        }
    }

    /// Notes that a recording begins in this tick: in a pause, if undo has left commands of it.
    pub(crate) fn begin_recording(&mut self, tick: SimTick) {
        if self.log.goes_back(tick, CommandSystems::Recording) {
            self.log.append_pause(tick, true);
        }
    }

    /// Notes the effects of a command that outlive a scene. To be called for recorded commands, too.
    pub(crate) fn note_lasting(&mut self, command: &SimCommand) {
        match command {
            SimCommand::Clock(ClockCommand::SetPaused(paused)) => {
                self.log.course.is_paused = *paused;
            }
            SimCommand::Robot(_) => self.log.course.has_used_robot = true,
            SimCommand::Recording(_)
            | SimCommand::Scene(_)
            | SimCommand::History(_)
            | SimCommand::Hand(_)
            | SimCommand::Mechanism(_) => {}
        }
    }

    /// Notes whether the simulation is paused. To be called while a recording runs, which logs pauses itself.
    pub(crate) const fn note_pause(&mut self, paused: Paused) {
        self.log.course.is_paused = paused.0;
    }

    /// Follows undo and redo to this tick, in which the simulation is paused or not. A pause is not undone, and a player pauses without a
    /// command where one was.
    pub(crate) fn follow(&mut self, history: &[HistoryFact], tick: SimTick, paused: Paused) {
        for fact in history {
            match fact {
                HistoryFact::Undone { .. } => self.undo(),
                HistoryFact::Redone { .. } => self.redo(),
                HistoryFact::SegmentBegun { .. } | HistoryFact::Kept { .. } => {}
            }
        }
        if self.log.course.is_paused != paused.0 {
            self.log.append_pause(tick, paused.0);
        }
    }

    /// Notes the changes of a tick that can be undone.
    pub(crate) fn end_tick(&mut self, tick: SimTick, facts: &[SimFact]) {
        for (index, fact) in facts.iter().enumerate() {
            if let SimFact::History(HistoryFact::Kept { cause }) = fact {
                self.keep(*cause, tick, &released_by(*cause, &facts[..index]));
            }
        }
        let is_lost = |noted: Noted| noted.before.replaced.is_some();
        if self.noted.drain(..).any(is_lost) {
            // The log before that scene is gone.
            self.forget_changes();
        }
    }

    /// Notes that the world before a command of this tick can be brought back, or before what it did after it had emptied these hands.
    fn keep(&mut self, cause: CommandId, tick: SimTick, released: &[Hand]) {
        let Some(noted) = self.noted.iter_mut().find(|noted| noted.id == cause) else {
            return self.forget_changes();
        };
        let actor = noted.actor;
        let before = LogMark {
            replaced: noted.before.replaced.take(),
            ..noted.before
        };
        let released = released.iter().map(|&hand| SessionCommand {
            tick: tick.0,
            actor,
            command: HandCommand::Release(hand).into(),
            at_once: false,
        });
        self.undoable.push(EarlierChange {
            before,
            released: released.collect(),
        });
        self.redoable.clear();
    }

    fn undo(&mut self) {
        let Some(mut change) = self.undoable.pop() else {
            warn!(
                "the world is as it was before the log of its commands; no recording can be replayed until a scene is set"
            );
            return self.log.forget();
        };
        let course = self.log.course;
        let taken = self.log.go_back(&mut change.before);
        for release in &change.released {
            self.log.append_command(release);
        }
        self.redoable.push(UndoneChange {
            change,
            taken,
            course,
        });
    }

    /// The undone lines take the place of later ones.
    fn redo(&mut self) {
        let Some(undone) = self.redoable.pop() else {
            return self.log.forget();
        };
        let UndoneChange {
            mut change,
            taken,
            course,
        } = undone;
        self.log.go_on(&mut change.before, taken, course);
        self.undoable.push(change);
    }

    /// Adds the lines that a recording has logged since it started; `None` if they are not known. What was before can no longer be undone.
    pub(crate) fn append_recorded(&mut self, lines: Option<&[u8]>) {
        self.forget_changes();
        match lines {
            Some(lines) => {
                let count = lines.iter().filter(|&&byte| byte == b'\n').count();
                self.log.append(lines, count);
            }
            None => self.log.forget(),
        }
    }

    fn forget_changes(&mut self) {
        self.undoable.clear();
        self.redoable.clear();
    }
}

impl EarlierLog {
    fn mark(&self) -> LogMark {
        LogMark {
            len: self.lines.len(),
            course: self.course,
            replaced: None,
        }
    }

    /// Begins anew, and returns the lines so far.
    fn begin_at(&mut self, tick: SimTick) -> Vec<u8> {
        let lines = mem::take(&mut self.lines);
        self.forget();
        self.course.begin = Some(tick);
        if self.course.is_paused {
            self.append_pause(tick, true);
        }
        lines
    }

    /// Goes back to a mark, and returns the lines that this takes away.
    fn go_back(&mut self, mark: &mut LogMark) -> TakenLines {
        self.course = mark.course;
        match mark.replaced.take() {
            Some(lines) => TakenLines::All(mem::replace(&mut self.lines, lines)),
            None if mark.len <= self.lines.len() => TakenLines::End(self.lines.split_off(mark.len)),
            None => {
                self.forget();
                TakenLines::End(Vec::new())
            }
        }
    }

    /// Goes on from a mark to where it was left.
    fn go_on(&mut self, mark: &mut LogMark, taken: TakenLines, course: EarlierCourse) {
        self.lines.truncate(mark.len);
        match taken {
            TakenLines::End(lines) => self.lines.extend(lines),
            TakenLines::All(lines) => mark.replaced = Some(mem::replace(&mut self.lines, lines)),
        }
        self.course = course;
    }

    /// True if a tick goes on with an earlier phase than those of the commands that undo has left of it: a pause has to lie between them.
    fn goes_back(&self, tick: SimTick, phase: CommandSystems) -> bool {
        !self.course.is_paused && Some((tick, phase)) <= self.course.last
    }

    fn append_pause(&mut self, tick: SimTick, paused: bool) {
        self.append_command(&SessionCommand::of_app(
            tick,
            ClockCommand::SetPaused(paused),
        ));
        self.course.is_paused = paused;
    }

    fn append_command(&mut self, command: &SessionCommand) {
        if is_logged(&command.command) {
            self.course.last = Some((SimTick(command.tick), command.command.phase()));
            match command_line(command) {
                Ok(line) => self.append(&line, 1),
                Err(error) => {
                    warn!("no recording can be replayed until a scene is set: {error}");
                    self.forget();
                }
            }
        }
    }

    fn append(&mut self, lines: &[u8], count: usize) {
        if self.lines.len() + lines.len() > MOST_BYTES {
            self.forget();
        } else if self.course.begin.is_some() {
            self.course.count += count;
            self.lines.extend_from_slice(lines);
        }
    }

    fn forget(&mut self) {
        self.course.begin = None;
        self.course.count = 0;
        self.lines = Vec::new();
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::{HandFact, RecordingCommand, RobotCommand};

    use super::*;

    fn scene() -> IssuedCommand {
        issued(SceneCommand::Set(Box::default()))
    }

    fn issued(command: impl Into<SimCommand>) -> IssuedCommand {
        IssuedCommand {
            id: CommandId(0),
            actor: Actor::Key,
            is_replayed: false,
            command: command.into(),
        }
    }

    fn lines_of(earlier: &EarlierCommands) -> Vec<String> {
        let lines = std::str::from_utf8(earlier.lines()).unwrap();
        let reported: Vec<_> = lines.lines().map(str::to_owned).collect();
        assert_eq!(reported.len(), earlier.count());
        reported
    }

    #[test]
    fn it_goes_back_to_the_last_scene_that_empties_the_world() {
        let mut earlier = EarlierCommands::default();
        assert_eq!(earlier.begin(), Some(SimTick(0)));
        earlier.note(
            SimTick(3),
            &[scene(), issued(HandCommand::Release(Hand::Left))],
            true,
        );
        assert_eq!(earlier.begin(), Some(SimTick(3)));
        let first = lines_of(&earlier);
        assert!(first[0].contains("Scene") && first[1].contains("Release"));
        earlier.note(SimTick(5), &[scene()], false);
        assert_eq!(earlier.begin(), Some(SimTick(3)));
        assert_eq!(earlier.count(), 3);
        earlier.note(
            SimTick(9),
            &[issued(RecordingCommand::Start), scene()],
            true,
        );
        assert_eq!((earlier.begin(), earlier.count()), (Some(SimTick(9)), 1));
    }

    #[test]
    fn earlier_commands_are_reported_as_noted() {
        let commands = [
            (3, scene()),
            (4, issued(RobotCommand::Show(true))),
            (5, scene()),
            (6, issued(ClockCommand::SetPaused(true))),
        ];
        let mut noted = EarlierCommands::default();
        for (tick, command) in &commands {
            noted.note(SimTick(*tick), std::slice::from_ref(command), true);
        }
        let commands = commands.map(|(tick, command)| SessionCommand::of(SimTick(tick), &command));
        let again = EarlierCommands::since(SimTick(3), &commands);
        assert_eq!(again.begin(), noted.begin());
        assert_eq!(lines_of(&again), lines_of(&noted));
        assert_eq!(again.is_paused(), noted.is_paused());
        assert_eq!(
            again.log.course.has_used_robot,
            noted.log.course.has_used_robot
        );
    }

    #[test]
    fn a_grasp_that_lets_go_of_something_first_is_undone_in_two_steps() {
        let (tick, cause) = (SimTick(5), CommandId(0));
        let grasp = HandCommand::Grasp {
            hand: Hand::Left,
            object: "block".into(),
        };
        let released = HandFact::Released {
            cause: Some(cause),
            hand: Hand::Left,
            id: "ball".into(),
        };
        let kept = SimFact::from(HistoryFact::Kept { cause });
        let mut earlier = EarlierCommands::default();
        earlier.note(tick, &[issued(grasp)], false);
        earlier.end_tick(tick, &[kept.clone(), released.into(), kept]);
        let mut follow = |fact: HistoryFact| {
            earlier.follow(&[fact], tick, Paused(false));
            let names = lines_of(&earlier).into_iter().map(|line| {
                let is_release = line.contains("Release");
                if is_release { "release" } else { "grasp" }
            });
            names.collect::<Vec<_>>()
        };
        let (undone, redone) = (HistoryFact::Undone { cause }, HistoryFact::Redone { cause });
        assert_eq!(follow(undone.clone()), ["release"]);
        assert!(follow(undone).is_empty());
        assert_eq!(follow(redone.clone()), ["release"]);
        assert_eq!(follow(redone), ["grasp"]);
    }

    #[test]
    fn a_pause_and_the_robot_outlive_a_scene() {
        let mut earlier = EarlierCommands::default();
        earlier.note(SimTick(1), &[issued(ClockCommand::SetPaused(true))], true);
        earlier.note(SimTick(1), &[scene()], true);
        assert!(lines_of(&earlier)[0].contains("SetPaused"));
        earlier.note(SimTick(2), &[issued(RobotCommand::Show(true))], true);
        earlier.note(SimTick(3), &[scene()], true);
        assert_eq!((earlier.begin(), earlier.count()), (Some(SimTick(1)), 4));
    }

    #[test]
    fn too_long_a_log_is_dropped_until_the_next_scene() {
        let mut earlier = EarlierCommands::default();
        earlier.append_recorded(Some(&vec![b'\n'; MOST_BYTES + 1]));
        earlier.note(SimTick(8), &[issued(SceneCommand::Clear)], true);
        assert_eq!((earlier.begin(), earlier.count()), (None, 0));
        earlier.note(SimTick(9), &[scene()], true);
        assert_eq!((earlier.begin(), earlier.count()), (Some(SimTick(9)), 1));
        earlier.append_recorded(None);
        assert_eq!(earlier.begin(), None);
    }
}
