//! Datasets, read back: numbers and pictures are those that were written.

use tabletop_export::{
    DatasetFormat as _, ExportError, LeRobot, LeRobotReader, Robomimic, TrainingEpisode,
    read_robomimic,
};

use crate::demonstration::{episode, fresh};

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
    let mut dataset = LeRobot::open(folder.clone()).unwrap();
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
fn a_robomimic_file_reads_back_equal() {
    let path = fresh("robomimic_read_back.hdf5");
    let mut file = Robomimic::open(path.clone()).unwrap();
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
