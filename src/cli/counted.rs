//! Numbers of things, in words.

/// A number of things, in words.
pub(super) fn counted(count: usize, of_what: &str) -> String {
    match count {
        1 => format!("1 {of_what}"),
        count => format!("{count} {of_what}s"),
    }
}
