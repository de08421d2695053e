//! Controls and bonds on the table.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use bevy::prelude::*;
use tabletop_core::{
    BondEnd, BondPoint, Bonds, Change, Control, ControlKind, CustomControl, CustomState,
    GuestPoint, Hand, HostPoint, IndicatorLights, LightState, Operator, Part, RobotLayout, Side,
    TightnessStep, ToggleSwitch, prelude::*,
};
use tabletop_demonstrator::DemonstratorPlugin;
use tabletop_mechanism::MechanismPlugin;
use tabletop_physics::PhysicsPlugin;
use tabletop_scene::ScenePlugin;

fn app(objects: Vec<ObjectSpec>) -> App {
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
    let items = objects.into_iter().map(SceneItem::Object).collect();
    let scene = SceneSpec { items, ..default() };
    let set = SceneCommand::Set(Box::new(scene));
    app.world_mut().write_command(set);
    app.step(1);
    app
}

fn control(id: &str, at: Vec3, control: Control) -> ObjectSpec {
    ObjectSpec::new(id, Pose::at(at), 0.0, Shape::Control(control))
}

fn switch(downstream: &[&str]) -> Control {
    Control {
        downstream: downstream.iter().map(|id| (*id).to_owned()).collect(),
        ..Control::new(ControlKind::ToggleSwitch(ToggleSwitch {
            span: Vec3::new(1.0, 0.5, 0.2),
            angle: 10.0,
            color: Rgb::GRAY,
            pressed: Side::Left,
            states: 3,
        }))
    }
}

fn lights(states: usize, downstream: &[&str]) -> Control {
    Control {
        downstream: downstream.iter().map(|id| (*id).to_owned()).collect(),
        ..Control::new(ControlKind::IndicatorLights(IndicatorLights {
            radius: 0.1,
            zspan: 0.1,
            lights: 1,
            xspan: 1.0,
            states: vec![LightState::default(); states],
        }))
    }
}

fn state(app: &App, id: &str) -> u32 {
    let index = app.world().resource::<ObjectIndex>();
    let mut specs = index
        .iter()
        .filter_map(|object| app.world().get::<ObjectSpec>(object));
    specs
        .find_map(|spec| spec.control(id))
        .unwrap()
        .shown_state()
}

fn pose(app: &App, id: &str) -> Pose {
    let object = app.world().resource::<ObjectIndex>().get(id).unwrap();
    app.world().get::<Transform>(object).unwrap().into()
}

fn do_it(app: &mut App, command: MechanismCommand) -> Vec<SimFact> {
    app.world_mut().resource_mut::<Messages<SimFact>>().clear();
    app.world_mut().write_command(command);
    app.step(1);
    let facts = app.world().resource::<Messages<SimFact>>();
    facts.get_cursor().read(facts).cloned().collect()
}

fn trigger(app: &mut App, id: &str) -> Vec<SimFact> {
    let (hand, control, part) = (Hand::Right, id.to_owned(), None);
    let trigger = MechanismCommand::Trigger {
        hand,
        control,
        part,
    };
    do_it(app, trigger)
}

#[test]
fn a_state_goes_downstream_and_round_a_circle_once() {
    let mut app = app(vec![
        control("power", Vec3::X * 3.0, switch(&["three", "two"])),
        control("three", Vec3::ZERO, lights(3, &["two", "power"])),
        control("two", Vec3::X * -3.0, lights(2, &["nothing"])),
    ]);
    for expected in [[1, 1, 1], [2, 2, 1], [0, 0, 0]] {
        trigger(&mut app, "power");
        assert_eq!(
            ["power", "three", "two"].map(|id| state(&app, id)),
            expected
        );
    }
    // A light is not triggered.
    let facts = trigger(&mut app, "two");
    assert!(matches!(facts[..], [SimFact::Refused { .. }]), "{facts:?}");
}

#[test]
fn states_are_passed_on_when_a_scene_is_set_and_nothing_is_reported() {
    let on = Control {
        state: 1,
        ..switch(&["light"])
    };
    let app = app(vec![
        control("light", Vec3::ZERO, lights(2, &[])),
        control("power", Vec3::X * 3.0, on),
    ]);
    assert_eq!(state(&app, "light"), 1);
    let facts = app.world().resource::<Messages<SimFact>>();
    let changes = facts.iter_current_update_messages().filter(|fact| {
        matches!(
            fact,
            SimFact::Mechanism(MechanismFact::ControlChanged { .. })
        )
    });
    assert_eq!(changes.count(), 0);
}

