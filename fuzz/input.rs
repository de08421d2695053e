//! The inputs of a target: files that are kept, changed.

use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::{
    mutation::{Random, mutate},
    target::{Material, Target},
};

/// Largest size of a shipped file to begin with: most of the time would go into reading longer ones.
const LONGEST_SEED: usize = 20_000;

/// Of how many inputs one begins as nothing.
const ONE_EMPTY_OF: usize = 50;

/// The inputs of a target with a seed.
pub struct Inputs {
    seed: u64,
    material: Option<Texts>,
}

/// The texts of which inputs are made.
struct Texts {
    /// First inputs, in the order of their lengths.
    corpus: Vec<Vec<u8>>,
    /// Words of the language.
    words: Vec<Vec<u8>>,
}

impl Inputs {
    /// The inputs that are made of files of the repository: where the program runs, or where it was built.
    pub fn of(target: &Target, seed: u64) -> Result<Self, String> {
        let here = Path::new("");
        let folder = match here.join("fuzz/corpus").is_dir() {
            true => here,
            false => Path::new(env!("CARGO_MANIFEST_DIR")),
        };
        let material = target.material.as_ref();
        let material = material.map(|material| Texts::of(target.name, material, folder));
        Ok(Self {
            seed,
            material: material.transpose()?,
        })
    }

    /// The first inputs.
    #[cfg(test)]
    pub fn corpus(&self) -> impl Iterator<Item = &[u8]> {
        let texts = self.material.iter();
        texts.flat_map(|texts| texts.corpus.iter().map(Vec::as_slice))
    }

    pub fn input(&self, number: u64) -> Vec<u8> {
        let mut random = Random::new(self.seed, number);
        match &self.material {
            Some(texts) => texts.input(&mut random),
            None => random.next().to_le_bytes().to_vec(),
        }
    }
}

impl Texts {
    fn of(target: &str, material: &Material, folder: &Path) -> Result<Self, String> {
        let read = |folder: PathBuf| {
            let files = files(&folder, material.ending).into_iter();
            files.filter_map(|file| fs::read(file).ok())
        };
        let shipped = material.shipped.iter().map(|path| folder.join(path));
        let shipped = shipped.flat_map(read);
        let mut corpus: Vec<Vec<u8>> = read(folder.join("fuzz/corpus").join(target))
            .chain(shipped.filter(|bytes| bytes.len() <= LONGEST_SEED))
            .collect();
        if corpus.is_empty() {
            let folder = folder.display();
            return Err(format!(
                "{target}: there is nothing to begin with in {folder}; run it in the repository"
            ));
        }
        corpus.sort_by(|a, b| (a.len(), a).cmp(&(b.len(), b)));
        let words = folder.join("fuzz/dictionary").join(material.dictionary);
        let words =
            fs::read_to_string(&words).map_err(|error| format!("{}: {error}", words.display()))?;
        let words = words.lines().map(|word| word.as_bytes().to_vec());
        Ok(Self {
            corpus,
            words: words.collect(),
        })
    }

    fn input(&self, random: &mut Random) -> Vec<u8> {
        // Short ones more often.
        let choice = random
            .below(self.corpus.len())
            .min(random.below(self.corpus.len()));
        let mut bytes = match random.below(ONE_EMPTY_OF) {
            0 => Vec::new(),
            _ => self.corpus[choice].clone(),
        };
        let changes = 1 + random.below(6) * random.below(2);
        for _ in 0..changes {
            mutate(&mut bytes, &self.corpus, &self.words, random);
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
