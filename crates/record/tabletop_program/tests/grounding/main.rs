//! Programs on tables: which steps they come to.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use bevy::math::{Quat, Vec3};
use tabletop_core::ObjectSpec;
use tabletop_geometry::{Pose, Rgb};
use tabletop_program::{NextAttempt, ProgramAttempts, ProgramRun, TableScene};
use tabletop_task::{Arrangement, Relation};

use scenes::{chest, container, cube, done, hanoi, on, plate, refused, rehearsed, scene, spread};

mod scenes;
mod shown;

fn arrangement(scene: &TableScene) -> Arrangement {
    let objects = scene.objects.iter();
    Arrangement::new(objects.map(|object| (object.id.as_str(), &object.shape, object.pose)))
}

#[test]
fn a_turned_box_has_its_inside_where_it_is() {
    for degrees in [0.0_f32, 20.0, 45.0, 80.0] {
        let span = Vec3::new(3.6, 2.4, 1.2);
        let mut turned = container("Box", Rgb::BLUE, span, 4.0, -2.0);
        turned.pose.rotation = Quat::from_rotation_z(degrees.to_radians());
        let cubes = [0.0, 1.5].map(|x| cube(&format!("C{x}"), Rgb::RED, 0.5, x, 3.0));
        let table = scene(cubes.into_iter().chain([turned]));
        let (_, after) = done("Put every red block into the box.", &table);
        for id in ["C0", "C1.5"] {
            let containers = arrangement(&after);
            let containers = containers.containers(id);
            assert_eq!(containers, ["Box"], "{degrees}: {}", location(&after, id));
        }
    }
}

fn location(scene: &TableScene, id: &str) -> Vec3 {
    scene.object(id).unwrap().pose.location
}

/// Cubes of an edge of 1 in these colours.
fn cubes(colors: &[Rgb]) -> Vec<ObjectSpec> {
    let places = spread(colors.len());
    let all = colors.iter().zip(places).enumerate();
    all.map(|(i, (color, at))| cube(&format!("C{i}"), *color, 1.0, at.x, at.y))
        .collect()
}

#[test]
fn every_red_block_goes_into_the_box() {
    for count in 2..=9_usize {
        let colors: Vec<_> = (0..count)
            .map(|i| if i % 2 == 0 { Rgb::RED } else { Rgb::GREEN })
            .collect();
        let mut objects = cubes(&colors);
        objects.push(container(
            "Box",
            Rgb::BLUE,
            Vec3::new(4.0, 4.0, 1.2),
            6.0,
            -3.0,
        ));
        let table = scene(objects);
        let (steps, after) = done("Put every red block into the blue box.", &table);
        assert_eq!(steps.len(), count.div_ceil(2));
        let arrangement = arrangement(&after);
        for (i, color) in colors.iter().enumerate() {
            let is_in = arrangement.containers(&format!("C{i}")).contains(&"Box");
            assert_eq!(is_in, *color == Rgb::RED, "{count}: C{i}");
        }
        assert!(
            done("Put every red block into the blue box.", &after)
                .0
                .is_empty()
        );
    }
}

#[test]
fn blocks_are_sorted_into_the_boxes_of_their_colour() {
    let colors = [
        Rgb::RED,
        Rgb::GREEN,
        Rgb::GREEN,
        Rgb::RED,
        Rgb::BLUE,
        Rgb::RED,
    ];
    let mut objects = cubes(&colors);
    for (i, color) in [Rgb::RED, Rgb::GREEN, Rgb::BLUE].into_iter().enumerate() {
        objects.push(container(
            &format!("Box{i}"),
            color,
            Vec3::new(3.5, 3.5, 1.2),
            5.0 - 4.0 * i as f32,
            3.5,
        ));
    }
    let scene = scene(objects);
    // The boxes are objects, too, and stay.
    for what in ["block", "object"] {
        let sentence = format!("Put each {what} into the box of its colour.");
        let (steps, after) = done(&sentence, &scene);
        assert_eq!(steps.len(), 6);
        let arrangement = arrangement(&after);
        for (i, color) in colors.iter().enumerate() {
            let expected = [Rgb::RED, Rgb::GREEN, Rgb::BLUE]
                .iter()
                .position(|other| other == color)
                .unwrap();
            let containers = arrangement.containers(&format!("C{i}"));
            assert_eq!(containers, [format!("Box{expected}").as_str()]);
        }
    }
}

