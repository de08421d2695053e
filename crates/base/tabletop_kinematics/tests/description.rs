//! Baxter's own file beyond the frames: limits, gripper, bodies.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DAffine3, DVec3};
use tabletop_kinematics::{
    ArmChain, Frames, Geometry, JointType, JointValues, LinkShape, RobotModel, baxter, baxter_smile,
};

const POSES: [(&str, [f64; 7]); 3] = [
    ("start", [0.25, 0.0, -1.527, 2.618, 1.529, 1.5, 0.0]),
    ("untucked", [-0.08, -1.0, -1.19, 1.94, 0.67, 1.03, -0.5]),
    ("tucked", [-1.0, -2.07, 3.0, 2.55, 0.0, 0.01, 0.0]),
];

/// Both arms in mirror images of a posture of the left one: the joints whose axes stand upright turn the other way.
fn posture(robot: &RobotModel, left: [f64; 7]) -> JointValues {
    let mut configuration = robot.zero();
    for (side, sign) in [("left", 1.0), ("right", -1.0)] {
        let arm = ArmChain::between(robot, "torso", &format!("{side}_wrist")).unwrap();
        let angles: [f64; 7] =
            std::array::from_fn(|i| if i % 2 == 0 { sign * left[i] } else { left[i] });
        arm.set_angles(&angles, &mut configuration);
    }
    configuration
}

#[test]
fn limits_are_those_of_the_reports_table() {
    for robot in [baxter().unwrap(), baxter_smile().unwrap()] {
        for (side, effort) in [("left", 50.0), ("right", 50.0)] {
            let limits = [
                ("s0", [-1.7, 1.7]),
                ("s1", [-2.147, 1.047]),
                ("e0", [-3.054, 3.054]),
                ("e1", [-0.05, 2.618]),
                ("w0", [-3.059, 3.059]),
                ("w1", [-FRAC_PI_2, 2.094]),
                ("w2", [-3.059, 3.059]),
            ];
            for (i, (name, limits)) in limits.into_iter().enumerate() {
                let id = robot.find_joint(&format!("{side}_{name}")).unwrap();
                let joint = robot.joint(id);
                assert_eq!(joint.limits, limits, "{}", joint.name);
                assert_eq!(joint.kind, JointType::Revolute);
                assert_eq!(joint.effort, if i < 4 { effort } else { 15.0 });
                assert_eq!(joint.velocity, if i < 4 { 1.5 } else { 4.0 });
                assert_eq!(joint.damping, 0.7);
            }
        }
        let neck = robot.find_joint("head_pan").unwrap();
        assert_eq!(robot.joint(neck).limits, [-FRAC_PI_2, FRAC_PI_2]);
        assert_eq!(robot.movable().count(), 7 + 7 + 1 + 4);
    }
}

#[test]
fn the_arms_are_mirror_images() {
    let robot = baxter().unwrap();
    for (name, left) in POSES {
        let frames = robot.frames(&posture(&robot, left));
        for link in robot
            .links()
            .iter()
            .filter(|link| link.name.starts_with("left_"))
        {
            // Mirrored cameras and buttons would not be the same part.
            if link.name.contains("hand_") || link.name.contains("itb") {
                continue;
            }
            let other = link.name.replacen("left", "right", 1);
            let [left, right] =
                [&link.name, &other].map(|name| frames[robot.find_link(name).unwrap()].translation);
            assert!(
                left.distance(right * DVec3::new(1.0, -1.0, 1.0)) < 1e-9,
                "{name} {other}"
            );
        }
    }
}

#[test]
fn fingers_have_their_inner_faces_half_the_opening_from_the_hands_centre() {
    let robot = baxter().unwrap();
    for (side, s) in [("left", 'l'), ("right", 'r')] {
        for opening in [0.0, 0.07, 0.2] {
            let mut configuration = posture(&robot, POSES[0].1);
            for finger in ['l', 'r'] {
                let name = format!("{s}_gripper_{finger}_finger_joint");
                configuration[robot.find_joint(&name).unwrap()] = opening / 2.0;
            }
            let frames = robot.frames(&configuration);
            let hand = frames[robot.find_link(&format!("{side}_end_effector")).unwrap()];
            for (finger, sign) in [('l', -1.0), ('r', 1.0)] {
                let id = robot
                    .find_link(&format!("{s}_gripper_{finger}_finger"))
                    .unwrap();
                let [shape] = robot.link(id).collisions.as_slice() else {
                    panic!("a finger is one box");
                };
                let corners = corners(shape).map(|c| {
                    hand.inverse()
                        .transform_point3(frames[id].transform_point3(c))
                });
                let inner = sign * opening / 2.0;
                let (least, largest) = bounds(&corners);
                let expected = if sign < 0.0 {
                    [
                        DVec3::new(inner - 0.03, -0.02, -0.075),
                        DVec3::new(inner, 0.02, 0.075),
                    ]
                } else {
                    [
                        DVec3::new(inner, -0.02, -0.075),
                        DVec3::new(inner + 0.03, 0.02, 0.075),
                    ]
                };
                assert!(
                    least.distance(expected[0]) < 1e-9,
                    "{side} {finger}: {least}"
                );
                assert!(
                    largest.distance(expected[1]) < 1e-9,
                    "{side} {finger}: {largest}"
                );
            }
        }
    }
}

