//! A real robot beside the simulated one: here a mock behind a mock rosbridge server.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

#[path = "../../tabletop_bridge/tests/rosbridge/mock.rs"]
#[expect(dead_code, reason = "it has more than is needed here")]
mod mock;

use bevy::prelude::*;
use mock::{MockServer, Trouble};
use tabletop_bridge::{Bridge, BridgeOptions, BridgeProfile, PictureFeed, Shadow, StopReason};
use tabletop_core::{
    Actor, Arm, ClockCommand, CommandWriter, Drive, HandCameras, HandImages, PictureDemand, Robot,
    RobotCommand, RobotJoint, RobotLayout, SceneCommand, SensorImage, SimFact, StepApp as _,
    WriteCommand as _,
};
use tabletop_geometry::Pose;
use tabletop_real::{RealLink, RealRobot, RealRobotPlugin, head_pictures};
use tabletop_sim::{TabletopSimPlugins, headless_app_with};

fn app_beside(link: RealLink) -> App {
    app_beside_seeing(link, None)
}

fn app_beside_seeing(link: RealLink, feed: Option<PictureFeed>) -> App {
    let plugins = TabletopSimPlugins
        .build()
        .add(RealRobotPlugin { is_paced: true });
    let mut app = headless_app_with(plugins);
    app.insert_resource(RealRobot::new(link, feed));
    app
}

/// The mock is driven with all its limbs, as fast as it can.
fn driven(server: &MockServer) -> RealLink {
    let profile = BridgeProfile::shipped("baxter").unwrap();
    let options = BridgeOptions {
        speed: 1.0,
        ..BridgeOptions::default()
    };
    let bridge = Bridge::connect(&server.address(), &profile, &options).unwrap();
    RealLink::Driven(Box::new(bridge))
}

fn angle(app: &App, joint: RobotJoint) -> f64 {
    let layout = app.world().resource::<RobotLayout>();
    let joint = layout.find_joint(joint.name()).unwrap();
    app.world().resource::<Robot>().joint(joint).position
}

fn turn(app: &mut App, joint: RobotJoint, speed: f64) {
    let command = RobotCommand::drive([(joint, Drive::Velocity(speed))]);
    app.world_mut().write_command(command);
    app.step(1);
}

#[test]
fn the_simulated_robot_is_where_the_real_one_is_and_orders_move_neither() {
    let server = MockServer::start("baxter");
    let profile = BridgeProfile::shipped("baxter").unwrap();
    let shadow = Shadow::connect(&server.address(), &profile).unwrap();
    let mut app = app_beside(RealLink::Shadow(shadow));
    for place in [0.3, -0.2] {
        let start = server.robot().angles["left_s0"];
        for tick in 1..=60 {
            // No faster than a joint can turn.
            let share = f64::from(tick.min(40)) / 40.0;
            let angle = start + share * (place - start);
            server.robot().angles.insert("left_s0".into(), angle);
            turn(&mut app, RobotJoint::LeftS0, 1.0);
        }
        assert!((angle(&app, RobotJoint::LeftS0) - place).abs() < 1e-3);
    }
    assert!(server.robot().modes.is_empty());
    assert_eq!(app.world().resource::<RealRobot>().end(), None);
}

#[test]
fn an_order_to_the_simulated_robot_moves_the_real_one_and_is_seen_there() {
    let server = MockServer::start("baxter");
    let profile = BridgeProfile::shipped("baxter").unwrap();
    let options = BridgeOptions {
        limbs: vec!["left".into()],
        speed: 1.0,
        ..BridgeOptions::default()
    };
    let bridge = Bridge::connect(&server.address(), &profile, &options).unwrap();
    let mut app = app_beside(RealLink::Driven(Box::new(bridge)));
    app.step(3);
    let start = angle(&app, RobotJoint::LeftS0);
    for _ in 0..60 {
        turn(&mut app, RobotJoint::LeftS0, 0.3);
    }
    let way = angle(&app, RobotJoint::LeftS0) - start;
    assert!((0.2..0.35).contains(&way), "{way}");
    // Without orders it rests.
    app.step(30);
    let rest = angle(&app, RobotJoint::LeftS0);
    app.step(10);
    assert!((angle(&app, RobotJoint::LeftS0) - rest).abs() < 0.01);

    server.robot().trouble = Trouble::EmergencyStop;
    app.step(30);
    let real = app.world().resource::<RealRobot>();
    assert!(
        real.end()
            .is_some_and(|end| end.contains("a person must reset it")),
        "{:?}",
        real.end()
    );
    let real = app.world_mut().remove_resource::<RealRobot>().unwrap();
    assert_eq!(real.stop(), Some(StopReason::EmergencyStop));
}

