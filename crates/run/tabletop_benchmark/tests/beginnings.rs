//! The beginnings of the tasks by which policies are judged, for each robot inside the program.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::{collections::BTreeSet, path::Path};

use bevy::math::Vec3;
use tabletop_benchmark::{BENCHMARK_VERSION, JUDGED_TASKS, Perturbation, TaskBeginning};
use tabletop_controller::{LimbSight, SeenObject, Sight};
use tabletop_core::{CameraCarrier, Light, ObjectSpec, RobotLayout};
use tabletop_episodes::{multiplication::Fingerprint, robot_body};
use tabletop_planner::RobotBody;
use tabletop_program::{ProgramRun, TableScene};
use tabletop_robot::RobotPlugin;
use tabletop_scene::{IdAllocator, assemble};
use tabletop_sim::robots::read_robot;
use tabletop_task::Relation;

/// Number of episodes of each task that are looked at.
const EPISODES: u64 = 5;

/// What an observer sees of objects.
fn sight(objects: &[ObjectSpec]) -> Sight {
    let seen = objects.iter().map(|object| {
        let (shape, pose) = (object.shape.clone(), object.pose);
        let is_fixed = object.is_fixed();
        (
            object.id.clone(),
            SeenObject {
                shape,
                pose,
                is_fixed,
            },
        )
    });
    Sight {
        objects: seen.collect(),
        limbs: vec![LimbSight::default()],
        ..Sight::default()
    }
}

fn table(beginning: &TaskBeginning) -> TableScene {
    let assembly = assemble(&beginning.scene, &mut IdAllocator::default());
    TableScene {
        table: beginning.scene.table,
        objects: assembly.objects,
        joints: assembly.joints,
    }
}

/// The robots that have room for all tasks: Baxter, and another one.
const ROBOTS: [Option<&str>; 2] = [None, Some("panda")];

fn robot(name: Option<&str>) -> (RobotBody, CameraCarrier) {
    let file = name.map(|name| format!("shipped:assets/{name}/robot.ron"));
    let description = file.map(|file| read_robot(Path::new(&file)).unwrap());
    let carrier = match &description {
        Some(description) => CameraCarrier::from(&description.layout),
        None => CameraCarrier::from(RobotLayout::baxter()),
    };
    let robot = RobotPlugin {
        description,
        ..RobotPlugin::default()
    };
    let body = robot_body(&robot, &tabletop_core::Table::default()).unwrap();
    (body, carrier)
}

/// Whoever changes these fingerprints changes what results mean: then the benchmark has another version.
#[test]
fn beginnings_are_those_of_this_version() {
    assert_eq!(BENCHMARK_VERSION, "benchmark@1");
    let found = ROBOTS.map(|name| {
        let (body, carrier) = robot(name);
        let mut all = Fingerprint::EMPTY;
        let mut different = BTreeSet::new();
        for task in &JUDGED_TASKS {
            for episode in 0..EPISODES {
                let beginning = task.begin(episode, &body, carrier);
                let beginning = beginning.unwrap_or_else(|error| panic!("{name:?}: {error}"));
                all = all.and(beginning.fingerprint.as_bytes());
                different.insert(beginning.fingerprint.clone());
                // It is not done at first, and done when the program has done it.
                let before = table(&beginning);
                let now = sight(&before.objects);
                assert!(!beginning.is_done(&now), "{}", task.name);
                assert_eq!(
                    beginning.left(&now).len(),
                    beginning.step_count(),
                    "{}",
                    task.name
                );
                let program = task.program().unwrap();
                let (steps, mut after, _) = ProgramRun::rehearsed(&program, &before);
                for (number, step) in steps.iter().enumerate() {
                    if let Relation::Inside { object } = &step.relation {
                        // Rehearsals do not know where a turned box has its corners.
                        let middle = after.object(object).unwrap().pose.location;
                        let mut objects = after.objects.iter_mut();
                        let inside = objects.find(|object| object.id == step.object).unwrap();
                        inside.pose.location = middle + Vec3::new(0.5 * number as f32, 0.0, 0.06);
                    }
                }
                let mut then = sight(&after.objects);
                assert!(
                    beginning.is_done(&then),
                    "{}, {:?}",
                    task.name,
                    beginning.left(&then)
                );
                then.limbs[0].holds.push("Red".into());
                assert!(!beginning.is_done(&then), "{}", task.name);
                then.objects.remove("Red");
                assert_eq!(
                    beginning.left(&then).len(),
                    usize::from(before.object("Red").is_some())
                );
                assert!(task.seconds >= 30 * steps.len() as u64, "{}", task.name);
            }
        }
        assert_eq!(different.len(), JUDGED_TASKS.len() * EPISODES as usize);
        all.to_string()
    });
    let expected = ["36561241c3c7845b", "942e8d878bd095ca"];
    assert_eq!(found, expected);
}

