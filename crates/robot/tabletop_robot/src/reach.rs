//! Where a limb's angles bring its end effector, and which angles bring it to a pose.

use bevy::prelude::*;
use tabletop_core::{LimbId, Robot};
use tabletop_geometry::{Pose, UNITS_PER_METER};
use tabletop_kinematics::Target;

use crate::articulation::{
    link_entities::base,
    tree::{Articulation, in_meters, in_units},
};

/// Angles of a limb, in rad (m), that bring its end effector to a pose in the table's frame, near its present angles. A limb of fewer than six
/// joints cannot have every rotation: it takes one near that of the pose.
///
/// # Errors
/// It cannot reach the pose; the error says how near it comes.
pub fn reach(world: &mut World, limb: LimbId, pose: Pose) -> Result<Vec<f64>, String> {
    search(world, limb, pose, usize::MAX)
}

/// [`reach`], but the search begins at the present angles alone: for poses so near that it would be of no use to begin anywhere else, and which
/// are refused much sooner.
///
/// # Errors
/// The search does not get there.
pub fn reach_nearby(world: &mut World, limb: LimbId, pose: Pose) -> Result<Vec<f64>, String> {
    search(world, limb, pose, 1)
}

fn search(world: &mut World, limb: LimbId, pose: Pose, starts: usize) -> Result<Vec<f64>, String> {
    let limb_layout = world.resource::<Articulation>().layout.limb(limb).clone();
    let arm = limb_layout.name;
    if !pose.location.is_finite() || !pose.rotation.is_finite() {
        return Err(format!(
            "the {arm} arm cannot reach for {pose:?}: not a pose"
        ));
    }
    let base = base(world);
    let robot = world.resource::<Robot>();
    let (chain, end_effector) = world.resource::<Articulation>().chain(limb);
    let target = in_meters(base.inverse() * pose) * end_effector.inverse();
    let seed = robot.positions_of(&limb_layout.joints);
    chain
        .solve_from(&Target::Pose(target), &seed, starts)
        .or_else(|unreachable| match chain.has_every_rotation() {
            true => Err(unreachable),
            // It goes there from where its rotation is as near as its joints allow.
            false => {
                let point = Target::Point(target.translation);
                chain.solve_from(&point, &unreachable.best, starts)
            }
        })
        .map_err(|unreachable| {
            format!(
                "the {arm} arm cannot reach {:.3}: it comes no nearer than {:.3} units and {:.1}°",
                pose.location,
                unreachable.miss.position * UNITS_PER_METER,
                unreachable.miss.rotation.to_degrees()
            )
        })
}

/// The pose, in the table's frame, of a limb's end effector at these angles, in rad.
pub fn end_effector_at(world: &mut World, limb: LimbId, angles: &[f64]) -> Pose {
    let base = base(world);
    let (chain, end_effector) = world.resource::<Articulation>().chain(limb);
    base * in_units(chain.tip(angles) * end_effector)
}

#[cfg(test)]
mod tests {
    use bevy::math::DQuat;

    use super::*;
    use crate::{Description, DescriptionSource};

    /// Two links that turn about verticals, a quill that slides down, and a wrist.
    const SCARA: &str = r#"<robot name="scara">
        <link name="base"/> <link name="1"/> <link name="2"/> <link name="3"/> <link name="tip"/>
        <joint name="A" type="revolute"><parent link="base"/><child link="1"/><origin xyz="0 0 0.5"/>
            <axis xyz="0 0 1"/><limit lower="-2.4" upper="2.4" velocity="1"/></joint>
        <joint name="B" type="revolute"><parent link="1"/><child link="2"/><origin xyz="0.4 0 0"/>
            <axis xyz="0 0 1"/><limit lower="-2.4" upper="2.4" velocity="1"/></joint>
        <joint name="Quill" type="prismatic"><parent link="2"/><child link="3"/><origin xyz="0.4 0 0"/>
            <axis xyz="0 0 -1"/><limit lower="0" upper="0.4" velocity="1"/></joint>
        <joint name="Wrist" type="continuous"><parent link="3"/><child link="tip"/><axis xyz="0 0 1"/></joint>
    </robot>"#;

    const LAYOUT: &str = r#"Robot(
        name: "Scara", urdf: "scara.urdf", base: (behind_edge: 1, height: 0),
        camera: (neck: (0, 0, 9), at: (0, 0, 0), tilt: 1),
        limbs: [(
            name: "arm", label: "Arm", prefix: "a",
            joints: [(name: "A", label: "A"), (name: "B", label: "B", home: 0.5), (name: "Quill", label: "Q"), (name: "Wrist", label: "W")],
            gripper: (name: "gripper", kind: Parallel, opening: (0, 1), finger: (0.2, 0.2, 0.5)),
            end_effector: [(link: "tip")],
        )],
    )"#;

    const ARM: LimbId = LimbId(0);

    fn world() -> World {
        let source = DescriptionSource {
            path: "scara.urdf".into(),
            urdf: SCARA.to_owned(),
            layout: Some(LAYOUT.to_owned()),
            reach: None,
        };
        let Description { model, layout, .. } = Description::read(source).unwrap();
        let mut world = World::new();
        world.insert_resource(Robot::at_home(&layout));
        world.insert_resource(Articulation::new(model, layout).unwrap());
        world
    }

    #[test]
    fn a_scara_reaches_down_and_turns_as_near_as_it_can() {
        let mut world = world();
        let there = end_effector_at(&mut world, ARM, &[0.4, -0.9, 0.3, 0.2]);
        let angles = reach(&mut world, ARM, there).unwrap();
        assert!((angles[2] - 0.3).abs() < 1e-4, "{angles:?}");
        let tilted = Pose {
            rotation: there.rotation * DQuat::from_rotation_x(0.5).as_quat(),
            ..there
        };
        let angles = reach(&mut world, ARM, tilted).unwrap();
        let found = end_effector_at(&mut world, ARM, &angles);
        assert!(found.location.distance(there.location) < 1e-3, "{found:?}");
        assert!(
            found.rotation.angle_between(there.rotation) < 0.1,
            "{found:?}"
        );
        let far = Pose::at(Vec3::new(0.0, 50.0, 1.0));
        assert!(reach(&mut world, ARM, far).is_err());
    }
}
