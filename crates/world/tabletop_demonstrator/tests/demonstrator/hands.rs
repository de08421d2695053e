//! Effects of hands on a world.

use bevy::prelude::*;
use tabletop_core::{ChainSpec, LidBoxSpec, TICK_SECONDS, prelude::*};
use tabletop_geometry::quat_from_degrees;

use crate::desk::{Desk, block, object, two_blocks};

#[test]
fn a_block_is_stacked_on_another() {
    let mut desk = Desk::new(two_blocks());
    let hand = Hand::Any;
    desk.grasp(hand, "red").step(1);
    for location in [(2.0, 0.0, 4.0), (-2.0, 0.0, 4.0), (-2.0, 0.0, 1.5)] {
        desk.move_to(hand, location.into());
        desk.step(12);
    }
    assert!((desk.pose("red").location - Vec3::new(-2.0, 0.0, 1.5)).length() < 1e-3);
    desk.tell(HandCommand::Release(hand)).step(1);
    let sunk = 1.5 - desk.pose("red").location.z;
    assert!(sunk < 0.001, "it fell by {sunk} into the block below");
    desk.step(120);
    let stacked = desk.pose("red").location;
    assert!(
        (stacked - Vec3::new(-2.0, 0.0, 1.5)).length() < 0.005,
        "{stacked}"
    );
    let heard = desk.heard();
    assert_eq!(
        heard,
        [
            "segment",
            "AnyHand grasps red",
            "segment",
            "AnyHand releases red"
        ]
    );
}

#[test]
fn an_object_released_where_it_was_grasped_stays_there() {
    let blocks = |spans: &[f32]| {
        let mut top = 0.0;
        let place = |(number, span): (usize, &f32)| {
            let at = (0.0, 0.0, top + span / 2.0);
            top += span;
            object(
                &format!("block{number}"),
                at,
                1.0,
                block(Vec3::splat(*span)),
            )
        };
        spans.iter().enumerate().map(place).collect()
    };
    for spans in [&[1.0][..], &[2.0], &[2.0, 1.0], &[1.0, 1.0, 1.0, 1.0]] {
        let mut desk = Desk::new(blocks(spans));
        let top = format!("block{}", spans.len() - 1);
        let before = desk.pose(&top);
        desk.grasp(Hand::Any, &top).step(30);
        desk.tell(HandCommand::Release(Hand::Any)).step(120);
        let moved = desk.pose(&top).location.distance(before.location);
        assert!(moved < 0.0002, "{top} moved by {moved}");
    }
}

#[test]
fn a_held_object_does_not_fall_and_goes_exactly_where_it_is_sent() {
    let mut desk = Desk::new(two_blocks());
    let location = Vec3::new(1.234, -2.5, 6.789);
    desk.grasp(Hand::Left, "red").move_to(Hand::Left, location);
    desk.step(200);
    assert_eq!(desk.pose("red").location, location);
}

#[test]
fn a_mouse_jump_of_any_size_never_enters_table_walls_or_the_other_hands_object() {
    let mut items = two_blocks();
    items.push(object(
        "wall",
        (5.0, 0.0, 3.0),
        0.0,
        block((0.05, 12.0, 6.0)),
    ));
    let mut desk = Desk::new(items);
    desk.grasp(Hand::Left, "red").grasp(Hand::Right, "green");
    desk.move_to(Hand::Right, Vec3::new(-1.0, 0.0, 0.5))
        .step(20);
    let mut state = 1u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32 * 2.0 - 1.0
    };
    for _ in 0..300 {
        let far = Vec3::new(random(), random() * 0.1, random()) * 1e6f32.powf(random());
        desk.move_to(Hand::Left, far);
        desk.tell(HandCommand::Turn {
            hand: Hand::Left,
            axis: Vec3::new(random(), random(), random() + 1.5),
            degrees: random() * 90.0,
        });
        desk.step(3);
        let red = desk.pose("red");
        let corners =
            [-0.5, 0.5].map(|x| [-0.5, 0.5].map(|y| [-0.5, 0.5].map(|z| Vec3::new(x, y, z))));
        for corner in corners.as_flattened().as_flattened() {
            let at = red * *corner;
            let over_the_table = at.x.abs() < 9.9 && at.y.abs() < 5.9;
            let beside_it = red.location.x.abs() > 9.0 || red.location.y.abs() > 5.0;
            assert!(
                !over_the_table || beside_it || at.z > -0.002,
                "corner at {at}, {red:?}"
            );
            assert!(
                (at - Vec3::new(-1.0, 0.0, 0.5)).abs().max_element() > 0.497,
                "corner at {at}"
            );
        }
    }
    let other = desk.pose("green").location;
    assert!(
        (other - Vec3::new(-1.0, 0.0, 0.5)).length() < 1e-3,
        "{other}"
    );
}

