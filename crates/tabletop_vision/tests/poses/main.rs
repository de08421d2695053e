//! Poses of objects in pictures of random scenes.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod scenes;

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
