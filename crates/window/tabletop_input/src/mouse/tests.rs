use super::*;
use crate::test_world::{TestWorld, towards};
use tabletop_core::{Hand, SimCommand};

const ABOVE_TABLE: Vec3 = Vec3::new(6.0, 3.0, 0.0);

/// A world in which the mouse drags in the level plane.
fn level() -> TestWorld {
    let mut test = TestWorld::new(plugin);
    test.app.insert_resource(Dragging {
        is_level: true,
        ..default()
    });
    test.app.insert_resource(DragPlane {
        is_level: true,
        ..default()
    });
    test
}

/// Points at a point, with the cursor at these pixels.
fn point(test: &mut TestWorld, cursor: f32, at: Vec3) {
    test.app.insert_resource(Pointer {
        ray: Some(towards(at)),
        cursor: Some(Vec2::splat(cursor)),
        is_panels: false,
    });
}

fn hold_at(test: &mut TestWorld, object: Entity, place: Vec3) {
    let world = test.app.world_mut();
    let hand = world.resource::<Hands>().selected;
    world.resource_mut::<Hands>().set_held(hand, Some(object));
    world.get_mut::<Transform>(object).unwrap().translation = place;
}

fn sent(commands: &[SimCommand]) -> Vec3 {
    match commands {
        [SimCommand::Hand(HandCommand::MoveTo { location, .. })] => *location,
        other => panic!("{other:?}"),
    }
}

fn grasp(hand: Hand, id: &str) -> SimCommand {
    SimCommand::Hand(HandCommand::Grasp {
        hand,
        object: id.into(),
    })
}

#[test]
fn an_object_is_taken_when_the_button_comes_up() {
    let mut test = TestWorld::new(plugin);
    test.block("red", Vec3::Z);
    test.point_at(Vec3::Z);
    assert_eq!(test.press(), []);
    assert_eq!(test.hold_still(), []);
    assert_eq!(test.come_up(), [grasp(Hand::Any, "red")]);
    assert_eq!(test.hold_still(), []);
}

#[test]
fn a_click_begins_and_ends_on_the_same_object() {
    let mut test = TestWorld::new(plugin);
    test.block("red", Vec3::Z);
    test.block("blue", Vec3::new(5.0, 0.0, 1.0));
    for (down, up) in [
        (Vec3::Z, ABOVE_TABLE),
        (ABOVE_TABLE, Vec3::Z),
        (Vec3::Z, Vec3::new(5.0, 0.0, 1.0)),
    ] {
        test.point_at(down);
        test.press();
        test.point_at(up);
        assert_eq!(test.come_up(), []);
    }
}

#[test]
fn a_press_beside_the_held_object_releases_it_and_takes_nothing() {
    let mut test = TestWorld::new(plugin);
    test.hold("red", Vec3::Z);
    test.block("blue", Vec3::new(5.0, 0.0, 1.0));
    for beside in [ABOVE_TABLE, Vec3::new(5.0, 0.0, 1.0)] {
        test.point_at(beside);
        assert_eq!(
            test.press(),
            [SimCommand::Hand(HandCommand::Release(Hand::Any))]
        );
        assert_eq!(test.come_up(), []);
    }
}

/// Presses on the red block, and moves the cursor with the button down until the block is there.
fn drag_red(test: &mut TestWorld, red: Entity, to: Vec3) {
    point(test, 100.0, Vec3::Z);
    test.press();
    point(test, 150.0, to);
    assert_eq!(test.hold_still(), [grasp(Hand::Any, "red")]);
    hold_at(test, red, Vec3::Z);
    let location = sent(&test.hold_still());
    assert!(location.distance(to) < 0.05, "{location}");
    hold_at(test, red, location);
}

#[test]
fn in_the_upright_plane_a_drag_takes_moves_and_keeps_hold() {
    let mut test = TestWorld::new(plugin);
    let red = test.block("red", Vec3::Z);
    drag_red(&mut test, red, Vec3::new(-4.0, 0.0, 3.0));
    assert_eq!(test.come_up(), []);
    assert_eq!(test.hold_still(), []);
}

#[test]
fn a_drag_of_another_object_lets_go_and_takes_that_one() {
    let mut test = TestWorld::new(plugin);
    test.hold("blue", Vec3::new(5.0, 0.0, 1.0));
    let red = test.block("red", Vec3::Z);
    point(&mut test, 100.0, Vec3::Z);
    assert_eq!(
        test.press(),
        [SimCommand::Hand(HandCommand::Release(Hand::Any))]
    );
    test.app
        .world_mut()
        .resource_mut::<Hands>()
        .set_held(Hand::Any, None);
    point(&mut test, 150.0, Vec3::new(1.0, 0.0, 1.0));
    assert_eq!(test.hold_still(), [grasp(Hand::Any, "red")]);
    hold_at(&mut test, red, Vec3::Z);
    assert!(sent(&test.hold_still()).x > 0.9);
}