#[test]
fn an_object_without_a_pair_is_named() {
    let mut objects = cubes(&[Rgb::RED, Rgb::YELLOW]);
    objects.push(container(
        "Box",
        Rgb::RED,
        Vec3::new(3.0, 3.0, 1.0),
        5.0,
        0.0,
    ));
    let reason = refused(
        "Put each block into the box of its colour.",
        &scene(objects),
    );
    assert_eq!(reason.object.as_deref(), Some("C1"));
    assert_eq!(reason.reason, "there is no box of its colour");
}

#[test]
fn towers_have_the_largest_below() {
    for count in 2..=9_u8 {
        let places = spread(count.into());
        // Out of order: 1, 3, 5, ... 2, 4, ...
        let edge = |i: u8| 0.6 + 0.1 * f32::from(i * 7 % 10);
        let objects = (0..count).map(|i| {
            let at = places[usize::from(i)];
            cube(&format!("C{i}"), Rgb::GRAY, edge(i), at.x, at.y)
        });
        let table = scene(objects);
        let (steps, after) = done("Put all blocks on each other, the largest first.", &table);
        assert_eq!(steps.len(), usize::from(count) - 1, "{steps:?}");
        let mut order: Vec<_> = (0..count).collect();
        order.sort_by(|a, b| edge(*b).total_cmp(&edge(*a)));
        let arrangement = arrangement(&after);
        for pair in order.windows(2) {
            let [below, above] = [pair[0], pair[1]].map(|i| format!("C{i}"));
            assert_eq!(arrangement.supports(&above), [below.as_str()]);
        }
        assert!(done("Stack all blocks, biggest first", &after).0.is_empty());
    }
}

#[test]
fn a_wrong_tower_is_taken_apart_first() {
    let small = cube("Small", Rgb::RED, 0.6, 0.0, -2.0);
    let large = on(cube("Large", Rgb::RED, 1.2, 0.0, 0.0), &small);
    let (steps, after) = done(
        "Put all blocks on each other, the largest first.",
        &scene([small, large]),
    );
    assert_eq!(steps.len(), 2, "{steps:?}");
    assert_eq!(arrangement(&after).supports("Small"), ["Large"]);
}

#[test]
fn the_table_is_cleared() {
    let mut objects = cubes(&[Rgb::RED, Rgb::GREEN, Rgb::BLUE]);
    let tower = on(cube("Top", Rgb::RED, 0.5, 0.0, 0.0), &objects[0]);
    objects.push(tower);
    let (steps, after) = done("Remove every block.", &scene(objects.clone()));
    assert_eq!(steps.len(), 4);
    assert!(after.objects.is_empty());
    objects.push(container(
        "Box",
        Rgb::GRAY,
        Vec3::new(5.0, 4.0, 1.5),
        5.0,
        -2.5,
    ));
    let text = "Put any block into the box until there is no block that is on the table.";
    let (steps, after) = done(text, &scene(objects));
    assert_eq!(steps.len(), 4, "{steps:?}");
    assert!(arrangement(&after).containers("C0").contains(&"Box"));
}

#[test]
fn a_row_is_set_from_left_to_right() {
    for count in 2..=6 {
        let table = scene(cubes(&vec![Rgb::BLUE; count]));
        let (steps, after) = done("Put all blocks in a row, the rightmost first.", &table);
        assert!(!steps.is_empty());
        let mut order: Vec<_> = table.objects.iter().collect();
        order.sort_by(|a, b| b.pose.location.x.total_cmp(&a.pose.location.x));
        let places: Vec<_> = order
            .iter()
            .map(|object| location(&after, &object.id))
            .collect();
        for pair in places.windows(2) {
            assert!(pair[0].x + 1.2 < pair[1].x, "{places:?}");
            assert!((pair[0].y - pair[1].y).abs() < 1e-3);
        }
    }
}