#[test]
fn a_held_ball_that_slides_down_a_roof_does_not_enter_the_table() {
    let shape = Shape::Sphere {
        radius: 0.5,
        color: Rgb::GRAY,
    };
    let slanted = Pose::from_degrees(Vec3::new(2.0, 0.0, 1.6), Vec3::Y * 45.0);
    let roof = ObjectSpec::new("roof", slanted, 0.0, block((4.0, 4.0, 0.2)));
    let items = vec![
        object("ball", (-4.0, 0.0, 0.5), 1.0, shape),
        SceneItem::Object(roof),
    ];
    for start in 0..8 {
        let mut desk = Desk::new(items.clone());
        let start = Vec3::new(-4.0 + 0.08 * start as f32, 0.0, 0.65);
        desk.grasp(Hand::Left, "ball").move_to(Hand::Left, start);
        desk.step(60).move_to(Hand::Left, start + Vec3::X * 12.0);
        for _ in 0..20 {
            let at = desk.step(1).pose("ball").location;
            assert!(at.z > 0.5 - 1e-3, "{at}");
        }
    }
}

#[test]
fn a_pushed_block_moves_and_is_not_flung_when_the_hand_lets_go() {
    let mut desk = Desk::new(two_blocks());
    desk.grasp(Hand::Right, "red")
        .move_to(Hand::Right, Vec3::new(-4.0, 0.0, 0.5));
    desk.step(90);
    let pushed = desk.pose("green").location;
    assert!(pushed.x < -4.9, "it was pushed to {pushed}");
    desk.tell(HandCommand::Release(Hand::Right)).step(2);
    assert!(desk.speed("red") < 3.0 && desk.speed("green") < 3.0);
    desk.step(120);
    assert!(
        desk.pose("red")
            .location
            .distance(Vec3::new(-4.0, 0.0, 0.5))
            < 0.1
    );
}

/// The largest distance of a box from where it is sent, on its way with something in it at a speed, in units/s; and how far that is then from the
/// middle of the box, seen from above.
fn lag_of_a_loaded_box(load: Shape, speed: f32) -> (f32, f32) {
    let span = Vec3::new(3.0, 3.0, 1.5);
    let tray = Shape::Box {
        span,
        color: Rgb::GREEN,
        thickness: 0.2,
    };
    let mut desk = Desk::new(vec![
        object("tray", (-4.0, 0.0, 0.75), 1.0, tray),
        object("load", (-4.0, 0.0, 0.6), 1.0, load),
    ]);
    desk.grasp(Hand::Right, "tray").step(1);
    let mut target = Vec3::new(-4.0, 0.0, 0.75);
    let mut lag = 0.0_f32;
    for (way, ticks) in [
        (Vec3::Z, 90),
        (Vec3::X, 150),
        (Vec3::Y, 60),
        (Vec3::NEG_X, 60),
    ] {
        for _ in 0..ticks {
            target += way * speed * TICK_SECONDS;
            desk.move_to(Hand::Right, target).step(1);
            lag = lag.max(desk.pose("tray").location.distance(target));
        }
    }
    let [tray, load] = ["tray", "load"].map(|id| desk.pose(id).location);
    (lag, tray.truncate().distance(load.truncate()))
}

