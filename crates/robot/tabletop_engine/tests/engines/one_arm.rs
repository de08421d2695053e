//! Scripts of a robot with one arm of seven joints: 1×7 where Baxter has 2×7.

use tabletop_engine::{
    Aux, EngineChoice, EngineConfig, EngineError, EngineKind, EngineLocator, JointMatrix, Reply,
    Sensor, StepReply, Trigger,
};
use tabletop_harness::test_with;

use crate::common::{self, Folder, Session, octave};

const SIZE: [usize; 2] = [1, 7];

fn aux() -> Aux {
    Aux {
        min_joint_angles: JointMatrix::from([[-2.5; 7]]),
        max_joint_angles: JointMatrix::from([[2.5; 7]]),
    }
}

/// The answer of the callback script to a sensor whose numbers are all different from 0.
fn step(session: &Session) -> Result<StepReply, EngineError> {
    session.engine.init(aux());
    match session.engine.recv_timeout(common::PATIENCE) {
        Some(Reply::Init(reply)) => {
            assert_eq!(reply.init_joint_angles, Some([[2.5; 7]].into()));
        }
        other => panic!("{other:?}"),
    }
    let mut sensor = Sensor::at_rest(SIZE);
    sensor.joint_angles = JointMatrix::from([[0.25; 7]]);
    sensor.end_eff_pos = vec![[1.0, 2.0, 3.0]];
    sensor.gripper_opening = vec![0.5];
    sensor.held = Some(vec![("arm".into(), vec!["block".into()])]);
    session.step(&sensor)
}

#[test_with(Octave)]
fn octave_has_one_row() {
    let folder = Folder::pair(
        "assert(isequal([aux.numLimbs, aux.numJoints], [1 7])); aux.initJointAngles = aux.maxJointAngles;",
        "assert(isequal(size(motor.jointVelocities), [1 7]) && isequal(size(motor.gripperVelocities), [1 1]));\n\
         assert(isequal(size(sensor.jointAngles), [1 7]) && isequal(sensor.endEffPos, [1 2 3]));\n\
         assert(strcmp(sensor.held.arm{1}, 'block') && sensor.gripperOpening == 0.5);\n\
         motor.jointVelocities(1, 3) = sensor.jointAngles(1, 7); motor.gripperVelocities(1) = -1;",
    );
    for trigger in common::TRIGGERS {
        let session = Session::start(octave(&folder.0, trigger)).unwrap();
        let motor = step(&session).unwrap().motor;
        let mut expected = [[0.0; 7]];
        expected[0][2] = 0.25;
        assert_eq!(motor.joint_velocities, expected);
        assert_eq!(motor.gripper_velocities, [-1.0]);
    }
}

#[test_with(Octave)]
fn two_rows_are_too_many() {
    let folder = Folder::pair(
        "aux.initJointAngles = aux.maxJointAngles;",
        "motor.jointVelocities = zeros(2, 7);",
    );
    let session = Session::start(octave(&folder.0, Trigger::Stdin)).unwrap();
    let error = step(&session).unwrap_err().to_string();
    let expected = "motor.jointVelocities is 2x7 double; it must be 1x7";
    assert!(error.starts_with(expected), "{error}");
}

#[test_with(Python)]
fn python_gets_one_row_of_any_length() {
    let script = "def init(aux):\n    aux.initJointAngles = aux.maxJointAngles\n\
        def callback(sensor, motor, aux):\n\
        \x20   assert (aux.numLimbs, aux.numJoints) == (1, 7)\n\
        \x20   assert sensor.gripperOpening[0][0] == 0.5 and sensor.endEffPos[0][2] == 3 and sensor.held.arm == ['block']\n\
        \x20   motor.jointVelocities[0][2] = sensor.jointAngles[0][6]\n    motor.gripperVelocities[0][0] = -1\n";
    let folder = Folder::new(&[("robot.py", script)]);
    let python = EngineLocator::system().find(&EngineChoice::Kind(EngineKind::Python));
    let mut config = EngineConfig::new(python.unwrap());
    config.agent = folder.0.join("robot.py");
    let session = Session::start(config).unwrap();
    let motor = step(&session).unwrap().motor;
    assert_eq!(motor.joint_velocities[0][2], 0.25);
    assert_eq!(motor.gripper_velocities, [-1.0]);
}
