//! Worlds in the hands of a program.

use std::path::PathBuf;

use tabletop_camera::{CameraPlace, CameraSpec};
use tabletop_environment::{TableWorld, WorldOptions, WorldOrigin};
use tabletop_geometry::Pose;
use tabletop_recorder::Session;

fn world(beginning: WorldOrigin) -> TableWorld {
    TableWorld::new(&WorldOptions {
        beginning,
        shows_robot: false,
        ..WorldOptions::default()
    })
    .unwrap()
}

#[test]
fn steps_take_the_ticks_that_they_take_in_a_scenario() {
    let mut whole = world(WorldOrigin::Scenario(
        "shipped:scenarios/stack_three.ron".into(),
    ));
    let mut parts = world(WorldOrigin::Empty);
    parts
        .perform(r#"Load(file: "shipped:tablesetup/blocks.xml")"#)
        .unwrap();
    for step in [
        "WaitUntilRest(2)",
        "Start",
        "Select(Right)",
        r#"Grasp("Green"), Glide(to: (0, -4, 4), seconds: 0.4)"#,
        "Turn(axis: Z, degrees: 70)",
        "Glide(to: (3, -2.5, 4), seconds: 0.8)",
        "Glide(to: (3, -2.5, 1.5), seconds: 0.5), WaitUntilThere(1), Release",
        "WaitUntilRest(3)",
        r#"Grasp("Red"), Glide(to: (-3, -3, 4), seconds: 0.4), Turn(axis: Z, degrees: 25)"#,
        "Glide(to: (3, -2.5, 4), seconds: 0.8), Glide(to: (3, -2.5, 2.5), seconds: 0.5)",
        "WaitUntilThere(1), Release",
        "WaitUntilRest(3), WaitUntilRest(5), Finish",
        r#"Expect(OnTopOf(object: "Green", of: "Blue"))"#,
    ] {
        parts.perform(step).unwrap();
    }
    assert_eq!(parts.objects(), whole.objects());
    // The whole one has a check behind its last command too, and asks it in the tick after.
    assert_eq!(parts.tick(), whole.tick());
    whole.step(60);
    parts.step(60);
    assert_eq!(parts.objects(), whole.objects());
}

#[test]
fn a_step_that_fails_says_so_and_the_world_goes_on() {
    let mut world = world(WorldOrigin::Setup("shipped:tablesetup/default.xml".into()));
    let error = world.perform(r#"Grasp("Nothing")"#).unwrap_err();
    assert!(error.to_string().contains("Nothing"), "{error}");
    let error = world.perform("Jump").unwrap_err();
    assert!(error.to_string().starts_with("steps:1:10"), "{error}");
    world.perform(r#"Grasp("RedBlock"), Release"#).unwrap();
    let facts = format!("{:?}", world.take_facts());
    assert!(facts.contains("Grasped"), "{facts}");
    assert!(world.take_facts().is_empty());
}

#[test]
fn a_recording_begins_where_it_began() {
    let folder = std::env::temp_dir().join(format!("tabletop_worlds_{}", std::process::id()));
    let options = WorldOptions {
        beginning: WorldOrigin::Setup("shipped:tablesetup/default.xml".into()),
        ..WorldOptions::default()
    };
    let mut recorded = TableWorld::new(&options).unwrap();
    recorded.record_into(&folder).unwrap();
    recorded
        .perform(r#"Grasp("RedBlock"), MoveBy((0, 1, 1)), Wait(0.5), Release, Start"#)
        .unwrap();
    let then = recorded.objects();
    recorded.perform("Wait(1)").unwrap();
    assert_eq!(recorded.finish_recording().unwrap(), 1);
    let session = Session::read(folder.join("session.jsonl")).unwrap();
    let mut again = world(WorldOrigin::Recording(folder.clone()));
    assert_eq!(again.tick(), session.header.start_tick);
    assert_ne!(again.objects(), then);
    again.step(1);
    assert_eq!(again.objects(), then);
    again.perform(r#"Grasp("RedBlock")"#).unwrap();
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn any_camera_sees_the_world() {
    let mut world = world(WorldOrigin::Setup("shipped:tablesetup/default.xml".into()));
    let above = Pose::looking_at(
        bevy::math::Vec3::new(0.0, -8.0, 12.0),
        bevy::math::Vec3::ZERO,
    );
    let cameras = [
        CameraSpec::head(64, 48),
        CameraSpec {
            name: "above".into(),
            viewpoint: CameraPlace::Standing(above),
            ..CameraSpec::head(40, 30)
        },
    ];
    let shots = world.shoot(&cameras).unwrap();
    let sizes: Vec<_> = shots.iter().map(|shot| shot.picture.rgb.len()).collect();
    assert_eq!(sizes, [64 * 48 * 3, 40 * 30 * 3]);
    let red = |rgb: &[u8]| rgb.chunks(3).any(|rgb| rgb[0] > 150 && rgb[1] < 60);
    assert!(shots.iter().all(|shot| red(&shot.picture.rgb)));
    let missing = CameraSpec {
        viewpoint: CameraPlace::Hand("third".into()),
        ..CameraSpec::head(8, 8)
    };
    assert!(world.shoot(&[missing]).is_err());
}

#[test]
fn a_missing_file_is_an_error() {
    for beginning in [
        WorldOrigin::Setup(PathBuf::from("missing.xml")),
        WorldOrigin::Scenario(PathBuf::from("missing.ron")),
        WorldOrigin::Recording(PathBuf::from("missing")),
    ] {
        let options = WorldOptions {
            beginning,
            ..WorldOptions::default()
        };
        let error = TableWorld::new(&options).map(drop).unwrap_err().to_string();
        assert!(error.contains("missing"), "{error}");
    }
}
