//! Two writers and readers at once.

use std::{
    fs,
    path::{Path, PathBuf},
    thread,
    time::Duration,
};

use tabletop_export::{
    DatasetFormat, ExportError, LeRobot, LeRobotReader, Matlab, Mcap, PendingCommit, Rlds,
    Robomimic,
};
use tabletop_storage::{Patience, Storage};

use crate::{
    alone,
    demonstration::{episode, fresh},
};

/// Adds so many episodes slowly, and waits for others.
fn add<F: DatasetFormat>(
    open: fn(PathBuf, &Storage) -> Result<F, ExportError>,
    place: &Path,
    episodes: usize,
) {
    let storage = Storage::default().with_patience(Patience::Wait(|_| {}));
    let mut dataset = open(place.to_owned(), &storage).unwrap();
    for _ in 0..episodes {
        dataset.write(F::prepare(episode()).unwrap()).unwrap();
        thread::sleep(Duration::from_millis(5));
    }
    dataset.finish().unwrap();
}

/// Lets two add 3 and 2 episodes at once.
fn add_at_once<F: DatasetFormat>(
    name: &str,
    open: fn(PathBuf, &Storage) -> Result<F, ExportError>,
) -> PathBuf {
    let place = fresh(name);
    fs::create_dir_all(place.parent().unwrap()).unwrap();
    thread::scope(|scope| {
        scope.spawn(|| add(open, &place, 3));
        scope.spawn(|| add(open, &place, 2));
    });
    place
}

