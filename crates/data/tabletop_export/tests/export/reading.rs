//! Datasets, read back: numbers and pictures are those that were written.

use std::{fs, path::Path, sync::Arc};

use arrow_array::{Array, Int64Array, RecordBatch, StringArray};
use parquet::arrow::ArrowWriter;
use tabletop_export::{
    DatasetFormat as _, ExportError, LeRobot, LeRobotReader, Robomimic, read_robomimic,
};
use tabletop_training::{EpisodeSelection, PictureSelection, StateKind, TrainingEpisode};

use crate::{
    alone,
    demonstration::{episode, fresh, recording},
};

fn is_same_in_numbers(read: &TrainingEpisode, written: &TrainingEpisode) {
    assert_eq!(read.fps, written.fps);
    assert_eq!(read.len(), written.len());
    assert_eq!(read.state, written.state);
    assert_eq!(read.action, written.action);
    assert_eq!(read.action_kind, written.action_kind);
    assert_eq!(read.task, written.task);
    let names = |episode: &TrainingEpisode| -> Vec<_> {
        episode
            .cameras
            .iter()
            .map(|camera| camera.name.clone())
            .collect()
    };
    assert_eq!(names(read), names(written));
    for (read, written) in read.cameras.iter().zip(&written.cameras) {
        assert_eq!(read.images.len(), written.images.len());
        let mut pairs = read.images.iter().zip(&written.images);
        assert!(pairs.all(|(read, written)| read.rgb == written.rgb));
    }
}

#[test]
fn a_lerobot_dataset_reads_back_equal() {
    let folder = fresh("lerobot_read_back");
    let dataset = LeRobot::open(folder.clone(), &alone()).unwrap();
    let mut dataset = dataset.with_language();
    for _ in 0..2 {
        dataset.write(LeRobot::prepare(episode()).unwrap()).unwrap();
    }
    dataset.finish().unwrap();
    let reader = LeRobotReader::open(&folder).unwrap();
    let written = episode();
    assert_eq!((reader.episodes(), reader.frames()), (2, 2 * written.len()));
    let mut count = 0;
    reader
        .visit(|read| {
            is_same_in_numbers(&read, &written);
            assert_eq!(read.subtasks, written.subtasks);
            assert_eq!(read.paraphrases, written.paraphrases);
            for (read, written) in read.cameras.iter().zip(&written.cameras) {
                assert_eq!(read.images, written.images, "to the byte");
            }
            count += 1;
            Ok::<_, ExportError>(())
        })
        .unwrap();
    assert_eq!(count, 2);
}

#[test]
fn a_video_takes_less_than_half_of_what_the_pictures_take() {
    let pictures = PictureSelection {
        size: Some([200, 150]),
        has_video: true,
        ..PictureSelection::default()
    };
    let selection = EpisodeSelection {
        pictures,
        ..EpisodeSelection::default()
    };
    let episode = TrainingEpisode::read(recording(), &selection).unwrap();
    let camera = &episode.cameras[0];
    let pictures: usize = camera.images.iter().map(|image| image.png.len()).sum();
    let packets = &camera.video.as_ref().unwrap().packets;
    let video: usize = packets.iter().map(|packet| packet.bytes.len()).sum();
    assert!(2 * video < pictures, "{video} of {pictures} bytes");
}

/// The recording as an episode with a small video.
fn with_video() -> TrainingEpisode {
    let pictures = PictureSelection {
        size: Some([48, 36]),
        has_video: true,
        has_depth: true,
        has_ids: true,
        ..PictureSelection::default()
    };
    let selection = EpisodeSelection {
        pictures,
        ..EpisodeSelection::default()
    };
    TrainingEpisode::read(recording(), &selection).unwrap()
}

fn write(folder: &Path, episodes: impl IntoIterator<Item = TrainingEpisode>) {
    let mut dataset = LeRobot::open(folder.to_owned(), &alone()).unwrap();
    for episode in episodes {
        dataset.write(LeRobot::prepare(episode).unwrap()).unwrap();
    }
    dataset.finish().unwrap();
}

fn episodes(folder: &Path) -> Vec<TrainingEpisode> {
    let mut all = Vec::new();
    let visited = LeRobotReader::open(folder).unwrap().visit(|read| {
        all.push(read);
        Ok::<_, ExportError>(())
    });
    visited.unwrap();
    all
}

/// What is wrong with the videos of a dataset of such episodes.
fn faults(folder: &Path, episodes: usize) -> Vec<String> {
    let mut videos = LeRobotReader::open(folder).unwrap().videos().unwrap();
    let length = with_video().len();
    let mut faults: Vec<_> = (0..episodes)
        .flat_map(|episode| videos.faults(episode, length))
        .collect();
    faults.extend(videos.strays());
    faults.iter().map(ToString::to_string).collect()
}

#[test]
fn videos_are_copied_to_the_byte_with_the_statistics_of_their_pictures() {
    let [first, again] = ["lerobot_video", "lerobot_video_copy"].map(fresh);
    let written = with_video();
    // Two exports: a video each.
    write(&first, [written.clone(), written.clone()]);
    write(&first, [written.clone()]);
    let read = episodes(&first);
    assert_eq!(read.len(), 3);
    for read in &read {
        let (read, written) = (&read.cameras[0], &written.cameras[0]);
        assert!(read.images.is_empty());
        assert_eq!(read.size(), written.size());
        let packets = |camera: &tabletop_training::CameraTrack| {
            let video = camera.video.as_ref().unwrap();
            assert!(video.packets[0].is_key);
            (video.track, video.packets.clone())
        };
        assert_eq!(packets(read), packets(written));
        assert_eq!(read.depths, written.depths);
        assert_eq!(read.ids, written.ids);
    }
    assert_eq!(faults(&first, 3), [""; 0]);
    write(&again, read);
    assert_eq!(faults(&again, 3), [""; 0]);
    for file in ["meta/info.json", "meta/stats.json"] {
        let [one, other] = [&first, &again].map(|folder| fs::read_to_string(folder.join(file)));
        assert_eq!(one.unwrap(), other.unwrap(), "{file}");
    }
}

