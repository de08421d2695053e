//! Small robots of many kinds.

use tabletop_core::RobotLayout;

use super::*;

/// A link as a box of these lengths about a point of its frame.
fn link(name: &str, at: &str, size: &str) -> String {
    format!(
        "<link name=\"{name}\"><collision><origin xyz=\"{at}\"/><geometry><box size=\"{size}\"/></geometry></collision></link>\n"
    )
}

/// A joint of a kind, with its place, its axis, and the rest of it.
fn joint(
    name: &str,
    kind: &str,
    [parent, child]: [&str; 2],
    at: &str,
    axis: &str,
    rest: &str,
) -> String {
    format!(
        "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
         <origin xyz=\"{at}\"/><axis xyz=\"{axis}\"/>{rest}</joint>\n"
    )
}

fn limit(least: f64, largest: f64) -> String {
    format!("<limit lower=\"{least}\" upper=\"{largest}\" effort=\"5\" velocity=\"2\"/>")
}

/// An arm on a link that stands upright at 0, of joints that turn about z, y, y and, from the fourth on, z and y in turn.
fn arm(prefix: &str, base: &str, at: &str, joints: usize) -> String {
    let mut text = String::new();
    let mut parent = base.to_owned();
    for number in 1..=joints {
        let child = format!("{prefix}link{number}");
        let axis = match number {
            1 | 4 | 6 => "0 0 1",
            _ => "0 1 0",
        };
        let place = match number {
            1 => at,
            3 | 5 => "0 0 0.25",
            _ => "0 0 0.05",
        };
        text += &link(&child, "0 0 0.02", "0.04 0.04 0.04");
        text += &joint(
            &format!("{prefix}joint{number}"),
            "revolute",
            [&parent, &child],
            place,
            axis,
            &limit(-2.5, 2.5),
        );
        parent = child;
    }
    text
}

fn robot(body: &str) -> String {
    format!(
        "<robot name=\"toy\">\n{}{body}</robot>",
        link("base", "0 0 0", "0.1 0.1 0.02")
    )
}

/// The first `robot.ron` of a robot, and the layout that it makes.
fn drafted(urdf: &str) -> (String, RobotLayout, RobotModel) {
    let source = DescriptionSource {
        path: "toy.urdf".into(),
        urdf: urdf.to_owned(),
        layout: None,
        reach: None,
    };
    let text = draft(&source, "toy.urdf").unwrap();
    let layout = Some(text.clone());
    let robot = Description::read(DescriptionSource { layout, ..source }).unwrap();
    (text, robot.layout, robot.model)
}

fn joints_of(layout: &RobotLayout, limb: usize) -> Vec<&str> {
    let joints = layout.limbs[limb].joints.iter();
    joints
        .map(|&joint| &*layout.joint(joint).urdf_name)
        .collect()
}

/// Two fingers that slide apart along y, the second of which follows the first.
fn two_fingers(prefix: &str, hand: &str) -> String {
    let finger = |side: &str| format!("{prefix}pad_{side}");
    let [left, right] = [finger("a"), finger("b")];
    let mimic = format!("{}<mimic joint=\"{prefix}slide_a\"/>", limit(0.0, 0.04));
    [
        link(&left, "0 0.005 0.03", "0.02 0.01 0.06"),
        link(&right, "0 -0.005 0.03", "0.02 0.01 0.06"),
        joint(
            &format!("{prefix}slide_a"),
            "prismatic",
            [hand, &left],
            "0 0 0.05",
            "0 1 0",
            &limit(0.0, 0.04),
        ),
        joint(
            &format!("{prefix}slide_b"),
            "prismatic",
            [hand, &right],
            "0 0 0.05",
            "0 -1 0",
            &mimic,
        ),
    ]
    .concat()
}

