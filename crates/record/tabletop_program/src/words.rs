//! The words of the grammar.

/// Kinds of objects, each followed by other words for it.
pub(crate) const KINDS: [&[&str]; 19] = [
    &["object", "thing", "item", "piece"],
    &["block", "cube", "brick"],
    &["cylinder", "can", "rod", "pillar"],
    &["ball", "sphere"],
    &["box", "container", "chest", "crate", "bin"],
    &["ring", "disk", "disc", "washer"],
    &["frustum", "cone", "pyramid"],
    &["lid", "cover"],
    &["switch"],
    &["button"],
    &["plate", "dish"],
    &["bowl"],
    &["cup", "mug"],
    &["tray"],
    &["peg", "post", "pole"],
    &["drawer"],
    &["bar", "beam"],
    &["letter"],
    &["tower", "stack", "pile"],
];

/// Colours of one word, as the simulator names them, each followed by other words for it.
pub(crate) const COLORS: [&[&str]; 12] = [
    &["black"],
    &["blue"],
    &["brown"],
    &["cyan", "turquoise"],
    &["gray", "grey"],
    &["green"],
    &["magenta", "purple"],
    &["orange"],
    &["pink"],
    &["red"],
    &["white"],
    &["yellow"],
];

/// Shades that make `dark gray` of `gray`.
pub(crate) const SHADES: [&str; 2] = ["dark", "light"];

/// Numbers in words, from 1.
const NUMBERS: [&str; 12] = [
    "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven",
    "twelve",
];

/// The largest number that a sentence may have.
pub(crate) const MOST: u32 = 99;

/// A number in words, or in digits if it is large.
pub(crate) fn number_word(number: u32) -> String {
    let index = usize::try_from(number)
        .ok()
        .and_then(|it| it.checked_sub(1));
    let word = index.and_then(|index| NUMBERS.get(index));
    word.map_or_else(|| number.to_string(), |word| (*word).to_owned())
}

/// The number that a word means.
pub(crate) fn number_of(word: &str) -> Option<u32> {
    let known = NUMBERS.iter().position(|known| *known == word);
    let number = match known {
        Some(index) => u32::try_from(index).ok()?.checked_add(1)?,
        None => word.parse().ok()?,
    };
    (1..=MOST).contains(&number).then_some(number)
}

/// The canonical one of the words of a list.
pub(crate) fn canonical(
    list: &'static [&'static [&'static str]],
    word: &str,
) -> Option<&'static str> {
    let found = list.iter().find(|words| words.contains(&word));
    found.and_then(|words| words.first().copied())
}

/// The plural of a noun.
pub(crate) fn plural(noun: &str) -> String {
    match noun {
        noun if noun.ends_with(['x', 's']) || noun.ends_with("ch") || noun.ends_with("sh") => {
            format!("{noun}es")
        }
        noun => format!("{noun}s"),
    }
}

/// The canonical kind that a noun means, and whether it is in the plural.
pub(crate) fn kind_of(noun: &str) -> Option<(&'static str, bool)> {
    let all = KINDS.iter().copied();
    all.flat_map(|words| words.iter().map(move |word| (words[0], *word)))
        .find_map(|(kind, word)| match noun {
            noun if noun == word => Some((kind, false)),
            noun if noun == plural(word) => Some((kind, true)),
            _ => None,
        })
}

/// Whether an id can stand in a sentence without quotation marks: it has something that no word of the grammar has.
pub(crate) fn is_plain_id(id: &str) -> bool {
    let mut letters = id.chars();
    let begins = letters
        .next()
        .is_some_and(|letter| letter.is_ascii_alphabetic());
    let is_inner = |letter: char| letter.is_ascii_alphanumeric() || "-_".contains(letter);
    let marks = |letter: char| !letter.is_ascii_lowercase();
    begins
        && id.chars().all(is_inner)
        && id.chars().any(marks)
        && !["it", "them"].contains(&id.to_ascii_lowercase().as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_plurals_read_back() {
        for number in 1..=MOST {
            assert_eq!(number_of(&number_word(number)), Some(number));
        }
        assert_eq!(number_of("0"), None);
        assert_eq!(number_of("100"), None);
        for words in KINDS {
            for word in words {
                assert_eq!(kind_of(word), Some((words[0], false)), "{word}");
                assert_eq!(kind_of(&plural(word)), Some((words[0], true)), "{word}");
            }
        }
        assert_eq!(plural("box"), "boxes");
        assert_eq!(plural("bench"), "benches");
    }

    #[test]
    fn ids_without_marks_need_quotation_marks() {
        for id in ["RedBlock", "chest-lid", "A", "block_2", "One"] {
            assert!(is_plain_id(id), "{id}");
        }
        for id in ["red", "It", "", "1a", "Red Block", "Röd"] {
            assert!(!is_plain_id(id), "{id}");
        }
    }
}