#[test]
fn faults_of_videos_are_located() {
    let folder = fresh("lerobot_video_faults");
    write(&folder, [with_video(), with_video()]);
    let path = folder.join("videos/observation.images.head/chunk-000/file-000.mp4");
    let other = fresh("lerobot_video_faults_other");
    write(&other, [with_video()]);
    let shorter = fs::read(other.join("videos/observation.images.head/chunk-000/file-000.mp4"));
    fs::write(&path, shorter.unwrap()).unwrap();
    let found = faults(&folder, 2);
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(
        found[0].contains("file-000.mp4: episode 1 ends at"),
        "{found:?}"
    );
    assert!(
        found[1].contains("are not those of its episodes"),
        "{found:?}"
    );
    fs::write(&path, "no video").unwrap();
    let found = faults(&folder, 2);
    assert!(
        found[0].contains("it is no video as this program makes them"),
        "{found:?}"
    );
    fs::remove_file(&path).unwrap();
    assert_eq!(faults(&folder, 2).len(), 2);

    let info = folder.join("meta/info.json");
    let text = fs::read_to_string(&info).unwrap();
    let text = text.replace(
        "observation.images.head\"",
        "observation.images.x/../../../head\"",
    );
    fs::write(&info, text).unwrap();
    let error = LeRobotReader::open(&folder).unwrap_err().to_string();
    assert!(
        error.contains("is no name of a file in this folder"),
        "{error}"
    );
}

#[test]
fn a_robomimic_file_reads_back_equal() {
    let path = fresh("robomimic_read_back.hdf5");
    let mut file = Robomimic::open(path.clone(), &alone()).unwrap();
    for _ in 0..2 {
        file.write(Robomimic::prepare(episode()).unwrap()).unwrap();
    }
    file.finish().unwrap();
    let read = read_robomimic(&path).unwrap();
    assert_eq!(read.len(), 2);
    for read in &read {
        is_same_in_numbers(read, &episode());
    }
}

/// The joints of the robot, and beside them the poses of the objects, without pictures.
fn poses() -> TrainingEpisode {
    let selection = EpisodeSelection {
        state: Some(StateKind::Both),
        pictures: PictureSelection {
            cameras: Some(Vec::new()),
            ..PictureSelection::default()
        },
        ..EpisodeSelection::default()
    };
    TrainingEpisode::read(recording(), &selection).unwrap()
}

#[test]
fn poses_are_a_feature_of_their_own_for_lerobot_and_part_of_the_state_elsewhere() {
    let written = poses();
    assert!(written.cameras.is_empty());
    let of_red = [
        "Red.x", "Red.y", "Red.z", "Red.qx", "Red.qy", "Red.qz", "Red.qw",
    ];
    assert_eq!(written.environment.names[..7], of_red);
    let folder = fresh("lerobot_poses");
    let mut dataset = LeRobot::open(folder.clone(), &alone()).unwrap();
    dataset.write(LeRobot::prepare(poses()).unwrap()).unwrap();
    dataset.finish().unwrap();
    let reader = LeRobotReader::open(&folder).unwrap();
    assert_eq!(reader.state_names(), written.whole_state().names);
    let visit = |read: TrainingEpisode| {
        is_same_in_numbers(&read, &written);
        assert_eq!(read.environment, written.environment);
        Ok::<_, ExportError>(())
    };
    reader.visit(visit).unwrap();

    let path = fresh("robomimic_poses.hdf5");
    let mut file = Robomimic::open(path.clone(), &alone()).unwrap();
    file.write(Robomimic::prepare(poses()).unwrap()).unwrap();
    file.finish().unwrap();
    assert_eq!(
        read_robomimic(&path).unwrap()[0].state,
        written.whole_state()
    );
}

/// Its tasks are the index of a table, to which it gives no name.
#[test]
fn the_tasks_of_lerobots_recorder_are_read() {
    let folder = fresh("lerobot_nameless_tasks");
    let mut dataset = LeRobot::open(folder.clone(), &alone()).unwrap();
    dataset.write(LeRobot::prepare(episode()).unwrap()).unwrap();
    dataset.finish().unwrap();
    let numbers: Arc<dyn Array> = Arc::new(Int64Array::from(vec![0, 1]));
    let sentences: Arc<dyn Array> = Arc::new(StringArray::from(vec!["Lift it.", "Drop it."]));
    let columns = [("task_index", numbers), ("__index_level_0__", sentences)];
    let batch = RecordBatch::try_from_iter(columns).unwrap();
    let file = fs::File::create(folder.join("meta/tasks.parquet")).unwrap();
    let mut writer = ArrowWriter::try_new(file, batch.schema(), None).unwrap();
    writer.write(&batch).unwrap();
    writer.close().unwrap();
    let reader = LeRobotReader::open(&folder).unwrap();
    assert_eq!(reader.tasks(), ["Lift it.", "Drop it."]);
}
