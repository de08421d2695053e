//! Edits of recordings: segments left out, in another order, faster or slower, or appended. The commands are simulated again; what comes of
//! them is a new recording.

use std::{
    collections::{BTreeMap, BTreeSet},
    ops::RangeInclusive,
};

use bevy::prelude::*;
use tabletop_core::{
    Actor, HandFact, IssuedCommand, RecordingCommand, RobotFact, SimCommand, SimFact, SimSystems,
    SimTick, StepApp as _,
};
use tabletop_recorder::{RecorderPlugin, Session, SessionCommand, UnrecordedPlugin};
use tabletop_sim::headless_app_with;

use crate::{Player, Replay};

/// An edit of a recording. Segments have the numbers that they had before all edits.
#[derive(Clone, Debug)]
pub enum SegmentEdit {
    /// Leaves out segments.
    Drop(BTreeSet<u32>),
    /// Lets two runs of segments change places.
    Swap(RangeInclusive<u32>, RangeInclusive<u32>),
    /// Lets a segment take so many times its time.
    Retime(u32, f64),
    /// Appends the segments of another recording.
    Splice(Box<Replay>),
}

/// The reason why an edit is refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EditError {
    /// There is no segment of this number, or it is the first one, which stays.
    #[error("there is no segment {number} to edit; the recording has segments 1 to {last}")]
    NoSegment {
        /// The number.
        number: u32,
        /// That of the last segment.
        last: u32,
    },
    /// Segments begin in one tick and cannot be told apart.
    #[error("segments {0} and {1} begin in the same tick; edit them together")]
    Together(u32, u32),
    /// Runs of segments overlap.
    #[error("the segments to be swapped overlap")]
    Overlap,
    /// The time has no sense.
    #[error("{0} is no factor of a segment's time, expected 0.01 to 100")]
    Factor(String),
    /// A command is refused that was not before.
    #[error("segment {segment}: {reason}")]
    Refused {
        /// The number of the segment; those of a spliced recording have theirs.
        segment: u32,
        /// The reason.
        reason: String,
    },
    /// A hand or gripper does something else in a segment.
    #[error(
        "segment {segment}: the {deed} {}",
        match happens {
            true => "happens now, which it did not before",
            false => "does not happen any more",
        }
    )]
    OtherDeeds {
        /// The number of the segment; those of a spliced recording have theirs.
        segment: u32,
        /// What is done to which object.
        deed: String,
        /// True if it happens now, false if it does not any more.
        happens: bool,
    },
}

/// Factors of a segment's time.
const FACTORS: RangeInclusive<f64> = 0.01..=100.0;

/// Segments that begin in the same tick, with their commands.
#[derive(Clone, Debug)]
struct CommandBlock {
    segments: RangeInclusive<u32>,
    ticks: u64,
    /// Their ticks count from its beginning.
    commands: Vec<SessionCommand>,
    /// What hands and grippers did in it, in order of their texts.
    deeds: Vec<String>,
}

impl Replay {
    /// The recording with these edits, which were tried in a simulation.
    ///
    /// # Errors
    /// An edit makes no sense, or its result fails: a command is refused that was not, or a hand takes or releases something else.
    pub fn edited(&self, edits: &[SegmentEdit]) -> Result<Self, EditError> {
        let before = EditTrial::of(self);
        let mut blocks = blocks_of(self, &before);
        let mut refused = before.refused;
        for edit in edits {
            apply(edit, &mut blocks, &mut refused)?;
        }
        let edited = self.with_session(joined(self.session(), &blocks));
        let after = EditTrial::of(&edited);
        check(&blocks, &refused, &after, self.session().header.start_tick)?;
        Ok(edited)
    }
}

/// What a simulation of a recording has refused, and what hands and grippers did in it.
#[derive(Clone, Debug, Default)]
struct EditTrial {
    /// The refused commands, as texts, each with tick and reason.
    refused: Vec<(String, u64, String)>,
    /// What hands and grippers did, with the ticks.
    deeds: Vec<(u64, String)>,
}