/// A tower whose control `lift` is two units high in its first state, and one in its second.
fn tower() -> ObjectSpec {
    let block = |zspan: f32, next| CustomState {
        name: String::new(),
        parts: vec![Part::new(
            "",
            Pose::at(Vec3::Z * zspan / 2.0),
            Shape::Block {
                span: Vec3::new(2.0, 2.0, zspan),
                color: Rgb::GRAY,
            },
        )],
        next: vec![Some(next)],
        changes: Vec::new(),
    };
    let lift = Control::new(ControlKind::Custom(CustomControl {
        name: "lift".into(),
        states: vec![block(2.0, 1), block(1.0, 0)],
    }));
    let part = Part::new("lift", Pose::IDENTITY, Shape::Control(lift));
    let shape = Shape::Composite { parts: vec![part] };
    ObjectSpec::new("tower", Pose::IDENTITY, 0.0, shape)
}

fn block(at: Vec3) -> ObjectSpec {
    let shape = Shape::Block {
        span: Vec3::ONE,
        color: Rgb::RED,
    };
    ObjectSpec::new("block", Pose::at(at), 1.0, shape)
}

#[test]
fn a_custom_control_collides_as_its_state_shows_and_wakes_its_load() {
    let mut app = app(vec![tower(), block(Vec3::Z * 2.5)]);
    app.step(300);
    assert!((pose(&app, "block").location.z - 2.5).abs() < 0.01);
    trigger(&mut app, "lift");
    app.step(120);
    assert!((pose(&app, "block").location.z - 1.5).abs() < 0.01);
}

#[test]
fn a_control_collides_as_the_state_shows_that_is_passed_on_to_it_at_first() {
    let on = Control {
        state: 1,
        ..switch(&["lift"])
    };
    let power = control("power", Vec3::X * 5.0, on);
    let mut app = app(vec![tower(), block(Vec3::Z * 1.6), power]);
    app.step(120);
    let height = pose(&app, "block").location.z;
    assert!((height - 1.5).abs() < 0.01, "{height}");
}

#[test]
fn a_held_object_presses_the_raised_side_of_a_switch_once() {
    let poker = Shape::Block {
        span: Vec3::new(0.2, 0.2, 1.0),
        color: Rgb::RED,
    };
    let mut app = app(vec![
        control("power", Vec3::ZERO, switch(&[])),
        ObjectSpec::new("poker", Pose::at(Vec3::new(0.35, 0.0, 3.0)), 1.0, poker),
    ]);
    let hand = Hand::Left;
    let object = "poker".into();
    app.world_mut()
        .write_command(HandCommand::Grasp { hand, object });
    let mut go = |x: f32, z: f32| {
        let location = Vec3::new(x, 0.0, z);
        app.world_mut()
            .write_command(HandCommand::MoveTo { hand, location });
        app.step(60);
        state(&app, "power")
    };
    assert_eq!(go(0.35, 0.5), 1);
    assert_eq!(go(0.35, 0.4), 1);
    assert_eq!(go(0.35, 3.0), 1);
    // That side is down now.
    assert_eq!(go(0.35, 0.4), 1);
    assert_eq!(go(0.35, 3.0), 1);
    assert_eq!(go(-0.35, 3.0), 1);
    assert_eq!(go(-0.35, 0.4), 2);
}

#[test]
fn a_state_spawns_recolors_and_removes() {
    let ball = || Shape::Sphere {
        radius: 0.5,
        color: Rgb::GRAY,
    };
    let state = |changes: &[Change]| CustomState {
        parts: vec![Part::new("", Pose::IDENTITY, ball())],
        next: vec![Some(1)],
        changes: changes.to_vec(),
        ..default()
    };
    let spawned = ObjectSpec::new("ball", Pose::at(Vec3::new(0.0, 3.0, 0.5)), 1.0, ball());
    let object = || "ball".to_owned();
    let color = Rgb::RED;
    let states = vec![
        state(&[]),
        state(&[
            Change::Spawn(spawned),
            Change::Recolor {
                object: object(),
                color,
            },
            Change::Remove {
                object: "old".into(),
            },
        ]),
    ];
    let name = "dispenser".into();
    let dispenser = Control::new(ControlKind::Custom(CustomControl { name, states }));
    let mut app = app(vec![
        control("dispenser", Vec3::Z, dispenser),
        ObjectSpec::new("old", Pose::at(Vec3::new(3.0, 0.0, 0.5)), 1.0, ball()),
    ]);
    trigger(&mut app, "dispenser");
    app.step(60);
    let index = app.world().resource::<ObjectIndex>();
    assert_eq!(index.get("old"), None);
    let ball = app.world().get::<ObjectSpec>(index.get("ball").unwrap());
    assert_eq!(ball.unwrap().shape.drawn()[0].color, Rgb::RED);
    assert!((pose(&app, "ball").location.z - 0.5).abs() < 0.01);
}

