//! Dynamics, compared with energies and their derivatives, which do not need it.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use glam::DVec3;
use proptest::prelude::*;
use tabletop_kinematics::{JointValues, LinkId, Load, ModelJointId, RobotModel, baxter};

const GRAVITY: DVec3 = DVec3::new(0.3, -0.2, -9.81);

/// A slide that carries a turn, which a second turn follows; masses off the axes.
const FOLLOWER: &str = r#"<robot name="follower">
  <link name="rail"/>
  <link name="cart"><inertial><origin xyz="0.1 0 0.2"/><mass value="3"/>
    <inertia ixx="0.1" ixy="0.01" ixz="0" iyy="0.2" iyz="0" izz="0.15"/></inertial></link>
  <link name="boom"><inertial><origin xyz="0.5 0.1 0" rpy="0.3 0.2 0.1"/><mass value="2"/>
    <inertia ixx="0.1" ixy="0" ixz="0.02" iyy="0.3" iyz="0" izz="0.35"/></inertial></link>
  <link name="jib"><inertial><origin xyz="0.2 0 0.1"/><mass value="1"/>
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/></inertial></link>
  <joint name="slide" type="prismatic"><parent link="rail"/><child link="cart"/>
    <origin rpy="0.1 0.2 0.3"/><axis xyz="1 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="lift" type="continuous"><parent link="cart"/><child link="boom"/>
    <origin xyz="0 0.1 0.4" rpy="0 0.5 0"/><axis xyz="0 1 0.2"/></joint>
  <joint name="level" type="continuous"><parent link="boom"/><child link="jib"/>
    <origin xyz="1 0 0"/><axis xyz="0 1 0"/><mimic joint="lift" multiplier="-0.7" offset="0.2"/></joint>
</robot>"#;

fn robots() -> [RobotModel; 2] {
    [baxter().unwrap(), RobotModel::from_urdf(FOLLOWER).unwrap()]
}

fn loads(robot: &RobotModel) -> Vec<Load> {
    let names = ["left_end_effector", "right_wrist", "jib"];
    let links = names
        .into_iter()
        .filter_map(|name| robot.find_link(name).ok());
    links
        .map(|link| Load {
            link,
            point: DVec3::new(0.05, -0.02, 0.1),
            mass: 1.5,
        })
        .collect()
}

/// Numbers between -1 and 1 for the movable joints.
fn values(robot: &RobotModel, numbers: &[f64]) -> JointValues {
    let mut values = robot.zero();
    for (joint, number) in robot.movable().zip(numbers) {
        values[joint] = *number;
    }
    values
}

fn moved(
    configuration: &JointValues,
    velocities: &JointValues,
    seconds: f64,
    robot: &RobotModel,
) -> JointValues {
    let mut moved = configuration.clone();
    for joint in robot.movable() {
        moved[joint] += seconds * velocities[joint];
    }
    moved
}

/// Centres of mass, by link, with their masses.
fn masses(robot: &RobotModel, configuration: &JointValues, loads: &[Load]) -> Vec<(f64, DVec3)> {
    let frames = robot.frames(configuration);
    let links = link_ids(robot).map(|id| {
        let inertial = &robot.link(id).inertial;
        (inertial.mass, frames[id].transform_point3(inertial.center))
    });
    let loads = loads
        .iter()
        .map(|load| (load.mass, frames[load.link].transform_point3(load.point)));
    links.chain(loads).collect()
}

fn link_ids(robot: &RobotModel) -> impl Iterator<Item = LinkId> {
    robot
        .links()
        .iter()
        .map(|link| robot.find_link(&link.name).unwrap())
}

fn potential_energy(robot: &RobotModel, configuration: &JointValues, loads: &[Load]) -> f64 {
    let masses = masses(robot, configuration, loads);
    masses
        .iter()
        .map(|(mass, center)| -mass * GRAVITY.dot(*center))
        .sum()
}