#[test]
fn what_was_measured_is_no_order_and_neither_is_rest() {
    let server = MockServer::start("baxter");
    server.robot().bias = 0.004;
    let mut app = app_beside(driven(&server));
    app.step(60);
    for _ in 0..10 {
        turn(&mut app, RobotJoint::LeftS0, 0.0);
    }
    // What a replay repeats was wanted of another robot.
    let replay = |mut commands: CommandWriter| {
        let drive = RobotCommand::drive([(RobotJoint::LeftS0, Drive::Velocity(0.5))]);
        commands.replay(Actor::Script, drive.clone());
        commands.write(Actor::Replay, drive);
    };
    for _ in 0..10 {
        app.world_mut().run_system_cached(replay).unwrap();
        app.step(1);
    }
    let mirrored = angle(&app, RobotJoint::LeftS0);
    let robot = server.robot();
    assert!(robot.modes.is_empty());
    // Nor was it told how soon to stop by itself.
    assert_eq!(robot.time_limit, 0.2);
    assert!((mirrored - robot.angles["left_s0"] - 0.004).abs() < 1e-9);
}

#[test]
fn an_arm_that_waits_stays_where_it_is_however_it_is_measured() {
    let server = MockServer::start("baxter");
    server.robot().bias = 0.004;
    let mut app = app_beside(driven(&server));
    for _ in 0..30 {
        turn(&mut app, RobotJoint::LeftS0, 0.3);
    }
    app.step(30);
    let before = server.robot().angles.clone();
    app.step(240);
    let after = server.robot().angles.clone();
    assert_eq!(app.world().resource::<RealRobot>().end(), None);
    for (joint, angle) in &before {
        assert!((after[joint] - angle).abs() < 1e-3, "{joint}");
    }
}

#[test]
fn a_lasting_order_ends_where_it_leads_and_a_pause_lets_the_robot_rest() {
    let server = MockServer::start("baxter");
    let mut app = app_beside(driven(&server));
    app.step(3);
    let start = angle(&app, RobotJoint::LeftW2);
    let there = RobotCommand::drive([(RobotJoint::LeftW2, Drive::Toward(start + 0.4))]);
    app.world_mut().write_command(there);
    app.step(15);
    app.world_mut().write_command(ClockCommand::SetPaused(true));
    app.step(20);
    let resting = server.robot().angles["left_w2"];
    assert!((0.05..0.35).contains(&(resting - start)), "{resting}");
    app.step(20);
    assert!((server.robot().angles["left_w2"] - resting).abs() < 1e-3);
    app.world_mut()
        .write_command(ClockCommand::SetPaused(false));
    app.step(120);
    let arrived = server.robot().angles["left_w2"];
    assert!((arrived - start - 0.4).abs() < 0.02, "{arrived}");
    // Somebody turns it away by hand: nobody wants it back.
    server
        .robot()
        .angles
        .insert("left_w2".into(), arrived + 0.05);
    app.step(60);
    assert!((server.robot().angles["left_w2"] - arrived - 0.05).abs() < 1e-3);
}

#[test]
fn a_pose_is_refused_with_the_reason() {
    let server = MockServer::start("baxter");
    let mut app = app_beside(driven(&server));
    let reach = RobotCommand::ReachTo {
        arm: Arm::Left.name(),
        pose: Pose::IDENTITY,
    };
    app.world_mut().write_command(reach);
    app.step(1);
    let facts = app.world().resource::<Messages<SimFact>>();
    let mut cursor = facts.get_cursor();
    let mut facts = cursor.read(facts);
    let is_refused = |fact: &SimFact| matches!(fact, SimFact::Refused { reason, .. } if reason.contains("not poses"));
    assert!(facts.any(is_refused));
    assert!(server.robot().modes.is_empty());
}

