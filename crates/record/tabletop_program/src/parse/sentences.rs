//! Sentences, procedures and whole programs.

use crate::{
    noun::{HowMany, Noun},
    parse::{
        conditions::condition,
        cursor::Cursor,
        instructions::{chain, is_new_verb},
        nouns,
    },
    print::target,
    program::{Procedure, Sentence, TaskProgram},
};

/// Reads a whole text.
pub(crate) fn program(cursor: &mut Cursor) -> Option<TaskProgram> {
    let mut program = TaskProgram::default();
    while !cursor.is_at_end() {
        match cursor.peek() == "to" {
            true => program.procedures.push(procedure(cursor)?),
            false => program.sentences.push(sentence(cursor)?),
        }
        ended(cursor)?;
    }
    if program.sentences.is_empty() && program.procedures.is_empty() {
        cursor.expect("a sentence", &[]);
        return None;
    }
    Some(program)
}

/// Reads the end of a sentence.
fn ended(cursor: &mut Cursor) -> Option<()> {
    if cursor.one_of(&[".", "!"]).is_some() || cursor.is_at_end() {
        return Some(());
    }
    let begins_line = cursor.token().is_some_and(|token| token.begins_line);
    begins_line.then_some(())
}

fn procedure(cursor: &mut Cursor) -> Option<Procedure> {
    cursor.word("to")?;
    let new = |word: &str| is_new_verb(word).then(|| word.to_owned());
    let verb = cursor.known("a verb that is not known yet", &[], new)?;
    let mut objects = Vec::new();
    while cursor.word(":").is_none() {
        if !objects.is_empty() {
            cursor.word("and")?;
        }
        match nouns::named(cursor)? {
            Noun::Named { id } => objects.push(id),
            Noun::Described { .. } => return None,
        }
    }
    let mut sentences = vec![sentence(cursor)?];
    while cursor.word(";").is_some() {
        sentences.push(sentence(cursor)?);
    }
    Some(Procedure {
        verb,
        objects,
        sentences,
    })
}

fn sentence(cursor: &mut Cursor) -> Option<Sentence> {
    let _ = cursor.attempt(|cursor| {
        cursor.one_of(&["please", "then", "first", "next", "now", "finally", "also"])?;
        let _ = cursor.word(",");
        Some(())
    });
    if cursor.word("if").is_some() {
        return conditional(cursor);
    }
    if cursor.word("while").is_some() {
        return repeated_while(cursor);
    }
    let (at, it) = (cursor.at, cursor.it.clone());
    let instructions = chain(cursor, None)?;
    let _ = cursor.attempt(|cursor| {
        cursor.word(",")?;
        (cursor.peek() == "until").then_some(())
    });
    if cursor.word("until").is_none() {
        return Some(Sentence::Do { instructions });
    }
    // Plurals mean one object in each round.
    (cursor.at, cursor.it, cursor.bare) = (at, it, HowMany::Any);
    let instructions = chain(cursor, None);
    cursor.bare = HowMany::Every;
    let instructions = instructions?;
    let _ = cursor.word(",");
    cursor.word("until")?;
    if let Some(target) = target(&instructions).filter(|target| target.is_definite()) {
        cursor.it = Some(target.clone());
    }
    let condition = condition(cursor)?;
    Some(Sentence::Until {
        condition,
        instructions,
    })
}

fn conditional(cursor: &mut Cursor) -> Option<Sentence> {
    let condition = condition(cursor)?;
    let it = condition.it();
    let _ = cursor.word(",");
    let _ = cursor.word("then");
    let then = chain(cursor, it.as_ref())?;
    let otherwise = cursor.attempt(|cursor| {
        let _ = cursor.word(",");
        cursor.one_of(&["otherwise", "else"])?;
        let _ = cursor.word(",");
        chain(cursor, it.as_ref())
    });
    Some(Sentence::If {
        condition,
        then,
        otherwise: otherwise.unwrap_or_default(),
    })
}

fn repeated_while(cursor: &mut Cursor) -> Option<Sentence> {
    let holds = condition(cursor)?;
    let it = holds.it();
    let Some(condition) = holds.negated() else {
        cursor.expect("a condition of which the opposite can be said", &[]);
        return None;
    };
    let _ = cursor.word(",");
    cursor.bare = HowMany::Any;
    let instructions = chain(cursor, it.as_ref());
    cursor.bare = HowMany::Every;
    Some(Sentence::Until {
        condition,
        instructions: instructions?,
    })
}
