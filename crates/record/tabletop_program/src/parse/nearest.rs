//! The nearest text that is understood.

use std::collections::BTreeMap;

use crate::{
    parse::{misfit::Misfit, token::Token},
    program::TaskProgram,
};

/// The most repaired texts that are tried.
const MOST_TRIED: usize = 300;
/// The longest sentence that is repaired, in words and marks.
const LONGEST: usize = 60;
/// What a repair costs, in hundredths of a wholly different word: a missing word, a missing article, a word too many.
const MISSING: usize = 60;
const MISSING_ARTICLE: usize = 40;
const TOO_MANY: usize = 70;

type Parsed = Result<TaskProgram, Misfit>;

/// The sentence that does not fit at this token, with the fewest and smallest changes that make it fit.
pub(crate) fn nearest(
    tokens: &[Token],
    at: usize,
    parsed: impl Fn(&[Token]) -> Parsed,
) -> Option<String> {
    let sentence = sentence_at(tokens, at);
    if sentence.is_empty() || sentence.len() > LONGEST {
        return None;
    }
    // Repairs by what they cost in sum, then in the order in which they were found; each is of a text that was tried.
    let mut tried = vec![sentence.to_vec()];
    let mut repairs = BTreeMap::new();
    let mut found = 0;
    let mut add =
        |repairs: &mut BTreeMap<_, _>, cost: usize, of: usize, text: &[Token], misfit: &Misfit| {
            for (more, repair) in repairs_of(text, misfit) {
                found += 1;
                repairs.insert((cost + more, found), (of, repair));
            }
        };
    let misfit = parsed(sentence).err()?;
    add(&mut repairs, 0, 0, sentence, &misfit);
    while tried.len() < MOST_TRIED {
        let ((cost, _), (of, repair)) = repairs.pop_first()?;
        let text = repair.on(&tried[of]);
        match parsed(&text) {
            Ok(program) => return Some(program.in_a_line()),
            Err(misfit) => add(&mut repairs, cost, tried.len(), &text, &misfit),
        }
        tried.push(text);
    }
    None
}

/// A change of a text.
enum SentenceRepair {
    Replace(usize, String),
    Insert(usize, String),
    Remove(usize),
}

impl SentenceRepair {
    fn on(&self, text: &[Token]) -> Vec<Token> {
        let mut text = text.to_vec();
        match self {
            Self::Replace(at, word) => text[*at] = text[*at].replaced(word),
            Self::Insert(at, word) => {
                let like = text.get(*at).or(text.last());
                let inserted = like.map(|like| Token {
                    begins_line: false,
                    ..like.replaced(word)
                });
                text.splice(*at..*at, inserted);
            }
            Self::Remove(at) => drop(text.remove(*at)),
        }
        text
    }
}

/// The tokens of the sentence at this place.
fn sentence_at(tokens: &[Token], at: usize) -> &[Token] {
    let at = at.min(tokens.len());
    let ends = |token: &Token| token.word == "." || token.word == "!";
    let start = (1..=at.min(tokens.len().saturating_sub(1)))
        .rev()
        .find(|&i| ends(&tokens[i - 1]) || tokens[i].begins_line);
    let start = start.unwrap_or(0);
    let end = tokens[start..].iter().position(ends);
    &tokens[start..end.map_or(tokens.len(), |end| start + end + 1)]
}

/// The changes at the place that does not fit, and what each costs.
fn repairs_of(text: &[Token], misfit: &Misfit) -> Vec<(usize, SentenceRepair)> {
    let at = misfit.at.min(text.len());
    let mut all = Vec::new();
    for word in &misfit.words {
        if let Some(here) = text.get(at) {
            let cost = difference(&here.text.to_lowercase(), word);
            all.push((cost, SentenceRepair::Replace(at, word.clone())));
        }
        let cost = match ["the", "any"].contains(&word.as_str()) {
            true => MISSING_ARTICLE,
            false => MISSING,
        };
        all.push((cost, SentenceRepair::Insert(at, word.clone())));
    }
    if at < text.len() {
        all.push((TOO_MANY, SentenceRepair::Remove(at)));
    }
    all
}

/// The share of letters that differ between two words, in hundredths; two letters in the wrong order are one (optimal string alignment).
fn difference(one: &str, other: &str) -> usize {
    let [one, other]: [Vec<char>; 2] = [one, other].map(|word| word.chars().collect());
    let mut rows = vec![(0..=other.len()).collect::<Vec<_>>()];
    for i in 1..=one.len() {
        let mut row = vec![i];
        for j in 1..=other.len() {
            let replaced = rows[i - 1][j - 1] + usize::from(one[i - 1] != other[j - 1]);
            let mut least = replaced.min(rows[i - 1][j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && one[i - 1] == other[j - 2] && one[i - 2] == other[j - 1] {
                least = least.min(rows[i - 2][j - 2] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    100 * rows[one.len()][other.len()] / one.len().max(other.len()).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_differ_by_their_letters() {
        assert_eq!(difference("block", "block"), 0);
        assert_eq!(difference("blokc", "block"), 20);
        assert_eq!(difference("ito", "into"), 25);
        assert_eq!(difference("", "abc"), 100);
        assert_eq!(difference("abc", ""), 100);
    }
}