#[test]
fn a_box_goes_where_it_is_sent_whatever_lies_or_rolls_in_it() {
    let ball = || Shape::Sphere {
        radius: 0.4,
        color: Rgb::BLUE,
    };
    for (load, name) in [(ball(), "ball"), (block(Vec3::splat(0.8)), "block")] {
        for speed in [0.5, 2.0, 5.0] {
            let (lag, aside) = lag_of_a_loaded_box(load.clone(), speed);
            let two_ticks = 2.0 * speed * TICK_SECONDS;
            assert!(
                lag < two_ticks,
                "{name} at {speed}: the box is {lag} behind"
            );
            assert!(
                aside < 1.4,
                "{name} at {speed}: it is {aside} from the middle"
            );
        }
    }
}

#[test]
fn a_block_squeezed_against_a_wall_stops_the_hand_and_does_not_explode() {
    let mut items = two_blocks();
    items.push(object(
        "wall",
        (-4.0, 0.0, 2.0),
        0.0,
        block((1.0, 8.0, 4.0)),
    ));
    let mut desk = Desk::new(items);
    desk.grasp(Hand::Right, "red")
        .move_to(Hand::Right, Vec3::new(-9.0, 0.0, 0.5));
    desk.step(180);
    let (hand, block) = (desk.pose("red").location, desk.pose("green").location);
    assert!(
        hand.x > -2.6 && (block.x + 3.0).abs() < 0.2,
        "hand at {hand}, block at {block}"
    );
    desk.tell(HandCommand::Release(Hand::Right));
    let mut fastest = 0.0f32;
    for _ in 0..60 {
        desk.step(1);
        fastest = fastest.max(desk.speed("green")).max(desk.speed("red"));
    }
    assert!(fastest < 5.0, "something flew off at {fastest} units/s");
}

/// The number of ticks in which the lowest block of a stack of large ones is deep in the table, while a hand presses a small block on the
/// uppermost in many ways.
fn deep_ticks_under_a_hand(count: usize) -> u32 {
    let mut deep_ticks = 0;
    let top = 1.5 * (count - 1) as f32;
    for seed in 0..40 {
        let mut random = tabletop_core::Random::new(seed);
        let large = |number: usize| {
            let location = (0.0, 0.0, 0.75 + 1.5 * number as f32);
            object(
                &format!("large{number}"),
                location,
                1.0,
                block(Vec3::splat(1.5)),
            )
        };
        let held = object("held", (4.0, 0.0, 0.5), 1.0, block(Vec3::ONE));
        let mut desk = Desk::new((0..count).map(large).chain([held]).collect());
        let mut beside = || random.between((-1.0, 1.0));
        let above = Vec3::new(beside(), beside(), 3.0 + top);
        let below = Vec3::new(beside(), beside(), 0.5 + top);
        let axis = Vec3::new(beside(), beside(), beside());
        let (hand, degrees) = (Hand::Left, 90.0 * beside());
        desk.grasp(hand, "held").move_to(hand, above).step(60);
        let turn = HandCommand::Turn {
            hand,
            axis,
            degrees,
        };
        desk.tell(turn).step(30).move_to(hand, below);
        for _ in 0..120 {
            desk.step(1);
            let Pose { location, rotation } = desk.pose("large0");
            let reach = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| (rotation * axis).z.abs() * 0.75);
            let depth = reach.iter().sum::<f32>() - location.z;
            deep_ticks += u32::from(depth > 0.1);
        }
    }
    deep_ticks
}

#[test]
fn a_hand_presses_no_block_into_the_table() {
    assert_eq!(deep_ticks_under_a_hand(1), 0);
}

#[test]
fn a_hand_presses_no_block_through_another_into_the_table() {
    assert_eq!(deep_ticks_under_a_hand(2), 0);
}

