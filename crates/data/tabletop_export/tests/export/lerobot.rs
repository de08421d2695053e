//! LeRobot datasets.

use std::{fs, path::Path};

use arrow_array::{
    Array, RecordBatch,
    cast::AsArray as _,
    types::{Float32Type, Int64Type},
};
use parquet::arrow::{ArrowWriter, arrow_reader::ParquetRecordBatchReaderBuilder};
use serde_json::Value;
use tabletop_export::{DatasetFormat as _, ExportError, LeRobot, LeRobotReader, export};
use tabletop_storage::{Storage, StorageFault};
use tabletop_training::EpisodeSelection;

use crate::{
    alone,
    demonstration::{episode, fresh, recording},
};

fn add(folder: &Path, storage: Storage, episodes: usize) -> Result<(), ExportError> {
    let mut dataset = LeRobot::open(folder.to_owned(), &storage)?;
    for _ in 0..episodes {
        dataset.write(LeRobot::prepare(episode())?)?;
    }
    dataset.finish()
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

fn read(path: &Path) -> (Vec<RecordBatch>, usize) {
    let file = fs::File::open(path).unwrap();
    let reader = ParquetRecordBatchReaderBuilder::try_new(file).unwrap();
    let groups = reader.metadata().num_row_groups();
    (
        reader.build().unwrap().map(Result::unwrap).collect(),
        groups,
    )
}

/// All rows of the data files in their order: each frame's picture, episode and number in the dataset.
fn frames(folder: &Path) -> Vec<(Vec<u8>, i64, i64)> {
    let mut all = Vec::new();
    for number in 0.. {
        let path = folder.join(format!("data/chunk-000/file-{number:03}.parquet"));
        if !path.exists() {
            break;
        }
        for batch in read(&path).0 {
            let column = |name: &str| batch.column_by_name(name).unwrap();
            let pictures = column("observation.images.head").as_struct();
            let pictures = pictures.column_by_name("bytes").unwrap().as_binary::<i32>();
            let episodes = column("episode_index").as_primitive::<Int64Type>();
            let numbers = column("index").as_primitive::<Int64Type>();
            for row in 0..batch.num_rows() {
                let picture = pictures.value(row).to_vec();
                all.push((picture, episodes.value(row), numbers.value(row)));
            }
        }
    }
    all
}

/// Number of episodes of a dataset of which everything fits together.
fn whole_episodes(folder: &Path) -> usize {
    if !folder.join("meta/info.json").exists() {
        return 0;
    }
    let info = json(&folder.join("meta/info.json"));
    let episodes = info["total_episodes"].as_u64().unwrap() as usize;
    let frames = frames(folder);
    let length = episode().len();
    assert_eq!(frames.len(), episodes * length);
    assert_eq!(info["total_frames"], frames.len());
    for (number, (_, episode, index)) in frames.iter().enumerate() {
        assert_eq!(
            (*episode, *index),
            ((number / length) as i64, number as i64)
        );
    }
    let stats = json(&folder.join("meta/stats.json"));
    assert_eq!(stats["action"]["count"][0], frames.len());
    episodes
}

#[test]
fn frames_have_the_pixels_and_numbers_of_the_recording() {
    let folder = fresh("lerobot");
    let dataset = LeRobot::open(folder.clone(), &alone()).unwrap();
    let recordings = [recording().to_owned(), recording().to_owned()];
    let summary = export(
        &recordings,
        &EpisodeSelection::default(),
        dataset,
        2,
        |_| {},
    )
    .unwrap();
    let episode = episode();
    assert_eq!((summary.episodes, summary.frames), (2, 2 * episode.len()));
    assert_eq!(whole_episodes(&folder), 2);
    for (frame, (picture, ..)) in frames(&folder).iter().enumerate() {
        let expected = &episode.cameras[0].images[frame % episode.len()];
        assert_eq!(*picture, expected.png);
    }
    let (batches, groups) = read(&folder.join("data/chunk-000/file-000.parquet"));
    assert_eq!(groups, 2, "a row group an episode");
    let states = batches[0].column_by_name("observation.state").unwrap();
    let first = states.as_fixed_size_list().value(1);
    let second: Vec<_> = episode.state.frames().nth(1).unwrap().to_vec();
    assert_eq!(
        first.as_primitive::<Float32Type>().values(),
        second.as_slice()
    );
}

#[test]
fn language_is_on_every_frame_with_the_times_from_which_it_holds() {
    let folder = fresh("lerobot_language");
    let dataset = LeRobot::open(folder.clone(), &alone()).unwrap();
    export(
        &[recording().to_owned()],
        &EpisodeSelection::default(),
        dataset.with_language(),
        1,
        |_| {},
    )
    .unwrap();
    add(&folder, Storage::default(), 1).unwrap();
    let info = json(&folder.join("meta/info.json"));
    assert!(info["features"].get("language_persistent").is_some());
    assert_eq!(info["total_episodes"], 2);
    let (batches, _) = read(&folder.join("data/chunk-000/file-000.parquet"));
    let batch = &batches[0];
    let rows = batch.column_by_name("language_persistent").unwrap();
    let times = batch.column_by_name("timestamp").unwrap();
    let times = times.as_primitive::<Float32Type>().values().to_vec();
    for frame in [0, batch.num_rows() - 1] {
        let rows = rows.as_list::<i32>().value(frame);
        let rows = rows.as_struct();
        let texts = |name: &str| {
            let column = rows.column_by_name(name).unwrap().as_string::<i32>();
            (0..column.len())
                .map(|i| column.value(i).to_owned())
                .collect::<Vec<_>>()
        };
        let since = rows.column_by_name("timestamp").unwrap();
        let since = since.as_primitive::<Float32Type>().values();
        assert!(since.iter().all(|time| times.contains(time)), "{since:?}");
        let styles = texts("style");
        let subtask = styles.iter().position(|style| style == "subtask").unwrap();
        assert_eq!(texts("content")[subtask], "pick up the red block");
        assert!(styles.iter().any(|style| style == "task_aug"));
        assert_eq!(
            rows.column_by_name("camera").unwrap().null_count(),
            styles.len()
        );
    }
}

#[test]
fn every_column_can_be_collated() {
    let folder = fresh("lerobot_no_language");
    add(&folder, Storage::default(), 1).unwrap();
    let (batches, _) = read(&folder.join("data/chunk-000/file-000.parquet"));
    for column in batches[0].columns() {
        assert!(
            column.as_list_opt::<i32>().is_none(),
            "{:?}",
            column.data_type()
        );
    }
    let info = json(&folder.join("meta/info.json"));
    assert!(info["features"].get("language_persistent").is_none());
}

/// As LeRobot's tools leave a dataset: with a row group for a whole file, and without the numbers of files that have gone.
#[test]
fn a_dataset_that_others_have_edited_is_read_and_added_to() {
    let folder = fresh("lerobot_edited");
    add(&folder, Storage::default(), 3).unwrap();
    let first = folder.join("data/chunk-000/file-000.parquet");
    let (batches, groups) = read(&first);
    assert_eq!(groups, 3);
    let later = folder.join("data/chunk-000/file-004.parquet");
    let file = fs::File::create(&later).unwrap();
    let mut writer = ArrowWriter::try_new(file, batches[0].schema(), None).unwrap();
    for batch in &batches {
        writer.write(batch).unwrap();
    }
    writer.close().unwrap();
    assert_eq!(read(&later).1, 1);
    fs::remove_file(first).unwrap();
    let lengths = |folder: &Path| {
        let reader = LeRobotReader::open(folder).unwrap();
        assert_eq!(reader.contradiction(), None);
        let mut lengths = Vec::new();
        let visited = reader.visit(|episode| {
            lengths.push(episode.len());
            Ok::<_, ExportError>(())
        });
        visited.unwrap();
        lengths
    };
    let length = episode().len();
    assert_eq!(lengths(&folder), [length; 3]);
    add(&folder, Storage::default(), 1).unwrap();
    assert!(folder.join("data/chunk-000/file-005.parquet").exists());
    assert_eq!(lengths(&folder), [length; 4]);
}

#[test]
fn tasks_are_the_index_of_a_pandas_table() {
    let folder = fresh("lerobot_tasks");
    add(&folder, Storage::default(), 2).unwrap();
    let file = fs::File::open(folder.join("meta/tasks.parquet")).unwrap();
    let reader = ParquetRecordBatchReaderBuilder::try_new(file).unwrap();
    let metadata = reader.metadata().file_metadata().key_value_metadata();
    let pandas = metadata.unwrap().iter().find(|entry| entry.key == "pandas");
    let pandas: Value = serde_json::from_str(pandas.unwrap().value.as_ref().unwrap()).unwrap();
    assert_eq!(pandas["index_columns"][0], "task");
    let of_arrow = reader.schema().metadata().get("pandas").unwrap();
    assert_eq!(serde_json::from_str::<Value>(of_arrow).unwrap(), pandas);
    let batch = reader.build().unwrap().next().unwrap().unwrap();
    assert_eq!(batch.num_rows(), 1, "both episodes have one task");
    let tasks = batch.column_by_name("task").unwrap().as_string::<i32>();
    assert_eq!(tasks.value(0), "Put the red block on the green block.");
}

#[test]
fn statistics_are_those_of_all_frames() {
    let folder = fresh("lerobot_stats");
    add(&folder, Storage::default(), 1).unwrap();
    add(&folder, Storage::default(), 1).unwrap();
    let stats = json(&folder.join("meta/stats.json"));
    let episode = episode();
    let x = episode
        .state
        .names
        .iter()
        .position(|name| name == "Red.x")
        .unwrap();
    let values: Vec<_> = episode
        .state
        .frames()
        .map(|frame| f64::from(frame[x]))
        .collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let of = |name: &str| stats["observation.state"][name][x].as_f64().unwrap();
    assert!((of("mean") - mean).abs() < 1e-9);
    assert_eq!(of("max"), values.iter().copied().fold(f64::MIN, f64::max));
    assert!(of("q01") <= of("q50") && of("q50") <= of("q99"));
    let picture = &stats["observation.images.head"];
    let brightness = picture["mean"][0][0][0].as_f64().unwrap();
    assert!((0.0..=1.0).contains(&brightness));
    let last = stats["index"]["max"][0].as_f64().unwrap();
    assert_eq!(last, (2 * episode.len() - 1) as f64);
}

#[test]
fn an_export_that_is_cut_off_anywhere_leaves_whole_episodes() {
    let calls = {
        let storage = Storage::with_fault(StorageFault::Killed, u64::MAX);
        let folder = fresh("lerobot_calls");
        add(&folder, storage.clone(), 2).unwrap();
        storage.calls()
    };
    assert!(calls > 30, "{calls}");
    for fault in StorageFault::ALL {
        for call in 0..calls {
            let folder = fresh("lerobot_cut_off");
            add(&folder, Storage::default(), 1).unwrap();
            let _failed = add(&folder, Storage::with_fault(fault, call), 2);
            add(&folder, Storage::default(), 0).unwrap();
            let episodes = whole_episodes(&folder);
            assert!(
                [1, 3].contains(&episodes),
                "{fault:?} at {call}: {episodes}"
            );
            add(&folder, Storage::default(), 1).unwrap();
            assert_eq!(whole_episodes(&folder), episodes + 1, "{fault:?} at {call}");
        }
    }
}

#[test]
fn other_folders_and_other_episodes_are_refused() {
    let folder = fresh("lerobot_other");
    fs::create_dir(&folder).unwrap();
    fs::write(folder.join("mine.txt"), "").unwrap();
    let error = LeRobot::open(folder, &alone()).unwrap_err().to_string();
    assert!(
        error.contains("neither empty nor a LeRobot dataset"),
        "{error}"
    );

    let folder = fresh("lerobot_mixed");
    add(&folder, Storage::default(), 1).unwrap();
    let mut dataset = LeRobot::open(folder.clone(), &alone()).unwrap();
    let mut other = episode();
    other.state.names[0] = "Blue.x".into();
    let error = dataset.write(LeRobot::prepare(other).unwrap());
    let error = error.unwrap_err().to_string();
    assert!(error.contains("its observation.state is"), "{error}");
    dataset.write(LeRobot::prepare(episode()).unwrap()).unwrap();
    dataset.finish().unwrap();
    assert_eq!(whole_episodes(&folder), 2, "a refused one changes nothing");
}
