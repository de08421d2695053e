//! Programs from English sentences.

mod conditions;
mod cursor;
mod instructions;
mod misfit;
mod nearest;
mod nouns;
mod sentences;
mod token;

use std::str::FromStr;

use cursor::Cursor;
use instructions::defined_verbs;
use misfit::Misfit;
use nearest::nearest;
use sentences::program;
use token::{Token, tokens};

use crate::{program::TaskProgram, sentence_error::SentenceError};

/// The longest text that is read, in bytes.
const MOST_BYTES: usize = 1 << 16;

impl FromStr for TaskProgram {
    type Err = SentenceError;

    /// Reads sentences, with or without capitals, full stops and numbers before them. Lines that begin with `#` are comments.
    fn from_str(text: &str) -> Result<Self, SentenceError> {
        if text.len() > MOST_BYTES {
            return Err(SentenceError {
                line: 1,
                column: 1,
                found: None,
                expected: vec![format!("a text of at most {MOST_BYTES} bytes")],
                nearest: None,
            });
        }
        let tokens = tokens(text);
        let verbs = defined_verbs(&tokens);
        parsed(&tokens, &verbs).map_err(|misfit| {
            let token = tokens.get(misfit.at);
            let end = text.lines().enumerate().last();
            let end = end.map_or((1, 1), |(line, text)| (line + 1, text.chars().count() + 1));
            let (line, column) = token.map_or(end, |token| (token.line, token.column));
            SentenceError {
                line,
                column,
                found: token.map(|token| token.text.clone()),
                nearest: nearest(&tokens, misfit.at, |tokens| parsed(tokens, &verbs)),
                expected: misfit.expected,
            }
        })
    }
}

fn parsed(tokens: &[Token], verbs: &[String]) -> Result<TaskProgram, Misfit> {
    let mut cursor = Cursor::new(tokens, verbs.to_vec());
    program(&mut cursor).ok_or_else(|| Misfit {
        at: cursor.farthest,
        expected: cursor.expected.keys().cloned().collect(),
        words: cursor.expected.values().flatten().cloned().collect(),
    })
}
