//! The inputs of a target: files that are kept, changed.

use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::{
    mutation::{Random, mutate},
    target::Target,
};

/// Largest size of a seed: most of the time would go into reading longer ones.
const LONGEST_SEED: usize = 20_000;

/// The inputs of a target with a seed.
pub struct Inputs {
    seed: u64,
    /// The seeds of inputs, in the order of their lengths.
    corpus: Vec<Vec<u8>>,
    /// Words of the language.
    words: Vec<Vec<u8>>,
}

impl Inputs {
    pub fn of(target: &Target, seed: u64) -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let own = folder.join("fuzz/corpus").join(target.name);
        let shipped = target.shipped.iter().map(|path| folder.join(path));
        let mut corpus: Vec<Vec<u8>> = [own]
            .into_iter()
            .chain(shipped)
            .flat_map(|folder| files(&folder, target.ending))
            .filter_map(|file| fs::read(file).ok())
            .filter(|bytes| bytes.len() <= LONGEST_SEED)
            .collect();
        corpus.sort_by(|a, b| (a.len(), a).cmp(&(b.len(), b)));
        corpus.insert(0, Vec::new());
        let words = folder.join("fuzz/dictionary").join(target.dictionary);
        let words = fs::read_to_string(words).unwrap_or_default();
        Self {
            seed,
            corpus,
            words: words.lines().map(|word| word.as_bytes().to_vec()).collect(),
        }
    }

    pub fn input(&self, number: u64) -> Vec<u8> {
        let mut random = Random::new(self.seed, number);
        // Short ones more often.
        let choice = random
            .below(self.corpus.len())
            .min(random.below(self.corpus.len()));
        let mut bytes = self.corpus[choice].clone();
        let changes = 1 + random.below(6) * random.below(2);
        for _ in 0..changes {
            mutate(&mut bytes, &self.corpus, &self.words, &mut random);
        }
        bytes
    }
}

/// The files of a folder, and of those in it, in the order of their names.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<_> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    let (folders, files): (Vec<_>, Vec<_>) = paths.into_iter().partition(|path| path.is_dir());
    let is_wanted = |path: &PathBuf| path.to_string_lossy().ends_with(ending);
    let inner = folders
        .iter()
        .flat_map(|folder| self::files(folder, ending));
    files.into_iter().filter(is_wanted).chain(inner).collect()
}
