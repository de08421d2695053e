//! The scripts in the folder "matlab" move a robot as they say.

use std::fs;

use tabletop_engine::{RgbImage, Sensor, Trigger};
use tabletop_harness::test_with;

use crate::common::{
    Folder, Session, TRIGGERS, limits, octave,
    robot::{Robot, TICK},
};

/// A copy of the scripts, so that the files that they write go with it.
fn scripts() -> Folder {
    let folder = Folder::new(&[]);
    fs::create_dir(folder.0.join("matlab")).unwrap();
    for entry in fs::read_dir("../../../matlab").unwrap() {
        let entry = entry.unwrap();
        if entry
            .path()
            .extension()
            .is_some_and(|extension| extension == "m")
        {
            fs::copy(
                entry.path(),
                folder.0.join("matlab").join(entry.file_name()),
            )
            .unwrap();
        }
    }
    folder
}

/// An engine for a pair of them, as it runs in the program's folder.
fn session(folder: &Folder, name: &str, trigger: Trigger) -> Session {
    let mut config = octave("matlab".as_ref(), trigger);
    config.working_dir = folder.0.clone();
    config.pair = Some([format!("{name}Init"), format!("{name}Callback")]);
    config.display = false;
    Session::start(config).unwrap()
}

/// Runs a pair until it exits; `see` changes the sensor.
fn run(
    session: &Session,
    ticks: usize,
    mut see: impl FnMut(usize, &Robot, &mut Sensor),
) -> (Robot, usize) {
    let mut robot = Robot::new(&session.init().unwrap());
    for tick in 0..ticks {
        let mut sensor = robot.sensor();
        see(tick, &robot, &mut sensor);
        let reply = session.step(&sensor).unwrap();
        robot.obey(&reply.motor);
        if reply.exit {
            return (robot, tick);
        }
    }
    (robot, ticks)
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).powi(2))
        .sum::<f64>()
        .sqrt()
}

#[test_with(Octave)]
fn the_example_turns_every_joint() {
    let folder = scripts();
    for trigger in TRIGGERS {
        let mut config = octave("matlab".as_ref(), trigger);
        config.working_dir = folder.0.clone();
        let session = Session::start(config).unwrap();
        let (robot, ticks) = run(&session, 300, |tick, _, sensor| {
            sensor.picture = tick
                .is_multiple_of(15)
                .then(|| RgbImage::new(200, 150, vec![9; 90_000]).unwrap());
        });
        assert_eq!(ticks, 300);
        let limits = limits();
        for side in 0..2 {
            for joint in 0..7 {
                let start = if (side, joint) == (1, 2) {
                    std::f64::consts::FRAC_PI_2
                } else {
                    0.0
                };
                let expected = (start + 2.5_f64).min(limits.max_joint_angles[side][joint]);
                assert!(
                    (robot.angles[side][joint] - expected).abs() < 1e-9,
                    "joint {joint} of arm {side}"
                );
            }
        }
        assert_eq!(robot.grippers, [0.0, 0.0]);
        let printed = session.printed("gripperVelocities");
        for name in [
            "minJointAngles",
            "jointAngles",
            "endEffPos",
            "gripperVelocities",
        ] {
            assert!(printed.contains(name), "{name}: {printed}");
        }
        let (robot, _) = run(&session, 600, |_, _, _| {});
        assert!(robot.angles[0][0] < 0.1, "it has turned back");
    }
}

#[test_with(Octave)]
fn the_reaching_hand_gets_to_every_marker() {
    let folder = scripts();
    let session = session(&folder, "reach", Trigger::Stdin);
    let markers = session.init().unwrap().draw_markers;
    let mut nearest = vec![f64::MAX; markers.len()];
    let (_, ticks) = run(&session, 3000, |_, robot, _| {
        for (nearest, marker) in nearest.iter_mut().zip(&markers) {
            *nearest = nearest.min(distance(robot.hands()[1], *marker));
        }
    });
    assert!(ticks < 3000, "{nearest:?} {}", session.printed("nothing"));
    assert!(
        nearest.iter().all(|distance| *distance < 0.12),
        "{nearest:?}"
    );
}