#[test]
fn turning_something_in_a_box_does_not_press_the_box_into_the_table() {
    let mut deepest = 0.0f32;
    for seed in 0..20 {
        let mut random = tabletop_core::Random::new(seed);
        let box_shape = Shape::Box {
            span: Vec3::new(5.0, 5.0, 3.0),
            thickness: 0.5,
            color: Rgb::GRAY,
        };
        let mut desk = Desk::new(vec![
            object("box", (0.0, 0.0, 1.5), 3.0, box_shape),
            object("held", (5.0, 0.0, 0.4), 1.0, block((1.8, 0.8, 0.8))),
        ]);
        let mut beside = || random.between((-1.0, 1.0));
        let inside = Vec3::new(beside(), beside(), 0.95);
        let axis = Vec3::new(beside(), beside(), beside());
        let (hand, degrees) = (Hand::Left, 90.0 * beside());
        desk.grasp(hand, "held")
            .move_to(hand, Vec3::new(5.0, 0.0, 5.0))
            .step(30)
            .move_to(hand, inside.with_z(5.0))
            .step(30)
            .move_to(hand, inside)
            .step(30);
        desk.tell(HandCommand::Turn {
            hand,
            axis,
            degrees,
        });
        for _ in 0..60 {
            desk.step(1);
            let Pose { location, rotation } = desk.pose("box");
            let up = rotation.inverse() * Vec3::Z;
            let depth = up.abs().dot(Vec3::new(2.5, 2.5, 1.5)) - location.z;
            deepest = deepest.max(depth);
        }
    }
    assert!(deepest < 0.05, "{deepest}");
}

#[test]
fn a_fixed_object_is_moved_as_one_piece_with_its_collider() {
    let mut items = two_blocks();
    items.push(object("post", (0.0, 3.0, 1.0), 0.0, block((1.0, 1.0, 2.0))));
    let mut desk = Desk::new(items);
    desk.grasp(Hand::Both, "post")
        .move_to(Hand::Both, Vec3::new(2.0, 0.0, 3.0));
    desk.step(60)
        .tell(HandCommand::Release(Hand::Both))
        .step(120);
    assert_eq!(desk.pose("post").location, Vec3::new(2.0, 0.0, 3.0));
    desk.grasp(Hand::Left, "red")
        .move_to(Hand::Left, Vec3::new(2.0, 0.0, 9.0));
    desk.step(120);
    let stopped = desk.pose("red").location;
    assert!(
        (stopped.z - 1.5).abs() < 0.02,
        "the block went to {stopped}"
    );
}

#[test]
fn hand_off_and_forced_releases_are_reported_under_the_hand_that_held() {
    let mut desk = Desk::new(two_blocks());
    desk.grasp(Hand::Left, "red").step(1);
    desk.grasp(Hand::Right, "red").step(1);
    desk.grasp(Hand::Both, "green").step(1);
    assert_eq!(
        desk.heard(),
        [
            "segment",
            "LeftHand grasps red",
            "segment",
            "LeftHand releases red",
            "segment",
            "RightHand grasps red",
            "segment",
            "RightHand releases red",
            "segment",
            "BothHands grasps green",
        ]
    );
    desk.grasp(Hand::Any, "red").step(1);
    assert_eq!(
        desk.heard(),
        ["refused: AnyHand cannot grasp `red`: both hands are occupied"]
    );
}

#[test]
fn facts_of_a_hand_name_the_command_that_caused_them() {
    let mut desk = Desk::new(two_blocks());
    desk.grasp(Hand::Left, "red").step(1);
    let hand = Hand::Right;
    let (object, id) = ("red".to_owned(), "red".to_owned());
    let world = desk.0.world_mut();
    let cause = world.write_command(HandCommand::Grasp { hand, object });
    world.resource_mut::<Messages<SimFact>>().clear();
    desk.step(1);
    let facts: Vec<_> = desk
        .0
        .world_mut()
        .resource_mut::<Messages<SimFact>>()
        .drain()
        .collect();
    assert_eq!(
        facts,
        [
            SimFact::History(HistoryFact::SegmentBegun { cause }),
            SimFact::Hand(HandFact::Released {
                cause: Some(cause),
                hand: Hand::Left,
                id: id.clone(),
            }),
            SimFact::History(HistoryFact::SegmentBegun { cause }),
            SimFact::Hand(HandFact::Grasped { cause, hand, id }),
        ]
    );
}

#[test]
fn a_destroyed_object_is_deleted_first() {
    let mut desk = Desk::new(two_blocks());
    desk.grasp(Hand::Left, "red").step(1);
    desk.heard();
    desk.tell(HandCommand::Destroy(Hand::Left)).step(1);
    assert_eq!(
        desk.heard(),
        ["segment", "red is gone", "LeftHand destroys red"]
    );
    assert_eq!(desk.0.world().resource::<Hands>().held_by(Hand::Left), None);
}

