//! Bytes of files, kept while elements refer to them.

use std::cell::OnceCell;

/// Bytes that stay where they are while more are added.
#[derive(Debug, Default)]
pub(crate) struct Arena(OnceCell<Box<ArenaEntry>>);

#[derive(Debug)]
struct ArenaEntry {
    bytes: Vec<u8>,
    next: Arena,
}

impl Arena {
    /// Keeps the bytes of a file.
    pub fn keep(&self, bytes: Vec<u8>) -> &[u8] {
        let mut end = self;
        while let Some(kept) = end.0.get() {
            end = &kept.next;
        }
        let next = Self::default();
        &end.0
            .get_or_init(|| Box::new(ArenaEntry { bytes, next }))
            .bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kept_bytes_stay() {
        let arena = Arena::default();
        let kept: Vec<_> = (0..100).map(|byte| arena.keep(vec![byte])).collect();
        assert!(kept.iter().zip(0..).all(|(bytes, byte)| **bytes == [byte]));
    }
}
