//! Texts that are no robots: refused where the fault is, and never with a panic.

use proptest::prelude::*;
use tabletop_kinematics::{ArmChain, Geometry, ModelError, RobotModel, baxter};

/// A robot of two links and a joint, with something put into or instead of its parts. The joint stands in line 4.
fn robot(joint: &str) -> String {
    format!("<robot name=\"test\">\n<link name=\"a\"/>\n<link name=\"b\"/>\n{joint}\n</robot>")
}

const ENDS: &str = "<parent link=\"a\"/><child link=\"b\"/>";

fn joint(kind: &str, inside: &str) -> String {
    robot(&format!(
        "<joint name=\"j\" type=\"{kind}\">{ENDS}{inside}</joint>"
    ))
}

fn link(inside: &str) -> String {
    format!("<robot name=\"test\">\n<link name=\"a\">\n{inside}</link></robot>")
}

fn body(geometry: &str) -> String {
    link(&format!(
        "<collision><geometry>{geometry}</geometry></collision>"
    ))
}

fn inertial(mass: &str, ixx: &str) -> String {
    link(&format!(
        "<inertial><mass value=\"{mass}\"/><inertia ixx=\"{ixx}\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial>"
    ))
}

#[test]
fn every_fault_is_reported_with_its_place() {
    let two_joints = |second: &str| {
        robot(&format!(
            "<joint name=\"j\" type=\"fixed\">{ENDS}</joint>\n{second}"
        ))
    };
    let cases = [
        (
            "<robot name=\"test\"/>".to_owned(),
            "there is no link: a robot has at least one",
        ),
        (
            robot(""),
            "line 3: link b hangs on no joint, and neither does a: only one link may be the root",
        ),
        (
            robot("<link name=\"b\"/>"),
            "line 4: there is already a link named b: give each link a name of its own",
        ),
        (
            two_joints(
                "<joint name=\"j\" type=\"fixed\"><parent link=\"b\"/><child link=\"a\"/></joint>",
            ),
            "line 5: there is already a joint named j: give each joint a name of its own",
        ),
        (
            two_joints(
                "<joint name=\"k\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>",
            ),
            "line 5: joint k: link b already hangs on joint j",
        ),
        (
            two_joints(
                "<joint name=\"k\" type=\"fixed\"><parent link=\"b\"/><child link=\"a\"/></joint>",
            ),
            "line 2: link a hangs on itself by way of its joints",
        ),
        (
            robot(
                "<joint name=\"j\" type=\"fixed\"><parent link=\"b\"/><child link=\"b\"/></joint>",
            ),
            "line 3: link b hangs on itself by way of its joints",
        ),
        (
            robot(
                "<joint name=\"j\" type=\"fixed\"><parent link=\"c\"/><child link=\"b\"/></joint>",
            ),
            "line 4: joint j: there is no link c",
        ),
        (
            joint("floating", ""),
            "line 4: joint j: floating joints are not supported: use fixed, revolute, continuous or prismatic",
        ),
        (
            joint("revolute", "<axis xyz=\"0 0 0\"/>"),
            "line 4: joint j: its axis has no direction",
        ),
        (
            joint("revolute", "<axis xyz=\"0 NaN 1\"/>"),
            "line 4: joint j: its axis is not finite",
        ),
        (
            joint(
                "revolute",
                "<limit lower=\"1\" upper=\"-1\" effort=\"1\" velocity=\"1\"/>",
            ),
            "line 4: joint j: its lower limit is above its upper one",
        ),
        (
            joint(
                "revolute",
                "<limit lower=\"NaN\" upper=\"1\" effort=\"1\" velocity=\"1\"/>",
            ),
            "line 4: joint j: its lower limit is above its upper one",
        ),
        (
            joint(
                "revolute",
                "<limit lower=\"0\" upper=\"1\" effort=\"-1\" velocity=\"1\"/>",
            ),
            "line 4: joint j: its effort is negative or not a number",
        ),
        (
            joint("fixed", "<origin xyz=\"inf 0 0\"/>"),
            "line 4: joint j: an xyz is not finite",
        ),
        (
            joint("revolute", "<mimic joint=\"x\"/>"),
            "line 4: joint j: it cannot mimic x: there is no such joint; name one, or remove its <mimic>",
        ),
        (
            joint("revolute", "<mimic joint=\"j\"/>"),
            "line 4: joint j: it cannot mimic j: it follows itself",
        ),
        (
            inertial("-1", "1"),
            "line 2: link a: its mass is negative or not finite",
        ),
        (
            inertial("1", "NaN"),
            "line 2: link a: its inertia is negative or not finite; correct its <inertia>, or remove its <inertial>",
        ),
        (
            inertial("1", "1e13"),
            "line 2: link a: no body has its inertia: a principal moment is negative; correct its <inertia>, or remove its <inertial>",
        ),
        (
            inertial("1", "1\" ixy=\"2").replacen(" ixy=\"0\"", "", 1),
            "line 2: link a: no body has its inertia: a principal moment is negative; correct its <inertia>, or remove its <inertial>",
        ),
        (
            inertial("1e7", "1"),
            "line 2: link a: its mass is over 1,000,000 kg",
        ),
        (
            body("<cylinder radius=\"18446744073709551616\" length=\"1\"/>"),
            "line 2: link a: a length is over 1000 m",
        ),
        (
            body("<sphere radius=\"-1\"/>"),
            "line 2: link a: a length is negative or not finite",
        ),
        (
            body("<capsule radius=\"-1\" length=\"1\"/>"),
            "line 2: link a: a length is negative or not finite",
        ),
        (
            robot("<xacro:arm name=\"left\"/>"),
            "line 4: <xacro:arm> is xacro, which makes URDF: expand it with `xacro NAME.urdf.xacro > NAME.urdf` (ROS, or `pip install xacro`) and use the result",
        ),
        (
            body("<sphere radius='${r / 2}'/>"),
            "line 3: ${r / 2} is xacro, which makes URDF: expand it with `xacro NAME.urdf.xacro > NAME.urdf` (ROS, or `pip install xacro`) and use the result",
        ),
    ];
    for (text, expected) in cases {
        let error = RobotModel::from_urdf(&text).unwrap_err();
        assert_eq!(error.to_string(), expected, "{text}");
    }
}

