//! Whether what was done in an example is what a program does.

use std::collections::{BTreeMap, BTreeSet};

use tabletop_core::ObjectSpec;
use tabletop_task::Relation;

use crate::{
    condition::Condition,
    expansion::{Expansion, Goals},
    finding::{
        example::ExampleView,
        length::{Length, choice, detour, orders},
    },
    goal::{GoalKind, ObjectGoal},
    instruction::{Instruction, Pattern, TargetPlace},
    noun::{HowMany, Noun, Spot, Superlative, TableSide},
    pattern_goals::{copies_of, next_of_tower},
    placement::Room,
    program::{Procedure, Sentence, TaskProgram},
    scene::SceneView,
};

/// The deeds of an example that a program has explained so far.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Progress {
    explained: BTreeSet<usize>,
    /// The objects that the program has named.
    named: BTreeSet<String>,
}

impl Progress {
    /// The first deed that is not explained yet.
    pub fn next(&self) -> usize {
        let mut explained = self.explained.iter();
        (0..).find(|i| explained.next() != Some(i)).unwrap_or(0)
    }

    /// True if all deeds of an example are explained.
    pub fn is_complete(&self, example: &ExampleView) -> bool {
        self.explained.len() == example.deeds.len()
    }

    /// The deeds that are explained.
    pub fn explained(&self) -> &BTreeSet<usize> {
        &self.explained
    }
}

/// The reading of an example as the work of a program.
pub(crate) struct Explanation<'a> {
    example: &'a ExampleView<'a>,
    procedures: &'a [Procedure],
    beginning: BTreeMap<String, ObjectSpec>,
}

/// Whether an instruction is one of a loop.
#[derive(Clone, Copy, PartialEq, Eq)]
enum StepTimes {
    Once,
    Repeatedly,
}

/// The most procedures that may be within each other.
const DEEPEST: usize = 8;

impl<'a> Explanation<'a> {
    pub fn of(example: &'a ExampleView<'a>, procedures: &'a [Procedure]) -> Self {
        let first = example.views.first().map(|view| view.scene);
        let objects = first.into_iter().flat_map(|scene| &scene.objects);
        Self {
            example,
            procedures,
            beginning: objects.map(|it| (it.id.clone(), it.clone())).collect(),
        }
    }

    /// The length of the choices that a program leaves, if it explains the whole example.
    pub fn whole(example: &'a ExampleView<'a>, program: &'a TaskProgram) -> Option<Length> {
        let reading = Self::of(example, &program.procedures);
        let mut progress = Progress::default();
        let lengths = program.sentences.iter();
        let choices: Option<Length> = lengths
            .map(|one| reading.sentence(one, &mut progress))
            .sum();
        choices.filter(|_| progress.is_complete(example))
    }

    /// Reads further deeds as a sentence. Returns the length of the choices that it leaves; `None` if it does anything else than was done.
    pub fn sentence(&self, sentence: &Sentence, progress: &mut Progress) -> Option<Length> {
        self.nested(sentence, progress, 0)
    }

    fn nested(&self, sentence: &Sentence, progress: &mut Progress, depth: usize) -> Option<Length> {
        match sentence {
            Sentence::Do { instructions } => {
                self.all(instructions, StepTimes::Once, progress, depth)
            }
            Sentence::If {
                condition,
                then,
                otherwise,
            } => match self.holds(condition, progress)? {
                true => self.all(then, StepTimes::Once, progress, depth),
                false => self.all(otherwise, StepTimes::Once, progress, depth),
            },
            Sentence::Until {
                condition,
                instructions,
            } => {
                let mut choices = 0;
                while !self.holds(condition, progress)? {
                    let before = progress.explained.len();
                    choices += self.all(instructions, StepTimes::Repeatedly, progress, depth)?;
                    if progress.explained.len() == before {
                        return None;
                    }
                }
                Some(choices)
            }
        }
    }

    fn all(
        &self,
        instructions: &[Instruction],
        times: StepTimes,
        progress: &mut Progress,
        depth: usize,
    ) -> Option<Length> {
        let all = instructions.iter();
        all.map(|one| self.instruction(one, times, progress, depth))
            .sum()
    }