#[test]
fn a_grid_has_its_columns() {
    let table = scene(cubes(&[Rgb::BLUE; 6]));
    let (_, after) = done("Put all blocks in a grid of three columns.", &table);
    let count = |axis: Vec3| {
        let all = after
            .objects
            .iter()
            .map(|object| (object.pose.location.dot(axis) * 100.0).round() as i32);
        all.collect::<std::collections::BTreeSet<_>>().len()
    };
    assert_eq!((count(Vec3::X), count(Vec3::Y)), (3, 2));
}

#[test]
fn a_tower_grows_until_it_is_high_enough() {
    let mut objects = cubes(&[Rgb::GREEN; 6]);
    objects.push(cube("Base", Rgb::RED, 1.0, 4.0, -3.0));
    let table = scene(objects);
    let text = "Put any green block on the red block until it is four high.";
    let (steps, after) = done(text, &table);
    assert_eq!(steps.len(), 3, "{steps:?}");
    assert!(location(&after, "C2").z > 3.0);
    let reason = refused(
        "Put any green block on the red block until it is nine high.",
        &table,
    );
    assert_eq!(reason.reason, "there is no green block");
}

#[test]
fn a_number_of_blocks_is_put_and_not_more() {
    let mut objects = cubes(&[Rgb::RED; 4]);
    objects.push(container(
        "Box",
        Rgb::BLUE,
        Vec3::new(4.0, 4.0, 1.5),
        5.0,
        -3.0,
    ));
    let table = scene(objects);
    let (steps, after) = done("Put two red blocks into the box.", &table);
    assert_eq!(steps.len(), 2);
    assert!(
        done("Put two red blocks into the box.", &after)
            .0
            .is_empty()
    );
    assert_eq!(
        done("Put three red blocks into the box.", &after).0.len(),
        1
    );
    let reason = refused("Put five red blocks into the box.", &table);
    assert_eq!(
        reason.reason,
        "there are only 4 of the 5 that are meant by `five red blocks`"
    );
}

#[test]
fn a_tray_has_room_for_more_than_one() {
    let mut turned = cube("Turned", Rgb::RED, 1.0, -2.0, -4.0);
    turned.pose = Pose::from_degrees(turned.pose.location, Vec3::Z * 30.0);
    let tray = container("Tray", Rgb::BLUE, Vec3::new(4.0, 3.0, 0.8), 4.0, -3.0);
    let table = scene([cube("Straight", Rgb::RED, 1.0, -4.0, -3.0), turned, tray]);
    let (steps, after) = done("Put every red block into the box.", &table);
    assert_eq!(steps.len(), 2);
    for id in ["Straight", "Turned"] {
        assert_eq!(arrangement(&after).supports(id), ["Tray"]);
    }
}

#[test]
fn sets_may_be_empty_and_single_objects_may_not() {
    let table = scene(cubes(&[Rgb::RED, Rgb::RED]));
    assert!(done("Put every green block aside.", &table).0.is_empty());
    let reason = refused("Put the green block aside.", &table);
    assert_eq!(reason.reason, "there is no green block");
    let reason = refused("Put the red block aside.", &table);
    assert_eq!(reason.reason, "the red block can be any of C0, C1");
    let reason = refused("Put C7 aside.", &table);
    assert_eq!(reason.reason, "there is no object C7");
}