#[test]
fn unreadable_elements_are_located() {
    let cases = [
        (joint("wobbly", ""), "line 4: joint j: "),
        (
            joint("revolute", "<axis xyz=\"0 0\"/>"),
            "line 4: joint j: ",
        ),
        (
            joint("revolute", "<axis xyz=\"0 0 o\"/>"),
            "line 4: joint j: ",
        ),
        (
            robot("<joint name='j' type='fixed'><child link='b'/></joint>"),
            "line 4: joint j: ",
        ),
        (robot("<joint type='fixed'/>"), "line 4: joint: "),
        (
            robot("<joint name='j'>\n<axis xyz='0 0 1'>\n</joint>"),
            "line 5: axis: it has not ended where </joint> stands in line 6",
        ),
        (robot("<joint name='j'"), "line 4: joint: it does not end"),
        (body("<cone/>"), "line 2: link a: "),
        (inertial("heavy", "1"), "line 2: link a: "),
    ];
    for (text, start) in cases {
        let error = RobotModel::from_urdf(&text).unwrap_err().to_string();
        assert!(error.starts_with(start), "{error}\n{text}");
    }
}

#[test]
fn texts_that_are_no_xml_are_refused() {
    let nested = |depth: usize| format!("{}{}", "<a>".repeat(depth), "</a>".repeat(depth));
    for text in [
        String::new(),
        "\u{feff}".to_owned(),
        "robot".to_owned(),
        "<".to_owned(),
        "<robot".to_owned(),
        "<robot>".to_owned(),
        "</robot>".to_owned(),
        "<robot></link>".to_owned(),
        "<robot name='é<link/>".to_owned(),
        "<robot><!-- ".to_owned(),
        "<robot><![CDATA[ ".to_owned(),
        "<robot>&nothing;</robot>".to_owned(),
        "<robot><link/></robot>".to_owned(),
        "<robot><joint name='j'><type><fixed/></type></joint></robot>".to_owned(),
        "<robot><joint name='j'><type>fixed</type></joint></robot>".to_owned(),
        nested(60),
        nested(100_000),
    ] {
        let refused = RobotModel::from_urdf(&text);
        assert!(refused.is_err(), "{text:.100}");
    }
    let error = RobotModel::from_urdf(&nested(100_000)).unwrap_err();
    assert!(
        matches!(error, ModelError::TooDeep { line: 1, .. }),
        "{error}"
    );
}

#[test]
fn xml_beyond_urdf_is_refused_or_left_out() {
    let entity = "<!DOCTYPE robot [<!ENTITY a \"<link name='a'/>\">]>\n<robot name='r'>&a;</robot>";
    let deep = format!(
        "<!DOCTYPE robot [<!ENTITY a \"<\">]><robot>{}",
        "<a>".repeat(20_000)
    );
    for text in [entity, &deep] {
        let error = RobotModel::from_urdf(text).unwrap_err().to_string();
        assert!(
            error.contains("DOCTYPE") || error.contains("deep"),
            "{error}"
        );
    }
    for robot in [
        "<robot xmlns='' name='r'><link xmlns='a' name='a'/></robot>",
        "<robot xmlns:a='' name='r'><a:b xmlns:a='c'/><link xmlns:c='a' c:d='e' name='a'/></robot>",
        "<a:robot xmlns:a='b' name='r'><link name='a'/></a:robot>",
    ] {
        // Robot or not, there is no panic.
        let _read = RobotModel::from_urdf(robot);
    }
}

