//! What an episode is to bring about: checks of the world, or what sentences say.

use bevy::prelude::*;
use tabletop_scenario::{Check, Judge, Verdict};

use crate::instruction::ToldGoal;

/// What an episode is to bring about.
#[derive(Clone, Debug)]
pub(crate) enum EpisodeGoal {
    /// These checks hold.
    Checks(Vec<Check>),
    /// What this says is done.
    Told(Box<ToldGoal>),
}

impl Default for EpisodeGoal {
    fn default() -> Self {
        Self::Checks(Vec::new())
    }
}

impl EpisodeGoal {
    /// The number of verdicts.
    pub const fn len(&self) -> usize {
        match self {
            Self::Checks(checks) => checks.len(),
            Self::Told(goal) => goal.len(),
        }
    }

    /// The world, compared with it.
    pub fn judge(&mut self, judge: &Judge, world: &mut World) -> Result<Vec<Verdict>> {
        match self {
            Self::Checks(checks) => judge.judge(world, checks),
            Self::Told(goal) => goal.judge(judge, world),
        }
    }

    /// Id of the object that is to be moved next, after these verdicts.
    pub fn next(&self, verdicts: &[Verdict]) -> Option<&str> {
        match self {
            Self::Checks(checks) => {
                let undone = verdicts.iter().position(|it| it.failure.is_some())?;
                checks[undone].moved()
            }
            Self::Told(goal) => goal.next(),
        }
    }

    /// The sentences that say it, if it is said.
    pub fn instruction(&self) -> Option<&str> {
        match self {
            Self::Checks(_) => None,
            Self::Told(goal) => Some(&goal.sentences),
        }
    }
}