#[test]
fn an_arm_of_six_with_two_mimicked_fingers() {
    let urdf = robot(&(arm("", "base", "0 0 0.1", 6) + &two_fingers("", "link6")));
    let (text, layout, model) = drafted(&urdf);
    assert_eq!(layout.limbs.len(), 1);
    assert_eq!(
        joints_of(&layout, 0),
        ["joint1", "joint2", "joint3", "joint4", "joint5", "joint6"]
    );
    let limb = &layout.limbs[0];
    let gripper = layout.joint(limb.gripper.joint);
    assert_eq!(gripper.limits, [0.0, 0.8], "8 cm, in units: {text}");
    assert_eq!(limb.gripper.fingers.concat().len(), 2);
    assert_eq!(limb.gripper.finger_joints, ["slide_a"]);
    let [end_effector] = &limb.end_effector[..] else {
        panic!("{text}")
    };
    let [x, _, z] = end_effector.axes;
    assert_eq!((end_effector.link.as_str(), z), ("link6", [0.0, 0.0, -1.0]));
    assert_eq!(x[1].abs(), 1.0, "the fingers slide along y: {text}");
    // The fingers reach from 5 to 11 cm, and 5 cm of them touch things.
    let [across, along, out] = end_effector.at;
    assert!(
        across.abs() < 1e-6 && along.abs() < 1e-6 && (out - 0.085).abs() < 1e-6,
        "{text}"
    );

    // It starts with its fingers down before it.
    let mut values = model.zero();
    for joint in &layout.joints[..6] {
        values[model.find_joint(&joint.urdf_name).unwrap()] = joint.home;
    }
    let hand = model.frames(&values)[model.find_link("link6").unwrap()];
    assert!(hand.matrix3.z_axis.z < -0.95, "{text}");
    assert!(
        hand.translation.x > 0.15 && hand.translation.z > 0.05,
        "{text}"
    );
}

#[test]
fn an_arm_of_five_with_a_jaw() {
    let jaw = [
        link("palm_side", "-0.03 0 0.05", "0.01 0.03 0.1"),
        joint(
            "palm",
            "fixed",
            ["link5", "palm_side"],
            "0 0 0",
            "0 0 0",
            "",
        ),
        link("moving_jaw", "0 0 0.05", "0.01 0.02 0.1"),
        joint(
            "gripper",
            "revolute",
            ["link5", "moving_jaw"],
            "0.01 0 0",
            "0 1 0",
            &limit(-0.2, 1.5),
        ),
        "<link name=\"gripper_frame\"/>".to_owned(),
        joint(
            "frame",
            "fixed",
            ["palm_side", "gripper_frame"],
            "0 0 0.09",
            "0 0 0",
            "",
        ),
    ];
    let urdf = robot(&(arm("", "base", "0 0 0.1", 5) + &jaw.concat()));
    let (text, layout, _) = drafted(&urdf);
    assert_eq!(joints_of(&layout, 0).len(), 5, "{text}");
    let limb = &layout.limbs[0];
    assert_eq!(
        limb.gripper.fingers,
        [vec![], vec!["moving_jaw".to_owned()]],
        "{text}"
    );
    assert_eq!(limb.end_effector[0].link, "gripper_frame");
    assert_eq!(
        limb.end_effector[0].axes[0],
        [1.0, 0.0, 0.0],
        "the jaw opens towards x: {text}"
    );
    let [least, widest] = layout.joint(limb.gripper.joint).limits;
    assert!(
        least < 0.3 && (0.5..1.5).contains(&widest),
        "{least} to {widest}"
    );
}

#[test]
fn two_arms_on_a_torso_with_a_head() {
    let torso = [
        link("torso", "0 0 0.2", "0.2 0.2 0.4"),
        joint(
            "torso_lift",
            "prismatic",
            ["base", "torso"],
            "0 0 0.4",
            "0 0 1",
            &limit(0.1, 0.4),
        ),
        link("head", "0 0 0.05", "0.1 0.1 0.1"),
        joint(
            "head_pan",
            "revolute",
            ["torso", "head"],
            "0 0 0.6",
            "0 0 1",
            &limit(-1.5, 1.5),
        ),
        link("wheel", "0 0 0", "0.1 0.02 0.1"),
        joint(
            "wheel_joint",
            "continuous",
            ["base", "wheel"],
            "0 0.3 0",
            "0 1 0",
            "",
        ),
    ];
    let arms = ["right", "left"].map(|side| {
        let at = match side {
            "left" => "0.1 0.3 0.5",
            _ => "0.1 -0.3 0.5",
        };
        let prefix = format!("{side}_");
        arm(&prefix, "torso", at, 7) + &two_fingers(&prefix, &format!("{side}_link7"))
    });
    let (text, layout, model) = drafted(&robot(&(torso.concat() + &arms.concat())));
    let names: Vec<_> = layout.limbs.iter().map(|limb| limb.name.as_str()).collect();
    assert_eq!(names, ["left", "right"]);
    assert_eq!(joints_of(&layout, 1).len(), 7);
    assert_eq!(
        layout.neck.map(|neck| layout.joint(neck).name.as_str()),
        Some("head_pan")
    );
    assert!(text.contains("still: [(\"torso_lift\", 0.1)]"), "{text}");
    assert!(text.contains("wheel_joint"), "{text}");
    let lift = model.joint(model.find_joint("torso_lift").unwrap());
    assert_eq!(
        lift.origin.translation.z, 0.5,
        "it stands at its lower limit"
    );
    // Its shoulders are 35 cm above the table, though it stands on the floor.
    assert!(
        (layout.base.height + 6.5).abs() < 0.01,
        "{}",
        layout.base.height
    );
}

