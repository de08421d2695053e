//! What a served policy sees of the robot and its table.

use bevy::{math::Mat3, prelude::*};
use tabletop_camera::{Camera, CameraPlace, CameraSpec, Studio, StudioError};
use tabletop_core::{
    HandCameras, HeadCamera, JointId, JointName, LimbId, LimbName, Robot, RobotLayout, Table,
};
use tabletop_episodes::multiplication::CameraDisplacement;
use tabletop_geometry::{Pose, UNITS_PER_METER, turn_about_x};
use tabletop_robot::base;
use tabletop_wire::{
    MappedCamera, MappedImage, MappedState, NumpyArray, PolicyMapping, PosePart, RobotNames,
    StateColumn, WireMap,
};

use crate::{
    driven_task::DrivenTask,
    place_numbers::{OF_CAMERA, camera_numbers},
};

/// The names of a robot's parts, as mappings are checked.
pub(crate) fn names_of(layout: &RobotLayout) -> RobotNames {
    let joints = layout.joints.iter();
    let limbs = layout.limbs.iter();
    let cameras = layout.hand_cameras.iter();
    RobotNames {
        robot: layout.name.clone(),
        joints: joints.map(|joint| joint.name.to_string()).collect(),
        limbs: limbs.map(|limb| limb.name.to_string()).collect(),
        cameras: cameras.map(|camera| camera.name.clone()).collect(),
    }
}

/// The joint of a name; `None` if the robot lacks it.
pub(crate) fn joint_named(layout: &RobotLayout, name: &str) -> Option<JointId> {
    layout.find_joint(JointName::new(name).ok()?)
}

/// The limb of a name; `None` if the robot lacks it.
pub(crate) fn limb_named(layout: &RobotLayout, name: &str) -> Option<LimbId> {
    layout.find_limb(LimbName::new(name).ok()?)
}

/// The observation of the present world, with the task in words and cameras where they are displaced to.
///
/// # Errors
/// A camera has no picture.
pub(crate) fn observe(
    world: &mut World,
    mapping: &PolicyMapping,
    task: &DrivenTask,
) -> Result<WireMap, StudioError> {
    let mut observation = WireMap::new();
    let head = *world.resource::<HeadCamera>();
    let own = [head.width, head.height];
    let cameras = mapping.images.iter().map(|image| CameraSpec {
        name: image.key.clone(),
        viewpoint: place_of(world, &image.camera, task.displacement),
        size: Some(image.fit(own).inner),
        vertical_fov: fov_of(&image.camera),
    });
    let cameras: Vec<_> = cameras.collect();
    let known = world.resource::<HandCameras>().0.clone();
    let mut studio = Studio::new(cameras, &known)?.alone();
    for (image, shot) in mapping.images.iter().zip(studio.shoot(world)?) {
        let rgb = &shot.picture.rgb;
        let array = image.fit(own).array(rgb, image.mirrored, image.layout);
        observation.insert(image.key.clone(), array.into());
    }
    for image in &mapping.images {
        if let Some((key, numbers)) = numbers_of_camera(world, image, &head) {
            observation.insert(key, numbers.into());
        }
    }
    for state in &mapping.states {
        let numbers = numbers_of_state(world, state);
        let array = NumpyArray::of_floats(&[numbers.len()], &numbers);
        observation.insert(state.key.clone(), array.into());
    }
    if let Some(key) = &mapping.prompt {
        observation.insert(key.clone(), task.prompt.into());
    }
    Ok(observation)
}

fn place_of(
    world: &World,
    camera: &MappedCamera,
    displacement: Option<CameraDisplacement>,
) -> CameraPlace {
    match camera {
        MappedCamera::Head => CameraPlace::Head,
        MappedCamera::Hand(name) => CameraPlace::Hand(name.clone()),
        MappedCamera::Standing { at, looks_at, .. } => {
            let usual = Pose::looking_at(Vec3::from(*at), Vec3::from(*looks_at));
            let displaced = displacement.map(|displacement| displacement.of(usual));
            CameraPlace::Standing(displaced.unwrap_or(usual))
        }
        MappedCamera::OnLimb { limb, at, tilt, .. } => {
            let limb = limb_named(world.resource::<RobotLayout>(), limb);
            let limb = limb.map(|limb| world.resource::<Robot>().limb(limb).end_effector);
            // A camera looks along its -Z, and so do the fingers point.
            let tilted = turn_about_x(f64::from(*tilt)).as_quat();
            CameraPlace::Standing(limb.unwrap_or_default() * Pose::new(Vec3::from(*at), tilted))
        }
    }
}