#[test]
fn a_lid_is_opened_if_it_is_closed() {
    let (objects, joint) = chest("chest", Rgb::BLUE, 2.0, -2.0);
    let block = cube("Yellow", Rgb::YELLOW, 1.0, -4.0, -3.0);
    let mut table = scene(objects.into_iter().chain([block]));
    table.joints.push(joint);
    let reason = refused("Put the yellow block into the box.", &table);
    assert_eq!(reason.reason, "chest-box is closed");
    let text = "If the box is closed, open it. Put the yellow block into the box. Close the box.";
    let (steps, after) = done(text, &table);
    let expected = [
        "Open the blue box.",
        "Put the yellow block into the blue box.",
        "Close the blue box.",
    ];
    assert_eq!(steps, expected);
    assert!(
        arrangement(&after)
            .containers("Yellow")
            .contains(&"chest-box")
    );
    let (steps, _) = done("If the box is closed, open it, otherwise close it.", &table);
    assert_eq!(steps, ["Open the blue box."]);
}

#[test]
fn two_blocks_change_places() {
    let table = scene(cubes(&[Rgb::RED, Rgb::BLUE, Rgb::GREEN]));
    let (steps, after) = done("Swap the red block and the blue block.", &table);
    assert_eq!(steps.len(), 3, "{steps:?}");
    assert!(location(&after, "C0").distance(location(&table, "C1")) < 1e-3);
    assert!(location(&after, "C1").distance(location(&table, "C0")) < 1e-3);
}

#[test]
fn rings_move_as_in_hanoi() {
    for count in 1..=5_u8 {
        let table = hanoi(count);
        let (steps, after) = done("Move the tower from PegA to PegC by way of PegB.", &table);
        assert_eq!(steps.len(), (1 << count) - 1);
        for i in 0..count {
            assert_eq!(arrangement(&after).posts(&format!("Ring{i}")), ["PegC"]);
        }
    }
}

#[test]
fn a_ring_rests_on_what_is_around_its_post() {
    let mut table = hanoi(2);
    let program = "Move the tower from PegA to PegC by way of PegB.".parse();
    let (steps, _, failure) = ProgramRun::rehearsed(&program.unwrap(), &table);
    assert_eq!(failure, None);
    let relations = steps.iter().map(|step| {
        let (task, binding) = step.task(&table);
        table = table.after(step);
        let relations = &task.steps[0].relations;
        let others = relations.iter().filter_map(Relation::object);
        let others: Vec<_> = others.map(str::to_owned).collect();
        assert!(others.iter().all(|other| binding.object(other).is_some()));
        others
    });
    let relations: Vec<_> = relations.collect();
    assert_eq!(
        relations,
        [vec!["PegB"], vec!["PegC"], vec!["PegC", "Ring0"]]
    );
}

#[test]
fn a_pattern_is_copied_to_the_other_side() {
    let mut objects = vec![
        cube("A1", Rgb::RED, 1.0, -6.0, -3.0),
        cube("B1", Rgb::BLUE, 1.0, -4.0, -3.0),
        cube("A2", Rgb::RED, 1.0, 2.0, -0.5),
        cube("B2", Rgb::BLUE, 1.0, 8.0, -1.5),
    ];
    let top = on(cube("T1", Rgb::GREEN, 1.0, 0.0, 0.0), &objects[0]);
    objects.push(top);
    objects.push(cube("T2", Rgb::GREEN, 1.0, 5.0, 2.0));
    let (_, after) = done(
        "Copy every block that is on the left side of the table to the right side.",
        &scene(objects.clone()),
    );
    let by = location(&after, "A2") - location(&after, "A1");
    assert!((location(&after, "B2") - location(&after, "B1")).distance(by) < 1e-3);
    assert!(by.x > 8.0);
    let (_, after) = done("Copy A1 to the right side.", &scene(objects));
    assert!(location(&after, "A2").x > 0.0);
}

#[test]
fn other_blocks_are_those_that_were_not_named() {
    let mut objects = cubes(&[Rgb::RED, Rgb::BLUE, Rgb::GREEN]);
    objects.push(plate("Plate", Rgb::WHITE, 3.0, 5.0, -3.0));
    let (steps, _) = done(
        "Put the red block on the plate. Put every other block aside.",
        &scene(objects),
    );
    assert_eq!(
        steps,
        [
            "Put the red block on the white plate.",
            "Put the blue block aside.",
            "Put the green block aside."
        ]
    );
}

