//! Sensor fields of scripts, and those that they are spared.

use bevy::prelude::*;
use tabletop_core::{Arm, ObjectSpec, RobotCommand, Shape};
use tabletop_geometry::{Pose, Rgb};
use tabletop_harness::test_with;
use tabletop_script::{FieldPolicy, ScriptSettings};

use crate::kit::{Folder, Stage};

const NAMES: &str =
    "if ~exist('shown', 'var'), shown = fieldnames(sensor)'; disp(strjoin(sort(shown))); end\n";
const BARE: &str = "demoCue endEffPos gripperOpening headAngle jointAngles rgbVision timeElapsed";

fn fields(settings: ScriptSettings) -> String {
    let mut stage = Stage::start(settings);
    stage.ticks(3);
    assert_eq!(stage.failure(), None);
    stage.printed()
}

#[test_with(Octave)]
fn scripts_get_the_fields_they_mention() {
    let folder = Folder::pair("", NAMES);
    assert_eq!(fields(folder.settings()), BARE);
    folder.write(
        "helper.m",
        "function helper(sensor)\nsensor.trackerLoc('l-S1')\nend\n",
    );
    assert_eq!(fields(folder.settings()), format!("{BARE} trackerLoc"));
    folder.write("helper.m", "x = sensor.held.left;\n");
    let all = "contacts demoCue endEffPos gripperOpening headAngle held jointAngles objects rgbVision timeElapsed";
    assert_eq!(fields(folder.settings()), all);
    let never = ScriptSettings {
        objects: FieldPolicy::Never,
        ..folder.settings()
    };
    assert_eq!(fields(never), BARE);
    let folder = Folder::pair("", NAMES);
    let always = ScriptSettings {
        objects: FieldPolicy::Always,
        trackers: FieldPolicy::Always,
        ..folder.settings()
    };
    let all = all.replace("contacts", "contacts controls");
    assert_eq!(fields(always), format!("{all} trackerLoc"));
}

#[test_with(Octave)]
fn sensed_values_match_the_world() {
    let folder = Folder::pair(
        "",
        "disp(sensor.trackerLoc('r-W1'));
disp(sensor.endEffPos);
disp(sensor.objects.id);
disp(sensor.objects.position);
disp([sensor.objects.rotation, sensor.objects.mass]);
disp(sensor.objects.description);
disp(sprintf('%d', isempty(sensor.held.left), numel(sensor.contacts.first)));
aux.exit = 1;
",
    );
    let mut stage = Stage::start(folder.settings());
    let pose = Pose::from_degrees(Vec3::new(1.0, 2.0, 0.5), Vec3::new(0.0, 0.0, 30.0));
    let spec = ObjectSpec {
        id: "thing".into(),
        pose,
        mass: 2.0,
        shape: Shape::Block {
            span: Vec3::ONE,
            color: Rgb::GRAY,
        },
        dynamics: Default::default(),
        descriptions: vec![("kind".into(), "toy".into())],
    };
    stage.app.world_mut().spawn((Transform::from(pose), spec));
    stage.ticks_until(Stage::has_stopped);
    let printed = stage.printed();
    let numbers: Vec<f32> = printed
        .split_whitespace()
        .filter_map(|word| word.parse().ok())
        .collect();
    let robot = stage.robot();
    let arms = Arm::BOTH.map(|arm| robot.limb(arm).end_effector.location);
    let wrist = robot.limb(Arm::Right).joint_origins[2].to_array();
    let expected: Vec<f32> = wrist
        .into_iter()
        .chain(arms[0].to_array())
        .chain(arms[1].to_array())
        .chain([1.0, 2.0, 0.5, 0.0, 0.0, 30f32.to_radians(), 2.0, 10.0])
        .collect();
    assert_eq!(numbers.len(), expected.len(), "{printed}");
    for (number, expected) in numbers.iter().zip(&expected) {
        assert!((number - expected).abs() < 1e-3, "{printed} {expected}");
    }
    assert!(printed.contains("thing"), "{printed}");
    assert!(printed.contains("kind=toy"), "{printed}");
}