const fn fov_of(camera: &MappedCamera) -> Option<f32> {
    match camera {
        MappedCamera::Head | MappedCamera::Hand(_) => None,
        MappedCamera::Standing { fov, .. } | MappedCamera::OnLimb { fov, .. } => Some(*fov),
    }
}

fn numbers_of_camera(
    world: &mut World,
    image: &MappedImage,
    head: &HeadCamera,
) -> Option<(String, NumpyArray)> {
    let key = image.numbers.clone()?;
    let table = world.query::<&Table>().iter(world).next().copied();
    let camera = Camera::of_head(head, &table.unwrap_or_default());
    let numbers = NumpyArray::of_floats(&[OF_CAMERA], &camera_numbers(&camera));
    Some((key, numbers))
}

fn numbers_of_state(world: &mut World, state: &MappedState) -> Vec<f32> {
    let base = base(world);
    let layout = world.resource::<RobotLayout>();
    let robot = world.resource::<Robot>();
    let number = |column: &StateColumn| match column {
        StateColumn::Joint(scaled) => {
            let joint = joint_named(layout, &scaled.name);
            let position = joint.map(|joint| robot.joint(joint).position);
            scaled.number(position.unwrap_or_default())
        }
        StateColumn::EndEffector { limb, part, plus } => {
            let limb = limb_named(layout, limb);
            let pose = limb.map(|limb| robot.limb(limb).end_effector);
            part_of(base.inverse() * pose.unwrap_or_default(), *part) + plus
        }
        StateColumn::Constant(number) => *number,
    };
    let numbers = state.columns.iter().map(number);
    numbers.map(|number| number as f32).collect()
}

/// A part of the pose of an end effector, in m or rad.
fn part_of(end_effector: Pose, part: PosePart) -> f64 {
    let location = end_effector.location.as_dvec3() / UNITS_PER_METER;
    // Ours has x along the opening, and z leads into the hand.
    let out_of_hand = Quat::from_mat3(&Mat3::from_cols(Vec3::Y, Vec3::X, Vec3::NEG_Z));
    let turn = turn_vector(end_effector.rotation * out_of_hand).as_dvec3();
    let six = [location, turn].map(|it| it.to_array());
    six.as_flattened()[part.index()]
}

/// A rotation as a vector along its axis, as long as the angle in rad, which is at most π.
fn turn_vector(rotation: Quat) -> Vec3 {
    let rotation = match rotation.w < 0.0 {
        true => -rotation,
        false => rotation,
    };
    let across = rotation.xyz();
    let length = across.length();
    match length > 1e-7 {
        true => across * (2.0 * libm::atan2f(length, rotation.w) / length),
        false => across * 2.0,
    }
}

#[cfg(test)]
mod tests {
    use tabletop_geometry::turn_about;

    use super::*;

    #[test]
    fn a_turn_is_a_vector_along_its_axis() {
        let axis = Vec3::new(2.0, -1.0, 2.0) / 3.0;
        for angle in [0.0, 1e-6, 0.3, 3.0, -2.0] {
            let off = turn_vector(turn_about(axis, angle)) - axis * angle;
            assert!(off.length() < 1e-5, "{angle}: {off}");
        }
    }

    #[test]
    fn a_hand_that_points_down_is_turned_by_half_a_turn_about_x() {
        // The frame of Panda's fingers when they point down and open to the left and right of the robot.
        let down = Quat::from_mat3(&Mat3::from_cols(Vec3::NEG_Y, Vec3::X, Vec3::Z));
        let pose = Pose::new(Vec3::new(5.0, 0.0, 2.0), down);
        let six = [
            PosePart::X,
            PosePart::Y,
            PosePart::Z,
            PosePart::TurnX,
            PosePart::TurnY,
            PosePart::TurnZ,
        ];
        let six = six.map(|part| part_of(pose, part).abs());
        let expected = [0.5, 0.0, 0.2, std::f64::consts::PI, 0.0, 0.0];
        for (found, expected) in six.into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-5, "{six:?}");
        }
    }
}