/// From the motion of the links, by differences.
fn kinetic_energy(
    robot: &RobotModel,
    configuration: &JointValues,
    velocities: &JointValues,
    loads: &[Load],
) -> f64 {
    const STEP: f64 = 1e-5;
    let [before, after] = [-STEP, STEP].map(|step| moved(configuration, velocities, step, robot));
    let masses = masses(robot, &before, loads)
        .into_iter()
        .zip(masses(robot, &after, loads));
    let of_masses: f64 = masses
        .map(|((mass, from), (_, to))| 0.5 * mass * ((to - from) / (2.0 * STEP)).length_squared())
        .sum();
    let frames = [&before, configuration, &after].map(|values| robot.frames(values));
    let of_turns: f64 = link_ids(robot)
        .map(|id| {
            let turn = frames[2][id].matrix3 * frames[0][id].matrix3.transpose();
            let spin = glam::DQuat::from_mat3(&turn).to_scaled_axis() / (2.0 * STEP);
            let own = frames[1][id].matrix3.transpose() * spin;
            0.5 * own.dot(robot.link(id).inertial.inertia * own)
        })
        .sum();
    of_masses + of_turns
}

fn product(
    robot: &RobotModel,
    matrix: impl Fn(ModelJointId, ModelJointId) -> f64,
    by: &JointValues,
) -> JointValues {
    let mut product = robot.zero();
    for row in robot.movable() {
        product[row] = robot
            .movable()
            .map(|column| matrix(row, column) * by[column])
            .sum();
    }
    product
}

