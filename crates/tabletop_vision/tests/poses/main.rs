//! Poses of objects in pictures of random scenes.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod scenes;

use bevy::math::Vec3;
use scenes::{Difficulty, TASKS};
use tabletop_vision::{Eyes, KnownScenery};

#[test]
fn objects_of_every_task_are_seen_to_a_fiftieth_of_a_unit() {
    for task in TASKS {
        for is_end in [false, true] {
            for seed in 0..3 {
                let sample = task.sample(
                    &Difficulty {
                        is_end,
                        ..Difficulty::default()
                    },
                    seed,
                );
                let mut eyes = Eyes::new(sample.known.clone(), sample.camera, sample.table);
                let seen = eyes.look(&sample.picture, &KnownScenery::default());
                for error in sample.errors(&seen) {
                    assert!(
                        error.length < 0.02 && error.degrees < 1.0 && error.is_sure,
                        "{} {is_end} {seed}: {error:?}",
                        task.name
                    );
                }
            }
        }
    }
}

#[test]
fn an_object_that_is_carried_is_followed_and_its_height_is_seen() {
    let sample = TASKS[0].sample(&Difficulty::default(), 3);
    let mut eyes = Eyes::new(sample.known.clone(), sample.camera, sample.table);
    let mut poses = sample.poses.clone();
    let start = poses[0].location;
    let mut largest = 0.0_f32;
    for frame in 0..24 {
        // Lifted by two units, and then carried over the others.
        let time = frame as f32 / 8.0;
        poses[0].location = start
            + Vec3::new(
                (time - 1.0).max(0.0),
                0.3 * (time - 1.0).max(0.0),
                2.0 * time.min(1.0),
            );
        let seen = eyes.look(&sample.with_poses(&poses), &KnownScenery::default());
        let pose = seen.objects[0].pose.unwrap();
        largest = largest.max(pose.location.distance(poses[0].location));
        for i in 1..3 {
            let error = seen.objects[i]
                .pose
                .unwrap()
                .location
                .distance(poses[i].location);
            assert!(error < 0.02, "frame {frame}, object {i}: {error}");
        }
    }
    assert!(largest < 0.1, "{largest}");
}
