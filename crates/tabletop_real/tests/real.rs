//! A real robot beside the simulated one: here a mock behind a mock rosbridge server.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

#[path = "../../tabletop_bridge/tests/rosbridge/mock.rs"]
#[expect(dead_code, reason = "it has more than is needed here")]
mod mock;

use bevy::prelude::*;
use mock::{MockServer, Trouble};
use tabletop_bridge::{Bridge, BridgeOptions, BridgeProfile, Shadow, StopReason};
use tabletop_core::{
    Drive, Robot, RobotCommand, RobotJoint, RobotLayout, StepApp as _, WriteCommand as _,
};
use tabletop_real::{RealLink, RealRobot, RealRobotPlugin};
use tabletop_sim::{TabletopSimPlugins, headless_app_with};

fn app_beside(link: RealLink) -> App {
    let plugins = TabletopSimPlugins
        .build()
        .add(RealRobotPlugin { is_paced: true });
    let mut app = headless_app_with(plugins);
    app.insert_resource(RealRobot::new(link, None));
    app
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
        server.robot().angles.insert("left_s0".into(), place);
        for _ in 0..30 {
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
