//! Colours, against the formula of the light (original program, rendering): the colour times
//! 0.8 + max(0, n·l)(1 - d/50), where the lamp hangs at (0, 0, 10).

use bevy::math::{DVec3, Vec3};
use tabletop_camera::{Camera, DrawnSolid};
use tabletop_core::{Picture, Pose, Rgb, Solid};

use crate::scenes::{default_scene, draw, head, level, smooth, solid, turned};

fn lit(part: f32, point: DVec3, normal: DVec3) -> f64 {
    let to_lamp = DVec3::Z * 10.0 - point;
    let distance = to_lamp.length();
    let cosine = normal.dot(to_lamp / distance).max(0.0);
    let light = 0.8 + cosine * (1.0 - distance / 50.0).max(0.0);
    (f64::from(part) * light).min(1.0) * 255.0
}

/// Every pixel that shows the solid has the colour of the formula, at the point that its depth tells.
fn assert_lit(drawn: DrawnSolid, camera: Camera, normal_at: impl Fn(DVec3) -> DVec3) {
    let picture = draw(&[drawn], &camera);
    let mut shown = std::collections::BTreeSet::new();
    for row in 0..camera.height {
        for column in 0..camera.width {
            let index = picture.index(column, row).expect("a pixel");
            if picture.objects[index] == 0 {
                assert_eq!(picture.color(column, row), Some([0, 0, 0]));
                continue;
            }
            let point = point_at(&picture, &camera, column, row);
            let color = picture.color(column, row).expect("a pixel");
            let Rgb { red, green, blue } = drawn.color;
            for (byte, part) in color.into_iter().zip([red, green, blue]) {
                let exact = lit(part, point, normal_at(point));
                assert!(
                    (f64::from(byte) - exact).abs() < 0.6,
                    "{byte} for {exact} at {point}"
                );
            }
            shown.insert(color);
        }
    }
    assert!(shown.len() > 10, "only {shown:?} are shown");
}

/// The point that is seen, worked out from the pose and the angles of the camera.
fn point_at(picture: &Picture, camera: &Camera, column: u32, row: u32) -> DVec3 {
    let depth = f64::from(picture.depth[picture.index(column, row).expect("a pixel")]);
    let pixel = 2.0 * (f64::from(camera.vertical_fov) / 2.0).tan() / f64::from(camera.height);
    let x = (f64::from(column) + 0.5 - f64::from(camera.width) / 2.0) * pixel;
    let y = (f64::from(camera.height) / 2.0 - f64::from(row) - 0.5) * pixel;
    let local = DVec3::new(x, y, -1.0) * depth;
    camera.pose.rotation.as_dquat() * local + camera.pose.location.as_dvec3()
}

#[test]
fn a_flat_face_is_lit_as_its_distance_from_the_lamp_tells() {
    let color = Rgb::new(0.5, 0.3, 0.55);
    let plate = Solid::Cuboid(Vec3::new(20.0, 20.0, 2.0));
    assert_lit(solid(1, [0.0, 0.0, -1.0], plate, color), head(), |_| {
        DVec3::Z
    });
    // Half a unit below the lamp, from above.
    let high = solid(1, [0.0, 0.0, 8.5], plate, color);
    let above = Camera {
        pose: Pose::at(Vec3::Z * 25.0),
        ..head()
    };
    assert_lit(high, above, |_| DVec3::Z);
}

#[test]
fn round_surfaces_are_lit_by_their_own_normals() {
    let center = DVec3::new(1.0, 0.0, 2.0);
    let color = Rgb::new(0.5, 0.3, 0.55);
    let ball = solid(1, center.as_vec3(), Solid::Ball(2.0), color);
    assert_lit(ball, head(), |point| (point - center) / 2.0);
    let lying = Solid::Cylinder {
        radius: 2.0,
        yspan: 8.0,
    };
    // Its axis is along X, and its ends are not in view.
    let cylinder = turned(1, center.as_vec3(), Vec3::Z * 90.0, lying, color);
    let camera = level(Vec3::new(1.0, -8.0, 4.0), 60, 60);
    assert_lit(cylinder, camera, |point| (point - center).with_x(0.0) / 2.0);
}

#[test]
fn the_end_of_a_cylinder_is_flat() {
    let standing = Solid::Cylinder {
        radius: 8.0,
        yspan: 2.0,
    };
    for degrees in [90.0, -90.0] {
        let color = Rgb::new(0.5, 0.3, 0.55);
        let cylinder = turned(1, Vec3::Z, Vec3::X * degrees, standing, color);
        let above = Camera {
            pose: Pose::at(Vec3::Z * 25.0),
            ..head()
        };
        assert_lit(cylinder, above, |_| DVec3::Z);
    }
}

#[test]
fn the_blocks_of_the_default_table_show_their_colours() {
    let camera = head();
    let picture = draw(&default_scene(), &camera);
    let color_at = |point: Vec3| {
        let pixel = camera.pixel_of(point).unwrap().round();
        picture.color(pixel.x as u32, pixel.y as u32)
    };
    // Faces that look up saturate; the near side of the red block is turned away from the lamp.
    assert_eq!(color_at(Vec3::new(2.0, 0.0, 2.0)), Some([255, 0, 0]));
    assert_eq!(color_at(Vec3::new(-2.0, 0.0, 2.0)), Some([0, 255, 0]));
    assert_eq!(color_at(Vec3::new(0.0, -4.0, 0.0)), Some([255, 255, 255]));
    assert_eq!(color_at(Vec3::new(1.74, -0.966, 1.0)), Some([204, 0, 0]));
    assert_eq!(color_at(Vec3::new(0.0, -6.0, -0.15)), Some([204, 204, 204]));
    assert_eq!(picture.color(100, 0), Some([0, 0, 0]));
}

/// The bytes of these pictures must not change unnoticed: people train on them. Where they are meant to change, put in the
/// numbers that the failing test prints, after looking at the pictures.
#[test]
fn the_picture_of_the_default_table_is_known_to_the_last_bit() {
    let sums = [head(), smooth(head())].map(|camera| fnv(&draw(&default_scene(), &camera).rgb));
    let known = [0x6024_b840_ac12_ff66, 0xc45e_724a_77b5_b00f];
    assert_eq!(sums, known, "{sums:#018x?}");
}

fn fnv(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |sum, &byte| {
        (sum ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}
