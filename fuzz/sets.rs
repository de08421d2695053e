//! Datasets, one file of which a stranger has changed: they are read, and copied and added to if they are what they say. What then comes
//! of them is what it says, too, and nothing else is touched.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process,
    thread::panicking,
};

use tabletop::{
    dataset::{
        CheckOptions, DatasetContent, DatasetFolder, check, merge, repair, statistics, summarize,
        trim,
    },
    export::{DatasetFormat, LeRobot, LeRobotReader, Rlds, Robomimic, read_robomimic},
    storage::Storage,
    training::TrainingEpisode,
};

/// The files of a dataset, by their paths in it.
type Files = &'static [(&'static str, &'static [u8])];

/// A dataset of two episodes for LeRobot, with pictures in its table of frames.
const PICTURES: Files = &[
    (
        "meta/info.json",
        include_bytes!("corpus/lerobot-info/pictures.json"),
    ),
    (
        "meta/stats.json",
        include_bytes!("corpus/lerobot-stats/pictures.json"),
    ),
    (
        "meta/tasks.parquet",
        include_bytes!("corpus/lerobot-tasks/pictures.parquet"),
    ),
    (
        EPISODES,
        include_bytes!("corpus/lerobot-episodes/pictures.parquet"),
    ),
    (
        FRAMES,
        include_bytes!("corpus/lerobot-frames/pictures.parquet"),
    ),
];

/// The same with videos.
const VIDEOS: Files = &[
    (
        "meta/info.json",
        include_bytes!("corpus/lerobot-info/videos.json"),
    ),
    (
        "meta/stats.json",
        include_bytes!("corpus/lerobot-stats/videos.json"),
    ),
    (
        "meta/tasks.parquet",
        include_bytes!("corpus/lerobot-tasks/pictures.parquet"),
    ),
    (
        EPISODES,
        include_bytes!("corpus/lerobot-episodes/videos.parquet"),
    ),
    (
        FRAMES,
        include_bytes!("corpus/lerobot-frames/videos.parquet"),
    ),
    (VIDEO, include_bytes!("corpus/lerobot-video/head.mp4")),
];

pub const EPISODES: &str = "meta/episodes/chunk-000/file-000.parquet";
pub const FRAMES: &str = "data/chunk-000/file-000.parquet";
pub const VIDEO: &str = "videos/observation.images.head/chunk-000/file-000.mp4";

const RLDS: Files = &[
    (
        "dataset_info.json",
        include_bytes!("corpus/rlds-info/set.json"),
    ),
    (
        "features.json",
        include_bytes!("corpus/rlds-features/set.json"),
    ),
    (
        "set-train.tfrecord-00000",
        include_bytes!("corpus/rlds-records/set.tfrecord"),
    ),
];

/// What nobody may change.
const CANARY: &str = "a file of the user";

/// A folder with a file of the user and, beside it, what is made of an input.
struct Place(PathBuf);

