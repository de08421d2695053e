//! Sliding, bouncing and initial velocities as the file gives them, and shapes with holes and many faces.

use bevy::prelude::*;
use tabletop_core::{Dynamics, SceneItem, Shape, StepApp as _};
use tabletop_geometry::Rgb;

use crate::world::*;

fn with(item: SceneItem, dynamics: Dynamics) -> SceneItem {
    match item {
        SceneItem::Object(object) => {
            SceneItem::Object(tabletop_core::ObjectSpec { dynamics, ..object })
        }
        SceneItem::Chain(_) | SceneItem::LidBox(_) | SceneItem::Jointed(_) => item,
    }
}

fn ring(radius_outer: f32, radius_inner: f32, zspan: f32) -> Shape {
    Shape::Ring {
        radius_outer,
        radius_inner,
        zspan,
        sides: 32,
        color: Rgb::RED,
    }
}

fn frustum(radius_top: f32, radius_bottom: f32, sides: u32) -> Shape {
    Shape::Frustum {
        radius_top,
        radius_bottom,
        zspan: 1.0,
        sides,
        color: Rgb::RED,
    }
}

#[test]
fn smooth_objects_slide_farther() {
    let sliding = |id: &str, y, friction| {
        let dynamics = Dynamics {
            friction,
            velocity: Vec3::X * 6.0,
            ..Dynamics::default()
        };
        with(object(id, (-8.0, y, 0.5), 1.0, block(Vec3::ONE)), dynamics)
    };
    let mut world = TestWorld::new([
        sliding("rough", -3.0, Some(1.0)),
        sliding("plain", 0.0, None),
        sliding("smooth", 3.0, Some(0.02)),
    ]);
    world.seconds(1.0);
    let [rough, plain, smooth] =
        ["rough", "plain", "smooth"].map(|id| world.pose(id).location.x + 8.0);
    assert!(
        0.1 < rough && rough < plain && plain < smooth - 1.0,
        "{rough} {plain} {smooth}"
    );
}

#[test]
fn elastic_objects_bounce() {
    let ball = |id: &str, x, restitution| {
        let dynamics = Dynamics {
            restitution,
            ..Dynamics::default()
        };
        with(object(id, (x, 0.0, 4.5), 1.0, sphere(0.5)), dynamics)
    };
    let mut world = TestWorld::new([ball("dull", -2.0, None), ball("elastic", 2.0, Some(1.0))]);
    let mut highest = [0.0_f32; 2];
    world.seconds(0.4);
    for _ in 0..60 {
        world.0.step(1);
        for (highest, id) in highest.iter_mut().zip(["dull", "elastic"]) {
            *highest = highest.max(world.pose(id).location.z);
        }
    }
    // The table is not elastic: half the speed is left, so a quarter of the height.
    assert!(highest[0] < 0.6, "{highest:?}");
    assert!((highest[1] - 1.5).abs() < 0.3, "{highest:?}");
}

#[test]
fn rings_lie_on_a_peg_and_frustums_stand() {
    let peg = turned(
        "peg",
        (0.0, 0.0, 1.0),
        Vec3::X * 90.0,
        0.0,
        cylinder(0.3, 2.0),
    );
    let mut world = TestWorld::new([
        peg,
        object("low", (0.0, 0.0, 0.2), 1.0, ring(1.0, 0.4, 0.4)),
        object("high", (0.0, 0.0, 3.0), 1.0, ring(0.8, 0.4, 0.4)),
        object("cone", (4.0, 0.0, 0.5), 1.0, frustum(0.2, 1.0, 32)),
        object("pyramid", (-4.0, 0.0, 0.5), 1.0, frustum(0.3, 1.0, 3)),
        object("nut", (4.0, 3.0, 0.5), 1.0, frustum(1.0, 1.0, 6)),
        object("on the nut", (4.0, 3.0, 1.5), 1.0, frustum(0.5, 0.5, 5)),
    ]);
    world.seconds(5.0);
    for (id, place) in [
        ("low", Vec3::new(0.0, 0.0, 0.2)),
        ("high", Vec3::new(0.0, 0.0, 0.6)),
        ("cone", Vec3::new(4.0, 0.0, 0.5)),
        ("pyramid", Vec3::new(-4.0, 0.0, 0.5)),
        ("nut", Vec3::new(4.0, 3.0, 0.5)),
        ("on the nut", Vec3::new(4.0, 3.0, 1.5)),
    ] {
        let found = world.pose(id).location;
        assert!(found.distance(place) < 0.12, "{id}: {found}");
        assert!((found.z - place.z).abs() < 0.02, "{id}: {found}");
    }
    let (far, turn) = world.motion_in(2.0);
    assert!(far < 1e-3 && turn < 0.1, "{far} {turn}");
}