/// What differs between a beginning and its twin: the light, where cameras are, the words, how things look, how large they are, how rough, and how many there are.
fn differences(one: &TaskBeginning, twin: &TaskBeginning) -> [bool; 7] {
    let own = |of: fn(&ObjectSpec) -> String| {
        [one, twin].map(|it| it.objects().iter().map(of).collect::<Vec<_>>())
    };
    let colors = |object: &ObjectSpec| {
        let drawn = object.shape.drawn().into_iter();
        format!("{:?}", drawn.map(|solid| solid.color).collect::<Vec<_>>())
    };
    let sizes = |object: &ObjectSpec| {
        let drawn = object.shape.drawn().into_iter();
        format!("{:?}", drawn.map(|solid| solid.solid).collect::<Vec<_>>())
    };
    let differ = |of| {
        let [one, twin] = own(of);
        one[..twin.len()] != twin
    };
    [
        one.light != Light::default(),
        one.displacement.is_some(),
        one.words != twin.words,
        differ(colors),
        differ(sizes),
        differ(|object| format!("{:?}", object.dynamics)),
        one.objects().len() > twin.objects().len(),
    ]
}

/// Whoever changes these fingerprints changes what results mean: then the benchmark has another version.
#[test]
fn a_perturbed_beginning_differs_from_its_twin_in_one_thing() {
    let found = ROBOTS.map(|name| {
        let (body, carrier) = robot(name);
        let mut all = Fingerprint::EMPTY;
        for task in &JUDGED_TASKS {
            for episode in 0..2 {
                let twin = task.begin(episode, &body, carrier).unwrap();
                for (place, perturbation) in [
                    (0, Perturbation::Light),
                    (1, Perturbation::Camera),
                    (2, Perturbation::Words),
                    (3, Perturbation::Colors),
                    (4, Perturbation::Sizes),
                    (5, Perturbation::Friction),
                    (6, Perturbation::Distractors),
                ] {
                    let at = format!("{name:?}, {}, {episode}, {perturbation}", task.name);
                    let one = twin.perturbed(perturbation, &body, carrier);
                    let one = one.unwrap_or_else(|error| panic!("{at}: {error}"));
                    let mut expected = [false; 7];
                    expected[place] = true;
                    assert_eq!(differences(&one, &twin), expected, "{at}");
                    assert_eq!(one.fingerprint, twin.fingerprint, "{at}");
                    let poses = |it: &TaskBeginning| {
                        let objects = it.objects().iter().take(twin.objects().len());
                        objects
                            .map(|object| (object.id.clone(), object.pose))
                            .collect::<Vec<_>>()
                    };
                    assert_eq!(poses(&one), poses(&twin), "{at}");
                    let now = sight(one.objects());
                    assert!(!one.is_done(&now), "{at}");
                    assert_eq!(one.left(&now).len(), twin.step_count(), "{at}");
                    let world = format!(
                        "{:?} {:?} {:?} {:?}",
                        one.scene, one.light, one.displacement, one.words
                    );
                    all = all.and(world.as_bytes());
                }
            }
        }
        all.to_string()
    });
    let expected = ["871ca0f64cccbd41", "7641d7606b1b12f0"];
    assert_eq!(found, expected);
}
