//! An engine's life: start, init, callbacks, end.

use tabletop_engine::{RgbImage, Sensor};
use tabletop_harness::test_with;

use crate::common::{self, Folder, Session, TRIGGERS};

#[test_with(Octave)]
fn scripts_share_the_base_workspace() {
    let folder = Folder::pair(
        "count = 0; aux.drawMarkers = [1 2 3; 4 5 6]; aux.initJointAngles = ones(2, 7) / 4;",
        "count = count + 1;\nmotor.jointVelocities(1, 2) = count;\nmotor.gripperVelocities = [sensor.timeElapsed; 2];",
    );
    for trigger in TRIGGERS {
        let session = Session::octave(&folder.0, trigger);
        assert!(
            session.description.starts_with("GNU Octave"),
            "{}",
            session.description
        );
        for _ in 0..2 {
            let reply = session.init().unwrap();
            assert_eq!(reply.draw_markers, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
            assert_eq!(reply.init_joint_angles, Some([[0.25; 7]; 2].into()));
            for count in 1..4 {
                let sensor = Sensor {
                    time_elapsed: 0.5,
                    ..common::at_rest()
                };
                let reply = session.step(&sensor).unwrap();
                assert_eq!(reply.motor.joint_velocities[0][1], f64::from(count));
                assert_eq!(reply.motor.gripper_velocities, [0.5, 2.0]);
                assert!(!reply.exit);
            }
        }
    }
}

#[test_with(Octave)]
fn pictures_and_all_else_arrive() {
    let folder = Folder::pair(
        "",
        "if isfield(sensor, 'rgbVision')\n\
         assert(isequal(size(sensor.rgbVision), [2 3 3])); assert(isa(sensor.rgbVision, 'double'));\n\
         motor.headVelocity = sensor.rgbVision(2, 3, 1);\nelse motor.headVelocity = -1; end\n\
         motor.jointVelocities(2, 7) = sensor.jointAngles(2, 7);",
    );
    let session = Session::octave(&folder.0, TRIGGERS[0]);
    session.init().unwrap();
    let mut rgb = vec![0; 18];
    rgb[15] = 51;
    let mut sensor = Sensor {
        picture: RgbImage::new(3, 2, rgb),
        ..common::at_rest()
    };
    sensor.joint_angles[1][6] = 0.75;
    let motor = session.step(&sensor).unwrap().motor;
    assert_eq!(motor.head_velocity, Some(0.2));
    assert_eq!(motor.joint_velocities[1][6], 0.75);
    sensor.picture = None;
    assert_eq!(
        session.step(&sensor).unwrap().motor.head_velocity,
        Some(-1.0)
    );
}