#[test]
fn a_cylinder_without_thickness_has_a_radius_of_zero() {
    let text = body("<cylinder radius=\"-0.0\" length=\"1\"/>");
    let robot = RobotModel::from_urdf(&text).unwrap();
    let link = robot.links().first();
    let shape = link.and_then(|link| link.collisions.first()).unwrap();
    assert!(
        matches!(shape.geometry, Geometry::Cylinder { radius, .. } if radius.is_sign_positive())
    );
}

#[test]
fn a_capsule_is_a_cylinder_and_two_balls() {
    let text = body("<capsule radius=\"0.1\" length=\"0.6\"/>").replace(
        "<collision>",
        "<collision><origin xyz=\"1 0 0\" rpy=\"0 1.5707963267948966 0\"/>",
    );
    let robot = RobotModel::from_urdf(&text).unwrap();
    let link = robot.links().first().unwrap();
    let found: Vec<_> = link
        .collisions
        .iter()
        .map(|shape| {
            (
                shape.geometry.clone(),
                (shape.origin.translation * 1e6).round() / 1e6,
            )
        })
        .collect();
    let ball = Geometry::Sphere { radius: 0.1 };
    let cylinder = Geometry::Cylinder {
        radius: 0.1,
        length: 0.6,
    };
    let at = |x| glam::DVec3::new(x, 0.0, 0.0);
    assert_eq!(
        found,
        [
            (cylinder, at(1.0)),
            (ball.clone(), at(0.7)),
            (ball, at(1.3))
        ]
    );
}

#[test]
fn what_xacro_has_made_is_read() {
    let text = "<?xml version='1.0'?>\n<!-- ${made} by <xacro:x> -->\n\
        <robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'>\n<link name='a'/></robot>";
    let robot = RobotModel::from_urdf(text).unwrap();
    assert_eq!(robot.links()[0].line, 4);
}

#[test]
fn a_long_chain_is_read() {
    let mut text = "<robot name=\"snake\"><link name=\"0\"/>".to_owned();
    for i in 1..=5000 {
        text += &format!(
            "<link name=\"{i}\"/><joint name=\"{i}\" type=\"continuous\"><parent link=\"{}\"/><child link=\"{i}\"/></joint>\n",
            i - 1
        );
    }
    text += "</robot>";
    let robot = RobotModel::from_urdf(&text).unwrap();
    assert_eq!(robot.links().len(), 5001);
    let error = ArmChain::between(&robot, "0", "5000").unwrap_err();
    assert_eq!(
        error.to_string(),
        "no arm leads from link 0 to link 5000: there are 5000 joints instead of 1 to 16"
    );
}

#[test]
fn arms_that_are_none_are_refused() {
    let robot = baxter().unwrap();
    for (base, tip, message) in [
        ("torso", "left_elbow", "robot baxter has no link left_elbow"),
        (
            "left_wrist",
            "torso",
            "no arm leads from link left_wrist to link torso: the tip does not hang on the base",
        ),
        (
            "torso",
            "torso",
            "no arm leads from link torso to link torso: there are 0 joints instead of 1 to 16",
        ),
    ] {
        let error = ArmChain::between(&robot, base, tip).unwrap_err();
        assert_eq!(error.to_string(), message);
    }
}

#[test]
fn a_joint_that_follows_another_is_no_part_of_an_arm() {
    let text = "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>\
        <joint name='i' type='prismatic'><parent link='a'/><child link='b'/><limit lower='0' upper='1' velocity='1'/></joint>\
        <joint name='j' type='prismatic'><parent link='b'/><child link='c'/><limit lower='0' upper='1' velocity='1'/><mimic joint='i'/></joint></robot>";
    let robot = RobotModel::from_urdf(text).unwrap();
    assert_eq!(
        ArmChain::between(&robot, "a", "b").unwrap().joints().len(),
        1
    );
    let error = ArmChain::between(&robot, "a", "c").unwrap_err();
    assert_eq!(
        error.to_string(),
        "no arm leads from link a to link c: joint j does not move by itself: it mimics i"
    );
}

proptest! {
    /// Baxter's file with something cut out, doubled or put in anywhere.
    #[test]
    fn damaged_files_never_panic(
        cut in any::<prop::sample::Index>(),
        length in 0..80_usize,
        patch in prop::sample::select(vec!["", "<", ">", "\"", "/>", "</link>", "é", "<!--", "]]>", "NaN", "-1e999", "&#0;", "<link name=\"x\">"]),
    ) {
        let text = include_str!("../../../../assets/baxter/baxter.urdf");
        let cut = cut.index(text.len());
        let end = (cut + length).min(text.len());
        let damaged = format!("{}{patch}{}", &text[..cut], &text[end..]);
        let _ = RobotModel::from_urdf(&damaged);
    }
}