#[test_with(Octave)]
fn sensed_contacts_are_those_of_the_robot() {
    // The left arm goes down to the table, on the right one lies a plate.
    let folder = Folder::pair(
        "n = 0;",
        "n = n + 1;
motor.jointVelocities(1, [2 4]) = [1 -1];
if n == 90
  c = sensor.contacts;
  for i = 1:numel(c.first)
    disp(sprintf('%s %s %.9g %.9g %.9g %.9g', c.first{i}, c.second{i}, c.point(i, :), c.impulse(i)));
  end
  aux.exit = 1;
end
",
    );
    let mut stage = Stage::start(folder.settings());
    stage.command(RobotCommand::Show(true));
    let pose = Pose::at(Vec3::new(4.4, -5.58, 6.65));
    let spec = ObjectSpec {
        id: "plate".into(),
        pose,
        mass: 2.0,
        shape: Shape::Block {
            span: Vec3::new(1.0, 1.0, 0.2),
            color: Rgb::GRAY,
        },
        dynamics: Default::default(),
        descriptions: Vec::new(),
    };
    stage.app.world_mut().spawn((Transform::from(pose), spec));
    let mut touched = Vec::new();
    for _ in 0..100 {
        if stage.has_stopped() {
            break;
        }
        touched = stage.robot().contacts.clone();
        stage.ticks(1);
    }
    assert_eq!(stage.failure(), None);
    assert!(stage.has_stopped());
    let printed = stage.printed();
    let lines: Vec<Vec<_>> = printed
        .lines()
        .map(|line| line.split_whitespace().collect())
        .collect();
    assert_eq!(lines.len(), touched.len(), "{printed}");
    for (line, contact) in lines.iter().zip(&touched) {
        assert_eq!(line[0], contact.body);
        let numbers: Vec<f32> = line[2..].iter().map(|word| word.parse().unwrap()).collect();
        let Vec3 { x, y, z } = contact.point;
        assert_eq!(numbers, [x, y, z, contact.impulse]);
    }
    let pairs: Vec<_> = lines.iter().map(|line| [line[0], line[1]]).collect();
    let expected = [
        ["right_upper_forearm", "plate"],
        ["left-gripper-left-finger", "table"],
    ];
    assert_eq!(pairs, expected);
}

#[test_with(Octave)]
fn pictures_come_as_often_as_they_are_wanted() {
    let counting = "n = n + 1;
if isfield(sensor, 'rgbVision')
  seen(end + 1) = n;
  if n == 1, disp([size(sensor.rgbVision), max(sensor.rgbVision(:))]); end
end
if n == 31, disp(sprintf('%d ', seen)); aux.exit = 1; end
";
    for (every, expected) in [(15, vec![1, 16, 31]), (1, (1..=31).collect())] {
        let folder = Folder::pair("n = 0; seen = [];", counting);
        let mut settings = folder.settings();
        settings.ticks_per_picture = every;
        let mut stage = Stage::start(settings);
        stage.ticks_until(Stage::has_stopped);
        let printed = stage.printed();
        let mut numbers = printed
            .split_whitespace()
            .filter_map(|word| word.parse::<u32>().ok());
        let size: Vec<_> = numbers.by_ref().take(4).collect();
        assert_eq!(size, [150, 200, 3, 1], "{printed}");
        assert_eq!(numbers.collect::<Vec<_>>(), expected, "{printed}");
    }
}

#[test_with(Octave)]
fn pictures_show_the_markers_and_not_the_past() {
    let folder = Folder::pair(
        "aux.drawMarkers = [0 0 1]; n = 0;",
        "n = n + 1; v = sensor.rgbVision; disp(squeeze(v(75, 100, :))'); if n == 2, aux.exit = 1; end",
    );
    let mut settings = folder.settings();
    settings.ticks_per_picture = 1;
    let mut stage = Stage::start(settings);
    stage.command(RobotCommand::Show(false));
    stage.ticks_until(Stage::has_stopped);
    let printed = stage.printed();
    let numbers: Vec<f32> = printed
        .split_whitespace()
        .filter_map(|word| word.parse().ok())
        .collect();
    assert_eq!(numbers.len(), 6, "{printed}");
    assert!(
        numbers[0] < 0.9 && numbers[0] < numbers[1],
        "a marker is blue-green: {printed}"
    );
}