#[test]
fn a_press_that_ends_typing_does_not_release() {
    let mut test = TestWorld::new(plugin);
    test.hold("red", Vec3::Z);
    test.app.insert_resource(KeyboardFocus::Text);
    test.point_at(ABOVE_TABLE);
    assert_eq!(test.press(), []);
    assert_eq!(test.come_up(), []);
    test.app.insert_resource(KeyboardFocus::World);
    assert_eq!(
        test.press(),
        [SimCommand::Hand(HandCommand::Release(Hand::Any))]
    );
}

#[test]
fn a_press_on_a_panel_is_the_panels() {
    let mut test = TestWorld::new(plugin);
    test.hold("red", Vec3::Z);
    test.point_at(ABOVE_TABLE);
    test.point_at_panel();
    assert_eq!(test.press(), []);
    assert_eq!(test.come_up(), []);
}

#[test]
fn the_held_object_follows_the_cursor_while_the_button_is_down() {
    let mut test = TestWorld::new(plugin);
    let red = test.hold("red", Vec3::Z);
    test.point_at(Vec3::Z);
    assert_eq!(test.press(), []);
    test.point_at(Vec3::new(3.0, 0.0, 4.0));
    let commands = test.hold_still();
    let [SimCommand::Hand(HandCommand::MoveTo { hand, location })] = commands[..] else {
        panic!("{commands:?}");
    };
    assert_eq!(hand, Hand::Any);
    assert!(location.distance(Vec3::new(3.0, 0.0, 4.0)) < 1e-4);
    assert_eq!(test.hold_still(), []);
    assert!(test.app.world().resource::<MousePress>().is_drag());
    assert_eq!(test.come_up(), []);
    test.point_at(Vec3::Z * 3.0);
    assert_eq!(test.hold_still(), []);
    assert_eq!(test.held(), Some(red));
}

#[test]
fn a_drag_ends_with_the_hold_the_selection_or_a_pause() {
    let end_by: [fn(&mut TestWorld); 4] = [
        |test| test.let_go(),
        |test| test.app.world_mut().resource_mut::<Hands>().selected = Hand::Left,
        |test| test.app.world_mut().resource_mut::<Paused>().0 = true,
        |test| test.look_along(Ray3d::new(towards(Vec3::Z).origin, Dir3::NEG_Y)),
    ];
    for end in end_by {
        let mut test = TestWorld::new(plugin);
        test.hold("red", Vec3::Z);
        test.point_at(Vec3::Z);
        test.press();
        assert!(test.app.world().resource::<MousePress>().is_drag());
        end(&mut test);
        assert_eq!(test.hold_still(), []);
        assert!(!test.app.world().resource::<MousePress>().is_drag());
    }
}

#[test]
fn outside_the_window_a_drag_waits() {
    let mut test = TestWorld::new(plugin);
    test.hold("red", Vec3::Z);
    test.point_at(Vec3::Z);
    test.press();
    test.point_nowhere();
    assert_eq!(test.hold_still(), []);
    test.point_at(Vec3::Z * 2.0);
    assert_eq!(test.hold_still().len(), 1);
}

#[test]
fn a_pause_stops_clicks() {
    let mut test = TestWorld::new(plugin);
    test.block("red", Vec3::Z);
    test.app.world_mut().resource_mut::<Paused>().0 = true;
    test.point_at(Vec3::Z);
    assert_eq!(test.press(), []);
    assert_eq!(test.come_up(), []);
}

#[test]
fn in_the_level_plane_a_drag_takes_moves_and_lets_go() {
    let mut test = level();
    let red = test.block("red", Vec3::Z);
    drag_red(&mut test, red, Vec3::new(-4.0, 2.0, 1.0));
    let released = SimCommand::Hand(HandCommand::Release(Hand::Any));
    assert_eq!(test.come_up(), [released]);
}

#[test]
fn a_stroke_that_is_over_before_the_hand_has_taken_the_object_still_moves_it() {
    let mut test = level();
    let red = test.block("red", Vec3::Z);
    point(&mut test, 100.0, Vec3::Z);
    test.press();
    let to = Vec3::new(-4.0, 2.0, 1.0);
    point(&mut test, 150.0, to);
    assert_eq!(test.come_up(), [grasp(Hand::Any, "red")]);
    hold_at(&mut test, red, Vec3::Z);
    let location = sent(&test.hold_still());
    assert!(location.distance(to) < 0.05, "{location}");
    hold_at(&mut test, red, location);
    let released = SimCommand::Hand(HandCommand::Release(Hand::Any));
    assert_eq!(test.hold_still(), [released]);
}

