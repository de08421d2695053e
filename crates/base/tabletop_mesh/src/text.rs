//! Files of words and numbers.

use bevy::math::Vec3;

/// Most words of a line that are read, and so most corners of a face.
const MOST_WORDS: usize = 1000;

/// The words of the lines that have some, each with its number.
pub(crate) fn lines(bytes: &[u8]) -> Result<impl Iterator<Item = (usize, Vec<&str>)>, String> {
    let text = str::from_utf8(bytes).map_err(|error| format!("it is no text: {error}"))?;
    let lines = text.lines().zip(1..).map(|(text, line)| {
        let said = text.split('#').next().unwrap_or_default();
        // A name can be as long as a line; of numbers, no more are needed.
        (line, said.split_whitespace().take(MOST_WORDS).collect())
    });
    Ok(lines)
}

/// The point that the words of a line begin with.
pub(crate) fn point(line: usize, words: &[&str]) -> Result<Vec3, String> {
    let number = |index: usize| words.get(index)?.parse().ok();
    let point = || Some(Vec3::new(number(0)?, number(1)?, number(2)?));
    point().ok_or_else(|| format!("line {line}: a corner is not three numbers"))
}