#[test]
fn its_joints_are_the_measured_ones_even_where_the_simulated_robot_would_stop() {
    // Down through the table.
    let there = [
        (RobotJoint::LeftS1, 0.9),
        (RobotJoint::LeftE1, 0.0),
        (RobotJoint::LeftW1, 0.0),
    ];
    let mut alone = headless_app_with(TabletopSimPlugins.build());
    let set = || SceneCommand::Set(Box::default());
    alone.world_mut().write_command(set());
    alone.world_mut().write_command(RobotCommand::Show(true));
    alone.step(1);
    let drives = there.map(|(joint, angle)| (joint, Drive::Position(angle)));
    alone.world_mut().write_command(RobotCommand::drive(drives));
    alone.step(1);
    assert!(
        there
            .iter()
            .any(|(joint, it)| (angle(&alone, *joint) - it).abs() > 0.05)
    );

    let server = MockServer::start("baxter");
    for (joint, angle) in there {
        let layout = RobotLayout::baxter();
        let name = layout.joint(joint.into()).urdf_name.clone();
        server.robot().angles.insert(name, angle);
    }
    let profile = BridgeProfile::shipped("baxter").unwrap();
    let shadow = Shadow::connect(&server.address(), &profile).unwrap();
    let mut app = app_beside(RealLink::Shadow(shadow));
    app.world_mut().write_command(set());
    app.world_mut().write_command(RobotCommand::Show(true));
    for _ in 0..10 {
        app.step(1);
        for (number, joint) in RobotLayout::baxter().joints.iter().enumerate() {
            let Some(truth) = server.robot().angles.get(&joint.urdf_name).copied() else {
                continue;
            };
            let state = app.world().resource::<Robot>().joints[number];
            assert_eq!(state.position, truth, "{}", joint.name);
            assert_eq!(state.velocity, 0.0, "{}", joint.name);
        }
    }
}

#[test]
fn pictures_are_those_of_the_real_camera_and_none_is_drawn() {
    let server = MockServer::start("baxter");
    let profile = BridgeProfile::shipped("baxter").unwrap();
    let shadow = Shadow::connect(&server.address(), &profile).unwrap();
    let feed = head_pictures(&server.address(), &profile).unwrap().unwrap();
    let mut app = app_beside_seeing(RealLink::Shadow(shadow), Some(feed));
    app.world_mut()
        .write_command(SceneCommand::Set(Box::default()));
    let look = |app: &mut App| {
        let cameras = app.world().resource::<HandCameras>().0.clone();
        app.world_mut().resource_mut::<HandImages>().ask(&cameras);
        app.world().resource::<PictureDemand>().ask();
        app.step(1);
        let image = app.world().resource::<SensorImage>();
        let pixels = image.picture.rgb.chunks(3);
        assert!(pixels.clone().all(|pixel| pixel == [30, 20, 10]));
        assert_eq!(image.received.is_some(), pixels.len() > 0);
        assert!(image.picture.objects.is_empty() && image.picture.depth.is_empty());
        let hands = app.world().resource::<HandImages>();
        assert!(hands.pictures.is_empty() && hands.asked().is_empty());
        image.received
    };
    let looks = |app: &mut App, ticks: usize| -> Vec<_> { (0..ticks).map(|_| look(app)).collect() };
    assert!(look(&mut app).is_some(), "the first look sees a picture");
    let mut received = looks(&mut app, 90);
    assert!(received.last().copied().flatten().is_some());
    received.dedup();
    assert!(received.len() > 3, "{received:?}");
    let size = server.robot().camera.take();
    assert_eq!(looks(&mut app, 90).last(), Some(&None));
    server.robot().camera = size;
    assert!(looks(&mut app, 60).last().unwrap().is_some());
}
