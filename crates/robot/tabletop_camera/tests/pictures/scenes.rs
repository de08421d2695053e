//! Scenes, and cameras that look at them.

use bevy::math::{Quat, Vec3};
use tabletop_camera::{Camera, DrawnSolid, Rasterizer, Scene};
use tabletop_core::{HeadCamera, LIGHT, Picture, Table};
use tabletop_geometry::{Pose, Rgb, Solid};

pub fn draw(solids: &[DrawnSolid], camera: &Camera) -> Picture {
    draw_scene(&of_solids(solids), camera)
}

pub fn draw_scene(scene: &Scene, camera: &Camera) -> Picture {
    let mut picture = Picture::default();
    Rasterizer::default().draw(scene, camera, &mut picture);
    picture
}

pub fn of_solids(solids: &[DrawnSolid]) -> Scene {
    Scene {
        solids: solids.to_vec(),
        ..Scene::default()
    }
}

pub fn head() -> Camera {
    let plain = HeadCamera {
        antialiasing: false,
        ..HeadCamera::default()
    };
    Camera::of_head(&plain, &Table::default())
}

pub fn smooth(camera: Camera) -> Camera {
    Camera {
        antialiasing: true,
        ..camera
    }
}

/// A camera that looks along Y with Z up.
pub fn level(location: Vec3, width: u32, height: u32) -> Camera {
    Camera {
        pose: Pose::new(location, Quat::from_rotation_x(90_f32.to_radians())),
        vertical_fov: 60_f32.to_radians(),
        square_fov: false,
        width,
        height,
        antialiasing: false,
        light: LIGHT,
    }
}

pub fn solid(object: u32, location: impl Into<Vec3>, solid: Solid, color: Rgb) -> DrawnSolid {
    turned(object, location, Vec3::ZERO, solid, color)
}

pub fn turned(
    object: u32,
    location: impl Into<Vec3>,
    degrees: Vec3,
    solid: Solid,
    color: Rgb,
) -> DrawnSolid {
    DrawnSolid {
        pose: Pose::from_degrees(location.into(), degrees),
        solid,
        color,
        object,
    }
}

/// `tablesetup/default.xml`.
pub fn default_scene() -> Vec<DrawnSolid> {
    let cube = Solid::Cuboid(Vec3::splat(2.0));
    let about_z = |degrees| Vec3::Z * degrees;
    vec![
        DrawnSolid::of_table(&Table::default(), 1),
        turned(
            2,
            [2.0, 0.0, 1.0],
            about_z(-15.0),
            cube.clone(),
            Rgb::new(1.0, 0.0, 0.0),
        ),
        turned(
            3,
            [-2.0, 0.0, 1.0],
            about_z(45.0),
            cube,
            Rgb::new(0.0, 1.0, 0.0),
        ),
    ]
}

/// Every kind of solid, in every attitude.
pub fn mixed_scene() -> Vec<DrawnSolid> {
    let cylinder = |radius, yspan| Solid::Cylinder { radius, yspan };
    let degrees = Vec3::new;
    vec![
        DrawnSolid::of_table(&Table::default(), 1),
        solid(2, [-4.0, 0.0, 1.0], Solid::Ball(1.0), Rgb::WHITE),
        turned(
            3,
            [-1.0, 0.0, 0.6],
            degrees(0.0, 0.0, 40.0),
            cylinder(0.6, 3.0),
            Rgb::GRAY,
        ),
        turned(
            4,
            [2.0, 0.0, 1.5],
            degrees(90.0, 0.0, 0.0),
            cylinder(0.8, 3.0),
            Rgb::GRAY,
        ),
        turned(
            5,
            [4.5, -3.0, 0.5],
            degrees(0.0, 0.0, 30.0),
            Solid::Cuboid(Vec3::new(2.0, 1.0, 1.0)),
            Rgb::GRAY,
        ),
        turned(
            6,
            [-4.0, 3.5, 1.0],
            degrees(0.0, 40.0, 70.0),
            cylinder(0.2, 4.0),
            Rgb::WHITE,
        ),
        turned(
            7,
            [7.0, 5.0, 2.0],
            degrees(35.0, 0.0, 20.0),
            Solid::Cuboid(Vec3::new(0.3, 0.3, 4.0)),
            Rgb::GRAY,
        ),
        solid(8, [0.0, 4.0, 0.3], Solid::Ball(0.3), Rgb::GRAY),
    ]
}
