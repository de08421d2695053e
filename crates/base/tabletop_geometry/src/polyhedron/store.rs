//! A store of shared values.

use std::{collections::BTreeMap, sync::Arc};

/// Size, in bytes, up to which a store keeps everything.
const LEAST: usize = 4 << 20;

/// Values by their keys: equal keys share a value. Whenever the store has doubled, it forgets the values that nobody else holds, so it
/// grows with those in use and not with those ever made.
pub(super) struct SharedStore<K, T> {
    values: BTreeMap<K, Arc<T>>,
    /// Size of a value in bytes.
    size_of: fn(&T) -> usize,
    /// Size of all values.
    size: usize,
    /// Size beyond which those that nobody else holds are forgotten.
    limit: usize,
}

impl<K: Ord, T> SharedStore<K, T> {
    pub(super) const fn new(size_of: fn(&T) -> usize) -> Self {
        Self {
            values: BTreeMap::new(),
            size_of,
            size: 0,
            limit: LEAST,
        }
    }

    /// The value of a key, made if it is not there.
    pub(super) fn get_or_make(&mut self, key: K, make: impl FnOnce() -> T) -> Arc<T> {
        if let Some(known) = self.values.get(&key) {
            return Arc::clone(known);
        }
        let new = Arc::new(make());
        self.size += (self.size_of)(&new);
        self.values.insert(key, Arc::clone(&new));
        if self.size > self.limit {
            self.forget_unused();
        }
        new
    }

    /// Number of values.
    #[cfg(test)]
    pub(super) fn len(&self) -> usize {
        self.values.len()
    }

    fn forget_unused(&mut self) {
        self.values.retain(|_, value| Arc::strong_count(value) > 1);
        let sizes = self.values.values().map(|value| (self.size_of)(value));
        self.size = sizes.sum();
        self.limit = LEAST.max(2 * self.size);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_store_grows_with_the_values_in_use_and_not_with_those_ever_made() {
        const KILOBYTE: usize = 1024;
        let mut store = SharedStore::new(|_: &usize| KILOBYTE);
        let mut make = |key: usize| store.get_or_make(key, || key);
        let held: Vec<_> = (0..100).map(&mut make).collect();
        for key in 0..100_000 {
            make(key);
        }
        for (key, value) in held.iter().enumerate() {
            assert!(Arc::ptr_eq(value, &make(key)), "{key}");
        }
        assert!(store.len() <= LEAST / KILOBYTE);
        assert!(store.size <= LEAST);
        let many: Vec<_> = (0..10_000)
            .map(|key| store.get_or_make(key, || key))
            .collect();
        assert!(store.len() >= many.len());
        drop((held, many));
        for key in 0..100_000 {
            store.get_or_make(key, || key);
        }
        assert!(store.len() <= LEAST / KILOBYTE);
    }
}