#[test]
fn the_cross_bar_lies_behind_the_fingers() {
    let robot = baxter().unwrap();
    let frames = robot.frames(&robot.zero());
    let hand = frames[robot.find_link("left_end_effector").unwrap()];
    let base = robot.find_link("left_gripper_base").unwrap();
    let [bar] = robot.link(base).collisions.as_slice() else {
        panic!("the gripper's base is one cylinder");
    };
    let bar = hand.inverse() * frames[base] * bar.origin;
    assert!(bar.translation.distance(DVec3::new(0.0, 0.0, 0.075)) < 1e-9);
    assert!(bar.matrix3.z_axis.x.abs() > 1.0 - 1e-9, "along the opening");
}

#[test]
fn an_arm_weighs_as_much_as_its_links() {
    let robot = baxter().unwrap();
    let left = |link: &str| link.starts_with("left_") || link.starts_with("l_gripper");
    let links = robot.links().iter().filter(|link| left(&link.name));
    let mass: f64 = links.map(|link| link.inertial.mass).sum();
    assert!((mass - (19.711 + 0.36)).abs() < 0.001, "{mass} kg");
    for link in robot.links().iter().filter(|link| link.inertial.mass > 0.0) {
        let inertia = link.inertial.inertia;
        let trace = inertia.x_axis.x + inertia.y_axis.y + inertia.z_axis.z;
        for axis in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE.normalize()] {
            let moment = axis.dot(inertia * axis);
            assert!(
                moment > 0.0 && moment < trace / 2.0,
                "{}: a real body",
                link.name
            );
        }
    }
}

#[test]
fn torso_and_head_meet_no_arm_in_the_usual_postures() {
    let robot = baxter().unwrap();
    for (name, left) in POSES {
        let mut configuration = posture(&robot, left);
        for s in ['l', 'r'] {
            for finger in ['l', 'r'] {
                let name = format!("{s}_gripper_{finger}_finger_joint");
                configuration[robot.find_joint(&name).unwrap()] = 0.1;
            }
        }
        let pan = robot.find_joint("head_pan").unwrap();
        for turn in [-FRAC_PI_2, -0.7, 0.0, 0.7, FRAC_PI_2] {
            configuration[pan] = turn;
            let frames = robot.frames(&configuration);
            let (body, arms): (Vec<_>, Vec<_>) = placed(&robot, &frames)
                .into_iter()
                .partition(|(link, ..)| ["torso", "pedestal", "head", "screen"].contains(link));
            assert_eq!((body.len(), arms.len()), (10, 20));
            for (link, shape, at) in &body {
                for (other, of_arm, place) in &arms {
                    let inside = at.inverse() * *place;
                    let meets =
                        surface(of_arm).any(|p| contains(shape, inside.transform_point3(p)));
                    assert!(
                        !meets,
                        "{name}, head at {turn}: {other} in {link} {:?}",
                        shape.geometry
                    );
                }
            }
        }
    }
}

/// The collision shapes of the robot by link, with their poses.
fn placed<'a>(robot: &'a RobotModel, frames: &Frames) -> Vec<(&'a str, &'a LinkShape, DAffine3)> {
    let mut placed = Vec::new();
    for link in robot.links() {
        let frame = frames[robot.find_link(&link.name).unwrap()];
        let shapes = link.collisions.iter();
        placed.extend(shapes.map(|shape| (link.name.as_str(), shape, frame * shape.origin)));
    }
    placed
}

/// Points all over a body's surface, at most about 2 cm apart, in its own frame.
fn surface(shape: &LinkShape) -> impl Iterator<Item = DVec3> {
    let points: Vec<DVec3> = match shape.geometry {
        Geometry::Cylinder { radius, length } => (0..=24)
            .flat_map(|i| (0..24).map(move |k| (f64::from(i) / 24.0, TAU * f64::from(k) / 24.0)))
            .flat_map(|(height, angle)| {
                let at = |r: f64, z: f64| {
                    DVec3::new(r * angle.cos(), r * angle.sin(), length * (z - 0.5))
                };
                let cap = radius * height;
                [at(radius, height), at(cap, 0.0), at(cap, 1.0)]
            })
            .collect(),
        Geometry::Box { size } => {
            let steps = || (0..=12).map(|i| f64::from(i) / 12.0 - 0.5);
            let grid = steps()
                .flat_map(|x| steps().flat_map(move |y| steps().map(move |z| DVec3::new(x, y, z))));
            grid.filter(|p| p.abs().max_element() == 0.5)
                .map(|p| p * size)
                .collect()
        }
        Geometry::Sphere { .. } | Geometry::Mesh { .. } => {
            panic!("a body is a box or a cylinder")
        }
    };
    points.into_iter()
}

fn contains(shape: &LinkShape, point: DVec3) -> bool {
    match shape.geometry {
        Geometry::Cylinder { radius, length } => {
            point.truncate().length() < radius && point.z.abs() < length / 2.0
        }
        Geometry::Box { size } => point.abs().cmplt(size / 2.0).all(),
        Geometry::Sphere { .. } | Geometry::Mesh { .. } => {
            panic!("a body is a box or a cylinder")
        }
    }
}

/// The corners of a box, in its link's frame.
fn corners(shape: &LinkShape) -> [DVec3; 8] {
    let Geometry::Box { size } = shape.geometry else {
        panic!("a box has corners");
    };
    std::array::from_fn(|i| {
        let sign = |bit: usize| if i & bit == 0 { -0.5 } else { 0.5 };
        shape
            .origin
            .transform_point3(DVec3::new(sign(1), sign(2), sign(4)) * size)
    })
}

fn bounds(points: &[DVec3]) -> (DVec3, DVec3) {
    let least = points.iter().copied().reduce(DVec3::min).unwrap();
    (least, points.iter().copied().reduce(DVec3::max).unwrap())
}
