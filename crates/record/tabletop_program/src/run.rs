//! A program on its way: the next step on the table as it is now.

use std::collections::{BTreeMap, BTreeSet};

use tabletop_core::ObjectSpec;

use crate::{
    condition::Condition,
    expansion::{Expansion, Goals},
    goal::{Hindrance, ObjectGoal, kept_places},
    instruction::{Instruction, TargetPlace},
    noun::{HowMany, Noun},
    pattern_goals::next_of_tower,
    program::{Sentence, TaskProgram},
    scene::{SceneView, TableScene},
    step::ConcreteStep,
};

/// A program on its way. It decides by the table as it is, so whatever happens between two steps is taken into account.
#[derive(Clone, Debug)]
pub struct ProgramRun {
    program: TaskProgram,
    /// What is to be done, the next last.
    pending: Vec<PendingWork>,
    /// The objects that the program has named.
    named: BTreeSet<String>,
    beginning: BTreeMap<String, ObjectSpec>,
    /// The sentence that is carried out.
    said: String,
    steps: usize,
    failure: Option<Impossible>,
}

/// The next step of a program.
#[derive(Clone, Debug, PartialEq)]
pub enum NextStep {
    /// This one.
    Step(ConcreteStep),
    /// There is nothing left to do.
    Done,
    /// It cannot be done.
    Impossible(Impossible),
}

/// The reason why a program cannot be carried on.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: {}{reason}", .sentence.trim_end_matches('.'), .object.as_ref().map_or(String::new(), |object| format!("{object}: ")))]
pub struct Impossible {
    /// The sentence that cannot be done.
    pub sentence: String,
    /// The object that it fails with.
    pub object: Option<String>,
    /// The reason.
    pub reason: String,
}

impl Impossible {
    /// A sentence that cannot be done, whatever its object.
    pub const fn sentence(sentence: String, reason: String) -> Self {
        Self {
            sentence,
            object: None,
            reason,
        }
    }
}

#[derive(Clone, Debug)]
enum PendingWork {
    Sentence(Sentence, usize),
    Instruction(Instruction, Times, usize),
    Round {
        condition: Condition,
        instructions: Vec<Instruction>,
        depth: usize,
        /// The number of steps before the last round.
        steps: Option<usize>,
    },
    Goals(Vec<ObjectGoal>, bool),
    Tower([String; 3]),
}

/// How often an instruction is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Times {
    Once,
    Repeatedly,
}

/// The most steps of a program.
const MOST_STEPS: usize = 2_000;
/// The most parts of a program that are looked at for one step.
const MOST_PARTS: usize = 10_000;
/// The most procedures that may be within each other.
const DEEPEST: usize = 64;

impl ProgramRun {
    /// A program that begins on this table.
    pub fn begin(program: &TaskProgram, scene: &TableScene) -> Self {
        let sentences = program.sentences.iter().rev().cloned();
        let objects = scene.objects.iter();
        Self {
            program: program.clone(),
            pending: sentences.map(|one| PendingWork::Sentence(one, 0)).collect(),
            named: BTreeSet::new(),
            beginning: objects
                .map(|object| (object.id.clone(), object.clone()))
                .collect(),
            said: String::new(),
            steps: 0,
            failure: None,
        }
    }

    /// The next step. A step whose object is not where it belongs afterwards comes again.
    pub fn next_on(&mut self, scene: &TableScene) -> NextStep {
        if let Some(failure) = &self.failure {
            return NextStep::Impossible(failure.clone());
        }
        let view = scene.view();
        for _ in 0..MOST_PARTS {
            let Some(pending) = self.pending.pop() else {
                return NextStep::Done;
            };
            match self.advance(&view, pending) {
                Ok(None) => {}
                Ok(Some(step)) if self.steps < MOST_STEPS => {
                    self.steps += 1;
                    return NextStep::Step(step);
                }
                Ok(Some(_)) => break,
                Err(hindrance) => return self.fail(hindrance),
            }
        }
        self.fail(Hindrance::from("it never ends".to_owned()))
    }

    /// All steps on a table on which each leads where geometry says, the table after them, and the reason if it ends too early.
    pub fn rehearsed(
        program: &TaskProgram,
        scene: &TableScene,
    ) -> (Vec<ConcreteStep>, TableScene, Option<Impossible>) {
        Self::begin(program, scene).rehearse(scene)
    }

