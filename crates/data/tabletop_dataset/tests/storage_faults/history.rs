//! What a few actors do, which of their calls fails, and what came of it.

use std::{
    fmt,
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{Arc, atomic::AtomicU64},
    thread,
};

use tabletop_storage::{Patience, Storage};

use crate::{
    operation::Operation,
    promise::{Claim, Outcome, check},
    stage::{ActorFate, ActorFault, Draw, Stage},
    workplace::Workplace,
};

/// What one program does, and its fault.
#[derive(Clone, Debug)]
struct Part {
    operations: Vec<Operation>,
    fault: Option<(ActorFault, u64)>,
    /// It does not wait for others.
    refuses: bool,
}

/// What is done first, one after the other and without faults, and what then at once.
#[derive(Clone, Debug)]
pub struct History {
    before: Vec<Operation>,
    at_once: Vec<Part>,
}

impl fmt::Display for History {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "before: {:?}", self.before)?;
        for (actor, part) in self.at_once.iter().enumerate() {
            write!(f, "; actor {actor}: {:?}", part.operations)?;
            if let Some((fault, call)) = part.fault {
                write!(f, ", {fault:?} at call {call}")?;
            }
            if part.refuses {
                write!(f, ", does not wait")?;
            }
        }
        Ok(())
    }
}

impl History {
    /// That of a seed, with operations of these.
    pub fn drawn(seed: u64, operations: &[Operation]) -> Self {
        let mut draw = Draw(seed);
        let favourite = draw.one_of(operations);
        let operation = |draw: &mut Draw| match draw.number(2) {
            0 => favourite,
            _ => draw.one_of(operations),
        };
        let before = (0..draw.number(3)).map(|_| operation(&mut draw)).collect();
        let actors = 1 + draw.number(2);
        let part = |_| Part {
            operations: (0..1 + draw.number(2))
                .map(|_| operation(&mut draw))
                .collect(),
            fault: (draw.number(4) > 0).then(|| {
                // Few calls and many of them are as frequent.
                let most = 2 << draw.number(7);
                (ActorFault::drawn(&mut draw), draw.number(most))
            }),
            refuses: draw.number(4) == 0,
        };
        Self {
            before,
            at_once: (0..actors).map(part).collect(),
        }
    }

    /// Performs it, and says which promise was broken, if one was.
    pub fn perform(&self, seed: u64) -> Result<(), String> {
        let performed = catch_unwind(AssertUnwindSafe(|| {
            let at = Workplace::new(&format!("{seed}-{:?}", thread::current().id()));
            let mut claims = self.prepare(&at)?;
            claims.extend(self.act(&at, seed)?);
            check(&at, &claims)
        }));
        performed.unwrap_or_else(|panic| Err(text_of(&*panic)))
    }

    fn prepare(&self, at: &Workplace) -> Result<Vec<Claim>, String> {
        let storage = Storage::default().with_patience(Patience::None);
        let operations = self.before.iter().enumerate();
        let claims = operations.map(|(number, &operation)| {
            let tasks = vec![format!("before {number} alone")];
            // A dataset that is not there cannot be repaired, and a new file cannot be made twice.
            let outcome = match operation.perform(at, &tasks, &storage) {
                Ok(()) => Outcome::Done,
                Err(error) => Outcome::Failed(error),
            };
            Ok(Claim {
                operation,
                tasks,
                outcome,
            })
        });
        claims.collect()
    }

    fn act(&self, at: &Workplace, seed: u64) -> Result<Vec<Claim>, String> {
        let stage = Stage::new(self.at_once.len(), seed);
        let claims = thread::scope(|scope| {
            let acting: Vec<_> = self
                .at_once
                .iter()
                .enumerate()
                .map(|(actor, part)| {
                    let stage = Arc::clone(&stage);
                    scope.spawn(move || part.act(actor, at, &stage))
                })
                .collect();
            let ended = acting.into_iter().map(|it| it.join());
            ended.collect::<Vec<_>>()
        });
        let mut all = Vec::new();
        for claims in claims {
            all.extend(claims.map_err(|panic| text_of(&*panic))?);
        }
        Ok(all)
    }

    /// The shortest history, of those that leave out something of this, that breaks a promise, too.
    pub fn shortest(mut self, seed: u64) -> Self {
        loop {
            let mut shorter = self.shorter().into_iter();
            match shorter.find(|history| history.perform(seed).is_err()) {
                Some(failing) => self = failing,
                None => return self,
            }
        }
    }

    fn shorter(&self) -> Vec<Self> {
        let mut all = Vec::new();
        for number in 0..self.before.len() {
            let mut shorter = self.clone();
            shorter.before.remove(number);
            all.push(shorter);
        }
        for actor in 0..self.at_once.len() {
            if self.at_once.len() > 1 {
                let mut shorter = self.clone();
                shorter.at_once.remove(actor);
                all.push(shorter);
            }
            for number in 0..self.at_once[actor].operations.len() {
                let mut shorter = self.clone();
                shorter.at_once[actor].operations.remove(number);
                all.push(shorter);
            }
            if self.at_once[actor].fault.is_some() {
                let mut shorter = self.clone();
                shorter.at_once[actor].fault = None;
                all.push(shorter);
            }
        }
        all
    }
}

impl Part {
    fn act(&self, actor: usize, at: &Workplace, stage: &Arc<Stage>) -> Vec<Claim> {
        /// Leaves the stage, be it in a panic.
        struct Leaving<'s>(&'s Stage, usize);
        impl Drop for Leaving<'_> {
            fn drop(&mut self) {
                self.0.leave(self.1);
            }
        }
        stage.enter(actor);
        let _leaving = Leaving(stage, actor);
        let fate = Arc::new(ActorFate {
            stage: Arc::clone(stage),
            actor,
            fault: self.fault,
            calls: AtomicU64::new(0),
        });
        let patience = match self.refuses {
            true => Patience::None,
            false => Patience::Wait(|_| {}),
        };
        let mut claims = Vec::new();
        for (number, &operation) in self.operations.iter().enumerate() {
            if fate.is_killed() {
                break;
            }
            let storage = Storage::with_fate(Arc::clone(&fate) as _).with_patience(patience);
            let tasks: Vec<_> = ["first", "second"]
                .iter()
                .map(|which| format!("actor {actor} operation {number} {which}"))
                .collect();
            let performed = operation.perform(at, &tasks, &storage);
            let outcome = match (performed, fate.is_killed()) {
                (_, true) => Outcome::Killed,
                (Ok(()), false) => Outcome::Done,
                (Err(error), false) => Outcome::Failed(error),
            };
            claims.push(Claim {
                operation,
                tasks,
                outcome,
            });
        }
        claims
    }
}

fn text_of(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().cloned();
    text.or_else(|| panic.downcast_ref::<&str>().map(|&text| text.to_owned()))
        .unwrap_or_else(|| "a panic".into())
}
