//! The interface by which a real robot is reached that is to stand in for a simulated one.

use std::path::Path;

use tabletop_bridge::{Address, BridgeProfile};
use tabletop_core::RobotLayout;

/// The profiles inside the program whose robot is not Baxter, with the `robot.ron` of their bodies.
const BODIES: [(&str, &str); 2] = [
    ("panda", "assets/panda/robot.ron"),
    ("fr3", "assets/panda/robot.ron"),
];

/// The `robot.ron` inside the program that is the body of an address' robot; none for Baxter and for robots of others.
pub fn shipped_body(address: &Address) -> Option<&'static str> {
    let body = BODIES.iter().find(|(name, _)| *name == address.robot);
    body.map(|(_, file)| *file)
}

/// The interface of the robot at an address: the `bridge.ron` in the folder of its description if that is of this robot, else the one inside the program.
///
/// # Errors
/// There is none, it cannot be read, or its limbs and joints are not those of the robot.
pub fn interface_of(
    address: &Address,
    folder: Option<&Path>,
    layout: &RobotLayout,
) -> Result<BridgeProfile, String> {
    let profile = find_interface(address, folder)?;
    fit(&profile, layout)?;
    Ok(profile)
}

/// The same for whatever robot.
///
/// # Errors
/// There is none, or it cannot be read.
pub fn find_interface(address: &Address, folder: Option<&Path>) -> Result<BridgeProfile, String> {
    let is_shipped = BridgeProfile::shipped_names().any(|name| name == address.robot);
    let beside = folder.map(|folder| folder.join("bridge.ron"));
    let own = match beside.filter(|path| path.is_file()) {
        Some(path) => Some(BridgeProfile::read(&path).map_err(|error| error.to_string())?),
        None => None,
    };
    let own = own.filter(|own| !is_shipped || own.robot.eq_ignore_ascii_case(&address.robot));
    match own {
        Some(own) => Ok(own),
        None => BridgeProfile::shipped(&address.robot).map_err(|error| {
            format!("{error}; one of your own is a bridge.ron beside the robot.ron of --robot")
        }),
    }
}

/// Makes sure that the limbs of an interface are those of a robot.
fn fit(profile: &BridgeProfile, layout: &RobotLayout) -> Result<(), String> {
    for limb in &profile.limbs {
        let own = layout.limbs.iter().find(|it| it.name.as_str() == limb.name);
        let Some(own) = own else {
            let names: Vec<_> = layout.limbs.iter().map(|it| it.name.as_str()).collect();
            return Err(format!(
                "{} has a limb {:?}, and the robot that stands for it has {}: name its robot.ron with --robot",
                profile.robot,
                limb.name,
                names.join(", ")
            ));
        };
        let joints = own.joints.iter().map(|joint| layout.joint(*joint));
        let joints: Vec<_> = joints.map(|joint| joint.urdf_name.as_str()).collect();
        let theirs: Vec<_> = limb
            .joints
            .iter()
            .map(|joint| joint.name.as_str())
            .collect();
        if joints != theirs {
            return Err(format!(
                "the joints of limb {:?} are {} in the bridge.ron of {}, and {} in the robot.ron",
                limb.name,
                theirs.join(", "),
                profile.robot,
                joints.join(", ")
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn address(text: &str) -> Address {
        text.parse().unwrap()
    }

    #[test]
    fn an_interface_is_that_of_the_body_that_stands_for_the_robot() {
        let baxter = RobotLayout::baxter();
        let own = interface_of(&address("baxter:ws://robot"), None, baxter).unwrap();
        assert_eq!(own.robot, "Baxter");
        let refusal = interface_of(&address("panda:ws://robot"), None, baxter).unwrap_err();
        assert!(
            refusal.starts_with("Panda has a limb \"panda\", and the robot that stands for it"),
            "{refusal}"
        );
        assert_eq!(
            shipped_body(&address("panda:ws://robot")),
            Some("assets/panda/robot.ron")
        );
    }

    #[test]
    fn a_strangers_interface_beside_its_robot_is_read() {
        let folder =
            std::env::temp_dir().join(format!("tabletop_interface_{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let text = include_str!("../../../../assets/baxter/bridge.ron");
        fs::write(
            folder.join("bridge.ron"),
            text.replace("\"Baxter\"", "\"Mine\""),
        )
        .unwrap();
        let baxter = RobotLayout::baxter();
        let of = |text: &str, folder: Option<&Path>| {
            interface_of(&address(text), folder, baxter).map(|own| own.robot)
        };
        assert_eq!(of("mine:ws://robot", Some(&folder)).unwrap(), "Mine");
        assert_eq!(of("baxter:ws://robot", Some(&folder)).unwrap(), "Baxter");
        let refusal = of("mine:ws://robot", None).unwrap_err();
        assert!(
            refusal.contains("bridge.ron beside the robot.ron"),
            "{refusal}"
        );
        fs::remove_dir_all(&folder).unwrap();
    }
}