impl EditTrial {
    fn of(replay: &Replay) -> Self {
        let plugins = replay.plugins().disable::<RecorderPlugin>();
        let mut app = headless_app_with(plugins.add(UnrecordedPlugin));
        app.init_resource::<EditNotes>()
            .add_systems(FixedUpdate, take_notes.in_set(SimSystems::Record));
        replay.play_in(&mut app);
        while !app.world().resource::<Player>().is_over() {
            app.step(1);
        }
        let mut notes = app.world_mut().resource_mut::<EditNotes>();
        std::mem::take(&mut notes.trial)
    }
}

#[derive(Resource, Default)]
struct EditNotes {
    trial: EditTrial,
    given: BTreeMap<u64, String>,
}

fn take_notes(
    tick: Res<SimTick>,
    mut given: MessageReader<IssuedCommand>,
    mut facts: MessageReader<SimFact>,
    mut notes: ResMut<EditNotes>,
) {
    let EditNotes { trial, given: all } = &mut *notes;
    for issued in given.read() {
        all.insert(issued.id.0, format!("{:?}", issued.command));
    }
    for fact in facts.read() {
        match fact {
            SimFact::Refused { cause, reason } => {
                let command = cause.and_then(|cause| all.get(&cause.0)).cloned();
                trial
                    .refused
                    .push((command.unwrap_or_default(), tick.0, reason.clone()));
            }
            SimFact::Hand(HandFact::Grasped { id, .. })
            | SimFact::Robot(RobotFact::GripMade { id, .. }) => {
                trial.deeds.push((tick.0, format!("grasp of {id}")));
            }
            SimFact::Hand(HandFact::Released { id, .. })
            | SimFact::Robot(RobotFact::GripReleased { id, .. }) => {
                trial.deeds.push((tick.0, format!("release of {id}")));
            }
            SimFact::Hand(HandFact::Destroyed { id, .. }) => {
                trial.deeds.push((tick.0, format!("removal of {id}")));
            }
            SimFact::Scene(_)
            | SimFact::History(_)
            | SimFact::Mechanism(_)
            | SimFact::Recording(_)
            | SimFact::Robot(_) => {}
        }
    }
    // Refusals come in the tick of their commands, or in the next one.
    let old = all.len().saturating_sub(MOST_KEPT);
    let last_old = all.keys().nth(old).copied().unwrap_or(0);
    *all = all.split_off(&last_old);
}

/// Number of commands that wait for their refusals.
const MOST_KEPT: usize = 10_000;

/// The blocks of a recording.
fn blocks_of(replay: &Replay, trial: &EditTrial) -> Vec<CommandBlock> {
    let session = replay.session();
    let start = session.header.start_tick;
    let end = session.commands.last().map_or(start, |last| last.tick);
    let mut blocks = Vec::<(u64, CommandBlock)>::new();
    let marks = session.segments.iter().map(|mark| mark.0);
    for (number, tick) in (0_u32..).zip([start].into_iter().chain(marks)) {
        match blocks.last_mut() {
            Some((last, block)) if *last == tick => {
                block.segments = *block.segments.start()..=number;
            }
            Some(_) | None => blocks.push((
                tick,
                CommandBlock {
                    segments: number..=number,
                    ticks: 0,
                    commands: Vec::new(),
                    deeds: Vec::new(),
                },
            )),
        }
    }
    let starts: Vec<_> = blocks.iter().map(|(tick, _)| *tick).collect();
    let place = |tick: u64| starts.partition_point(|start| *start <= tick).max(1) - 1;
    for command in &session.commands {
        if command.command != RecordingCommand::Finish.into() {
            let (start, block) = &mut blocks[place(command.tick)];
            let mut command = command.clone();
            command.tick -= *start;
            block.commands.push(command);
        }
    }
    for (tick, deed) in trial.deeds.iter().filter(|(tick, _)| *tick >= start) {
        blocks[place(*tick)].1.deeds.push(deed.clone());
    }
    for (_, block) in &mut blocks {
        block.deeds.sort();
    }
    let ends = starts.iter().skip(1).copied().chain([end]);
    let blocks = blocks.into_iter().zip(ends);
    blocks
        .map(|((start, block), end)| CommandBlock {
            ticks: end.saturating_sub(start),
            ..block
        })
        .collect()
}

