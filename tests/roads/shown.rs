//! What a recording is known to show.

use super::program::Ended;

/// The sentences of a task, as `explain` prints them.
pub type Sentences = &'static [&'static str];

/// The sentence itself, without its number and what must come before it.
fn words(line: &str) -> &str {
    let line = line.trim();
    let line = match line.split_once(". ") {
        Some((number, rest)) if number.parse::<u32>().is_ok() => rest,
        _ => line.strip_prefix("- ").unwrap_or(line),
    };
    line.split(" (")
        .next()
        .unwrap_or(line)
        .trim_end_matches('.')
}

/// The sentences of those who do the task with one hand, such as a robot, which is free to.
pub fn with_one_hand(sentences: Sentences) -> Vec<String> {
    let with_one_hand = |line: &&str| {
        let by_hands = " from the left hand to the right hand and put it";
        line.replace(by_hands, "").replace("Hand the ", "Put the ")
    };
    sentences.iter().map(with_one_hand).collect()
}

/// The sentences that pictures can show: hands are invisible.
pub fn seen(sentences: Sentences) -> Vec<String> {
    let mut seen = with_one_hand(sentences);
    seen.retain(|line| !line.starts_with("- "));
    seen
}

/// Compares the first lines that were printed with what is to be shown.
pub fn check_printed<S: AsRef<str>>(ended: &Ended, sentences: &[S]) -> Result<(), String> {
    let printed: Vec<_> = ended.stdout.lines().collect();
    let expected: Vec<_> = sentences.iter().map(AsRef::as_ref).collect();
    match printed.starts_with(&expected) {
        true => Ok(()),
        false => Err(format!("expected {expected:?}, not {printed:?}")),
    }
}

/// Compares the words of a text with what is to be shown.
pub fn check_told(text: &str, sentences: Sentences) -> Result<(), String> {
    let missing = sentences.iter().find(|line| {
        let words = words(line);
        !text.contains(words)
    });
    match missing {
        None => Ok(()),
        Some(missing) => {
            let text: String = text.chars().take(300).collect();
            Err(format!("{:?} is not told in {text:?}", words(missing)))
        }
    }
}
