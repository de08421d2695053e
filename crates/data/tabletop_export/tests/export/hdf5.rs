//! HDF5 files: robomimic's and MATLAB's.

use hdf5_pure::{AttrValue, File};
use tabletop_export::{DatasetFormat as _, Matlab, Robomimic};

use crate::{
    alone,
    demonstration::{episode, fresh},
};

#[test]
fn demonstrations_are_groups_with_actions_within_one() {
    let path = fresh("robomimic.hdf5");
    for _ in 0..2 {
        let mut file = Robomimic::open(path.clone(), &alone()).unwrap();
        let episode = Robomimic::prepare(episode()).unwrap();
        file.write(episode).unwrap();
        file.finish().unwrap();
    }
    let (file, episode) = (File::open(&path).unwrap(), episode());
    let frames = episode.len() as u64;
    let data = file.group("data").unwrap();
    let total = data.attrs().unwrap()["total"].as_i64();
    assert_eq!(total, Some(2 * frames as i64));
    for demonstration in ["data/demo_0", "data/demo_1"] {
        let group = file.group(demonstration).unwrap();
        let samples = group.attrs().unwrap()["num_samples"].as_i64();
        assert_eq!(samples, Some(frames as i64));
        let actions = group.dataset("actions").unwrap();
        assert_eq!(actions.shape().unwrap(), [frames, 14]);
        let actions = actions.read_f64().unwrap();
        assert!(actions.iter().all(|action| action.abs() <= 1.0));
        let pictures = file
            .dataset(&format!("{demonstration}/obs/head_image"))
            .unwrap();
        assert_eq!(pictures.shape().unwrap(), [frames, 150, 200, 3]);
        let pixels = pictures.read_u8().unwrap();
        let expected: Vec<u8> = episode.cameras[0]
            .images
            .iter()
            .flat_map(|image| image.rgb.clone())
            .collect();
        assert!(pixels == expected);
        // What is observed next: in the end the same again.
        let next = file
            .dataset(&format!("{demonstration}/next_obs/head_image"))
            .unwrap();
        assert_eq!(next.shape().unwrap(), [frames, 150, 200, 3]);
        let size = 150 * 200 * 3;
        let last = pixels.len() - size;
        let next = next.read_u8().unwrap();
        assert!(next[..last] == pixels[size..] && next[last..] == pixels[last..]);
        let state = |of: &str| {
            let set = file.dataset(&format!("{demonstration}/{of}/state"));
            set.unwrap().read_f32().unwrap()
        };
        let width = episode.state.names.len();
        let (now, next) = (state("obs"), state("next_obs"));
        assert_eq!(next[..next.len() - width], now[width..]);
        assert_eq!(next[next.len() - width..], now[now.len() - width..]);
    }
    let train = file.dataset("mask/train").unwrap().read_string().unwrap();
    assert_eq!(train, ["demo_0"]);
    let valid = file.dataset("mask/valid").unwrap().read_string().unwrap();
    assert_eq!(valid, ["demo_1"]);
    let env_args = data.attrs().unwrap();
    let env_args = env_args
        .get("env_args")
        .and_then(AttrValue::as_str)
        .unwrap();
    assert!(env_args.contains("\"action_scale\""), "{env_args}");
}

#[test]
fn some_demonstrations_are_for_validation_as_soon_as_there_are_two() {
    let path = fresh("robomimic_masks.hdf5");
    let mut small = episode();
    small.cameras.clear();
    for (count, expected) in [
        (1, &[][..]),
        (2, &["demo_1"]),
        (9, &["demo_8"]),
        (10, &["demo_9"]),
        (21, &["demo_9", "demo_19"]),
    ] {
        let mut file = Robomimic::open(path.clone(), &alone()).unwrap();
        let there = File::open(&path).unwrap();
        for _ in there.group("data").unwrap().groups().unwrap().len()..count {
            file.write(small.clone()).unwrap();
        }
        file.finish().unwrap();
        let file = File::open(&path).unwrap();
        let names = |mask: &str| {
            let set = file.dataset(mask).ok();
            set.map_or(Vec::new(), |set| set.read_string().unwrap())
        };
        assert_eq!(names("mask/valid"), expected, "{count}");
        assert_eq!(names("mask/train").len() + expected.len(), count);
    }
}

#[test]
fn other_episodes_are_refused() {
    let path = fresh("robomimic_mixed.hdf5");
    let mut file = Robomimic::open(path, &alone()).unwrap();
    file.write(episode()).unwrap();
    let mut other = episode();
    other.state.names[0] = "Blue.x".into();
    assert!(file.write(other).is_err());
    let mut far = episode();
    far.action.values[0] = 1000.0;
    let error = Robomimic::prepare(far).unwrap_err().to_string();
    assert!(error.contains("its action left_hand.dx is 1000"), "{error}");
}

#[test]
fn arrays_of_matlab_have_frames_as_rows() {
    let folder = fresh("matlab");
    let mut files = Matlab::open(folder.clone(), &alone()).unwrap();
    for _ in 0..2 {
        files.write(Matlab::prepare(episode()).unwrap()).unwrap();
    }
    files.finish().unwrap();
    let file = File::open(folder.join("episode-000001.mat")).unwrap();
    let episode = episode();
    let state = file.dataset("state").unwrap();
    // MATLAB's dimensions are HDF5's in reverse.
    let shape = [episode.state.names.len() as u64, episode.len() as u64];
    assert_eq!(state.shape().unwrap(), shape);
    let values = state.read_f32().unwrap();
    let first: Vec<_> = episode.state.frames().map(|frame| frame[0]).collect();
    assert_eq!(values[..first.len()], first);
    let pictures = file.dataset("head_image").unwrap();
    let shape = [episode.len() as u64, 3, 200, 150];
    assert_eq!(pictures.shape().unwrap(), shape);
    let pixels = pictures.read_u8().unwrap();
    assert_eq!(pixels[1], episode.cameras[0].images[0].rgb[200 * 3]);
}
