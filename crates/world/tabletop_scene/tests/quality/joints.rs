//! Sliders and hinges.

use bevy::prelude::*;
use tabletop_core::{JointMotion, JointedSpec, prelude::*};

use crate::world::*;

/// A slider or hinge on a fixed post; `turned` is the joint's rotation in degrees, `arm` the place of the second object.
fn jointed(motion: JointMotion, turned: Vec3, arm: Vec3, limits: [f32; 2]) -> JointedSpec {
    let pose = Pose::from_degrees(Vec3::Z * 5.0, turned);
    let upright = Pose::from_degrees(Vec3::ZERO, turned).inverse();
    let span = block(Vec3::splat(0.5));
    JointedSpec {
        pose,
        objects: [
            ObjectSpec::new("post", upright, 0.0, span.clone()),
            ObjectSpec::new("mover", Pose::at(arm) * upright, 1.0, span),
        ],
        motion,
        limits,
        init: 0.0,
        collides: false,
        damping: 0.0,
    }
}

fn world(spec: &JointedSpec) -> TestWorld {
    TestWorld::new([SceneItem::Jointed(spec.clone())])
}

/// A slider whose -X points down.
fn hanging() -> JointedSpec {
    jointed(
        JointMotion::Slide,
        Vec3::new(0.0, -90.0, 0.0),
        Vec3::ZERO,
        [0.5, 1.5],
    )
}

#[test]
fn a_slider_slides_as_far_as_its_greatest_displacement() {
    let spec = JointedSpec {
        init: 0.5,
        ..hanging()
    };
    let mut world = world(&spec);
    assert!(world.pose("mover").location.distance(Vec3::Z * 4.5) < 0.1);
    world.seconds(3.0);
    let mover = world.pose("mover");
    assert!(mover.location.distance(Vec3::Z * 3.5) < 0.02, "{mover:?}");
    assert!(
        mover.rotation.angle_between(Quat::IDENTITY) < 0.02,
        "{mover:?}"
    );
    let (far, turn) = world.motion_in(5.0);
    assert!(far < 0.001 && turn < 0.01, "moved {far}, turned {turn}°");
}

#[test]
fn a_damper_slows_a_slider() {
    let fallen = |damping| {
        let spec = JointedSpec {
            limits: [0.0, 4.0],
            damping,
            ..hanging()
        };
        let mut world = world(&spec);
        world.seconds(0.25);
        5.0 - world.pose("mover").location.z
    };
    // 98.1 / 2 · (1/4)² without, 98.1 / 60 · (1 - d) / d units a second with it.
    let (free, half, full) = (fallen(0.0), fallen(0.5), fallen(1.0));
    assert!((3.3..3.7).contains(&free), "{free}");
    assert!((0.25..0.5).contains(&half), "{half}");
    assert!(full < 0.02, "{full}");
}

#[test]
fn a_hinge_turns_as_far_as_its_limits() {
    for (arm, limits, angle) in [
        (Vec3::Y * 1.5, [-45.0, 30.0], -45.0),
        (Vec3::NEG_Y * 1.5, [-45.0, 30.0], 30.0),
        (Vec3::Y * 1.5, [-180.0, 180.0], -90.0),
    ] {
        let mut spec = jointed(JointMotion::Turn, Vec3::ZERO, arm, limits);
        spec.damping = 0.1;
        let mut world = world(&spec);
        world.seconds(6.0);
        let mover = world.pose("mover");
        let there = Quat::from_rotation_x(f32::to_radians(angle));
        let place = Vec3::Z * 5.0 + there * arm;
        assert!(mover.location.distance(place) < 0.05, "{angle}: {mover:?}");
        assert!(
            mover.rotation.angle_between(there) < 0.03,
            "{angle}: {mover:?}"
        );
    }
}

#[test]
fn jointed_objects_collide_if_they_are_to() {
    for (collides, height) in [(false, 3.5), (true, 5.5)] {
        let mut spec = hanging();
        spec.limits = [-1.0, 1.5];
        spec.init = -0.9;
        spec.collides = collides;
        let mut world = world(&spec);
        world.seconds(3.0);
        let mover = world.pose("mover").location.z;
        assert!((mover - height).abs() < 0.03, "{collides}: {mover}");
    }
}

#[test]
fn a_jointed_object_begins_at_its_initial_displacement() {
    let spec = JointedSpec {
        init: 60.0,
        ..jointed(
            JointMotion::Turn,
            Vec3::new(0.0, -90.0, 0.0),
            Vec3::Y,
            [0.0, 90.0],
        )
    };
    let mut world = world(&spec);
    world.seconds(2.0);
    let found = spec.displacement([world.pose("post"), world.pose("mover")]);
    assert!((found - 60.0).abs() < 0.5, "{found}");
}
