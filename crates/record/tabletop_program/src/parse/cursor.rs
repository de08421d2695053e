//! A place in a text, with all that would have fitted at the farthest place that was reached.

use std::collections::BTreeMap;

use crate::{
    noun::{HowMany, Noun},
    parse::token::Token,
};

/// A place in a text. What cannot be read there is `None`, and leaves a trace of what was expected.
pub(crate) struct Cursor<'t> {
    pub tokens: &'t [Token],
    pub at: usize,
    /// The farthest place at which something did not fit.
    pub farthest: usize,
    /// What would have fitted there, as an error names it, and as words that can stand there.
    pub expected: BTreeMap<String, Vec<String>>,
    /// The verbs of the text's procedures.
    pub verbs: Vec<String>,
    /// What `it` means.
    pub it: Option<Noun>,
    /// What a plural without any article means.
    pub bare: HowMany,
    /// How many nouns this one is part of.
    pub depth: usize,
}

impl<'t> Cursor<'t> {
    pub fn new(tokens: &'t [Token], verbs: Vec<String>) -> Self {
        Self {
            tokens,
            at: 0,
            farthest: 0,
            expected: BTreeMap::new(),
            verbs,
            it: None,
            bare: HowMany::Every,
            depth: 0,
        }
    }

    pub fn token(&self) -> Option<&'t Token> {
        self.tokens.get(self.at)
    }

    /// The present word, in lower case.
    pub fn peek(&self) -> &'t str {
        self.token().map_or("", |token| token.word.as_str())
    }

    pub fn is_at_end(&self) -> bool {
        self.at >= self.tokens.len()
    }

    /// Remembers that something else was expected here.
    pub fn expect(&mut self, name: &str, words: &[&str]) {
        if self.at > self.farthest {
            self.farthest = self.at;
            self.expected.clear();
        }
        if self.at == self.farthest && !self.expected.contains_key(name) {
            let words = words.iter().map(|word| (*word).to_owned());
            self.expected.insert(name.to_owned(), words.collect());
        }
    }

    /// Reads this word.
    pub fn word(&mut self, word: &str) -> Option<()> {
        let is_here = self.peek() == word;
        match is_here {
            true => self.at += 1,
            false => self.expect(word, &[word]),
        }
        is_here.then_some(())
    }

    /// Reads one of these words, each of which an error names.
    pub fn one_of(&mut self, words: &[&str]) -> Option<()> {
        words.iter().find_map(|word| self.word(word))
    }

    /// Reads these words, or nothing.
    pub fn phrase(&mut self, words: &str) -> Option<()> {
        self.attempt(|cursor| words.split(' ').try_for_each(|word| cursor.word(word)))
    }

    /// Reads one of these phrases.
    pub fn phrases(&mut self, phrases: &[&str]) -> Option<()> {
        phrases.iter().find_map(|words| self.phrase(words))
    }

    /// Reads what a word of a kind means; `words` can stand there.
    pub fn known<T>(
        &mut self,
        name: &str,
        words: &[&str],
        meaning: impl Fn(&str) -> Option<T>,
    ) -> Option<T> {
        let found = meaning(self.peek());
        match &found {
            Some(_) => self.at += 1,
            None => self.expect(name, words),
        }
        found
    }

    /// Reads it, or nothing at all.
    pub fn attempt<T>(&mut self, read: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        let (at, depth) = (self.at, self.depth);
        let found = read(self);
        if found.is_none() {
            self.at = at;
        }
        self.depth = depth;
        found
    }
}