#[test]
fn what_was_taken_for_a_drag_is_let_go_of_in_the_upright_plane_too() {
    let mut test = level();
    let red = test.block("red", Vec3::Z);
    point(&mut test, 100.0, Vec3::Z);
    test.press();
    point(&mut test, 150.0, Vec3::new(2.0, 0.0, 1.0));
    test.hold_still();
    hold_at(&mut test, red, Vec3::Z);
    test.hold_still();
    test.app.insert_resource(DragPlane::default());
    test.hold_still();
    point(&mut test, 200.0, Vec3::new(2.0, 0.0, 3.0));
    let raised = test.hold_still();
    hold_at(&mut test, red, sent(&raised));
    let released = SimCommand::Hand(HandCommand::Release(Hand::Any));
    assert_eq!(test.come_up(), [released]);
}

#[test]
fn a_hand_that_cannot_take_an_object_drags_nothing() {
    let mut test = level();
    test.block("red", Vec3::Z);
    point(&mut test, 100.0, Vec3::Z);
    test.press();
    point(&mut test, 150.0, Vec3::X);
    test.hold_still();
    (0..=LONGEST_TAKING).for_each(|_| assert_eq!(test.hold_still(), []));
    assert_eq!(*test.app.world().resource::<MousePress>(), MousePress::Idle);
}

#[test]
fn what_is_dragged_over_another_object_goes_up_and_then_onto_it() {
    let mut test = level();
    test.block("blue", Vec3::new(5.0, 0.0, 1.0));
    let red = test.hold("red", Vec3::Z);
    point(&mut test, 100.0, Vec3::Z);
    test.press();
    point(&mut test, 150.0, Vec3::new(5.0, 0.0, 1.0));
    let up = sent(&test.hold_still());
    assert!(up.distance(Vec3::Z * 3.0) < 0.05, "{up}");
    hold_at(&mut test, red, up);
    // The button is up before the object has arrived.
    let onto = sent(&test.come_up());
    assert!(onto.distance(Vec3::new(5.0, 0.0, 3.0)) < 0.05, "{onto}");
    hold_at(&mut test, red, onto);
    assert_eq!(test.hold_still(), [], "it was held before the drag");
    assert_eq!(*test.app.world().resource::<MousePress>(), MousePress::Idle);
}

#[test]
fn the_wheel_raises_what_is_dragged_in_the_level_plane() {
    let mut test = level();
    test.hold("red", Vec3::Z);
    point(&mut test, 100.0, Vec3::Z);
    test.press();
    test.app.world_mut().write_message(MouseWheel {
        unit: bevy::input::mouse::MouseScrollUnit::Line,
        x: 0.0,
        y: 4.0,
        window: Entity::PLACEHOLDER,
        phase: bevy::input::touch::TouchPhase::Moved,
    });
    let raised = sent(&test.hold_still());
    assert!(raised.distance(Vec3::Z * 2.0) < 0.05, "{raised}");
}

#[test]
fn what_is_in_the_way_does_not_hold_a_drag_for_ever() {
    let mut test = level();
    test.hold("red", Vec3::Z);
    point(&mut test, 100.0, Vec3::Z);
    test.press();
    point(&mut test, 150.0, Vec3::new(-4.0, 0.0, 1.0));
    test.hold_still();
    test.come_up();
    assert!(test.app.world().resource::<MousePress>().is_drag());
    (0..=LONGEST_SETTLING).for_each(|_| _ = test.hold_still());
    assert_eq!(*test.app.world().resource::<MousePress>(), MousePress::Idle);
}

#[test]
fn an_arrow_turns_what_is_held_in_steps_if_wished() {
    for (turns_in_steps, least) in [(false, 1.0), (true, 15.0)] {
        let mut test = TestWorld::new(plugin);
        test.app.insert_resource(Dragging {
            turns_in_steps,
            ..default()
        });
        test.hold("red", Vec3::Z);
        let tip = Vec3::Z * 5.8;
        test.point_at(tip);
        assert_eq!(test.press(), []);
        test.point_at(tip + Vec3::X * 0.7);
        let commands = test.hold_still();
        let [SimCommand::Hand(HandCommand::Turn { axis, degrees, .. })] = commands[..] else {
            panic!("{commands:?}");
        };
        assert_eq!(axis, Vec3::Z);
        assert!(degrees >= least && degrees % least == 0.0, "{degrees}");
        assert_eq!(test.come_up(), []);
    }
}