fn assert_near(robot: &RobotModel, found: &JointValues, expected: &JointValues, tolerance: f64) {
    for joint in robot.movable() {
        let (found, expected) = (found[joint], expected[joint]);
        let name = &robot.joint(joint).name;
        assert!(
            (found - expected).abs() < tolerance,
            "{name}: {found} instead of {expected}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(50))]

    #[test]
    fn gravity_torques_are_the_slope_of_the_potential_energy(
        angles in prop::collection::vec(-1.5..1.5_f64, 19),
    ) {
        const STEP: f64 = 1e-5;
        for robot in robots() {
            let configuration = values(&robot, &angles);
            let loads = loads(&robot);
            let torques = robot.gravity_torques(&robot.frames(&configuration), GRAVITY, &loads);
            let mut slopes = robot.zero();
            for joint in robot.movable() {
                let energy = |step| {
                    let mut moved = configuration.clone();
                    moved[joint] += step;
                    potential_energy(&robot, &moved, &loads)
                };
                slopes[joint] = (energy(STEP) - energy(-STEP)) / (2.0 * STEP);
            }
            assert_near(&robot, &torques, &slopes, 1e-5);
        }
    }

    #[test]
    fn the_inertia_matrix_holds_the_kinetic_energy(
        angles in prop::collection::vec(-1.5..1.5_f64, 19),
        speeds in prop::collection::vec(-1.0..1.0_f64, 19),
    ) {
        for robot in robots() {
            let (configuration, velocities) = (values(&robot, &angles), values(&robot, &speeds));
            let loads = loads(&robot);
            let matrix = robot.inertia_matrix(&robot.frames(&configuration), &loads);
            let momenta = product(&robot, |row, column| matrix[(row, column)], &velocities);
            let energy: f64 = robot.movable().map(|j| 0.5 * momenta[j] * velocities[j]).sum();
            let expected = kinetic_energy(&robot, &configuration, &velocities, &loads);
            prop_assert!((energy - expected).abs() < 1e-6 * expected.max(1.0), "{energy} J, {expected} J");
            prop_assert!(energy > 0.0);
        }
    }

    #[test]
    fn the_inertia_matrix_is_symmetric_and_positive_definite(
        angles in prop::collection::vec(-1.5..1.5_f64, 19),
    ) {
        for robot in robots() {
            let matrix = robot.inertia_matrix(&robot.frames(&values(&robot, &angles)), &[]);
            let joints: Vec<ModelJointId> = robot.movable().collect();
            // Cholesky's factor exists just then.
            let mut factor = vec![vec![0.0; joints.len()]; joints.len()];
            for i in 0..joints.len() {
                for j in 0..=i {
                    let entry = matrix[(joints[i], joints[j])];
                    prop_assert_eq!(entry, matrix[(joints[j], joints[i])]);
                    let known: f64 = (0..j).map(|k| factor[i][k] * factor[j][k]).sum();
                    factor[i][j] = if i == j {
                        prop_assert!(entry - known > 0.0, "{}", robot.joint(joints[i]).name);
                        (entry - known).sqrt()
                    } else {
                        (entry - known) / factor[j][j]
                    };
                }
            }
        }
    }

    #[test]
    fn torques_without_speed_are_inertia_times_acceleration_and_gravity(
        angles in prop::collection::vec(-1.5..1.5_f64, 19),
        rates in prop::collection::vec(-3.0..3.0_f64, 19),
    ) {
        for robot in robots() {
            let frames = robot.frames(&values(&robot, &angles));
            let (loads, accelerations) = (loads(&robot), values(&robot, &rates));
            let found = robot.inverse_dynamics(&frames, &robot.zero(), &accelerations, GRAVITY, &loads);
            let matrix = robot.inertia_matrix(&frames, &loads);
            let mut expected = product(&robot, |row, column| matrix[(row, column)], &accelerations);
            let weight = robot.gravity_torques(&frames, GRAVITY, &loads);
            for joint in robot.movable() {
                expected[joint] += weight[joint];
            }
            assert_near(&robot, &found, &expected, 1e-9);
        }
    }

    #[test]
    fn the_power_of_the_torques_equals_the_change_of_energy(
        angles in prop::collection::vec(-1.5..1.5_f64, 19),
        speeds in prop::collection::vec(-1.0..1.0_f64, 19),
        rates in prop::collection::vec(-3.0..3.0_f64, 19),
    ) {
        const STEP: f64 = 1e-4;
        for robot in robots() {
            let (configuration, velocities) = (values(&robot, &angles), values(&robot, &speeds));
            let (loads, accelerations) = (loads(&robot), values(&robot, &rates));
            let frames = robot.frames(&configuration);
            let torques = robot.inverse_dynamics(&frames, &velocities, &accelerations, GRAVITY, &loads);
            let power: f64 = robot.movable().map(|j| torques[j] * velocities[j]).sum();
            let energy = |step: f64| {
                let halfway = moved(&velocities, &accelerations, 0.5 * step, &robot);
                let then = moved(&configuration, &halfway, step, &robot);
                let faster = moved(&velocities, &accelerations, step, &robot);
                let matrix = robot.inertia_matrix(&robot.frames(&then), &loads);
                let momenta = product(&robot, |row, column| matrix[(row, column)], &faster);
                let kinetic: f64 = robot.movable().map(|j| 0.5 * momenta[j] * faster[j]).sum();
                kinetic + potential_energy(&robot, &then, &loads)
            };
            let slope = (energy(STEP) - energy(-STEP)) / (2.0 * STEP);
            prop_assert!((power - slope).abs() < 1e-4 * power.abs().max(1.0), "{power} W, {slope} W");
        }
    }
}

#[test]
fn a_straight_arm_pulls_at_its_shoulder_with_masses_times_distances() {
    let robot = baxter().unwrap();
    let frames = robot.frames(&robot.zero());
    let torques = robot.gravity_torques(&frames, DVec3::NEG_Z * 9.81, &[]);
    // Masses (kg) and how far out from the joint they are (m), by hand from the tables of the robot's links.
    let masses = [
        (3.22698, 0.06845),
        (4.31272, 0.28286),
        (2.07206, 0.39053),
        (2.24665, 0.60753),
        (1.60979, 0.79912),
        (0.35093, 0.873235),
        (0.19125, 0.952915),
        (0.3, 0.993235),
        (0.06, 1.050035),
    ];
    // The joint turns the arm down when it grows.
    let expected: f64 = masses
        .iter()
        .map(|(mass, distance)| -9.81 * mass * distance)
        .sum();
    let found = torques[robot.find_joint("left_s1").unwrap()];
    assert!(
        (found - expected).abs() < 1e-3,
        "{found} instead of {expected} N m"
    );
    let upright = torques[robot.find_joint("left_s0").unwrap()];
    assert!(
        upright.abs() < 1e-9,
        "nothing turns an upright joint: {upright} N m"
    );
}
