//! Poses of objects in pictures of random scenes.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod contained;
mod described;
mod guided;
mod scenes;

use bevy::math::Vec3;
use scenes::{Difficulty, Sample, TASKS};
use tabletop_camera::{Camera, DrawnSolid};
use tabletop_core::Random;
use tabletop_geometry::{Pose, Rgb, Solid, turn_about};
use tabletop_vision::{KnownScenery, Visibility, calibrated};

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
                let mut eyes = sample.eyes();
                let seen = eyes.look(&sample.picture, &KnownScenery::default());
                for (object, error) in sample.errors(&seen).into_iter().enumerate() {
                    // What is hidden cannot be known.
                    if error.visible < 0.1 {
                        continue;
                    }
                    assert!(
                        error.length < 0.02 && error.degrees < 1.0 && error.is_sure,
                        "{} {is_end} {seed}, object {object}: {error:?}",
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
    let mut eyes = sample.eyes();
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
        for (own, truth) in seen.objects.iter().zip(&poses).skip(1) {
            let error = own.pose.unwrap().location.distance(truth.location);
            assert!(error < 0.02, "frame {frame}: {error}");
        }
    }
    assert!(largest < 0.1, "{largest}");
}

/// Moves an object along a way, one step a picture. Everything else has to be seen where it stays, picture by picture.
fn assert_others_stay(sample: &Sample, moved: usize, way: impl IntoIterator<Item = Vec3>) {
    let mut eyes = sample.eyes();
    let mut seen = eyes.look(&sample.picture, &KnownScenery::default());
    let places: Vec<_> = sample.poses.iter().copied().map(Some).collect();
    eyes.name_by_place(&places, &mut seen);
    let mut poses = sample.poses.clone();
    for (frame, step) in way.into_iter().enumerate() {
        poses[moved].location += step;
        let seen = eyes.look(&sample.with_poses(&poses), &KnownScenery::default());
        for (i, (own, truth)) in seen.objects.iter().zip(&poses).enumerate() {
            let error = own.pose.unwrap().location.distance(truth.location);
            assert!(
                error < 0.05 || i == moved || !own.is_sure,
                "frame {frame}: object {i} is {error} off"
            );
        }
    }
}

#[test]
fn what_was_under_a_ring_that_is_lifted_stays() {
    let [small, other_peg] = [5, 1];
    for seed in 0..8 {
        let sample = TASKS[3].sample(&Difficulty::default(), seed);
        let lift = [Vec3::Z * 0.7; 3];
        let over = sample.poses[other_peg].location - sample.poses[small].location;
        let carry = [over.with_z(0.0) / 5.0; 5];
        assert_others_stay(&sample, small, lift.into_iter().chain(carry));
    }
}

#[test]
fn what_a_fast_block_flies_past_stays() {
    for seed in 0..8 {
        let sample = TASKS[2].sample(&Difficulty::default(), seed);
        let others = &sample.poses[1..];
        let stops = others.iter().map(|pose| pose.location + Vec3::Z * 2.5);
        let mut at = sample.poses[0].location;
        let way = stops.map(|stop| stop - std::mem::replace(&mut at, stop));
        assert_others_stay(&sample, 0, way);
    }
}

#[test]
fn a_camera_that_was_moved_is_found_by_the_edges_of_the_table() {
    for seed in 0..5 {
        let mut sample = TASKS[0].sample(&Difficulty::default(), seed);
        let thought = sample.camera;
        let mut random = Random::new(seed);
        let mut any = |most: f32| random.between((-most, most));
        let by = Vec3::new(any(0.4), any(0.4), any(0.4));
        let axis = Vec3::new(any(1.0), any(1.0), any(1.0)).normalize();
        sample.camera.pose = thought.pose * Pose::new(by, turn_about(axis, any(0.03)));
        let truth = sample.camera;
        let found = calibrated(&sample.with_poses(&sample.poses), &thought, &sample.table);
        let shift = |camera: &Camera, point: Vec3| {
            let [seen, expected] = [&truth, camera].map(|it| it.pixel_of(point).unwrap());
            seen.distance(expected)
        };
        let points =
            (-5..=5).flat_map(|x| (-5..1).map(move |y| Vec3::new(x as f32, y as f32, 0.5)));
        let largest = |camera| {
            let shifts = points.clone().map(|point| shift(camera, point));
            shifts.fold(0.0, f32::max)
        };
        assert!(largest(&thought) > 4.0);
        assert!(
            largest(&found) < 1.0,
            "seed {seed}: {} pixels",
            largest(&found)
        );
        let off = found.pose.location.distance(truth.pose.location);
        assert!(off < 0.15, "seed {seed}: {off} units");
    }
}

