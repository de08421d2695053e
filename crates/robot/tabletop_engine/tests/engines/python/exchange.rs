//! Exchange with a script in both directions.

use std::{fs, path};

use tabletop_engine::{RgbImage, SensedContact, SensedObject, Sensor};
use tabletop_harness::test_with;

use super::{config, of_callback, start};
use crate::common::{self, Session};

#[test_with(Python)]
fn the_example_turns_every_joint() {
    let root = path::absolute("../../..").unwrap();
    let mut config = config("python/example.py".into());
    config.working_dir = root;
    let session = Session::start(config).unwrap();
    assert!(
        session.description.starts_with("Python 3"),
        "{}",
        session.description
    );
    let reply = session.init().unwrap();
    assert_eq!(reply.draw_markers.len(), 4);
    assert_eq!(
        reply.init_joint_angles.unwrap()[1][2],
        std::f64::consts::FRAC_PI_2
    );
    let sensor = Sensor {
        time_elapsed: 3.0,
        ..common::at_rest()
    };
    let speed = || session.step(&sensor).unwrap().motor.joint_velocities;
    assert_eq!(
        [speed(), speed(), speed()],
        [[[0.5; 7]; 2], [[0.5; 7]; 2], [[-0.5; 7]; 2]]
    );
    assert!(session.printed("jointAngles").contains("sensed: "));
}

#[test_with(Python)]
fn everything_that_is_sensed_arrives() {
    let (_folder, session) = start(
        "import os\n\
         def init(aux):\n    assert aux.numLimbs == 2 and aux.maxJointAngles[1][3] == 2.618 and aux.path.endswith('/'), vars(aux)\n\
         def callback(sensor, motor, aux):\n\
         \x20   assert abs(sensor.rgbVision[1, 2][0] - 0.2) < 1e-12\n\
         \x20   assert sensor.trackerLoc['l-S1'][2] == 3 and sensor.demoCue is True\n\
         \x20   assert sensor.objects.id == ['a', 'b'] and sensor.objects.position[1][0] == 7\n\
         \x20   motor.jointVelocities[1][2] = sensor.jointAngles[1][6]\n\
         \x20   motor.gripperVelocities = [1, -1]\n",
    );
    session.init().unwrap();
    let mut rgb = vec![0; 18];
    rgb[15] = 51;
    let mut sensor = Sensor {
        picture: RgbImage::new(3, 2, rgb),
        demo_cue: true,
        ..common::at_rest()
    };
    sensor.tracker_loc = Some(vec![("l-S1".into(), [1.0, 2.0, 3.0])]);
    sensor.joint_angles[1][6] = 0.75;
    let b = SensedObject {
        id: "b".into(),
        position: [7.0, 0.0, 0.0],
        ..SensedObject::default()
    };
    sensor.objects = Some(vec![
        SensedObject {
            id: "a".into(),
            ..b.clone()
        },
        b,
    ]);
    let motor = session.step(&sensor).unwrap().motor;
    assert_eq!(
        (motor.joint_velocities[1][2], motor.gripper_velocities),
        (0.75, vec![1.0, -1.0])
    );
}

#[test_with(Python)]
fn columns_are_lists_of_any_length_and_counts_are_whole() {
    let (_folder, session) = start(
        "def init(aux): assert list(range(aux.numLimbs)) == [0, 1] and aux.numJoints == 7\n\
         def callback(sensor, motor, aux):\n\
         \x20   assert list(sensor.objects.mass) == [2.0] * len(sensor.objects.id), sensor.objects.mass\n\
         \x20   assert list(sensor.contacts.impulse) == [0.5] * len(sensor.contacts.first), sensor.contacts.impulse\n\
         \x20   assert len(sensor.objects.position) == len(sensor.objects.id)\n",
    );
    session.init().unwrap();
    let object = SensedObject {
        mass: 2.0,
        ..SensedObject::default()
    };
    let contact = SensedContact {
        impulse: 0.5,
        ..SensedContact::default()
    };
    for count in 0..4 {
        let sensor = Sensor {
            objects: Some(vec![object.clone(); count]),
            contacts: Some(vec![contact.clone(); count]),
            ..common::at_rest()
        };
        session.step(&sensor).unwrap();
    }
}