#[test_with(Octave)]
fn the_head_follows_red() {
    let folder = scripts();
    let session = session(&folder, "follow", Trigger::Stdin);
    let bearing = |tick: usize| 0.8 - 0.001 * tick as f64;
    let (robot, _) = run(&session, 600, |tick, robot, sensor| {
        // Something red at a bearing, as a camera with a view of 60 degrees sees it.
        let (width, height) = (200, 150);
        let column = 100.0 - (bearing(tick) - robot.head).tan() / 30f64.to_radians().tan() * 100.0;
        let mut rgb = vec![0; 3 * width * height];
        for pixel in 0..width * height {
            let (row, offset) = (pixel / width, (pixel % width) as f64 - column);
            if row > 100 && offset.abs() < 8.0 && (bearing(tick) - robot.head).abs() < 1.0 {
                rgb[3 * pixel] = 230;
            }
        }
        sensor.picture = tick
            .is_multiple_of(15)
            .then(|| RgbImage::new(200, 150, rgb).unwrap());
    });
    assert!(
        (robot.head - bearing(600)).abs() < 0.12,
        "{} instead of {}",
        robot.head,
        bearing(600)
    );
}

#[test_with(Octave)]
fn the_babbling_arm_learns_to_reach() {
    let folder = scripts();
    let session = session(&folder, "babble", Trigger::Stdin);
    let markers = session.init().unwrap().draw_markers;
    let mut nearest = vec![f64::MAX; markers.len()];
    let (_, ticks) = run(&session, 6000, |tick, robot, _| {
        for (nearest, marker) in nearest.iter_mut().zip(&markers) {
            if tick as f64 * TICK > 60.0 {
                *nearest = nearest.min(distance(robot.hands()[1], *marker));
            }
        }
    });
    let printed = session.printed("target 4");
    assert!(ticks < 6000, "{printed}");
    assert!(
        nearest.iter().all(|distance| *distance < 0.4),
        "{nearest:?} {printed}"
    );
    assert!(folder.0.join("matlab/babble.mat").exists());
    let errors: Vec<f64> = printed
        .lines()
        .find(|line| line.contains("units; error"))
        .unwrap()
        .split_whitespace()
        .filter_map(|word| word.parse().ok())
        .filter(|number| *number < 1.0)
        .collect();
    assert!(errors[1] < 0.7 * errors[0], "it has learnt: {printed}");
}

#[test_with(Octave)]
fn the_plan_takes_the_hand_from_one_place_to_the_other() {
    let folder = scripts();
    let session = session(&folder, "pick", Trigger::Stdin);
    let mut closed_at = None;
    let mut opened_at = None;
    let mut opening = 2.0;
    let (robot, ticks) = run(&session, 3000, |_, robot, _| {
        let now = robot.grippers[1];
        if now < opening {
            closed_at = Some(robot.hands()[1]);
        } else if now > opening {
            opened_at = Some(robot.hands()[1]);
        }
        opening = now;
    });
    assert!(ticks < 3000);
    assert!(
        distance(closed_at.unwrap(), [3.0, -3.0, 0.9]) < 0.15,
        "{closed_at:?}"
    );
    assert!(
        distance(opened_at.unwrap(), [0.0, -3.0, 1.93]) < 0.15,
        "{opened_at:?}"
    );
    assert!(robot.grippers[1] > 1.5);
}

#[test_with(Octave)]
fn demonstrations_become_pictures() {
    let folder = scripts();
    let session = session(&folder, "record", Trigger::Stdin);
    run(&session, 30, |tick, _, sensor| {
        sensor.demo_cue = (5..20).contains(&tick);
        sensor.picture = tick
            .is_multiple_of(5)
            .then(|| RgbImage::new(20, 10, vec![tick as u8; 600]).unwrap());
    });
    let mut names: Vec<_> = fs::read_dir(folder.0.join("matlab/pictures"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["00001.png", "00002.png", "00003.png"]);
    let printed = session.printed("pictures go to");
    assert!(!printed.contains("warning"), "{printed}");
}