#[test]
fn rings_stand_on_the_foot_of_their_peg_and_not_in_it() {
    let task = |name: &str| TASKS.iter().find(|task| task.name == name).unwrap();
    let noise = Difficulty {
        noise: 10.0,
        ..Difficulty::default()
    };
    let light = Difficulty {
        light: 0.3,
        ..Difficulty::default()
    };
    for (name, difficulty, seed) in [("hanoi_rings", noise, 6), ("hanoi", light, 9)] {
        let sample = task(name).sample(&difficulty, seed);
        let mut eyes = sample.eyes();
        let seen = eyes.look(&sample.picture, &KnownScenery::default());
        for (object, error) in sample.errors(&seen).into_iter().enumerate() {
            assert!(error.length < 0.02, "{name} {object}: {error:?}");
        }
    }
}

#[test]
fn what_is_wrong_in_a_hard_picture_is_not_sure() {
    let hard = [
        Difficulty {
            noise: 10.0,
            ..Difficulty::default()
        },
        Difficulty {
            distractors: 4,
            ..Difficulty::default()
        },
        Difficulty {
            light: 0.3,
            ..Difficulty::default()
        },
    ];
    for (task, difficulty) in TASKS[..3]
        .iter()
        .flat_map(|it| hard.iter().map(move |own| (it, own)))
    {
        for seed in 0..3 {
            let sample = task.sample(difficulty, seed);
            let mut eyes = sample.eyes();
            let seen = eyes.look(&sample.picture, &KnownScenery::default());
            assert!(
                (seen.noise - difficulty.noise).abs() < 2.0,
                "{}",
                seen.noise
            );
            for error in sample.errors(&seen) {
                assert!(
                    error.length < 0.1 || !error.is_sure,
                    "{} {seed}: {error:?}",
                    task.name
                );
            }
        }
    }
}

#[test]
fn an_unknown_object_is_clutter() {
    let mut sample = TASKS[0].sample(&Difficulty::default(), 1);
    let before = sample.picture.clone();
    // Only the first two blocks are known.
    sample.known.truncate(2);
    let mut eyes = sample.eyes();
    let seen = eyes.look(&before, &KnownScenery::default());
    let clutter = &seen.clutter[0];
    assert_eq!(seen.clutter.len(), 1, "{:?}", seen.clutter);
    let middle = sample.camera.pixel_of(sample.poses[2].location).unwrap();
    assert!(clutter.window.columns.contains(&(middle.x as u32)));
    assert!(clutter.window.rows.contains(&(middle.y as u32)));
    assert!(seen.objects.iter().all(|object| object.is_sure));
}

#[test]
fn a_hidden_object_stays_where_it_was_last_seen() {
    let sample = TASKS[0].sample(&Difficulty::default(), 2);
    let mut eyes = sample.eyes();
    eyes.look(&sample.picture, &KnownScenery::default());
    // A board between the camera and the first block.
    let eye = sample.camera.pose.location;
    let at = sample.poses[0].location;
    let board = DrawnSolid {
        pose: Pose::new(at + (eye - at) * 0.3, sample.camera.pose.rotation),
        solid: Solid::Cuboid(Vec3::new(2.5, 2.5, 0.1)),
        color: Rgb::new(0.9, 0.6, 0.9),
        object: 9,
    };
    let picture = sample.with_poses_and(&sample.poses, std::slice::from_ref(&board));
    let scenery = KnownScenery {
        solids: vec![board],
        ..KnownScenery::default()
    };
    let seen = eyes.look(&picture, &scenery);
    assert_eq!(seen.objects[0].visibility, Visibility::Hidden);
    assert!(!seen.objects[0].is_sure);
    assert!(seen.objects[0].pose.unwrap().location.distance(at) < 0.02);
    assert!(seen.objects[1].is_sure && seen.objects[2].is_sure);
}
