//! What demonstrations mean.

use bevy::math::Vec3;
use tabletop_core::{Hand, Manipulator, SimTick};
use tabletop_geometry::Rgb;
use tabletop_program::{Example, Meaning, ProgramRun, TableScene, TaskProgram, Untouched};
use tabletop_task::{ActDeed, Demonstration, ShownAct, Task, Track};

use crate::scenes::{container, cube, hanoi, scene, spread};

/// A demonstration of a program, step by step.
fn shown(program: &str, table: &TableScene) -> Example {
    let program: TaskProgram = program.parse().unwrap();
    let (steps, _, failure) = ProgramRun::rehearsed(&program, table);
    assert_eq!(failure, None);
    let (mut now, mut tick, mut acts) = (table.clone(), 0, Vec::new());
    let mut tracks: Vec<_> = table
        .objects
        .iter()
        .map(|object| {
            let mut track = Track::default();
            track.push(SimTick(0), object.pose);
            (object.clone(), track)
        })
        .collect();
    for step in &steps {
        let mut act = |tick, deed| {
            acts.push(ShownAct {
                tick: SimTick(tick),
                by: Manipulator::Hand(Hand::Right),
                deed,
            })
        };
        act(tick + 10, ActDeed::Grasp(step.object.clone()));
        now = now.after(step);
        let pose = step.pose.unwrap();
        let (_, track) = tracks
            .iter_mut()
            .find(|(object, _)| object.id == step.object)
            .unwrap();
        let high = tabletop_geometry::Pose::new(pose.location + Vec3::Z * 5.0, pose.rotation);
        track.push(SimTick(tick + 20), high);
        track.push(SimTick(tick + 40), pose);
        act(tick + 50, ActDeed::Release(None));
        tick += 100;
    }
    let mut shown = Demonstration::of_motions(table.table, tracks, Vec::new(), SimTick(tick + 60));
    shown.acts = acts;
    shown.is_poses_only = false;
    Example::of(&shown, &Task::of(&shown)).unwrap()
}

fn meant(program: &str, table: &TableScene) -> Meaning {
    Meaning::of(&[shown(program, table)])
}

fn first(found: &Meaning) -> String {
    found
        .program
        .as_ref()
        .map_or(String::new(), ToString::to_string)
}

fn others(found: &Meaning) -> Vec<String> {
    let others = found.alternatives.iter();
    others.map(|other| other.program.to_string()).collect()
}

/// What demonstrations of a program on these tables mean.
fn meant_by(program: &str, tables: &[TableScene]) -> Meaning {
    let examples: Vec<_> = tables.iter().map(|table| shown(program, table)).collect();
    Meaning::of(&examples)
}

fn mixed(colors: &[Rgb]) -> TableScene {
    let places = spread(colors.len());
    let cubes = colors.iter().zip(places).enumerate();
    let mut objects: Vec<_> = cubes
        .map(|(i, (color, at))| cube(&format!("C{i}"), *color, 1.0 + 0.1 * i as f32, at.x, at.y))
        .collect();
    objects.push(container(
        "Box",
        Rgb::BLUE,
        Vec3::new(4.5, 4.5, 1.5),
        6.5,
        -3.0,
    ));
    objects.push(container(
        "Red",
        Rgb::RED,
        Vec3::new(3.5, 3.5, 1.5),
        6.5,
        3.0,
    ));
    scene(objects)
}

fn untouched(of: &str, objects: &[&str]) -> Untouched {
    let objects = objects.iter().map(|id| (*id).to_owned());
    Untouched {
        of: of.into(),
        objects: objects.collect(),
    }
}

#[test]
fn all_of_a_colour_were_meant() {
    let table = mixed(&[Rgb::RED, Rgb::GREEN, Rgb::RED, Rgb::GREEN]);
    let found = meant("Put every red block into the blue box.", &table);
    assert_eq!(first(&found), "Put every red block into the blue box.");
    assert_eq!(found.untouched, [untouched("every block", &["C1", "C3"])]);
}

#[test]
fn one_that_was_left_says_that_a_number_was_meant() {
    let table = mixed(&[Rgb::RED, Rgb::RED, Rgb::RED]);
    let found = meant("Put two blocks into the blue box.", &table);
    assert_eq!(first(&found), "Put two blocks into the blue box.");
    let red = "Put two red blocks into the blue box.".to_owned();
    assert!(others(&found).contains(&red), "{:?}", others(&found));
    assert!(
        found
            .untouched
            .contains(&untouched("every red block", &["C2"]))
    );
}

#[test]
fn pairs_of_one_colour_are_seen() {
    let table = mixed(&[Rgb::RED, Rgb::BLUE, Rgb::RED]);
    let found = meant("Put each block into the box of its colour.", &table);
    assert_eq!(first(&found), "Put each block into the box of its colour.");
}

#[test]
fn towers_by_size_are_seen_before_their_places() {
    let table = mixed(&[Rgb::GREEN, Rgb::RED, Rgb::GREEN, Rgb::GRAY]);
    let found = meant("Put all blocks on each other, the largest first.", &table);
    assert_eq!(
        first(&found),
        "Put all blocks on each other, the largest first."
    );
    for program in others(&found) {
        let again: TaskProgram = program.parse().unwrap();
        assert_eq!(again.to_string(), program);
    }
}

#[test]
fn a_single_step_means_itself() {
    let table = mixed(&[Rgb::RED, Rgb::GREEN]);
    let found = meant("Put C0 into the blue box.", &table);
    assert_eq!(first(&found), "Put the red block into the blue box.");
}

#[test]
fn patterns_are_seen_and_done_only_once() {
    let table = mixed(&[Rgb::GREEN, Rgb::RED, Rgb::GREEN, Rgb::GRAY]);
    for said in [
        "Put all blocks in a row, the largest first.",
        "Put all blocks in a column, the smallest first.",
        "Put all blocks in a grid of two columns, the largest first.",
    ] {
        let found = meant(said, &table);
        assert_eq!(first(&found), said);
        let program: TaskProgram = said.parse().unwrap();
        let (_, after, _) = ProgramRun::rehearsed(&program, &table);
        assert_eq!(ProgramRun::rehearsed(&program, &after).0, [], "{said}");
    }
}

#[test]
fn two_that_change_places_are_swapped() {
    let table = mixed(&[Rgb::GREEN, Rgb::RED, Rgb::GRAY]);
    let found = meant("Swap the green block and the red block.", &table);
    assert_eq!(first(&found), "Swap the green block and the red block.");
}

#[test]
fn a_second_demonstration_decides() {
    let said = "Put every red block into the blue box.";
    let red = mixed(&[Rgb::RED, Rgb::RED]);
    let found = meant(said, &red);
    assert_eq!(first(&found), "Put every block into the blue box.");
    assert!(
        others(&found).contains(&said.to_owned()),
        "{:?}",
        others(&found)
    );
    let mixed = mixed(&[Rgb::RED, Rgb::GREEN, Rgb::RED]);
    assert_eq!(first(&meant_by(said, &[red, mixed])), said);
}

#[test]
fn a_tower_that_is_moved_is_no_tower_that_is_made() {
    let sentence = "Move the tower from PegA to PegC by way of PegB.";
    for count in [3, 4] {
        let found = first(&meant(sentence, &hanoi(count)));
        assert!(found.starts_with("Move the tower from "), "{found}");
    }
}