#[test]
fn impossible_commands_are_refused_and_change_nothing() {
    let mut desk = Desk::new(two_blocks());
    desk.grasp(Hand::Left, "no such thing");
    desk.move_to(Hand::Left, Vec3::ONE);
    desk.tell(HandCommand::Destroy(Hand::Right));
    desk.tell(HandCommand::Release(Hand::Right)).step(1);
    assert_eq!(desk.heard().len(), 3);
    desk.grasp(Hand::Left, "red").step(1);
    desk.move_to(Hand::Left, Vec3::new(f32::NAN, 0.0, 0.0));
    desk.tell(HandCommand::Turn {
        hand: Hand::Left,
        axis: Vec3::ZERO,
        degrees: 45.0,
    });
    desk.step(30);
    assert!(desk.pose("red").location.distance(Vec3::new(2.0, 0.0, 0.5)) < 0.001);
}

#[test]
fn hands_do_not_act_while_the_simulation_is_paused() {
    let mut desk = Desk::new(two_blocks());
    desk.tell(ClockCommand::SetPaused(true));
    desk.grasp(Hand::Left, "red").step(1);
    desk.tell(ClockCommand::SetPaused(false)).step(3);
    assert_eq!(desk.0.world().resource::<Hands>().held_by(Hand::Left), None);
    assert_eq!(
        desk.heard(),
        ["refused: hands cannot act while the simulation is paused"]
    );
}

#[test]
fn a_held_lid_follows_its_slider() {
    let lidbox = LidBoxSpec {
        id: "b".into(),
        pose: Pose::new(Vec3::Z * 2.5, quat_from_degrees(Vec3::ZERO)),
        span: Vec3::new(6.0, 5.0, 5.0),
        thickness: 0.6,
        box_mass: 9.0,
        lid_mass: 1.0,
        color: Rgb::GRAY,
        handle_span: Vec3::new(1.0, 2.0, 0.6),
        handle_thickness: 0.2,
        handle_color: Rgb::GRAY,
        descriptions: Vec::new(),
    };
    let mut desk = Desk::new(vec![SceneItem::LidBox(lidbox)]);
    desk.grasp(Hand::Left, "b-lid")
        .move_to(Hand::Left, Vec3::new(-4.0, 0.0, 5.3));
    desk.step(120);
    let lid = desk.pose("b-box").inverse() * desk.pose("b-lid");
    assert!(
        (lid.location - Vec3::new(-4.0, 0.0, 2.8)).length() < 0.1,
        "{lid:?}"
    );
    assert!(lid.rotation.angle_between(Quat::IDENTITY).to_degrees() < 0.5);
    desk.tell(HandCommand::Release(Hand::Left)).step(120);
    let after = desk.pose("b-box").inverse() * desk.pose("b-lid");
    assert!(after.location.distance(lid.location) < 0.05, "{after:?}");
}

#[test]
fn a_held_link_follows_its_chain() {
    let chain = ChainSpec {
        id: "c".into(),
        start: Vec3::new(6.0, -2.0, 4.0),
        end: Vec3::new(-6.0, -2.0, 4.0),
        link_span: Vec3::new(0.1, 1.0, 0.1),
        link_count: 14,
        link_padding: 0.05,
        link_mass: 1.0,
        color: Rgb::GRAY,
    };
    let mut desk = Desk::new(vec![SceneItem::Chain(chain)]);
    desk.step(240);
    let hanging = desk.pose("c-link6").location.z;
    desk.grasp(Hand::Left, "c-link6")
        .move_to(Hand::Left, Vec3::new(0.4, -2.0, 4.5));
    desk.step(120);
    let lifted = desk.pose("c-link6").location;
    assert!(lifted.z > hanging + 1.0, "from {hanging} to {lifted}");
    desk.move_to(Hand::Left, Vec3::new(0.0, -2.0, 1000.0))
        .step(120);
    let taut = desk.pose("c-link6").location;
    assert!(taut.is_finite() && taut.z < 9.5, "torn to {taut}");
    desk.tell(HandCommand::Release(Hand::Left)).step(300);
    let back = desk.pose("c-link6").location.z;
    assert!(
        (back - hanging).abs() < 0.3,
        "it hangs at {back}, not {hanging}"
    );
}
