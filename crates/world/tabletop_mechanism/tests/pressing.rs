//! Buttons and switches that are pressed by forces.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use bevy::prelude::*;
use tabletop_core::{
    Control, ControlKind, Hand, IndicatorLights, LightState, Operator, PressMode, PushButton, Side,
    ToggleSwitch, prelude::*,
};
use tabletop_demonstrator::DemonstratorPlugin;
use tabletop_mechanism::MechanismPlugin;
use tabletop_physics::PhysicsPlugin;
use tabletop_scene::ScenePlugin;

fn app(items: Vec<SceneItem>) -> App {
    let mut app = App::new();
    app.add_plugins((
        MinimalPlugins,
        CorePlugin::default(),
        PhysicsPlugin::default(),
        ScenePlugin,
        DemonstratorPlugin,
        MechanismPlugin,
    ))
    .start();
    let scene = SceneSpec { items, ..default() };
    let set = SceneCommand::Set(Box::new(scene));
    app.world_mut().write_command(set);
    app.step(1);
    app
}

fn push_button(mode: PressMode) -> PushButton {
    PushButton {
        radius: 0.5,
        zspan: 0.4,
        travel: 0.2,
        force: 5.0,
        color: Rgb::RED,
        mode,
        state: 1,
    }
}

/// A button that stands on the table and hands its state on to `lamp`.
fn button(button: PushButton, mass: f32) -> SceneItem {
    let mut jointed = button.jointed("button", Pose::IDENTITY, mass, 0.0);
    if let Shape::Control(control) = &mut jointed.objects[1].shape {
        control.downstream = vec!["lamp".into()];
    }
    SceneItem::Jointed(jointed)
}

fn lamp() -> SceneItem {
    let lights = Control::new(ControlKind::IndicatorLights(IndicatorLights {
        radius: 0.1,
        zspan: 0.1,
        lights: 1,
        xspan: 1.0,
        states: vec![LightState::default(); 3],
    }));
    fixed_control("lamp", Vec3::X * 5.0, lights)
}

fn fixed_control(id: &str, at: Vec3, control: Control) -> SceneItem {
    let shape = Shape::Control(control);
    SceneItem::Object(ObjectSpec::new(id, Pose::at(at), 0.0, shape))
}

fn switch() -> SceneItem {
    let switch = Control::new(ControlKind::ToggleSwitch(ToggleSwitch {
        span: Vec3::new(1.0, 0.5, 0.2),
        angle: 10.0,
        color: Rgb::GRAY,
        pressed: Side::Left,
        states: 3,
    }));
    fixed_control("power", Vec3::ZERO, switch)
}

fn block(id: &str, at: Vec3, span: Vec3, mass: f32) -> SceneItem {
    let color = Rgb::GREEN;
    let shape = Shape::Block { span, color };
    SceneItem::Object(ObjectSpec::new(id, Pose::at(at), mass, shape))
}

fn state(app: &App, id: &str) -> u32 {
    let object = app.world().resource::<ObjectIndex>().get(id).unwrap();
    let spec = app.world().get::<ObjectSpec>(object).unwrap();
    spec.control(id).unwrap().state
}

fn height(app: &App, id: &str) -> f32 {
    let object = app.world().resource::<ObjectIndex>().get(id).unwrap();
    app.world().get::<Transform>(object).unwrap().translation.z
}

/// Who has triggered what during some ticks.
fn triggers(app: &mut App, ticks: u32) -> Vec<(Operator, String)> {
    let mut triggers = Vec::new();
    for _ in 0..ticks {
        app.world_mut().resource_mut::<Messages<SimFact>>().clear();
        app.step(1);
        let facts = app.world().resource::<Messages<SimFact>>();
        for fact in facts.get_cursor().read(facts) {
            if let SimFact::Mechanism(MechanismFact::Triggered { by, control, .. }) = fact {
                triggers.push((by.clone(), control.clone()));
            }
        }
    }
    triggers
}

fn by_object(id: &str, control: &str) -> (Operator, String) {
    (Operator::Object(id.into()), control.into())
}

#[test]
fn a_hand_pushes_a_button_of_any_size_and_it_springs_back() {
    for travel in [0.01, 0.05, 0.2, 1.0, 10.0] {
        for force in [0.1, 5.0, 1000.0] {
            for mode in [PressMode::Once, PressMode::Held] {
                let of_size = PushButton {
                    zspan: 2.0 * travel,
                    travel,
                    force,
                    ..push_button(mode)
                };
                let mut app = app(vec![button(of_size, 0.0), lamp()]);
                app.step(10);
                let up = height(&app, "button");
                assert_eq!(state(&app, "button"), 0);
                let (hand, control, part) = (Hand::Left, "button".to_owned(), None);
                app.world_mut().write_command(MechanismCommand::Trigger {
                    hand,
                    control,
                    part,
                });
                let mut seen = triggers(&mut app, 2);
                let is_long = travel > 1.0;
                seen.extend(triggers(&mut app, if is_long { 8 } else { 0 }));
                let by_hand = (Operator::Hand(hand), "button".to_owned());
                assert_eq!(seen, [by_hand]);
                let case = format!("{travel} {force} {mode:?}");
                assert_eq!(
                    (state(&app, "button"), state(&app, "lamp")),
                    (1, 1),
                    "{case}"
                );
                app.step(120);
                let after = if mode == PressMode::Held { 0 } else { 1 };
                assert_eq!(
                    (state(&app, "button"), state(&app, "lamp")),
                    (0, after),
                    "{case}"
                );
                assert!(
                    (height(&app, "button") - up).abs() < 0.02 * travel,
                    "{case}"
                );
            }
        }
    }
}

