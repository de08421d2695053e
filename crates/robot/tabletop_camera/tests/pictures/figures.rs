//! Figures, compared with rays that are intersected with their triangles one by one, and with solids of the same shape.

use bevy::{math::Vec3, prelude::*};
use proptest::prelude::*;
use tabletop_camera::{Camera, DrawnFigure, Facets, Scene};
use tabletop_core::Picture;
use tabletop_geometry::{Pose, Rgb, Solid, Triangles};

use crate::scenes::{default_scene, draw_scene, head, level, of_solids, smooth, solid};

/// The surface of a cuboid of so many units; faces have vertices of their own.
fn cuboid(span: Vec3, color: Rgb) -> Triangles {
    let mut surface = Triangles::default();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let mut normal = Vec3::ZERO;
            normal[axis] = side;
            let across = Vec3::from_array(std::array::from_fn(|i| {
                [0.0, 1.0][usize::from(i == (axis + 1) % 3)]
            }));
            let up = normal.cross(across);
            let first = surface.positions.len() as u32;
            for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                surface
                    .positions
                    .push((normal + across * x + up * y) * span / 2.0);
                surface.normals.push(normal);
                surface.colors.push(color);
            }
            let [a, b, c, d] = std::array::from_fn(|i| first + i as u32);
            surface.indices.extend([[a, b, c], [c, d, a]]);
        }
    }
    surface
}

/// A ball of radius 1 with this many rings of twice as many corners, all one smooth surface.
fn ball(rings: u32, color: Rgb) -> Triangles {
    let mut surface = Triangles::default();
    let around = 2 * rings;
    for ring in 0..=rings {
        let (sin, cos) = (std::f32::consts::PI * ring as f32 / rings as f32).sin_cos();
        for corner in 0..around {
            let turned =
                Quat::from_rotation_z(std::f32::consts::TAU * corner as f32 / around as f32);
            surface.positions.push(turned * Vec3::new(sin, 0.0, cos));
        }
    }
    for ring in 0..rings {
        for corner in 0..around {
            let [a, b] = [corner, (corner + 1) % around].map(|i| ring * around + i);
            let [c, d] = [a + around, b + around];
            surface.indices.extend([[a, c, d], [a, d, b]]);
        }
    }
    surface.normals = surface.positions.clone();
    surface.colors = vec![color; surface.positions.len()];
    surface
}

fn drawn(surface: &Triangles, pose: Pose, object: u32) -> DrawnFigure {
    DrawnFigure {
        pose,
        facets: Facets::from(surface).into(),
        object,
    }
}

fn of_figures(figures: Vec<DrawnFigure>) -> Scene {
    Scene {
        figures,
        ..Scene::default()
    }
}

