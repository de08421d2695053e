//! The words and marks of a text.

/// A word or a mark of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Token {
    /// As it is written.
    pub text: String,
    /// In lower case; empty for a quoted text.
    pub word: String,
    pub line: usize,
    pub column: usize,
    /// True if it is the first of its line.
    pub begins_line: bool,
}

impl Token {
    /// A word that is not in the text, in the place of this one.
    pub fn replaced(&self, word: &str) -> Self {
        Self {
            text: word.to_owned(),
            word: word.to_owned(),
            ..self.clone()
        }
    }

    /// True if it is a text in quotation marks.
    pub const fn is_quoted(&self) -> bool {
        self.word.is_empty()
    }
}

/// The words and marks of a text. Numbers before sentences, and lines that begin with `#`, are left out.
pub(crate) fn tokens(text: &str) -> Vec<Token> {
    let lines = text.lines().enumerate();
    lines
        .flat_map(|(line, text)| of_line(line + 1, text))
        .collect()
}

fn of_line(line: usize, text: &str) -> Vec<Token> {
    let letters: Vec<char> = text.chars().collect();
    let mut tokens = Vec::new();
    let mut at = 0;
    if text.trim_start().starts_with('#') {
        return tokens;
    }
    while let Some(&letter) = letters.get(at) {
        if letter.is_whitespace() {
            at += 1;
            continue;
        }
        let end = end_of(&letters, at);
        let is_quoted = letter == '"';
        let inner = match is_quoted {
            true => &letters[at + 1..(end - 1).max(at + 1)],
            false => &letters[at..end],
        };
        let text: String = inner.iter().collect();
        let word = if is_quoted {
            String::new()
        } else {
            text.to_lowercase()
        };
        let begins_line = tokens.is_empty();
        tokens.push(Token {
            text,
            word,
            line,
            column: at + 1,
            begins_line,
        });
        at = end;
    }
    let is_numbered = |tokens: &[Token]| match tokens {
        [number, stop, ..] => number.word.parse::<u32>().is_ok() && stop.word == ".",
        _ => false,
    };
    if is_numbered(&tokens) {
        tokens.drain(..2);
        if let Some(first) = tokens.first_mut() {
            first.begins_line = true;
        }
    }
    tokens
}

/// The end of the word or mark that begins here.
fn end_of(letters: &[char], at: usize) -> usize {
    let while_all = |from: usize, is_part: fn(char) -> bool| {
        let rest = letters[from..].iter();
        from + rest.take_while(|letter| is_part(**letter)).count()
    };
    let is_digit = |letter: char| letter.is_ascii_digit();
    let next_is_digit = |at: usize| letters.get(at + 1).copied().is_some_and(is_digit);
    match letters[at] {
        '"' => {
            let close = while_all(at + 1, |letter| letter != '"');
            (close + 1).min(letters.len())
        }
        letter if letter.is_alphabetic() => while_all(at, |letter| {
            letter.is_alphanumeric() || "-_".contains(letter)
        }),
        letter if is_digit(letter) || (letter == '-' && next_is_digit(at)) => {
            let whole = while_all(at + 1, |letter| letter.is_ascii_digit());
            match letters.get(whole) {
                Some('.') if next_is_digit(whole) => {
                    while_all(whole + 1, |letter| letter.is_ascii_digit())
                }
                _ => whole,
            }
        }
        _ => at + 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_numbers_and_texts_have_their_places() {
        let found = tokens("# a comment\n1. Put \"A b\" on\n  PegA at (1, -2.5).");
        let found: Vec<_> = found
            .iter()
            .map(|it| (it.text.as_str(), it.line, it.column))
            .collect();
        let expected = [
            ("Put", 2, 4),
            ("A b", 2, 8),
            ("on", 2, 14),
            ("PegA", 3, 3),
            ("at", 3, 8),
            ("(", 3, 11),
            ("1", 3, 12),
            (",", 3, 13),
            ("-2.5", 3, 15),
            (")", 3, 19),
            (".", 3, 20),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn strange_texts_have_tokens_too() {
        for text in ["\"", "\"a", "-", "1.", "9.9.9", "é\u{301}", "((", "\u{0}"] {
            let _ = tokens(text);
        }
    }
}
