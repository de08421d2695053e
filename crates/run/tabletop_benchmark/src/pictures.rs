//! Demonstrations as the robot's eyes see them: by pictures of the head camera alone.

use tabletop_camera::{Camera, DrawnSolid, Rasterizer, Scene};
use tabletop_core::{HeadCamera, ObjectSpec, Picture, SimTick};
use tabletop_episodes::{has_in_view, watching::Watcher};
use tabletop_recorder::TICKS_PER_FRAME;
use tabletop_task::{Demonstration, ShownObject};
use tabletop_vision::KnownScenery;

/// What the pictures of a demonstration show. `None` if the eyes are not sure of something, such as an object that disappears.
pub(crate) fn watched(shown: &Demonstration) -> Option<Demonstration> {
    let camera = Camera::of_head(&HeadCamera::default(), &shown.table);
    let objects = shown.objects.iter().map(|object| ObjectSpec {
        pose: object.track.at(shown.start).unwrap_or(object.spec.pose),
        ..object.spec.clone()
    });
    let joints = shown.joints.clone();
    let mut watcher = Watcher::new(objects.collect(), joints, shown.table, camera);
    let mut rasterizer = Rasterizer::default();
    let mut picture = Picture::default();
    for tick in (shown.start.0..=shown.end.0).step_by(TICKS_PER_FRAME as usize) {
        let tick = SimTick(tick);
        rasterizer.draw(&scene_at(shown, tick), &camera, &mut picture);
        watcher.watch(tick, &picture, &KnownScenery::default());
    }
    let is_sure = watcher.doubts().is_empty();
    is_sure.then(|| watcher.demonstration())
}

/// True if the head camera sees all objects wherever they are in a demonstration, were nothing before them; and none disappears, which no eyes
/// can tell from one that is hidden.
pub(crate) fn is_in_view(shown: &Demonstration) -> bool {
    let camera = Camera::of_head(&HeadCamera::default(), &shown.table);
    shown.objects.iter().all(|object| {
        let mut poses = object.track.between(shown.start, shown.end);
        object.deleted.is_none() && poses.all(|pose| has_in_view(&camera, &object.spec.shape, pose))
    })
}

/// What the camera sees at the end of a tick.
fn scene_at(shown: &Demonstration, tick: SimTick) -> Scene {
    let is_there = |object: &&ShownObject| {
        object.created <= tick && object.deleted.is_none_or(|deleted| tick < deleted)
    };
    let mut solids = vec![DrawnSolid::of_table(&shown.table, 1)];
    for (number, object) in (2..).zip(shown.objects.iter().filter(is_there)) {
        let pose = object.track.at(tick).unwrap_or(object.spec.pose);
        let parts = object.spec.shape.filled();
        let parts = parts.iter();
        solids.extend(parts.map(|part| DrawnSolid::of(pose, part, number)));
    }
    Scene {
        solids,
        ..Scene::default()
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::Random;
    use tabletop_task::Task;

    use super::*;
    use crate::{LESSONS, lesson::SEEN, showing::shown};

    /// The floor is little above the table, and the walls hide parts of what lies on it.
    #[test]
    fn balls_are_seen_on_the_floor_of_a_box() {
        let lesson = LESSONS
            .iter()
            .find(|lesson| lesson.sentences == "Put every ball into the box.");
        let lesson = lesson.unwrap();
        let program = lesson.program().unwrap();
        let mut random = Random::new(1);
        let demonstrations = std::iter::repeat_with(|| {
            let scene = lesson.scene(4, SEEN, &mut random)?;
            shown(&program, &scene, &mut random)
        });
        for shown in demonstrations.flatten().filter(is_in_view).take(5) {
            let seen = watched(&shown).unwrap();
            let steps = |shown: &Demonstration| -> Vec<_> {
                let task = Task::of(shown);
                let steps = task.steps.into_iter();
                steps.map(|step| (step.object, step.relations)).collect()
            };
            assert_eq!(steps(&seen), steps(&shown));
        }
    }
}