#[test_with(Python)]
fn truth_values_are_numbers() {
    let (_folder, session) = start(&of_callback(
        "motor.headVelocity = True; motor.gripperVelocities = [True, False]",
    ));
    session.init().unwrap();
    let motor = session.step(&common::at_rest()).unwrap().motor;
    assert_eq!(motor.head_velocity, Some(1.0));
    assert_eq!(motor.gripper_velocities, [1.0, 0.0]);
}

#[test_with(Python)]
fn a_misused_aux_names_the_script_and_a_typo_is_noted() {
    let script =
        |line: &str| format!("def init(aux): {line}\ndef callback(sensor, motor, aux): pass\n");
    let (folder, session) = start(&script("aux.drawMarkers = [[1, 2, 3], [0, -1e39, 0]]"));
    let message = format!(
        "aux.drawMarkers[1][1] is -1e39; it must be between -1e6 and 1e6\n  at {}",
        folder.0.join("robot.py").display()
    );
    assert_eq!(session.init().unwrap_err().to_string(), message);
    let (_folder, session) = start(&script("aux.drawMarker = [[1, 2, 3]]; aux.plan = []"));
    session.init().unwrap();
    let note = "tabletop: aux.drawMarker means nothing (did you mean drawMarkers?)\n";
    assert_eq!(session.printed("drawMarkers"), note);
    let (_folder, session) = start(
        "def init(aux): aux.Exit = 1\ndef callback(sensor, motor, aux): aux.exits = True; aux.mine = 1\n",
    );
    session.init().unwrap();
    for _ in 0..2 {
        session.step(&common::at_rest()).unwrap();
    }
    let notes = "tabletop: aux.Exit means nothing (did you mean exit?)\ntabletop: aux.exits means nothing (did you mean exit?)\n";
    assert_eq!(session.printed("exits"), notes);
}

#[test_with(Python)]
fn oversized_values_are_reported_with_their_size() {
    let (folder, session) = start("def init(aux): pass\ndef callback(sensor, motor, aux): pass\n");
    let reported = |line: &str| {
        let script =
            format!("def init(aux): pass\ndef callback(sensor, motor, aux):\n    {line}\n");
        fs::write(folder.0.join("robot.py"), script).unwrap();
        session.init().unwrap();
        let error = session.step(&common::at_rest()).unwrap_err();
        assert!(!error.is_fatal(), "{error}");
        error.to_string()
    };
    let error = reported("raise ValueError('x' * 70_000_000)");
    assert!(error.starts_with("ValueError: xxx"), "{}", error.len());
    let error = reported("motor.jointVelocities = [[0.0] * 3000] * 3000");
    assert!(error.contains("is 3000x3000 double"), "{error}");
    // So much that nobody can look at all of it.
    let error = reported("motor.jointVelocities = [range(10**12)] * 2");
    assert!(error.contains("is 2x4294967295 double"), "{error}");
}

#[test_with(Python)]
fn a_row_of_a_column_may_be_a_number() {
    let (_folder, session) = start(
        "def init(aux): pass\n\
         def callback(sensor, motor, aux): motor.gripperVelocities = [[0.0], [0.5]]; motor.gripperVelocities[0] = -1.0\n",
    );
    session.init().unwrap();
    let motor = session.step(&common::at_rest()).unwrap().motor;
    assert_eq!(motor.gripper_velocities, [-1.0, 0.5]);
}

#[test]
fn any_printed_text_is_shown() {
    let (_folder, session) = start(
        "import os, sys\ndef init(aux): pass\n\
         def callback(sensor, motor, aux):\n\
         \x20   print('\\x01no mark')\n    print('before\\x01after')\n\
         \x20   for line in ['he was: called from', '', '    tabletop_mine at line 3', 'end']:\n\
         \x20       print(line, file=sys.stderr)\n",
    );
    session.init().unwrap();
    session.step(&common::at_rest()).unwrap();
    let printed = session.printed("end");
    let errors = "he was: called from\n\n    tabletop_mine at line 3\nend\n";
    assert!(printed.contains(errors), "{printed}");
    assert!(printed.contains("no mark\nbefore\nafter\n"), "{printed}");
}

#[test]
fn equal_errors_before_a_crash_are_all_shown() {
    let (_folder, session) = start(&of_callback(
        "[print('again', file=sys.stderr) for k in range(50)]; os._exit(3)",
    ));
    session.init().unwrap();
    let error = session.step(&common::at_rest()).unwrap_err().to_string();
    let rest = session.engine.drain_console();
    let again = rest.iter().filter(|line| line.text == "again").count();
    assert_eq!(again + error.matches("again").count(), 50, "{error}");
}