    /// Whether a condition holds before the next deed.
    pub fn holds(&self, condition: &Condition, progress: &Progress) -> Option<bool> {
        let preferred = self.preferred(progress);
        let expansion = self.expansion(progress, StepTimes::Repeatedly, &preferred)?;
        expansion.selection().holds(condition).ok()
    }

    /// What an instruction comes to at the next deed.
    fn expansion<'b>(
        &'b self,
        progress: &'b Progress,
        times: StepTimes,
        preferred: &'b [String],
    ) -> Option<Expansion<'b>> {
        Some(Expansion {
            view: self.example.views.get(progress.next())?,
            named: &progress.named,
            beginning: &self.beginning,
            is_repeated: times == StepTimes::Repeatedly,
            preferred,
        })
    }

    /// The objects of the deeds that are left, and those to which they were put.
    fn preferred(&self, progress: &Progress) -> Vec<String> {
        let left = self.example.deeds.iter().enumerate();
        let left: Vec<_> = left
            .filter(|(i, _)| !progress.explained.contains(i))
            .map(|(_, deed)| deed)
            .collect();
        let moved = left.iter().map(|deed| deed.object.as_str());
        let others = left
            .iter()
            .flat_map(|deed| deed.relations.iter().filter_map(Relation::object));
        moved.chain(others).map(str::to_owned).collect()
    }

    fn instruction(
        &self,
        instruction: &Instruction,
        times: StepTimes,
        progress: &mut Progress,
        depth: usize,
    ) -> Option<Length> {
        let preferred = self.preferred(progress);
        let expansion = self.expansion(progress, times, &preferred)?;
        let goals = match instruction {
            Instruction::Put { what, to, first } => match to {
                TargetPlace::Arranged { pattern, at } => {
                    return self.pattern(what, *pattern, at.as_ref(), *first, progress);
                }
                TargetPlace::Spot(_)
                | TargetPlace::Location { .. }
                | TargetPlace::Aside
                | TargetPlace::PlaceOf { .. } => expansion.put(what, to, *first),
            },
            Instruction::Remove { what, first } => expansion.remove(what, *first),
            Instruction::Open { what } => expansion.slide(what, true),
            Instruction::Close { what } => expansion.slide(what, false),
            Instruction::Swap { one, other } => {
                let orders = [expansion.swap(one, other), expansion.swap(other, one)];
                let goals = orders.into_iter().flatten();
                let explained = goals.map(|goals| self.explained_by(&goals, progress));
                let explained = explained.flatten().next()?;
                progress.explained.extend(explained);
                return Some(0);
            }
            Instruction::MoveTower { from, to, by } => {
                let selection = expansion.selection();
                let places = [from, to, by].map(|place| selection.one(place).ok());
                let [Some(from), Some(to), Some(by)] = places else {
                    return None;
                };
                return self.tower_moved([from, to, by], progress);
            }
            Instruction::Copy { what, to } => return self.copied(what, *to, progress),
            Instruction::Call { verb, with } => return self.called(verb, with, progress, depth),
        };
        let goals = goals.ok()?;
        let explained = self.explained_by(&goals, progress)?;
        let piled = self.piled(&goals, &explained);
        progress.explained.extend(explained);
        progress.named.extend(goals.named);
        Some(choice(goals.ways) + choice(orders(piled)))
    }

    /// The deeds that reach goals which are not met yet, in their order if that matters, with those that made room for them.
    fn explained_by(&self, goals: &Goals, progress: &Progress) -> Option<Vec<usize>> {
        let view = self.example.views.get(progress.next())?;
        let mut taken = Vec::<usize>::new();
        for goal in goals.goals.iter().filter(|goal| !goal.is_met(view)) {
            let moved = goal.moved(view);
            let deeds = self.example.deeds.iter().enumerate();
            let mut left = deeds.filter(|(i, deed)| {
                deed.object == moved && !progress.explained.contains(i) && !taken.contains(i)
            });
            let (at, _) = left.next()?;
            let is_in_order = !goals.is_ordered || taken.last().is_none_or(|last| *last < at);
            if !is_in_order || !self.is_reached(goal, at) {
                return None;
            }
            taken.push(at);
        }
        let room_made = self.room_made(goals, progress, &taken);
        taken.extend(room_made);
        Some(taken)
    }

    /// The number of objects that came to lie on each other, in an order that goals leave to choice.
    fn piled(&self, goals: &Goals, taken: &[usize]) -> usize {
        let after = taken
            .iter()
            .max()
            .and_then(|last| self.example.views.get(last + 1));
        let rests = |one: &ObjectGoal, other: &ObjectGoal| {
            after.is_some_and(|after| after.standing.rests_on(&one.object, &other.object))
        };
        let goals = &goals.goals;
        let is_piled = |one: &&ObjectGoal| {
            let mut others = goals.iter();
            others.any(|other| rests(one, other) || rests(other, one))
        };
        goals.iter().filter(is_piled).count()
    }

    fn is_reached(&self, goal: &ObjectGoal, deed: usize) -> bool {
        let Some(after) = self.example.views.get(deed + 1) else {
            return false;
        };
        match goal.goal {
            GoalKind::Aside => after.standing.is_on_table(&goal.object),
            GoalKind::Upon(_)
            | GoalKind::Directly(_)
            | GoalKind::Inside(_)
            | GoalKind::Around(_)
            | GoalKind::Beside(..)
            | GoalKind::Table(_)
            | GoalKind::At(_)
            | GoalKind::Removed
            | GoalKind::Slid(_) => goal.is_met(after),
        }
    }

    /// The deeds that put on the table what stood on the objects of goals, before these were moved.
    fn room_made(&self, goals: &Goals, progress: &Progress, taken: &[usize]) -> Vec<usize> {
        let deeds = self.example.deeds.iter().enumerate();
        let made = deeds.filter(|(i, deed)| {
            let views = (self.example.views.get(*i), self.example.views.get(i + 1));
            let (Some(before), Some(after)) = views else {
                return false;
            };
            let mut later = taken.iter().filter(|at| *at > i);
            let is_in_the_way = |id: &str| before.is_upon(&deed.object, id);
            !progress.explained.contains(i)
                && !taken.contains(i)
                && after.standing.is_on_table(&deed.object)
                && later.any(|at| is_in_the_way(&self.example.deeds[*at].object))
                && goals.goals.iter().all(|goal| goal.object != deed.object)
        });
        made.map(|(i, _)| i).collect()
    }

    /// Reads the deeds of the objects of a pattern as its making.
    fn pattern(
        &self,
        what: &Noun,
        pattern: Pattern,
        at: Option<&Spot>,
        first: Option<Superlative>,
        progress: &mut Progress,
    ) -> Option<Length> {
        let preferred = self.preferred(progress);
        let expansion = self.expansion(progress, StepTimes::Once, &preferred)?;
        let set = expansion.pattern_set(what, at, first).ok()?;
        progress
            .named
            .extend(set.ids.iter().cloned().chain(set.target.clone()));
        let now = progress.clone();
        let expansion = self.expansion(&now, StepTimes::Once, &preferred)?;
        if set.is_made(&expansion, pattern, at) {
            return Some(0);
        }
        let deeds = self.example.deeds.iter().enumerate();
        let own: Vec<_> = deeds
            .filter(|(i, deed)| !progress.explained.contains(i) && set.ids.contains(&deed.object))
            .map(|(i, _)| i)
            .collect();
        let last = own.last()?;
        let after = Expansion {
            view: self.example.views.get(last + 1)?,
            ..expansion
        };
        let standing = &after.view.standing;
        let is_by_itself = |id: &String| {
            standing.is_on_table(id) || set.ids.iter().any(|other| standing.rests_on(id, other))
        };
        // For a pattern that is to be nowhere in particular, nothing is put on or into anything else.
        let moved = |id: &String| {
            let mut own = own.iter();
            own.any(|i| self.example.deeds[*i].object == *id)
        };
        let mut moved_ones = set.ids.iter().filter(|id| moved(id));
        let is_where_it_belongs = at.is_some() || moved_ones.all(is_by_itself);
        if !set.is_made(&after, pattern, at) || !is_where_it_belongs {
            return None;
        }
        progress.explained.extend(own.iter().copied());
        let in_any_order = match set.is_sorted {
            true => 1,
            false => orders(set.ids.len()),
        };
        // Each side of the table has half of the places.
        let stays = pattern == Pattern::Tower && !set.ids.iter().all(moved);
        let places = if at.is_some() || stays { 1 } else { 2 };
        let made = set.ids.iter().filter(|id| moved(id)).count();
        let detours = detour() * (own.len() - made) as Length;
        Some(choice(set.ways) + choice(in_any_order) + choice(places) + detours)
    }

    fn tower_moved(&self, places: [String; 3], progress: &mut Progress) -> Option<Length> {
        loop {
            let at = progress.next();
            let view = self.example.views.get(at)?;
            let Some(goal) = next_of_tower(view, &places) else {
                return Some(0);
            };
            let deed = self.example.deeds.get(at)?;
            if deed.object != goal.object || !self.is_reached(&goal, at) {
                return None;
            }
            progress.explained.insert(at);
        }
    }

    fn copied(&self, what: &Noun, to: TableSide, progress: &mut Progress) -> Option<Length> {
        let preferred = self.preferred(progress);
        let expansion = self.expansion(progress, StepTimes::Once, &preferred)?;
        let models = expansion.chosen(what, &[], None, |_| false).ok()?.ids;
        let copies = copies_of(expansion.view, &models, to);
        if copies.is_some() {
            return Some(0);
        }
        let end = self.example.views.last()?;
        let copies = copies_of(end, &models, to)?;
        let deeds = self.example.deeds.iter().enumerate();
        let left: Vec<_> = deeds
            .filter(|(i, _)| !progress.explained.contains(i))
            .collect();
        let copying = left
            .iter()
            .filter(|(_, deed)| copies.contains(&deed.object));
        let copying: Vec<_> = copying.map(|(i, deed)| (*i, &deed.object)).collect();
        let made_room = left.iter().filter(|(i, deed)| {
            let mut later = copying.iter().filter(|(at, _)| at > i);
            later.any(|(_, copy)| self.is_in_the_way(*i, &deed.object, copy, end))
        });
        let explained: Vec<_> = copying
            .iter()
            .map(|(i, _)| *i)
            .chain(made_room.map(|(i, _)| *i))
            .collect();
        progress.explained.extend(explained);
        Some(0)
    }

    /// True if an object is, before a deed, where another one comes to be in the end.
    fn is_in_the_way(&self, deed: usize, id: &str, other: &str, end: &SceneView) -> bool {
        let before = self.example.views.get(deed);
        let places = before.zip(before.and_then(|view| view.object(other)));
        let there = end.object(other).map(|object| object.pose);
        places.zip(there).is_some_and(|((before, object), there)| {
            Room::new(before, object).occupant(there) == Some(id)
        })
    }

    fn called(
        &self,
        verb: &str,
        with: &[Noun],
        progress: &mut Progress,
        depth: usize,
    ) -> Option<Length> {
        let procedure = self.procedures.iter().find(|one| one.verb == verb)?;
        let is_one = |noun: &Noun| match noun {
            Noun::Named { .. } => true,
            Noun::Described { quantity, .. } => *quantity != HowMany::Every,
        };
        if depth >= DEEPEST || !with.iter().all(is_one) {
            return None;
        }
        let preferred = self.preferred(progress);
        let selection = self
            .expansion(progress, StepTimes::Once, &preferred)?
            .selection();
        let objects: Option<Vec<_>> = with
            .iter()
            .map(|noun| selection.one(noun).ok().map(Noun::named))
            .collect();
        let sentences = procedure.with(&objects?)?;
        let all = sentences.iter();
        all.map(|one| self.nested(one, progress, depth + 1)).sum()
    }
}
