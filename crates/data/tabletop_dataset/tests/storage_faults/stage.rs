//! The order in which the calls of several actors happen.

use std::{
    io,
    sync::{
        Arc, Condvar, Mutex,
        atomic::{AtomicU64, Ordering},
    },
    time::Duration,
};

use tabletop_storage::{CallFailure, Fate, StorageFault};

/// Pauses in a row after which all wait for each other.
const MOST_PAUSES: u32 = 5_000;

/// Numbers that a seed draws (SplitMix64).
#[derive(Clone, Debug)]
pub struct Draw(pub u64);

impl Draw {
    pub fn number(&mut self, below: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (bits ^ (bits >> 31)) % below
    }

    pub fn one_of<T: Clone>(&mut self, choices: &[T]) -> T {
        choices[self.number(choices.len() as u64) as usize].clone()
    }
}

/// Lets one actor at a time go on.
#[derive(Debug)]
pub struct Stage {
    turn: Mutex<Turn>,
    changed: Condvar,
}

#[derive(Debug)]
struct Turn {
    of: usize,
    /// The actors that have not ended.
    acting: Vec<usize>,
    draw: Draw,
    pauses: u32,
}

impl Stage {
    pub fn new(actors: usize, seed: u64) -> Arc<Self> {
        let mut draw = Draw(seed);
        Arc::new(Self {
            turn: Mutex::new(Turn {
                of: draw.number(actors as u64) as usize,
                acting: (0..actors).collect(),
                draw,
                pauses: 0,
            }),
            changed: Condvar::new(),
        })
    }

    /// Waits until this actor's turn comes.
    pub fn enter(&self, actor: usize) {
        let turn = self.turn.lock().unwrap();
        drop(
            self.changed
                .wait_while(turn, |turn| turn.of != actor)
                .unwrap(),
        );
    }

    /// Lets others go on, and waits until this actor's turn comes again.
    fn yield_turn(&self, actor: usize, is_pause: bool) {
        let mut turn = self.turn.lock().unwrap();
        turn.pauses = if is_pause { turn.pauses + 1 } else { 0 };
        assert!(turn.pauses < MOST_PAUSES, "all wait for each other");
        let others: Vec<_> = turn
            .acting
            .iter()
            .copied()
            .filter(|&it| it != actor)
            .collect();
        if !others.is_empty() && (is_pause || turn.draw.number(4) == 0) {
            turn.of = turn.draw.one_of(&others);
            self.changed.notify_all();
            drop(
                self.changed
                    .wait_while(turn, |turn| turn.of != actor)
                    .unwrap(),
            );
        }
    }

    /// This actor has ended.
    pub fn leave(&self, actor: usize) {
        let mut turn = self.turn.lock().unwrap();
        turn.acting.retain(|&it| it != actor);
        turn.pauses = 0;
        if let Some(&first) = turn.acting.first() {
            turn.of = first;
        }
        self.changed.notify_all();
    }
}

/// A fault of an actor's calls.
#[derive(Clone, Copy, Debug)]
pub enum ActorFault {
    Storage(StorageFault),
    /// One call is not allowed.
    Denied,
}

impl ActorFault {
    pub fn drawn(draw: &mut Draw) -> Self {
        match draw.number(6) {
            0 => Self::Denied,
            _ => Self::Storage(draw.one_of(&StorageFault::ALL)),
        }
    }

    const fn is_kill(self) -> bool {
        match self {
            Self::Storage(StorageFault::Killed | StorageFault::KilledWithin) => true,
            Self::Storage(StorageFault::FullOnce | StorageFault::Full | StorageFault::Broken)
            | Self::Denied => false,
        }
    }
}

/// The calls of an actor: they happen when its turn comes, and from one on, there may be a fault.
#[derive(Debug)]
pub struct ActorFate {
    pub stage: Arc<Stage>,
    pub actor: usize,
    pub fault: Option<(ActorFault, u64)>,
    pub calls: AtomicU64,
}

impl ActorFate {
    /// True once the program is killed.
    pub fn is_killed(&self) -> bool {
        let calls = self.calls.load(Ordering::Relaxed);
        self.fault
            .is_some_and(|(fault, at)| fault.is_kill() && calls > at)
    }
}

impl Fate for ActorFate {
    fn of_call(&self) -> Option<CallFailure> {
        // The dead do nothing, and at once.
        if !self.is_killed() {
            self.stage.yield_turn(self.actor, false);
        }
        let call = self.calls.fetch_add(1, Ordering::Relaxed);
        match self.fault? {
            (ActorFault::Storage(fault), at) => fault.of_call(call, at),
            (ActorFault::Denied, at) => (call == at).then(|| CallFailure {
                error: io::ErrorKind::PermissionDenied.into(),
                tears: false,
            }),
        }
    }

    fn pause(&self, _: Duration) {
        self.stage.yield_turn(self.actor, true);
    }
}
