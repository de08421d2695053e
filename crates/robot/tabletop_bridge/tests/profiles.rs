//! The shipped profiles and the descriptions of the same robots.

use tabletop_bridge::BridgeProfile;
use tabletop_kinematics::RobotModel;

const DESCRIPTIONS: [(&str, &str); 2] = [
    (
        "baxter",
        include_str!("../../../../assets/baxter/baxter.urdf"),
    ),
    ("panda", include_str!("../../../../assets/panda/panda.urdf")),
];

/// Our description of Baxter rounds the limits of the maker's as the report's table 1 does, by this many rad at most.
const ROUNDING: f64 = 0.002;

#[test]
fn limbs_have_the_joints_limits_and_speeds_of_their_descriptions() {
    for (name, urdf) in DESCRIPTIONS {
        let model = RobotModel::from_urdf(urdf).unwrap();
        let profile = BridgeProfile::shipped(name).unwrap();
        for joint in profile.limbs.iter().flat_map(|limb| &limb.joints) {
            let described = model.joint(model.find_joint(&joint.name).unwrap());
            assert_eq!(joint.speed, described.velocity, "{}", joint.name);
            let (least, largest) = joint.limits;
            for (of_robot, described) in [least, largest].into_iter().zip(described.limits) {
                assert!((of_robot - described).abs() <= ROUNDING, "{}", joint.name);
            }
        }
    }
}