fn names(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = names
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn two_that_export_at_once_lose_nothing() {
    let folder = add_at_once("at_once_lerobot", LeRobot::open);
    let dataset = LeRobotReader::open(&folder).unwrap();
    let mut seen = 0;
    let visited = dataset.visit(|_| {
        seen += 1;
        Ok::<_, ExportError>(())
    });
    visited.unwrap();
    assert_eq!((dataset.episodes(), seen), (5, 5));
    assert_eq!(names(&folder), ["data", "meta"]);

    let folder = add_at_once("at_once_rlds", Rlds::open);
    let info = fs::read(folder.join("dataset_info.json")).unwrap();
    let info: serde_json::Value = serde_json::from_slice(&info).unwrap();
    let lengths = info["splits"][0]["shardLengths"].as_array().unwrap();
    let lengths = lengths
        .iter()
        .map(|it| it.as_str().unwrap().parse::<u32>().unwrap());
    assert_eq!(lengths.sum::<u32>(), 5);

    for folder in [
        add_at_once("at_once_mcap", Mcap::open),
        add_at_once("at_once_mat", Matlab::open),
    ] {
        assert_eq!(names(&folder).len(), 5);
    }

    let file = add_at_once("at_once_robomimic.hdf5", Robomimic::open);
    let file = hdf5_pure::File::open(&file).unwrap();
    assert_eq!(file.group("data").unwrap().groups().unwrap().len(), 5);
}

#[test]
fn the_second_writer_is_refused_if_it_is_not_to_wait() {
    let folder = fresh("at_once_refused");
    let first = LeRobot::open(folder.clone(), &alone()).unwrap();
    let error = LeRobot::open(folder.clone(), &alone()).unwrap_err();
    let reason = format!("process {} writes there since ", std::process::id());
    assert!(error.to_string().contains(&reason), "{error}");
    assert!(!error.is_of_input());
    let error = LeRobot::repair(&folder, &alone()).unwrap_err();
    assert!(error.to_string().contains(&reason), "{error}");
    drop(first);
    drop(LeRobot::open(folder, &alone()).unwrap());
}

#[test]
fn a_dataset_is_read_before_or_after_an_export_to_it() {
    let folder = fresh("at_once_read");
    add(LeRobot::open, &folder, 1);
    let mut writer = LeRobot::open(folder.clone(), &alone()).unwrap();
    writer.write(LeRobot::prepare(episode()).unwrap()).unwrap();
    let error = LeRobotReader::open(&folder).unwrap_err().to_string();
    assert!(error.contains("writes there since"), "{error}");
    writer.finish().unwrap();
    assert_eq!(LeRobotReader::open(&folder).unwrap().episodes(), 2);
}

/// A journal that names files of which some are gone, as a removal during the export left it.
#[test]
fn a_journal_that_cannot_be_ended_is_taken_back() {
    for named in [&[][..], &["data/chunk-000/file-001.parquet"]] {
        let folder = fresh("at_once_journal");
        add(LeRobot::open, &folder, 2);
        let mut before = names(&folder.join("data/chunk-000"));
        let mut writer = LeRobot::open(folder.clone(), &alone()).unwrap();
        writer.write(LeRobot::prepare(episode()).unwrap()).unwrap();
        drop(writer);
        let part = folder.join("data/chunk-000/.file-001.parquet.part");
        for file in named {
            // A file of the next episode has its name already.
            let info = fs::read(folder.join("meta/info.json")).unwrap();
            add(LeRobot::open, &folder, 1);
            fs::write(folder.join("meta/info.json"), info).unwrap();
            assert!(folder.join(file).exists());
        }
        let _gone = fs::remove_file(part);
        let journal = serde_json::json!([
            "data/chunk-000/file-001.parquet",
            "meta/episodes/chunk-000/file-002.parquet",
            "meta/info.json",
        ]);
        fs::write(folder.join("meta/.commit.json"), journal.to_string()).unwrap();
        fs::write(folder.join("meta/.info.json.part"), "{}").unwrap();
        let error = LeRobotReader::open(&folder).unwrap_err().to_string();
        assert!(
            error.contains("of them are gone; run `tabletop dataset repair`"),
            "{error}"
        );
        let made_up = LeRobot::repair(&folder, &alone()).unwrap();
        let is_broken = matches!(made_up.export, Some(PendingCommit::Broken { files: 3, .. }));
        assert!(is_broken, "{made_up:?}");
        let dataset = LeRobotReader::open(&folder).unwrap();
        assert_eq!(dataset.episodes(), 2);
        before.sort();
        assert_eq!(names(&folder.join("data/chunk-000")), before);
        add(LeRobot::open, &folder, 1);
        assert_eq!(LeRobotReader::open(&folder).unwrap().episodes(), 3);
    }
}

#[test]
fn a_journal_that_cannot_be_understood_is_taken_back() {
    for journal in ["", "{}", "[\"../../stolen\"]", "[\"/etc/passwd\"]", "[7]"] {
        let folder = fresh("at_once_damaged");
        add(LeRobot::open, &folder, 1);
        fs::write(folder.join("meta/.commit.json"), journal).unwrap();
        let error = LeRobotReader::open(&folder).unwrap_err().to_string();
        assert!(
            error.contains("is damaged; run `tabletop dataset"),
            "{error}"
        );
        let repaired = LeRobot::repair(&folder, &alone()).unwrap();
        assert_eq!(repaired.export, Some(PendingCommit::Damaged));
        assert_eq!(LeRobotReader::open(&folder).unwrap().episodes(), 1);
    }
}

#[test]
fn a_journal_is_written_over_files_that_are_there() {
    let folder = fresh("at_once_removed");
    add(LeRobot::open, &folder, 1);
    let mut writer = LeRobot::open(folder.clone(), &alone()).unwrap();
    writer.write(LeRobot::prepare(episode()).unwrap()).unwrap();
    fs::remove_file(folder.join("data/chunk-000/.file-001.parquet.part")).unwrap();
    let error = writer.finish().unwrap_err().to_string();
    assert!(error.contains("somebody has removed it"), "{error}");
    assert!(!folder.join("meta/.commit.json").exists());
    LeRobot::repair(&folder, &alone()).unwrap();
    assert_eq!(LeRobotReader::open(&folder).unwrap().episodes(), 1);
}

#[test]
fn folders_of_files_take_no_other_content() {
    for name in ["session.jsonl", "episode-000000.mcap", "notes.txt"] {
        let folder = fresh("at_once_other");
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join(name), "mine").unwrap();
        let error = Matlab::open(folder.clone(), &alone()).unwrap_err();
        assert!(error.to_string().contains("neither empty nor"), "{error}");
        assert_eq!(names(&folder), [name]);
    }
}
