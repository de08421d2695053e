//! Programs.

use serde::{Deserialize, Serialize};

use crate::{condition::Condition, instruction::Instruction};

/// A task program: sentences that are carried out one after the other.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TaskProgram {
    /// The procedures that its sentences may call.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub procedures: Vec<Procedure>,
    /// Its sentences.
    pub sentences: Vec<Sentence>,
}

/// Sentences with a name, for any objects.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Procedure {
    /// The verb that names it, which no other sentence has.
    pub verb: String,
    /// The names of its objects.
    pub objects: Vec<String>,
    /// What is done with them.
    pub sentences: Vec<Sentence>,
}

/// A sentence of a program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "sentence", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Sentence {
    /// Instructions one after the other.
    Do {
        /// The instructions.
        instructions: Vec<Instruction>,
    },
    /// Instructions if a condition holds.
    If {
        /// The condition.
        condition: Condition,
        /// The instructions.
        then: Vec<Instruction>,
        /// The instructions if it does not hold.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        otherwise: Vec<Instruction>,
    },
    /// Instructions again and again, until a condition holds.
    Until {
        /// The condition, which is looked at before each round.
        condition: Condition,
        /// The instructions.
        instructions: Vec<Instruction>,
    },
}