fn apply(
    edit: &SegmentEdit,
    blocks: &mut Vec<CommandBlock>,
    refused: &mut Vec<(String, u64, String)>,
) -> Result<(), EditError> {
    match edit {
        SegmentEdit::Drop(numbers) => {
            let mut places = BTreeSet::new();
            for &number in numbers {
                let place = place_of(number, blocks)?;
                let together = blocks[place].segments.clone();
                if let Some(other) = together.into_iter().find(|other| !numbers.contains(other)) {
                    return Err(EditError::Together(number.min(other), number.max(other)));
                }
                places.insert(place);
            }
            let mut place = 0..;
            blocks.retain(|_| !place.next().is_some_and(|place| places.contains(&place)));
        }
        SegmentEdit::Swap(one, other) => {
            let one = places_of(one, blocks)?;
            let other = places_of(other, blocks)?;
            let (first, second) = match one.start() < other.start() {
                true => (one, other),
                false => (other, one),
            };
            if first.end() >= second.start() {
                return Err(EditError::Overlap);
            }
            let after = blocks.split_off(second.end() + 1);
            let last = blocks.split_off(*second.start());
            let middle = blocks.split_off(first.end() + 1);
            let begin = blocks.split_off(*first.start());
            blocks.extend([last, middle, begin, after].into_iter().flatten());
        }
        SegmentEdit::Retime(number, factor) => {
            if !FACTORS.contains(factor) {
                return Err(EditError::Factor(factor.to_string()));
            }
            let place = match number {
                0 => 0,
                _ => place_of(*number, blocks)?,
            };
            let block = &mut blocks[place];
            let scaled = |ticks: u64| (ticks as f64 * factor).round() as u64;
            block.ticks = scaled(block.ticks).max(1);
            for command in &mut block.commands {
                command.tick = scaled(command.tick);
            }
        }
        SegmentEdit::Splice(other) => {
            let trial = EditTrial::of(other);
            blocks.extend(blocks_of(other, &trial));
            refused.extend(trial.refused);
        }
    }
    Ok(())
}

/// The place of the block with a segment, which is not the first one.
fn place_of(number: u32, blocks: &[CommandBlock]) -> Result<usize, EditError> {
    let last = blocks.iter().map(|block| *block.segments.end()).max();
    let place = blocks
        .iter()
        .position(|block| block.segments.contains(&number));
    place
        .filter(|place| number > 0 && *place > 0)
        .ok_or(EditError::NoSegment {
            number,
            last: last.unwrap_or(0),
        })
}

/// The places of the blocks with these segments, which must be whole.
fn places_of(
    numbers: &RangeInclusive<u32>,
    blocks: &[CommandBlock],
) -> Result<RangeInclusive<usize>, EditError> {
    let first = place_of(*numbers.start(), blocks)?;
    let last = place_of(*numbers.end(), blocks)?;
    for place in [first, last] {
        let segments = &blocks[place].segments;
        if !(numbers.contains(segments.start()) && numbers.contains(segments.end())) {
            return Err(EditError::Together(*segments.start(), *segments.end()));
        }
    }
    match first <= last {
        true => Ok(first..=last),
        false => Err(EditError::Overlap),
    }
}

/// The session in which the blocks follow each other.
fn joined(session: &Session, blocks: &[CommandBlock]) -> Session {
    let mut session = session.clone();
    session.commands.clear();
    session.segments.clear();
    let mut begin = session.header.start_tick;
    for block in blocks {
        let commands = block.commands.iter().cloned();
        session.commands.extend(commands.map(|mut command| {
            command.tick += begin;
            command
        }));
        begin += block.ticks;
    }
    session.commands.push(SessionCommand {
        tick: begin,
        actor: Actor::Replay,
        command: SimCommand::Recording(RecordingCommand::Finish),
        at_once: false,
    });
    session
}

