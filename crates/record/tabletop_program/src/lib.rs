//! Task programs: what is to be done with sets of objects (every, each, the largest first, until, patterns, counts, conditions), in
//! sentences that are printed and parsed, and the next step of a program on the table as it is now.
//!
//! ```
//! use tabletop_program::TaskProgram;
//!
//! let program: TaskProgram = "put all the red cubes in the blue container".parse()?;
//! assert_eq!(program.to_string(), "Put every red block into the blue box.");
//! # Ok::<_, tabletop_program::SentenceError>(())
//! ```

mod attempts;
mod condition;
mod expansion;
mod finding;
mod goal;
mod hand;
mod instruction;
mod items;
mod layout;
mod look;
mod noun;
mod parse;
mod pattern_goals;
mod placement;
mod print;
mod program;
mod reading;
mod run;
mod scene;
mod selection;
mod sentence_error;
mod standing;
mod step;
mod substitution;
mod truth;
mod words;

pub use attempts::{NextAttempt, ProgramAttempts, StepAttempt};
pub use condition::Condition;
pub use finding::{Alternative, Example, Meaning, SceneVariation, Untouched};
pub use hand::{HandFailure, HandProgress, HandStep, HandledObject};
pub use instruction::{Instruction, Pattern, TargetPlace};
pub use noun::{
    Feature, HowMany, Noun, ObjectKind, Preposition, RelativeSize, Restriction, Spot, Superlative,
    TableSide,
};
pub use program::{Procedure, Sentence, TaskProgram};
pub use reading::{ProgramError, SCHEMA};
pub use run::{Impossible, NextStep, ProgramRun};
pub use scene::TableScene;
pub use sentence_error::SentenceError;
pub use step::ConcreteStep;
