//! Pictures that the recording has not: other cameras, sizes and rates.

use std::f32::consts::FRAC_PI_3;

use bevy::math::Vec3;
use tabletop_camera::{CameraPlace, CameraSpec};
use tabletop_core::TICKS_PER_SECOND;
use tabletop_geometry::Pose;
use tabletop_training::{
    ActionKind, EpisodeSelection, PictureSelection, StateKind, TrainingEpisode,
};

use crate::demonstration::{episode, recording};

fn camera(name: &str, viewpoint: CameraPlace) -> CameraSpec {
    CameraSpec {
        name: name.into(),
        viewpoint,
        size: None,
        vertical_fov: None,
    }
}

fn read(pictures: PictureSelection) -> TrainingEpisode {
    let selection = EpisodeSelection {
        pictures,
        ..EpisodeSelection::default()
    };
    TrainingEpisode::read(recording(), &selection).unwrap()
}

#[test]
fn pictures_made_again_are_the_recorded_ones_to_the_byte() {
    let again = read(PictureSelection {
        cameras: Some(vec![camera("head", CameraPlace::Head)]),
        ..PictureSelection::default()
    });
    let recorded = episode();
    assert_eq!(again.ticks, recorded.ticks);
    let [made, there] = [&again, &recorded].map(|episode| &episode.cameras[0].images);
    // Frames in which an object has moved by less than a `move` line says have the picture before.
    let is_new = |frame: &usize| *frame == 0 || there[*frame] != there[frame - 1];
    let new: Vec<_> = (0..there.len()).filter(is_new).collect();
    assert!(new.len() > 4, "{new:?}");
    for frame in new {
        assert!(made[frame] == there[frame], "frame {frame}");
    }
    assert_eq!(again.state, recorded.state);
}

#[test]
fn there_can_be_sixty_frames_a_second_of_any_size() {
    let recorded = episode();
    let fast = read(PictureSelection {
        fps: Some(60),
        size: Some([64, 48]),
        ..PictureSelection::default()
    });
    let last = recorded.ticks.len() - 1;
    let ticks = recorded.ticks[last].0 - recorded.ticks[0].0;
    assert_eq!((fast.fps, fast.len() as u64), (TICKS_PER_SECOND, ticks + 1));
    assert_eq!(fast.cameras[0].images.len(), fast.len());
    for image in &fast.cameras[0].images {
        assert_eq!([image.width, image.height], [64, 48]);
    }
    let frames: Vec<_> = fast.state.frames().collect();
    let frames_of_recording: Vec<_> = recorded.state.frames().collect();
    assert_eq!(frames[0], frames_of_recording[0]);
    assert_eq!(frames.last(), frames_of_recording.last());
    // What moves has a picture of its own, what stands shares one.
    let mut different: Vec<_> = fast.cameras[0].images.clone();
    different.dedup();
    assert!(
        (10..fast.len()).contains(&different.len()),
        "{}",
        different.len()
    );
}

#[test]
fn a_camera_from_above_sees_distances_and_objects() {
    let above = Pose::looking_at(Vec3::new(0.0, -0.01, 10.0), Vec3::ZERO);
    let episode = read(PictureSelection {
        cameras: Some(vec![
            camera("above", CameraPlace::Standing(above)),
            camera("left_hand", CameraPlace::Hand("left_hand".into())),
        ]),
        size: Some([80, 60]),
        has_depth: true,
        has_ids: true,
        ..PictureSelection::default()
    });
    let names: Vec<_> = episode
        .cameras
        .iter()
        .map(|camera| camera.name.as_str())
        .collect();
    assert_eq!(names, ["above", "left_hand"]);
    let above = &episode.cameras[0];
    assert_eq!(above.depths.len(), episode.len());
    assert_eq!(above.ids.len(), episode.len());
    // The red block, the first object, has its top at (2, 0, 1), 9 units below the camera.
    let per_unit = 30.0 / (FRAC_PI_3 / 2.0).tan() / 9.0;
    let pixel = 30 * 80 + 40 + (2.0 * per_unit) as usize;
    assert_eq!(above.ids[0][pixel], 2);
    assert!(
        (above.depths[0][pixel] - 0.9).abs() < 1e-3,
        "{}",
        above.depths[0][pixel]
    );
    let middle = 30 * 80 + 40;
    assert_eq!(above.ids[0][middle], 1);
    assert!((above.depths[0][middle] - 1.0).abs() < 1e-3);
    // In the end it lies on the green one, the second object.
    let last = episode.len() - 1;
    assert_eq!(above.ids[last][pixel], 1);
    assert!(above.ids[last].contains(&2));
}

#[test]
fn cameras_that_the_robot_lacks_are_refused_by_name() {
    let selection = EpisodeSelection {
        pictures: PictureSelection {
            cameras: Some(vec![camera(
                "third_hand",
                CameraPlace::Hand("third_hand".into()),
            )]),
            ..PictureSelection::default()
        },
        ..EpisodeSelection::default()
    };
    let error = TrainingEpisode::read(recording(), &selection)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("third_hand") && error.contains("left_hand_camera"),
        "{error}"
    );
}

#[test]
fn end_effectors_that_stand_still_do_not_move() {
    let selection = EpisodeSelection {
        state: Some(StateKind::Robot),
        action: Some(ActionKind::EndEffectors),
        ..EpisodeSelection::default()
    };
    let episode = TrainingEpisode::read(recording(), &selection).unwrap();
    let names = &episode.action.names;
    assert_eq!(names.len(), 14, "{names:?}");
    assert_eq!(
        (names[0].as_str(), names[6].as_str()),
        ("left.dx", "left.opening")
    );
    for frame in episode.action.frames() {
        assert_eq!(frame[..6], [0.0; 6]);
        assert!(frame[6] > 0.0);
    }
}