impl Place {
    fn new() -> Self {
        let root = env::temp_dir().join(format!("tabletop_sets_{}", process::id()));
        let _not_there = fs::remove_dir_all(&root);
        write(&root.join("canary"), CANARY.as_bytes());
        Self(root)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Writes a dataset, one file of which is another one.
    fn set(&self, files: Files, changed: &str, bytes: &[u8]) -> PathBuf {
        let set = self.path("set");
        for (name, whole) in files {
            write(&set.join(name), whole);
        }
        write(&set.join(changed), bytes);
        set
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let names = fs::read_dir(&self.0).into_iter().flatten().flatten();
        for entry in names {
            let name = entry.file_name().to_string_lossy().into_owned();
            let is_expected = ["canary", "set", "out", "trimmed", "set.hdf5"].contains(&&*name);
            assert!(is_expected || panicking(), "{name} was written");
        }
        let canary = fs::read_to_string(self.path("canary")).unwrap_or_default();
        assert!(canary == CANARY || panicking(), "the canary says {canary}");
        let _stays = fs::remove_dir_all(&self.0);
    }
}

fn write(path: &Path, bytes: &[u8]) {
    let made = path.parent().map_or(Ok(()), fs::create_dir_all);
    made.and_then(|()| fs::write(path, bytes))
        .expect("a folder for temporary files can be written");
}

/// A target that changes this file of LeRobot datasets with pictures and with videos.
pub fn lerobot(changed: &'static str) -> Box<dyn FnMut(&[u8])> {
    let sets = [PICTURES, VIDEOS].map(|files| (files, first_episode(files)));
    Box::new(move |bytes| {
        for (files, episode) in &sets {
            let place = Place::new();
            let set = place.set(files, changed, bytes);
            copied(&place, &set);
            added_to(&set, episode);
            repaired(&set);
        }
    })
}

fn first_episode(files: Files) -> TrainingEpisode {
    let place = Place::new();
    let (name, bytes) = files[0];
    let reader = LeRobotReader::open(&place.set(files, name, bytes));
    let mut first = None;
    let visited = reader.expect("the corpus is a dataset").visit(|episode| {
        first.get_or_insert(episode);
        Ok::<_, tabletop::export::ExportError>(())
    });
    visited.expect("the corpus can be read");
    first.expect("the corpus has an episode")
}

/// Reads a dataset in every way, and makes others of it.
fn copied(place: &Place, set: &Path) {
    let Ok(dataset) = DatasetFolder::open(set) else {
        return;
    };
    let _summary = summarize(&dataset);
    let _statistics = statistics(&dataset);
    let _findings = check(&dataset, CheckOptions { simulates: false }, |_| {});
    let [out, trimmed] = ["out", "trimmed"].map(|name| place.path(name));
    let twice = [dataset.clone(), dataset.clone()];
    match merge(&twice, &out, &Storage::default()) {
        Ok(episodes) => {
            assert_eq!(episodes, 2 * dataset.episodes());
            is_whole(&out, episodes);
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            assert!(!out.exists(), "what is not made is not there");
        }
    }
    if let Ok(done) = trim(&dataset, &trimmed, &Storage::default()) {
        is_whole(&trimmed, done.episodes);
    }
}

/// Makes sure that a dataset holds so many episodes and can be read.
fn is_whole(set: &Path, episodes: usize) {
    let dataset = DatasetFolder::open(set).expect("what was made can be opened");
    let DatasetContent::LeRobot(reader) = &dataset.content else {
        panic!("what was made is no LeRobot dataset");
    };
    assert_eq!(
        (reader.episodes(), reader.contradiction()),
        (episodes, None)
    );
    let mut visited = 0;
    let read = reader.visit(|_| {
        visited += 1;
        Ok::<_, tabletop::export::ExportError>(())
    });
    read.expect("what was made can be read");
    assert_eq!(visited, episodes);
}

/// Adds an episode, if the dataset takes one.
fn added_to(set: &Path, episode: &TrainingEpisode) {
    let before = LeRobotReader::open(set).map(|reader| reader.episodes());
    let added = LeRobot::open(set.to_owned(), &Storage::default()).and_then(|mut dataset| {
        dataset.write(LeRobot::prepare(episode.clone())?)?;
        dataset.finish()
    });
    if let (Ok(before), Ok(())) = (before, added) {
        let reader = LeRobotReader::open(set).expect("what got an episode can be opened");
        assert_eq!(
            (reader.episodes(), reader.contradiction()),
            (before + 1, None)
        );
    }
}

fn repaired(set: &Path) {
    if repair(set, &Storage::default()).is_ok() && set.join("meta/info.json").exists() {
        LeRobotReader::open(set).expect("what was repaired can be opened");
    }
}

/// A target that changes this file of an RLDS dataset, to which an episode is added.
pub fn rlds(changed: &'static str) -> Box<dyn FnMut(&[u8])> {
    let episode = first_episode(PICTURES);
    Box::new(move |bytes| {
        let place = Place::new();
        let set = place.set(RLDS, changed, bytes);
        let added = Rlds::open(set.clone(), &Storage::default()).and_then(|mut dataset| {
            dataset.write(Rlds::prepare(episode.clone())?)?;
            dataset.finish()
        });
        if added.is_ok() {
            Rlds::open(set, &Storage::default()).expect("what got an episode can be opened");
        }
    })
}

/// A robomimic file that is read, and to which an episode is added.
pub fn robomimic() -> Box<dyn FnMut(&[u8])> {
    let episode = first_episode(PICTURES);
    Box::new(move |bytes| {
        let place = Place::new();
        let file = place.path("set.hdf5");
        write(&file, bytes);
        let before = read_robomimic(&file).map(|episodes| episodes.len());
        let added = Robomimic::open(file.clone(), &Storage::default()).and_then(|mut set| {
            set.write(Robomimic::prepare(episode.clone())?)?;
            set.finish()
        });
        if let (Ok(before), Ok(())) = (before, added) {
            let after = read_robomimic(&file).expect("what got an episode can be read");
            assert_eq!(after.len(), before + 1);
        }
    })
}