    /// All steps that are left on the table as it is now, as [`rehearsed`](Self::rehearsed) has them.
    pub fn rehearse(
        mut self,
        scene: &TableScene,
    ) -> (Vec<ConcreteStep>, TableScene, Option<Impossible>) {
        let (mut steps, mut scene) = (Vec::new(), scene.clone());
        loop {
            match self.next_on(&scene) {
                NextStep::Done => return (steps, scene, None),
                NextStep::Impossible(reason) => return (steps, scene, Some(reason)),
                NextStep::Step(step) => {
                    scene = scene.after(&step);
                    steps.push(step);
                }
            }
        }
    }

    fn fail(&mut self, hindrance: Hindrance) -> NextStep {
        let failure = Impossible {
            sentence: self.said.clone(),
            object: hindrance.object,
            reason: hindrance.reason,
        };
        self.failure = Some(failure.clone());
        NextStep::Impossible(failure)
    }

    fn expansion<'a>(&'a self, view: &'a SceneView<'a>, times: Times) -> Expansion<'a> {
        Expansion {
            view,
            named: &self.named,
            beginning: &self.beginning,
            is_repeated: times == Times::Repeatedly,
            preferred: &[],
        }
    }

    fn advance(
        &mut self,
        view: &SceneView,
        pending: PendingWork,
    ) -> Result<Option<ConcreteStep>, Hindrance> {
        match pending {
            PendingWork::Sentence(sentence, depth) => self.read(view, sentence, depth)?,
            PendingWork::Instruction(instruction, times, depth) => {
                let instructions = vec![instruction.clone()];
                self.said = Sentence::Do { instructions }.to_string();
                self.carry_out(view, &instruction, times, depth)?;
            }
            PendingWork::Round {
                condition,
                instructions,
                depth,
                steps,
            } => self.go_round(view, condition, instructions, depth, steps)?,
            PendingWork::Goals(goals, is_ordered) => return self.reach(view, goals, is_ordered),
            PendingWork::Tower(places) => {
                let Some(mut next) = next_of_tower(view, &places) else {
                    return Ok(None);
                };
                self.pending.push(PendingWork::Tower(places));
                return next.step(view, &[]).map(Some);
            }
        }
        Ok(None)
    }

    fn read(
        &mut self,
        view: &SceneView,
        sentence: Sentence,
        depth: usize,
    ) -> Result<(), Hindrance> {
        self.said = sentence.to_string();
        let instructions = match sentence {
            Sentence::Do { instructions } => instructions,
            Sentence::If {
                condition,
                then,
                otherwise,
            } => match self
                .expansion(view, Times::Once)
                .selection()
                .holds(&condition)?
            {
                true => then,
                false => otherwise,
            },
            Sentence::Until {
                condition,
                instructions,
            } => {
                self.pending.push(PendingWork::Round {
                    condition,
                    instructions,
                    depth,
                    steps: None,
                });
                return Ok(());
            }
        };
        self.push_all(instructions, Times::Once, depth);
        Ok(())
    }

    fn push_all(&mut self, instructions: Vec<Instruction>, times: Times, depth: usize) {
        let all = instructions.into_iter().rev();
        self.pending
            .extend(all.map(|one| PendingWork::Instruction(one, times, depth)));
    }

    fn go_round(
        &mut self,
        view: &SceneView,
        condition: Condition,
        instructions: Vec<Instruction>,
        depth: usize,
        steps: Option<usize>,
    ) -> Result<(), Hindrance> {
        let again = instructions.clone();
        self.said = Sentence::Until {
            condition: condition.clone(),
            instructions: again.clone(),
        }
        .to_string();
        if self
            .expansion(view, Times::Repeatedly)
            .selection()
            .holds(&condition)?
        {
            return Ok(());
        }
        if steps == Some(self.steps) {
            return Err(Hindrance::from(
                "there is nothing left to do for it".to_owned(),
            ));
        }
        self.pending.push(PendingWork::Round {
            condition,
            instructions,
            depth,
            steps: Some(self.steps),
        });
        self.push_all(again, Times::Repeatedly, depth);
        Ok(())
    }

    fn carry_out(
        &mut self,
        view: &SceneView,
        instruction: &Instruction,
        times: Times,
        depth: usize,
    ) -> Result<(), Hindrance> {
        let expansion = self.expansion(view, times);
        let goals = match instruction {
            Instruction::Put { what, to, first } => match to {
                TargetPlace::Arranged { pattern, at } => {
                    expansion.arrange(what, *pattern, at.as_ref(), *first)?
                }
                TargetPlace::Spot(_)
                | TargetPlace::Location { .. }
                | TargetPlace::Aside
                | TargetPlace::PlaceOf { .. } => expansion.put(what, to, *first)?,
            },
            Instruction::Remove { what, first } => expansion.remove(what, *first)?,
            Instruction::Open { what } => expansion.slide(what, true)?,
            Instruction::Close { what } => expansion.slide(what, false)?,
            Instruction::Swap { one, other } => expansion.swap(one, other)?,
            Instruction::Copy { what, to } => expansion.copy(what, *to)?,
            Instruction::MoveTower { from, to, by } => {
                let selection = expansion.selection();
                let places = [selection.one(from)?, selection.one(to)?, selection.one(by)?];
                self.named.extend(places.iter().cloned());
                self.pending.push(PendingWork::Tower(places));
                return Ok(());
            }
            Instruction::Call { verb, with } => return self.call(view, verb, with, depth),
        };
        let Goals {
            goals,
            is_ordered,
            named,
            ways: _,
        } = goals;
        self.named.extend(named);
        self.pending.push(PendingWork::Goals(goals, is_ordered));
        Ok(())
    }

    /// Carries out a procedure with these objects; with every object of a noun that means all of a kind.
    fn call(
        &mut self,
        view: &SceneView,
        verb: &str,
        with: &[Noun],
        depth: usize,
    ) -> Result<(), Hindrance> {
        if depth >= DEEPEST {
            return Err(Hindrance::from("it calls itself too often".to_owned()));
        }
        let procedure = self.program.procedures.iter().find(|one| one.verb == verb);
        let unknown = || Hindrance::from(format!("nothing says how to {verb}"));
        let procedure = procedure.ok_or_else(unknown)?;
        let selection = self.expansion(view, Times::Once).selection();
        let mut calls = vec![Vec::new()];
        for noun in with {
            let objects = match noun {
                Noun::Described {
                    quantity: HowMany::Every,
                    ..
                } => selection.candidates(noun)?,
                Noun::Described { .. } | Noun::Named { .. } => vec![selection.one(noun)?],
            };
            let longer = calls.iter().flat_map(|call| {
                objects
                    .iter()
                    .map(|id| [call.as_slice(), &[Noun::named(id.clone())]].concat())
            });
            calls = longer.collect();
        }
        let bodies: Option<Vec<_>> = calls.iter().map(|call| procedure.with(call)).collect();
        let other_number = || {
            let count = procedure.objects.len();
            Hindrance::from(format!("`{verb}` is said of {count} objects"))
        };
        let sentences = bodies.ok_or_else(other_number)?.into_iter().flatten();
        let sentences: Vec<_> = sentences.collect();
        let all = sentences.into_iter().rev();
        self.pending
            .extend(all.map(|one| PendingWork::Sentence(one, depth + 1)));
        Ok(())
    }

    /// The step towards one of these goals that are not met yet.
    fn reach(
        &mut self,
        view: &SceneView,
        mut goals: Vec<ObjectGoal>,
        is_ordered: bool,
    ) -> Result<Option<ConcreteStep>, Hindrance> {
        match is_ordered {
            true => {
                let met = goals.iter().take_while(|goal| goal.is_met(view)).count();
                goals.drain(..met);
            }
            false => goals.retain(|goal| !goal.is_met(view)),
        }
        if goals.is_empty() {
            return Ok(None);
        }
        let is_clear = |goal: &ObjectGoal| view.stack_above(&goal.object).is_empty();
        let next = match is_ordered {
            true => 0,
            false => goals.iter().position(is_clear).unwrap_or(0),
        };
        let kept = kept_places(view, &goals);
        let step = goals[next].step(view, &kept)?;
        self.pending.push(PendingWork::Goals(goals, is_ordered));
        Ok(Some(step))
    }
}
