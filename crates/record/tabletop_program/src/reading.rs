//! Programs read from files, as JSON or as sentences.

use crate::{program::TaskProgram, sentence_error::SentenceError};

/// The fault of a program in a file.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the message says it")]
pub enum ProgramError {
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    #[error("no sentence says this: {text}: {fault}")]
    Unsayable { text: String, fault: SentenceError },
    #[error("its sentence means something else: {0}")]
    Ambiguous(String),
    #[error(transparent)]
    Sentence(#[from] SentenceError),
}

/// The JSON schema of programs.
pub const SCHEMA: &str = include_str!("../program.schema.json");

impl TaskProgram {
    /// Reads a program from JSON, and makes sure that sentences say the same.
    ///
    /// # Errors
    /// It is no program, or no sentence says it.
    pub fn from_json(text: &str) -> Result<Self, ProgramError> {
        let program: Self = serde_json::from_str(text)?;
        let text = program.to_string();
        match text.parse::<Self>() {
            Ok(same) if same == program => Ok(program),
            Ok(_) => Err(ProgramError::Ambiguous(text)),
            Err(fault) => Err(ProgramError::Unsayable { text, fault }),
        }
    }

    /// Reads a program from a file's text: JSON, or sentences, which may be numbered.
    ///
    /// # Errors
    /// It is no program.
    pub fn read(text: &str) -> Result<Self, ProgramError> {
        match text.trim_start().starts_with('{') {
            true => Self::from_json(text),
            false => Ok(text.parse()?),
        }
    }

    /// It as JSON.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}
