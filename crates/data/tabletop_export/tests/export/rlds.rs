//! RLDS datasets.

use std::fs;

use serde_json::Value;
use tabletop_export::{DatasetFormat as _, Rlds};

use crate::{
    alone,
    demonstration::{episode, fresh},
};

fn json(path: &std::path::Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

/// Adds so many episodes.
fn add(folder: &std::path::Path, count: usize) {
    let mut dataset = Rlds::open(folder.to_owned(), &alone()).unwrap();
    for _ in 0..count {
        let frames = dataset.write(Rlds::prepare(episode()).unwrap()).unwrap();
        assert_eq!(frames, episode().len());
    }
    dataset.finish().unwrap();
}

/// The messages of a TFRecord file.
fn records(bytes: &[u8]) -> Vec<&[u8]> {
    let mut records = Vec::new();
    let mut rest = bytes;
    while !rest.is_empty() {
        let length = u64::from_le_bytes(rest[..8].try_into().unwrap()) as usize;
        records.push(&rest[12..12 + length]);
        rest = &rest[16 + length..];
    }
    records
}

#[test]
fn each_export_adds_a_file_that_the_description_counts() {
    let folder = fresh("rlds_dataset");
    add(&folder, 2);
    add(&folder, 1);
    let info = json(&folder.join("dataset_info.json"));
    let split = &info["splits"][0];
    assert_eq!(info["name"], "rlds_dataset");
    assert_eq!(split["shardLengths"], serde_json::json!(["2", "1"]));
    let files = ["00000", "00001"].map(|number| {
        fs::read(folder.join(format!("rlds_dataset-train.tfrecord-{number}"))).unwrap()
    });
    let bytes: usize = files.iter().map(Vec::len).sum();
    assert_eq!(split["numBytes"], bytes.to_string());
    let records = files.each_ref().map(|file| records(file));
    assert_eq!([records[0].len(), records[1].len()], [2, 1]);
    let text = String::from_utf8_lossy(records[0][0]).into_owned();
    for part in [
        "steps/observation/head_image",
        "steps/is_terminal",
        "put it on the green block",
    ] {
        assert!(text.contains(part), "{part}");
    }
    let features = json(&folder.join("features.json"));
    let step = &features["featuresDict"]["features"]["steps"]["sequence"]["feature"];
    let image =
        &step["featuresDict"]["features"]["observation"]["featuresDict"]["features"]["head_image"];
    assert_eq!(
        image["image"]["shape"]["dimensions"],
        serde_json::json!(["150", "200", "3"])
    );
}

#[test]
fn what_others_have_written_into_the_description_stays() {
    let folder = fresh("rlds_others");
    add(&folder, 1);
    let path = folder.join("dataset_info.json");
    let mut info = json(&path);
    info["version"] = "2.3.0".into();
    info["releaseNotes"] = serde_json::json!({ "2.3.0": "Of a stranger." });
    info["citation"] = "@article{}".into();
    let validation = serde_json::json!({
        "name": "validation", "filepathTemplate": "V", "numBytes": "7", "shardLengths": ["3"]
    });
    info["splits"].as_array_mut().unwrap().insert(0, validation);
    fs::write(&path, serde_json::to_vec(&info).unwrap()).unwrap();
    add(&folder, 2);
    info["splits"][1]["shardLengths"] = serde_json::json!(["1", "2"]);
    let bytes = json(&path)["splits"][1]["numBytes"].clone();
    assert_ne!(bytes, info["splits"][1]["numBytes"]);
    info["splits"][1]["numBytes"] = bytes;
    assert_eq!(json(&path), info);

    for (pointer, value, reason) in [
        (
            "/fileFormat",
            "array_record",
            "its files are \"array_record\"",
        ),
        (
            "/splits/1/filepathTemplate",
            "{DATASET}-{SPLIT}.{FILEFORMAT}-{SHARD_X_OF_Y}",
            "the files of its split train are named",
        ),
    ] {
        let mut other = info.clone();
        *other.pointer_mut(pointer).unwrap() = value.into();
        fs::write(&path, serde_json::to_vec(&other).unwrap()).unwrap();
        let error = Rlds::open(folder.clone(), &alone()).unwrap_err();
        assert!(error.to_string().contains(reason), "{error}");
    }
}

#[test]
fn other_folders_and_other_episodes_are_refused() {
    let folder = fresh("rlds_other");
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("thesis.txt"), "years of work").unwrap();
    let error = Rlds::open(folder, &alone()).unwrap_err().to_string();
    assert!(
        error.contains("neither empty nor an RLDS dataset"),
        "{error}"
    );

    let folder = fresh("rlds_mixed");
    add(&folder, 1);
    let mut dataset = Rlds::open(folder, &alone()).unwrap();
    let mut other = episode();
    other.state.names.pop();
    other.state.values.clear();
    let error = dataset
        .write(Rlds::prepare(other).unwrap())
        .unwrap_err()
        .to_string();
    assert!(error.contains("not those of the dataset"), "{error}");
}