#[test]
fn procedures_are_carried_out_for_every_object() {
    let mut objects = cubes(&[Rgb::RED, Rgb::RED, Rgb::GREEN]);
    objects.push(plate("Plate", Rgb::WHITE, 4.0, 5.0, -3.0));
    let table = scene(objects);
    let text = "To serve A and B: put A on B; if A is on the table, put A aside.\nServe every red block and the plate.";
    let (steps, after) = done(text, &table);
    assert_eq!(
        steps,
        ["Put C0 on the white plate.", "Put C1 on the white plate."]
    );
    assert_eq!(arrangement(&after).supports("C1"), ["Plate"]);
    let reason = refused("To spin A: spin A.\nSpin the green block.", &table);
    assert_eq!(reason.reason, "it calls itself too often");
}

#[test]
fn a_step_that_failed_comes_again_from_where_things_are() {
    let mut objects = cubes(&[Rgb::RED, Rgb::BLUE]);
    objects.push(plate("Plate", Rgb::WHITE, 3.0, 5.0, -3.0));
    let mut table = scene(objects);
    let program = "Put the red block on the plate.".parse().unwrap();
    let mut run = tabletop_program::ProgramRun::begin(&program, &table);
    let tabletop_program::NextStep::Step(first) = run.next_on(&table) else {
        panic!()
    };
    // It falls down beside the plate, and a block comes to lie on it.
    table.objects[0].pose.location = Vec3::new(3.0, -3.0, 0.5);
    table.objects[1].pose.location = Vec3::new(3.0, -3.0, 1.5);
    let tabletop_program::NextStep::Step(second) = run.next_on(&table) else {
        panic!()
    };
    assert_eq!(
        (second.object.as_str(), &second.relation),
        ("C1", &Relation::Aside)
    );
    table = table.after(&second);
    let tabletop_program::NextStep::Step(third) = run.next_on(&table) else {
        panic!()
    };
    assert_eq!(third.relation, first.relation);
    table = table.after(&third);
    assert_eq!(run.next_on(&table), tabletop_program::NextStep::Done);
}

/// A robot can make nothing disappear.
#[test]
fn removed_objects_that_were_laid_aside_are_out_of_play() {
    let table = scene(cubes(&[Rgb::RED, Rgb::BLUE, Rgb::RED]));
    let program = "Remove every red block. Put all blocks in a row.";
    let mut attempts = ProgramAttempts::begin(&program.parse().unwrap(), &table);
    let mut removed = Vec::new();
    while let NextAttempt::Try(attempt) = attempts.next_on(&table) {
        assert_eq!(attempt.step.relation, Relation::Destroyed);
        removed.push(attempt.step.object.clone());
        attempts.did(attempt);
    }
    assert_eq!(removed, ["C0", "C2"]);
    assert_eq!(attempts.next_on(&table), NextAttempt::Done);
}

#[test]
fn conditions_count_and_compare() {
    let table = scene(cubes(&[Rgb::RED, Rgb::RED, Rgb::BLUE]));
    for (condition, holds) in [
        ("there are more red blocks than blue blocks", true),
        ("there are more blue blocks than red blocks", false),
        ("there are two red blocks", true),
        ("there are three red blocks", false),
        ("there is no green block", true),
        ("any red block is on the table", true),
        ("every block is on the left side of the table", false),
        ("the blue block is to the left of C0", false),
    ] {
        let text = format!("If {condition}, remove the blue block.");
        let (steps, _, reason) = rehearsed(&text, &table);
        assert_eq!((steps.len() == 1, reason), (holds, None), "{condition}");
    }
}

#[test]
fn the_same_program_comes_to_the_same_steps() {
    let table = scene(cubes(&[Rgb::RED, Rgb::BLUE, Rgb::RED, Rgb::GREEN]));
    let text = "Put all blocks in a row, the leftmost first. Put all red blocks on each other.";
    assert_eq!(rehearsed(text, &table).0, rehearsed(text, &table).0);
}