#[test]
fn a_weight_presses_a_button_while_it_lies_there_and_something_light_does_not() {
    for (mass, is_pressed) in [(0.05, false), (1.0, true), (20.0, true)] {
        for housing in [0.0, 1.0] {
            let mut app = app(vec![
                button(push_button(PressMode::Held), housing),
                lamp(),
                block("block", Vec3::Z * 1.16, Vec3::ONE, mass),
            ]);
            let seen = triggers(&mut app, 180);
            let expected = [by_object("block", "button")];
            assert_eq!(
                seen,
                expected[..usize::from(is_pressed)],
                "{mass} {housing}"
            );
            assert_eq!(state(&app, "lamp"), u32::from(is_pressed));
            let cap = height(&app, "button");
            assert!(cap > 0.2, "{mass} {housing}: the cap is at {cap}");
            let hand = Hand::Right;
            let object = "block".into();
            app.world_mut()
                .write_command(HandCommand::Grasp { hand, object });
            let location = Vec3::Z * 4.0;
            app.world_mut()
                .write_command(HandCommand::MoveTo { hand, location });
            app.step(90);
            assert_eq!((state(&app, "button"), state(&app, "lamp")), (0, 0));
        }
    }
}

#[test]
fn a_held_object_presses_a_button_no_further_than_its_travel() {
    let mut app = app(vec![
        button(push_button(PressMode::Once), 0.0),
        lamp(),
        block("poker", Vec3::Z * 3.0, Vec3::new(0.3, 0.3, 1.0), 1.0),
    ]);
    let hand = Hand::Left;
    let object = "poker".into();
    app.world_mut()
        .write_command(HandCommand::Grasp { hand, object });
    let location = Vec3::ZERO;
    app.world_mut()
        .write_command(HandCommand::MoveTo { hand, location });
    let up = height(&app, "button");
    assert_eq!(triggers(&mut app, 120), [by_object("poker", "button")]);
    assert_eq!(state(&app, "lamp"), 1);
    let down = up - height(&app, "button");
    assert!((0.1..0.26).contains(&down), "it is down by {down}");
}

#[test]
fn nothing_upstream_moves_a_button() {
    let upstream = Control {
        downstream: vec!["button".into()],
        ..Control::new(ControlKind::ToggleSwitch(ToggleSwitch {
            span: Vec3::new(1.0, 0.5, 0.2),
            angle: 10.0,
            color: Rgb::GRAY,
            pressed: Side::Left,
            states: 2,
        }))
    };
    let mut app = app(vec![
        button(push_button(PressMode::Held), 0.0),
        lamp(),
        fixed_control("power", Vec3::X * -3.0, upstream),
    ]);
    let (hand, control, part) = (Hand::Left, "power".to_owned(), None);
    app.world_mut().write_command(MechanismCommand::Trigger {
        hand,
        control,
        part,
    });
    app.step(2);
    assert_eq!(
        ["power", "button", "lamp"].map(|id| state(&app, id)),
        [1, 0, 0]
    );
}

#[test]
fn a_block_that_falls_on_the_raised_side_of_a_switch_presses_it() {
    let mut app = app(vec![
        switch(),
        block("block", Vec3::new(0.3, 0.0, 1.5), Vec3::splat(0.3), 0.2),
    ]);
    let seen = triggers(&mut app, 120);
    assert_eq!(seen, [by_object("block", "power")]);
    assert_eq!(state(&app, "power"), 1);
}

#[test]
fn a_plank_across_a_switch_presses_it_once() {
    let mut app = app(vec![
        switch(),
        block("plank", Vec3::Z * 0.6, Vec3::new(3.0, 0.4, 0.2), 1.0),
    ]);
    let seen = triggers(&mut app, 600);
    assert_eq!(seen, [by_object("plank", "power")]);
}

#[test]
fn a_feather_does_not_press_a_switch() {
    // It lies flat on the raised side, which is turned by 10°.
    let turned = Pose::from_degrees(Vec3::ZERO, Vec3::Y * -10.0);
    let mut feather = ObjectSpec::new(
        "feather",
        turned * Pose::at(Vec3::new(0.25, 0.0, 0.226)),
        0.02,
        Shape::Block {
            span: Vec3::new(0.2, 0.2, 0.05),
            color: Rgb::WHITE,
        },
    );
    feather.dynamics.friction = Some(10.0);
    let mut app = app(vec![switch(), SceneItem::Object(feather)]);
    assert_eq!(triggers(&mut app, 120), []);
    assert!(height(&app, "feather") > 0.2);
}