fn screw(id: &str, at: Vec3) -> ObjectSpec {
    let rod = Shape::Block {
        span: Vec3::new(0.2, 0.2, 1.0),
        color: Rgb::GRAY,
    };
    let tip = BondPoint {
        fit: "screw".into(),
        end: BondEnd::Guest(GuestPoint::default()),
    };
    let parts = vec![
        Part::new("", Pose::at(Vec3::Z * 0.5), rod),
        Part::new(format!("{id}Tip"), Pose::IDENTITY, Shape::BondPoint(tip)),
    ];
    ObjectSpec::new(id, Pose::at(at), 1.0, Shape::Composite { parts })
}

/// A block with a hole in which a screw sinks by 0.2 and turns by a quarter a step.
fn nut(at: Vec3, mass: f32) -> ObjectSpec {
    let block = Shape::Block {
        span: Vec3::splat(1.0),
        color: Rgb::GRAY,
    };
    let step = |number: f32| TightnessStep {
        pose: Pose::from_degrees(Vec3::Z * -0.2 * number, Vec3::Z * 90.0 * number),
        ..default()
    };
    let hole = BondPoint {
        fit: "screw".into(),
        end: BondEnd::Host(HostPoint {
            downstream: "light".into(),
            steps: [1.0, 2.0, 3.0].map(step).into(),
            ..default()
        }),
    };
    let parts = vec![
        Part::new("", Pose::IDENTITY, block),
        Part::new("hole", Pose::at(Vec3::Z * 0.5), Shape::BondPoint(hole)),
    ];
    ObjectSpec::new("nut", Pose::at(at), mass, Shape::Composite { parts })
}

fn fasten(app: &mut App, guest: &str) -> Vec<SimFact> {
    let (hand, guest) = (Hand::Any, guest.to_owned());
    do_it(app, MechanismCommand::Fasten { hand, guest })
}

fn loosen(app: &mut App, guest: &str) -> Vec<SimFact> {
    let (hand, guest) = (Hand::Any, guest.to_owned());
    do_it(app, MechanismCommand::Loosen { hand, guest })
}

#[test]
fn a_screw_goes_in_three_steps_cannot_go_a_fourth_and_comes_out() {
    let mut app = app(vec![
        nut(Vec3::Z * 0.5, 0.0),
        screw("screw", Vec3::new(1.0, 0.0, 0.5)),
        control("light", Vec3::X * 5.0, lights(4, &[])),
    ]);
    for (step, height) in [(1, 0.8), (2, 0.6), (3, 0.4)] {
        fasten(&mut app, "screw");
        app.step(30);
        assert_eq!(state(&app, "light"), step);
        let screw = pose(&app, "screw");
        assert!(
            screw.location.distance(Vec3::Z * height) < 0.01,
            "{screw:?}"
        );
    }
    let facts = fasten(&mut app, "screw");
    assert!(matches!(facts[..], [SimFact::Refused { .. }]), "{facts:?}");
    for step in [2, 1, 0] {
        loosen(&mut app, "screwTip");
        assert_eq!(state(&app, "light"), step);
    }
    assert_eq!(app.world().resource::<Bonds>().0, []);
    let facts = loosen(&mut app, "screw");
    assert!(matches!(facts[..], [SimFact::Refused { .. }]), "{facts:?}");
}

#[test]
fn fastened_objects_are_one_body() {
    let mut app = app(vec![
        nut(Vec3::Z * 0.5, 1.0),
        screw("screw", Vec3::new(1.0, 0.0, 0.5)),
    ]);
    fasten(&mut app, "screw");
    let hand = Hand::Right;
    let object = "screw".into();
    app.world_mut()
        .write_command(HandCommand::Grasp { hand, object });
    let location = Vec3::new(2.0, 1.0, 4.0);
    app.world_mut()
        .write_command(HandCommand::MoveTo { hand, location });
    app.step(180);
    let (screw, nut) = (pose(&app, "screw"), pose(&app, "nut"));
    let apart = (screw.inverse() * nut).location;
    assert!(apart.distance(Vec3::NEG_Z * 0.3) < 0.02, "{apart}");
    assert!(nut.location.z > 3.0, "{nut:?}");
}