/// Finds a command that is refused and was not before, or a segment in which hands do something else.
fn check(
    blocks: &[CommandBlock],
    before: &[(String, u64, String)],
    after: &EditTrial,
    start: u64,
) -> Result<(), EditError> {
    let mut known = BTreeMap::<&str, usize>::new();
    for (command, ..) in before {
        *known.entry(command).or_default() += 1;
    }
    for (command, tick, reason) in &after.refused {
        match known.get_mut(command.as_str()) {
            Some(left) if *left > 0 => *left -= 1,
            Some(_) | None => {
                return Err(EditError::Refused {
                    segment: segment_at(*tick, start, blocks),
                    reason: reason.clone(),
                });
            }
        }
    }
    let mut begin = start;
    for (place, block) in blocks.iter().enumerate() {
        let end = match place + 1 == blocks.len() {
            true => u64::MAX,
            false => begin + block.ticks,
        };
        let is_here = |deed: &&(u64, String)| (begin..end).contains(&deed.0);
        let here = after.deeds.iter().filter(is_here);
        let mut here: Vec<_> = here.map(|(_, deed)| deed.clone()).collect();
        here.sort();
        if let Some((deed, happens)) = first_difference(&block.deeds, &here) {
            return Err(EditError::OtherDeeds {
                segment: *block.segments.start(),
                deed: deed.to_owned(),
                happens,
            });
        }
        begin = end;
    }
    Ok(())
}

/// The first of two sorted lists that only one of them has, and whether that is the second one.
fn first_difference<'d>(before: &'d [String], after: &'d [String]) -> Option<(&'d str, bool)> {
    let same = before
        .iter()
        .zip(after)
        .take_while(|(one, other)| one == other);
    let place = same.count();
    match (before.get(place), after.get(place)) {
        (None, None) => None,
        (Some(was), Some(is)) if is < was => Some((is, true)),
        (Some(was), _) => Some((was, false)),
        (None, Some(is)) => Some((is, true)),
    }
}

/// The segment, by its number before the edits, in whose time a tick now is.
fn segment_at(tick: u64, start: u64, blocks: &[CommandBlock]) -> u32 {
    let mut begin = start;
    let mut number = 0;
    for block in blocks {
        if tick >= begin {
            number = *block.segments.start();
        }
        begin += block.ticks;
    }
    number
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(number: u32, ticks: u64) -> CommandBlock {
        CommandBlock {
            segments: number..=number,
            ticks,
            commands: Vec::new(),
            deeds: Vec::new(),
        }
    }

    fn numbers(edits: &[SegmentEdit]) -> Result<Vec<u32>, EditError> {
        let mut blocks = (0..6).map(|number| block(number, 10)).collect();
        for edit in edits {
            apply(edit, &mut blocks, &mut Vec::new())?;
        }
        Ok(blocks.iter().map(|block| *block.segments.start()).collect())
    }

    #[test]
    fn segments_keep_their_numbers_through_all_edits() {
        let drop = SegmentEdit::Drop([3].into());
        let swap = SegmentEdit::Swap(1..=2, 4..=5);
        assert_eq!(numbers(&[drop, swap]), Ok(vec![0, 4, 5, 1, 2]));
    }

    #[test]
    fn edits_without_sense_are_refused() {
        let of_first = SegmentEdit::Drop([0].into());
        assert_eq!(
            numbers(&[of_first]),
            Err(EditError::NoSegment { number: 0, last: 5 })
        );
        let overlapping = SegmentEdit::Swap(1..=3, 3..=4);
        assert_eq!(numbers(&[overlapping]), Err(EditError::Overlap));
        assert!(numbers(&[SegmentEdit::Retime(1, f64::NAN)]).is_err());
    }

    #[test]
    fn commands_of_a_shorter_segment_come_closer() {
        let mut blocks = vec![block(0, 10), block(1, 10)];
        blocks[1].commands.push(SessionCommand {
            tick: 8,
            actor: Actor::Mouse,
            command: tabletop_core::SceneCommand::Clear.into(),
            at_once: false,
        });
        let half = SegmentEdit::Retime(1, 0.5);
        apply(&half, &mut blocks, &mut Vec::new()).unwrap();
        assert_eq!((blocks[1].ticks, blocks[1].commands[0].tick), (5, 4));
        assert_eq!(segment_at(12, 0, &blocks), 1);
    }
}
