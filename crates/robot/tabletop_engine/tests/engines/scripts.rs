//! Scripts as users wrote them in 2014 run as they are.

use std::fs;

use tabletop_engine::{RgbImage, Sensor, Trigger};
use tabletop_harness::test_with;

use crate::common::{self, Folder, Session, TRIGGERS, octave, robot::Robot};

/// A copy of the scripts in a folder "scripts", with a file that Octave has not written.
fn folder() -> Folder {
    let folder = Folder::new(&[]);
    let scripts = folder.0.join("scripts");
    fs::create_dir(&scripts).unwrap();
    for entry in fs::read_dir("tests/scripts").unwrap() {
        let entry = entry.unwrap();
        fs::copy(entry.path(), scripts.join(entry.file_name())).unwrap();
    }
    fs::write(
        scripts.join("given.mat"),
        mat_file("given", [2, 3], &[1.0, 4.0, 2.0, 5.0, 3.0, 6.0]),
    )
    .unwrap();
    folder
}

/// A MAT file of version 5 with one matrix.
fn mat_file(name: &str, dims: [u32; 2], values: &[f64]) -> Vec<u8> {
    let mut file = format!("{:<124}", "MATLAB 5.0 MAT-file").into_bytes();
    file.extend([0, 1, b'I', b'M']);
    let mut matrix = Vec::new();
    let mut element = |kind: u32, bytes: &[u8]| {
        matrix.extend(kind.to_le_bytes());
        matrix.extend((bytes.len() as u32).to_le_bytes());
        matrix.extend(bytes);
        matrix.resize(matrix.len().next_multiple_of(8), 0);
    };
    element(6, &[6, 0, 0, 0, 0, 0, 0, 0]);
    element(5, &dims.map(u32::to_le_bytes).concat());
    element(1, name.as_bytes());
    element(
        9,
        &values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect::<Vec<_>>(),
    );
    file.extend(14u32.to_le_bytes());
    file.extend((matrix.len() as u32).to_le_bytes());
    file.extend(matrix);
    file
}

fn session(folder: &Folder, name: &str, trigger: Trigger) -> Session {
    let mut config = octave("scripts".as_ref(), trigger);
    config.working_dir = folder.0.clone();
    config.pair = Some([format!("{name}Init"), format!("{name}Callback")]);
    config.display = false;
    Session::start(config).unwrap()
}

fn sensor() -> Sensor {
    let names = ["l-S1", "l-E1", "l-W1", "r-S1", "r-E1", "r-W1"];
    Sensor {
        time_elapsed: 0.02,
        picture: RgbImage::new(4, 3, (0..36).collect()),
        tracker_loc: Some(names.map(|name| (name.to_owned(), [1.0, 2.0, 3.0])).into()),
        ..common::at_rest()
    }
}

/// Runs a pair until it exits, and says in which tick and with which motor it does.
fn until_exit(name: &str) -> Vec<(usize, tabletop_engine::MotorCommand)> {
    let run = |trigger| {
        let folder = folder();
        let session = session(&folder, name, trigger);
        session.init().unwrap();
        for tick in 1..10 {
            let reply = session.step(&sensor()).unwrap();
            if reply.exit {
                return (tick, reply.motor);
            }
        }
        panic!("{name} did not end");
    };
    TRIGGERS.map(run).into()
}

#[test_with(Octave)]
fn variables_grow() {
    for (tick, motor) in until_exit("growth") {
        assert_eq!(
            (
                tick,
                motor.joint_velocities[1][0],
                motor.joint_velocities[0][2]
            ),
            (4, 4.0, 3.0)
        );
        assert_eq!(motor.gripper_velocities, [0.0, 1.0]);
    }
}

#[test_with(Octave)]
fn maps_hold_values_and_functions() {
    for (tick, motor) in until_exit("maps") {
        assert_eq!(
            (tick, motor.joint_velocities, motor.head_velocity),
            (1, [[0.25; 7]; 2].into(), Some(3.0))
        );
    }
}

#[test_with(Octave)]
fn handle_classes_work() {
    for (tick, motor) in until_exit("classes") {
        assert_eq!(
            (tick, motor.joint_velocities[0][0], motor.head_velocity),
            (2, 12.0, Some(7.0))
        );
    }
}

#[test_with(Octave)]
fn arrays_of_many_dimensions_work() {
    for (tick, motor) in until_exit("arrays") {
        assert_eq!((tick, motor.joint_velocities[1][6]), (1, 1.0));
    }
}

#[test_with(Octave)]
fn files_are_read_and_written() {
    for (tick, motor) in until_exit("files") {
        assert_eq!(
            (tick, motor.joint_velocities[0][..3].to_vec()),
            (2, vec![5.0, 7.0, 9.0])
        );
    }
}

#[test_with(Octave)]
fn a_script_may_be_left_by_break() {
    for (tick, motor) in until_exit("leaves") {
        assert_eq!((tick, motor.head_velocity), (3, Some(20.0)));
    }
}

#[test_with(Octave)]
fn figures_do_no_harm_without_a_display() {
    for (tick, motor) in until_exit("drawing") {
        assert_eq!(tick, 2);
        assert!(motor.head_velocity.is_some());
    }
}

#[test_with(Octave)]
fn functions_with_globals_do_the_same_as_scripts() {
    let run = |name, trigger| {
        let folder = folder();
        let session = session(&folder, name, trigger);
        let mut robot = Robot::new(&session.init().unwrap());
        for tick in 1..=120 {
            let reply = session.step(&robot.sensor()).unwrap();
            robot.obey(&reply.motor);
            assert_eq!(reply.exit, tick == 120);
        }
        (robot.angles, robot.grippers, robot.hands())
    };
    let [script, function] = ["plain", "globals"].map(|name| run(name, Trigger::Stdin));
    assert_eq!(script, function);
    assert_eq!(script, run("globals", Trigger::Poll));
    assert_ne!(script.0, [[0.1; 7]; 2]);
}