/// Depth and number of the surface at a point of the picture.
fn met(figures: &[(Triangles, Pose)], camera: &Camera, x: f32, y: f32) -> Option<(f32, u32)> {
    let pixel = 2.0 * (camera.vertical_fov / 2.0).tan() / camera.height as f32;
    let local = Vec3::new(
        (x + 0.5 - camera.width as f32 / 2.0) * pixel,
        (camera.height as f32 / 2.0 - y - 0.5) * pixel,
        -1.0,
    );
    let ray = Ray3d {
        origin: camera.pose.location,
        direction: Dir3::new(camera.pose.rotation * local).expect("a direction"),
    };
    (1..)
        .zip(figures)
        .filter_map(|(object, (surface, pose))| {
            Some((surface.distance_along(ray, *pose)? / local.length(), object))
        })
        .min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Compares every pixel whose surface is certain, and returns the number of these pixels.
fn assert_seen(figures: &[(Triangles, Pose)], camera: &Camera) -> usize {
    let scene = (1..)
        .zip(figures)
        .map(|(object, (surface, pose))| drawn(surface, *pose, object));
    let picture = draw_scene(&of_figures(scene.collect()), camera);
    let mut sure = 0;
    for row in 0..camera.height {
        for column in 0..camera.width {
            let at = |x, y| met(figures, camera, column as f32 + x, row as f32 + y);
            let around =
                [(0.03, 0.0), (-0.03, 0.0), (0.0, 0.03), (0.0, -0.03)].map(|(x, y)| at(x, y));
            let center = at(0.0, 0.0);
            let is_like_center = |other: &Option<(f32, u32)>| match (center, other) {
                // A surface nearer than the near plane is not seen.
                (Some((near, one)), Some((far, other))) => {
                    one == *other && (near - far).abs() < 0.05 * near && near > 0.02
                }
                (None, None) => true,
                _ => false,
            };
            if !around.iter().all(is_like_center) {
                continue;
            }
            sure += 1;
            let (depth, object) = center.unwrap_or((f32::INFINITY, 0));
            let index = picture.index(column, row).expect("a pixel");
            assert_eq!(
                picture.objects[index], object,
                "({column}, {row}) at {depth}"
            );
            let own = picture.depth[index];
            assert!(
                own == depth || (own - depth).abs() < 2e-3 * depth,
                "{own} for {depth}"
            );
        }
    }
    sure
}

#[test]
fn every_pixel_shows_the_triangle_that_its_ray_meets_first() {
    let turned = |location: [f32; 3], degrees| Pose::from_degrees(location.into(), degrees);
    let figures = [
        (ball(6, Rgb::GRAY), turned([-2.0, 0.0, 1.0], Vec3::ZERO)),
        (
            ball(12, Rgb::GRAY),
            turned([-1.0, 0.5, 1.5], Vec3::X * 40.0),
        ),
        (
            cuboid(Vec3::new(20.0, 0.3, 0.4), Rgb::GRAY),
            turned([1.0, -1.0, 0.0], Vec3::new(10.0, 20.0, 50.0)),
        ),
    ];
    for camera in [
        head(),
        level(Vec3::new(-0.5, -7.0, 0.4), 160, 120),
        level(Vec3::new(1.0, -1.6, 0.0), 3, 90),
    ] {
        let sure = assert_seen(&figures, &camera);
        let pixels = (camera.width * camera.height) as usize;
        assert!(sure > pixels * 9 / 10, "{sure} of {pixels}");
    }
}

#[test]
fn a_cuboid_of_triangles_looks_like_a_solid_one() {
    let (pose, span) = (Pose::at(Vec3::new(1.0, 0.5, 1.0)), Vec3::new(2.0, 1.0, 2.0));
    let color = Rgb::new(0.5, 0.3, 0.4);
    for camera in [head(), smooth(head())] {
        let solid = of_solids(&[solid(1, pose.location, Solid::Cuboid(span), color)]);
        let figure = of_figures(vec![drawn(&cuboid(span, color), pose, 1)]);
        let [solid, figure] = [solid, figure].map(|scene| draw_scene(&scene, &camera));
        let same = |i: &usize| solid.objects[*i] == figure.objects[*i];
        let pixels: Vec<_> = (0..solid.objects.len()).filter(same).collect();
        assert!(pixels.len() + 5 > solid.objects.len());
        for i in pixels {
            let [one, other] = [&solid, &figure].map(|picture| picture.depth[i]);
            assert!(one == other || (one - other).abs() < 1e-3, "{one} {other}");
            for part in 3 * i..3 * i + 3 {
                assert!(solid.rgb[part].abs_diff(figure.rgb[part]) <= 8);
            }
        }
    }
}

#[test]
fn the_order_of_figures_does_not_matter() {
    let figures: Vec<_> = (1..8)
        .map(|object| {
            let color = Rgb::new(0.1 * object as f32, 0.5, 0.5);
            let location = Vec3::new(object as f32 * 0.7 - 3.0, 0.0, 1.0);
            drawn(&ball(5, color), Pose::at(location), object)
        })
        .collect();
    let backwards = figures.iter().rev().cloned().collect();
    let [one, other] =
        [figures, backwards].map(|figures| draw_scene(&of_figures(figures), &smooth(head())));
    assert!(one == other);
}

#[test]
fn a_smooth_surface_has_no_edges_inside() {
    let scene = of_figures(vec![drawn(&ball(20, Rgb::GRAY), Pose::at(Vec3::Z), 1)]);
    let [plain, mixed] = [head(), smooth(head())].map(|camera| draw_scene(&scene, &camera));
    let (mut inside, mut changed) = (0, 0);
    for row in 1..plain.height - 1 {
        for column in 1..plain.width - 1 {
            let object = |x, y| plain.objects[plain.index(x, y).expect("a pixel")];
            let around = (0..9).map(|i| object(column + i % 3 - 1, row + i / 3 - 1));
            let is_same = plain.color(column, row) == mixed.color(column, row);
            if around.clone().all(|object| object == 1) {
                inside += 1;
                assert!(is_same, "({column}, {row})");
            }
            changed += u32::from(!is_same);
        }
    }
    assert!(inside > 50 && changed > 20, "{inside} {changed}");
}

/// Red, green and blue of the pixel where a point is seen.
fn color_at(picture: &Picture, camera: &Camera, point: Vec3) -> [u8; 3] {
    let pixel = camera.pixel_of(point).expect("in front").round();
    picture
        .color(pixel.x as u32, pixel.y as u32)
        .expect("a pixel")
}

#[test]
fn markers_are_blended_over_the_picture_and_change_nothing_else() {
    for camera in [head(), smooth(head())] {
        let plain = draw_scene(&of_solids(&default_scene()), &camera);
        let with = |markers: Vec<Vec3>| {
            let scene = Scene {
                markers,
                ..of_solids(&default_scene())
            };
            draw_scene(&scene, &camera)
        };
        let center = Vec3::new(0.0, 3.0, 1.0);
        let picture = with(vec![center]);
        assert_eq!(picture.objects, plain.objects);
        assert_eq!(picture.depth, plain.depth);
        // Half of the white table behind it, and half of a ball that shows between 60 and 100 % of its colour.
        let [red, green, blue] = color_at(&picture, &camera, center);
        assert_eq!(red, 128);
        assert!(
            (178..=230).contains(&green) && green == blue,
            "{green} {blue}"
        );
        let changed = (0..plain.depth.len()).filter(|i| {
            let pixel = |picture: &Picture| picture.rgb[3 * i..3 * i + 3].to_vec();
            pixel(&plain) != pixel(&picture)
        });
        assert!((200..1000).contains(&changed.count()));
        // Below the table, and in the middle of nowhere.
        assert!(with(vec![Vec3::NEG_Z * 3.0, Vec3::NAN, Vec3::splat(1e30)]) == plain);
        // The order in the list does not matter, that in the world does.
        let (near, far) = (center, Vec3::new(0.3, 3.5, 0.0));
        assert!(with(vec![near, far]) == with(vec![far, near]));
        let [twice, ..] = color_at(&with(vec![near, far]), &camera, center);
        assert_eq!(twice, 64);
    }
}

fn any_number() -> impl Strategy<Value = f32> {
    prop_oneof![
        6 => -5.0..5.0_f32,
        1 => any::<f32>(),
        1 => prop::sample::select(vec![0.0, 1e-30, 1e15, f32::MAX, f32::INFINITY, f32::NAN]),
    ]
}

fn any_vector() -> impl Strategy<Value = Vec3> {
    [any_number(), any_number(), any_number()].prop_map(Vec3::from)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn every_pixel_of_any_figure_has_a_value(
        vertices in prop::collection::vec((any_vector(), any_vector()), 0..12),
        indices in prop::collection::vec([0..14_u32, 0..14_u32, 0..14_u32], 0..30),
        pose in (any_vector(), any_vector()),
        markers in prop::collection::vec(any_vector(), 0..3),
        eye in any_vector(),
        (width, height) in (0..40_u32, 0..40_u32),
        antialiasing: bool,
    ) {
        let surface = Triangles {
            positions: vertices.iter().map(|vertex| vertex.0).collect(),
            normals: vertices.iter().map(|vertex| vertex.1).collect(),
            colors: vertices.iter().map(|vertex| Rgb::new(vertex.0.x, vertex.0.y, vertex.1.z)).collect(),
            indices,
        };
        let rotation = Quat::from_scaled_axis(pose.1.normalize_or_zero());
        let scene = Scene {
            figures: vec![drawn(&surface, Pose::new(pose.0, rotation), 1)],
            markers,
            ..Scene::default()
        };
        let camera = Camera { antialiasing, ..level(eye, width, height) };
        let picture = draw_scene(&scene, &camera);
        prop_assert_eq!(picture.rgb.len(), 3 * (width * height) as usize);
        for (&depth, &object) in picture.depth.iter().zip(&picture.objects) {
            prop_assert!(depth > 0.0 && object <= 1, "depth {depth} of object {object}");
            prop_assert_eq!(depth.is_infinite(), object == 0);
        }
    }

    #[test]
    fn any_ball_is_seen_as_its_rays_meet_it(
        location in [-4.0..4.0_f32, -1.0..9.0, -3.0..3.0],
        axis in [-3.0..3.0_f32, -3.0..3.0, -3.0..3.0],
        rings in 2..6_u32,
        (width, height) in (1..40_u32, 1..40_u32),
    ) {
        let pose = Pose::new(location.into(), Quat::from_scaled_axis(axis.into()));
        assert_seen(&[(ball(rings, Rgb::GRAY), pose)], &level(Vec3::NEG_Y, width, height));
    }
}