#[test]
fn a_destroyed_object_loses_its_bonds() {
    let mut app = app(vec![
        nut(Vec3::Z * 0.5, 0.0),
        screw("screw", Vec3::new(1.0, 0.0, 0.5)),
        screw("other", Vec3::new(-1.0, 0.0, 0.5)),
        control("light", Vec3::X * 5.0, lights(4, &[])),
    ]);
    fasten(&mut app, "screw");
    assert_eq!(state(&app, "light"), 1);
    let hand = Hand::Right;
    let object = "screw".into();
    app.world_mut()
        .write_command(HandCommand::Grasp { hand, object });
    app.world_mut().write_command(HandCommand::Destroy(hand));
    app.step(1);
    assert_eq!(app.world().resource::<Bonds>().0, []);
    assert_eq!(state(&app, "light"), 0);
    fasten(&mut app, "other");
    assert_eq!(app.world().resource::<Bonds>().0.len(), 1);
}

/// Lets the robot's first gripper be at a pose, with an object in it, for a tick.
fn grip(app: &mut App, object: &str, gripper: Pose) -> Vec<SimFact> {
    let object = app.world().resource::<ObjectIndex>().get(object).unwrap();
    let mut robot = app.world_mut().resource_mut::<Robot>();
    robot.limbs[0].holds = vec![object];
    robot.limbs[0].end_effector = gripper;
    app.world_mut().resource_mut::<Messages<SimFact>>().clear();
    app.step(1);
    let facts = app.world().resource::<Messages<SimFact>>();
    facts.get_cursor().read(facts).cloned().collect()
}

/// Turns a gripper with the screw about the vertical between these angles, in degrees. Returns the tightness after each step.
fn wrench(app: &mut App, from: f32, to: f32) -> Vec<u32> {
    let mut steps = Vec::new();
    for number in 0..=30_u8 {
        let angle = from + (to - from) * f32::from(number) / 30.0;
        let gripper = Pose::from_degrees(Vec3::Z, Vec3::Z * angle);
        for fact in grip(app, "screw", gripper) {
            if let SimFact::Mechanism(
                MechanismFact::Fastened { cause, by, bond }
                | MechanismFact::Loosened { cause, by, bond },
            ) = fact
            {
                assert_eq!(cause, None);
                let limb = app.world().resource::<RobotLayout>().limbs[0].name;
                assert_eq!(by, Operator::Limb(limb));
                steps.push(bond.tightness);
            }
        }
    }
    steps
}

/// A screw that is held over the hole of a nut.
fn screw_at_the_hole(hole: Vec3) -> App {
    let mut app = app(vec![
        nut(Vec3::Z * 0.5, 0.0),
        screw("screw", Vec3::new(2.0, 0.0, 1.1)),
        control("light", Vec3::X * 5.0, lights(4, &[])),
    ]);
    let (hand, object) = (Hand::Left, "screw".into());
    app.world_mut()
        .write_command(HandCommand::Grasp { hand, object });
    let location = hole;
    app.world_mut()
        .write_command(HandCommand::MoveTo { hand, location });
    app.step(60);
    app
}

#[test]
fn a_gripper_turns_a_screw_in_and_out_by_the_angle_of_each_step() {
    let mut app = screw_at_the_hole(Vec3::Z * 1.1);
    assert_eq!(wrench(&mut app, 10.0, 95.0), []);
    assert_eq!(wrench(&mut app, 95.0, 105.0), [1]);
    assert_eq!(wrench(&mut app, 105.0, 285.0), [2, 3]);
    assert_eq!(state(&app, "light"), 3);
    // It goes no further, and turning on does not have to be taken back.
    assert_eq!(wrench(&mut app, 285.0, 600.0), []);
    assert_eq!(wrench(&mut app, 600.0, 515.0), []);
    assert_eq!(wrench(&mut app, 515.0, 505.0), [2]);
    assert_eq!(wrench(&mut app, 505.0, 320.0), [1, 0]);
    assert_eq!(state(&app, "light"), 0);
    assert_eq!(wrench(&mut app, 320.0, 0.0), []);
}

#[test]
fn a_gripper_away_from_the_hole_turns_nothing_in() {
    for place in [Vec3::Z * 1.5, Vec3::new(0.4, 0.0, 1.1)] {
        let mut app = screw_at_the_hole(place);
        assert_eq!(wrench(&mut app, 0.0, 300.0), [], "{place}");
    }
}
