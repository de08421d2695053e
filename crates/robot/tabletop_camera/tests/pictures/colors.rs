//! Colours: a surface that faces up shows its full colour, any other a share of it (as in the original program, but without the lamp
//! that made dark colours brighter than the task file says).

use bevy::math::{DVec3, Vec3};
use tabletop_camera::{Camera, DrawnSolid};
use tabletop_core::{Picture, Table};
use tabletop_geometry::{NAMED_COLORS, Pose, Rgb, Solid};

use crate::scenes::{default_scene, draw, head, level, smooth, solid, turned};

/// The share of its colour that a surface with this normal shows: the mean of the shares along the axes, weighted by the
/// squares of the normal's components.
fn share(normal: DVec3) -> f64 {
    let along = |component: f64, positive: f64, negative: f64| {
        component * component * if component > 0.0 { positive } else { negative }
    };
    along(normal.x, 0.9, 0.7) + along(normal.y, 0.85, 0.8) + along(normal.z, 1.0, 0.6)
}

/// Asserts that every pixel of the solid has the colour of the formula, at the point that its depth gives.
fn assert_lit(drawn: &DrawnSolid, camera: Camera, normal_at: impl Fn(DVec3) -> DVec3) {
    let picture = draw(std::slice::from_ref(drawn), &camera);
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
                let exact = f64::from(part) * share(normal_at(point)) * 255.0;
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

/// The visible point, computed from the pose and the angles of the camera.
fn point_at(picture: &Picture, camera: &Camera, column: u32, row: u32) -> DVec3 {
    let depth = f64::from(picture.depth[picture.index(column, row).expect("a pixel")]);
    let pixel = 2.0 * (f64::from(camera.vertical_fov) / 2.0).tan() / f64::from(camera.height);
    let x = (f64::from(column) + 0.5 - f64::from(camera.width) / 2.0) * pixel;
    let y = (f64::from(camera.height) / 2.0 - f64::from(row) - 0.5) * pixel;
    let local = DVec3::new(x, y, -1.0) * depth;
    camera.pose.rotation.as_dquat() * local + camera.pose.location.as_dvec3()
}

/// The colour of the pixel in which a point is seen.
fn color_at(picture: &Picture, camera: &Camera, point: Vec3) -> Option<[u8; 3]> {
    let pixel = camera.pixel_of(point).expect("in front").round();
    picture.color(pixel.x as u32, pixel.y as u32)
}

/// The colours of all pixels in which this object is seen.
fn colors_of(object: u32, picture: &Picture) -> Vec<[u8; 3]> {
    let pixels = picture.rgb.chunks_exact(3).zip(&picture.objects);
    let mut colors: Vec<_> = pixels
        .filter(|&(_, seen)| *seen == object)
        .map(|(pixel, _)| [pixel[0], pixel[1], pixel[2]])
        .collect();
    colors.sort_unstable();
    colors.dedup();
    colors
}

#[test]
fn upward_faces_show_the_exact_colour_of_the_task_file_anywhere_on_the_table() {
    let from_above = Camera {
        pose: Pose::at(Vec3::Z * 30.0),
        ..head()
    };
    let colors = NAMED_COLORS.map(|(_, color)| color).into_iter();
    let colors = colors.chain(["#00A57F", "#010203", "#fe7f80"].map(|text| text.parse().unwrap()));
    for (number, color) in colors.enumerate() {
        for location in [[0.0, 0.0], [-9.0, 5.0], [8.0, -5.0], [3.0, 4.0]] {
            let [x, y] = location;
            let plate = Solid::Cuboid(Vec3::new(1.0, 1.0, 0.2));
            let about_z = Vec3::Z * 10.0 * number as f32;
            let plate = turned(2, [x, y, 0.1], about_z, plate, color);
            let scene = [DrawnSolid::of_table(&Table::default(), 1), plate];
            let picture = draw(&scene, &from_above);
            let shown = color_at(&picture, &from_above, Vec3::new(x, y, 0.2));
            assert_eq!(shown, Some(color.to_bytes()), "{color} at {location:?}");
            assert_eq!(colors_of(1, &picture), [[255; 3]]);
        }
    }
}

#[test]
fn each_other_side_of_a_block_shows_a_share_of_its_own() {
    let block = solid(1, [0.0; 3], Solid::Cuboid(Vec3::splat(2.0)), Rgb::WHITE);
    for (side, percent) in [
        (Vec3::X, 90.0),
        (Vec3::NEG_X, 70.0),
        (Vec3::Y, 85.0),
        (Vec3::NEG_Y, 80.0),
        (Vec3::Z, 100.0),
        (Vec3::NEG_Z, 60.0),
    ] {
        let before = bevy::prelude::Transform::from_translation(side * 6.0)
            .looking_at(Vec3::ZERO, side.any_orthonormal_vector());
        let camera = Camera {
            pose: (&before).into(),
            ..level(Vec3::ZERO, 30, 30)
        };
        let shown = colors_of(1, &draw(std::slice::from_ref(&block), &camera));
        let [[red, green, blue]] = shown[..] else {
            panic!("{shown:?} of the side {side}");
        };
        assert!(red == green && green == blue);
        assert!((f32::from(red) - percent * 2.55).abs() < 0.6, "{red}");
    }
}

#[test]
fn round_surfaces_are_lit_by_their_own_normals() {
    let center = DVec3::new(1.0, 0.0, 2.0);
    let color = Rgb::new(0.5, 0.3, 0.55);
    let ball = solid(1, center.as_vec3(), Solid::Ball(2.0), color);
    assert_lit(&ball, head(), |point| (point - center) / 2.0);
    let lying = Solid::Cylinder {
        radius: 2.0,
        yspan: 8.0,
    };
    // Its axis is along X, and its ends are not in view.
    let cylinder = turned(1, center.as_vec3(), Vec3::Z * 90.0, lying, color);
    let camera = level(Vec3::new(1.0, -8.0, 4.0), 60, 60);
    assert_lit(&cylinder, camera, |point| {
        (point - center).with_x(0.0) / 2.0
    });
}

#[test]
fn the_end_of_a_cylinder_is_flat() {
    let standing = Solid::Cylinder {
        radius: 8.0,
        yspan: 2.0,
    };
    for degrees in [90.0, -90.0] {
        let color = "#00A57F".parse().unwrap();
        let cylinder = turned(1, Vec3::Z, Vec3::X * degrees, standing.clone(), color);
        let above = Camera {
            pose: Pose::at(Vec3::Z * 35.0),
            ..head()
        };
        assert_eq!(
            colors_of(1, &draw(&[cylinder], &above)),
            [[0x00, 0xa5, 0x7f]]
        );
    }
}

#[test]
fn the_blocks_of_the_default_table_show_their_colours() {
    let camera = head();
    let picture = draw(&default_scene(), &camera);
    let color_at = |point| color_at(&picture, &camera, point);
    // The near side of the red block is turned a little to the left.
    assert_eq!(color_at(Vec3::new(2.0, 0.0, 2.0)), Some([255, 0, 0]));
    assert_eq!(color_at(Vec3::new(-2.0, 0.0, 2.0)), Some([0, 255, 0]));
    assert_eq!(color_at(Vec3::new(0.0, -4.0, 0.0)), Some([255, 255, 255]));
    assert_eq!(color_at(Vec3::new(1.74, -0.966, 1.0)), Some([202, 0, 0]));
    assert_eq!(color_at(Vec3::new(0.0, -6.0, -0.15)), Some([204, 204, 204]));
    assert_eq!(picture.color(100, 0), Some([0, 0, 0]));
}

/// The bytes of these pictures must not change unnoticed: people train on them. To change them on purpose, look at the pictures
/// and enter the numbers that the failing test prints.
#[test]
fn the_picture_of_the_default_table_is_known_to_the_last_bit() {
    let sums = [head(), smooth(head())].map(|camera| fnv(&draw(&default_scene(), &camera).rgb));
    let known = [0x76d4_e45d_3977_9a8c, 0xf65c_a0a9_b2ae_889e];
    assert_eq!(sums, known, "{sums:#018x?}");
}

fn fnv(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |sum, &byte| {
        (sum ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}