#[test]
fn a_lift_belongs_to_the_only_arm() {
    let lift = [
        link("mast", "0 0 0", "0.1 0.1 0.1"),
        joint(
            "Lift",
            "prismatic",
            ["base", "mast"],
            "0 0 0.05",
            "0 0 1",
            &limit(0.0, 0.4),
        ),
    ];
    let urdf = robot(&(lift.concat() + &arm("J", "mast", "0 0 0.1", 6)));
    let (text, layout, _) = drafted(&urdf);
    assert_eq!(joints_of(&layout, 0)[..2], ["Lift", "Jjoint1"]);
    assert!(layout.joints[0].slides);
    assert!(text.contains("The URDF has no fingers"), "{text}");
}

#[test]
fn what_branches_after_five_joints_is_a_hand() {
    let digits = [("a", "0 -0.03 0.1"), ("b", "0 0.03 0.1")].map(|(digit, at)| {
        let mut text = String::new();
        let mut parent = "link5".to_owned();
        for number in 0..4 {
            let child = format!("{digit}{number}");
            text += &link(&child, "0 0 0", "0.01 0.01 0.01");
            let name = format!("digit_{digit}{number}");
            text += &joint(
                &name,
                "revolute",
                [&parent, &child],
                if number == 0 { at } else { "0 0 0.03" },
                "1 0 0",
                &limit(0.0, 1.0),
            );
            parent = child;
        }
        text
    });
    let (text, layout, _) = drafted(&robot(&(arm("", "base", "0 0 0.1", 5) + &digits.concat())));
    assert_eq!(joints_of(&layout, 0).len(), 5, "{text}");
    let fingers = [vec!["a0".to_owned()], vec!["b0".to_owned()]];
    assert_eq!(layout.limbs[0].gripper.fingers, fingers, "{text}");
}

#[test]
fn what_has_no_limbs_or_faults_is_refused_with_a_sentence() {
    let refused = |urdf: &str| {
        let source = DescriptionSource {
            path: "toy.urdf".into(),
            urdf: urdf.to_owned(),
            layout: None,
            reach: None,
        };
        draft(&source, "toy.urdf").unwrap_err().to_string()
    };
    assert!(refused(&robot("")).starts_with("no limb was found"));
    assert!(refused("<robot name=\"a\">\n<link/></robot>").starts_with("line 2: "));
    let twice = arm("", "base", "0 0 0.1", 3).replace("joint2", "Joint1");
    let said = refused(&robot(&twice));
    assert!(said.contains("there are two joints joint1"), "{said}");
}

#[test]
fn names_stay_in_their_strings_and_comments() {
    let urdf = robot(&arm("a&quot;\\", "base", "0 0 0.1", 3))
        .replace("name=\"toy\"", "name=\"t&#10;) evil&quot;\"");
    let (_, layout, _) = drafted(&urdf);
    assert_eq!(layout.name, "t\n) evil\"");
    assert_eq!(joints_of(&layout, 0)[0], "a\"\\joint1");
}

#[test]
fn what_is_written_of_a_robot_inside_the_program_is_what_its_file_says() {
    let urdf = include_str!("../../../../../assets/panda/panda.urdf");
    let (text, layout, _) = drafted(urdf);
    assert_eq!(joints_of(&layout, 0).len(), 7, "{text}");
    assert_eq!(layout.limbs[0].end_effector[0].axes[2], [0.0, 0.0, -1.0]);
}
