//! An arm whose first joint slides.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod kit;

use kit::Stage;
use tabletop_core::{Drive, JointName, Robot, RobotCommand, RobotMode, StepApp};
use tabletop_robot::{Description, DescriptionSource, RobotPlugin};

/// The Panda on a lift in place of its first joint.
fn on_a_lift(mode: RobotMode) -> Stage {
    let turn = "<joint name=\"panda_joint1\" type=\"revolute\">";
    let urdf = include_str!("../../../../assets/panda/panda.urdf");
    assert!(urdf.contains(turn));
    let source = DescriptionSource {
        path: "lift.urdf".into(),
        urdf: urdf.replace(turn, &turn.replace("revolute", "prismatic")),
        layout: Some(include_str!("../../../../assets/panda/robot.ron").to_owned()),
        reach: None,
    };
    Stage::with(RobotPlugin {
        description: Some(Description::read(source).unwrap()),
        mode,
    })
}

fn height(robot: &Robot) -> f32 {
    robot.limbs[0].end_effector.location.z
}

fn tell(stage: &mut Stage, drive: Drive) {
    let lift = JointName::from_static("panda_joint1");
    stage.tell(RobotCommand::Drive(vec![(lift, drive)]));
}

#[test]
fn a_lift_goes_up_by_a_unit_per_second() {
    let mut stage = on_a_lift(RobotMode::Kinematic);
    let low = height(stage.robot());
    tell(&mut stage, Drive::Toward(0.2));
    stage.app.step(60);
    let rise = height(stage.robot()) - low;
    assert!((rise - 1.0).abs() < 0.05, "{rise} units in a second");
    stage.app.step(120);
    let rise = height(stage.robot()) - low;
    assert!((rise - 2.0).abs() < 1e-4, "{rise} units");
}

#[test]
fn a_motor_lifts_the_arm_and_holds_it() {
    let mut stage = on_a_lift(RobotMode::Dynamic);
    let low = height(stage.robot());
    tell(&mut stage, Drive::Toward(0.2));
    stage.app.step(240);
    let rise = height(stage.robot()) - low;
    assert!((rise - 2.0).abs() < 0.02, "{rise} units");
    stage.app.step(60);
    let later = height(stage.robot()) - low;
    assert!((later - rise).abs() < 0.01, "{later} units, was {rise}");
}

#[test]
fn a_force_accelerates_the_arm_as_its_mass_has_it() {
    let mut stage = on_a_lift(RobotMode::Dynamic);
    for _ in 0..10 {
        tell(&mut stage, Drive::Torque(20.0));
        stage.app.step(1);
    }
    let joint = stage.robot().joints[0];
    assert_eq!(joint.torque, 20.0, "N");
    let mass = 20.0 * (10.0 / 60.0) / joint.velocity;
    assert!((5.0..40.0).contains(&mass), "{mass} kg");
}
