//! Random scenes of everything that can be drawn.

use std::sync::Arc;

use bevy::math::{Quat, Vec3};
use tabletop_camera::{Camera, DrawnFigure, DrawnSolid, Facets, Scene};
use tabletop_core::{HeadCamera, Picture, Table};
use tabletop_geometry::{Pose, Rgb, Solid, Triangles};

/// A scene and a camera. Every fourth scene has something very near, very large or behind the camera; in every third one,
/// solids stand upright and in a grid, so that their edges are level and their faces meet.
pub fn random_scene(seed: u64, antialiasing: bool) -> (Scene, Camera) {
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let is_wild = seed % 4 == 3;
    let is_upright = seed.is_multiple_of(3);
    let sizes = [(200, 150), (61, 47), (33, 17), (3, 90), (1, 1), (130, 5)];
    let (width, height) = sizes[random.below(12) as usize % sizes.len()];
    let head = HeadCamera {
        width,
        height,
        antialiasing,
        square_fov: random.below(2) == 0,
        ..HeadCamera::default()
    };
    let table = Table::default();
    let mut camera = Camera::of_head(&head, &table);
    if random.below(2) == 0 {
        camera.pose.rotation *= random.rotation(0.2);
        camera.pose.location += random.point(3.0);
    }
    let mut scene = Scene {
        solids: vec![DrawnSolid::of_table(&table, 1)],
        ..Scene::default()
    };
    for object in 0..random.below(40) {
        scene
            .solids
            .push(random.solid(object + 2, is_wild, is_upright));
    }
    for object in 0..random.below(6) {
        scene.figures.push(random.figure(object + 100, is_wild));
    }
    for _ in 0..random.below(4) {
        let marker = random.point(6.0);
        scene.markers.push(marker);
    }
    (scene, camera)
}

/// A hash that two different pictures hardly share (FNV).
pub fn hash_of(picture: &Picture) -> u64 {
    let rgb = picture.rgb.iter().copied();
    let depth = picture
        .depth
        .iter()
        .flat_map(|depth| depth.to_bits().to_le_bytes());
    let objects = picture
        .objects
        .iter()
        .flat_map(|object| object.to_le_bytes());
    rgb.chain(depth)
        .chain(objects)
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        })
}

/// Numbers that are the same on every system (SplitMix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    fn below(&mut self, end: u32) -> u32 {
        (self.next() % u64::from(end)) as u32
    }

    /// From -1 to 1.
    fn signed(&mut self) -> f32 {
        self.below(2_000_001) as f32 / 1e6 - 1.0
    }

    fn point(&mut self, reach: f32) -> Vec3 {
        Vec3::new(self.signed(), self.signed(), self.signed()) * reach
    }

    fn rotation(&mut self, reach: f32) -> Quat {
        let axis = self.point(reach);
        Quat::from_xyzw(axis.x, axis.y, axis.z, 1.0).normalize()
    }

    fn color(&mut self) -> Rgb {
        let color = (self.point(0.5) + 0.5).to_array();
        Rgb::new(color[0], color[1], color[2])
    }

    fn solid(&mut self, object: u32, is_wild: bool, is_upright: bool) -> DrawnSolid {
        let span = if is_upright {
            Vec3::splat(1.0 + self.below(3) as f32)
        } else {
            self.point(1.0).abs() * 2.0 + 0.05
        };
        let reach = if is_wild { 30.0 } else { 6.0 };
        let location = if is_upright {
            self.point(6.0).round() + Vec3::Z * span.z / 2.0
        } else {
            self.point(reach) + Vec3::Z * 2.0
        };
        let scale = match (is_wild, self.below(5)) {
            (true, 0) => 100.0,
            (true, 1) => 1e-6,
            (true, 2) => 1e4,
            _ => 1.0,
        };
        let rotation = match (is_upright, self.below(3)) {
            (true, _) => Quat::IDENTITY,
            (false, 0) => self.rotation(2.0),
            (false, _) => self.rotation(2.0) * Quat::from_xyzw(0.0, 0.0, 1.0, 0.0),
        };
        let solid = match self.below(4) {
            0 | 1 => Solid::Cuboid(span * scale),
            2 => Solid::Ball(span.x / 2.0 * scale),
            _ => Solid::Cylinder {
                radius: span.x / 2.0 * scale,
                yspan: span.y * scale,
            },
        };
        DrawnSolid {
            pose: Pose::new(location, rotation),
            solid,
            color: self.color(),
            object,
        }
    }

    fn figure(&mut self, object: u32, is_wild: bool) -> DrawnFigure {
        let reach = if is_wild { 20.0 } else { 5.0 };
        let surface = match self.below(3) {
            0 => self.triangles(),
            _ => self.ball_of_triangles(),
        };
        DrawnFigure {
            pose: Pose::new(self.point(reach) + Vec3::Z * 2.0, self.rotation(2.0)),
            facets: Arc::new(Facets::from(&surface)),
            object,
        }
    }

    /// Any triangles.
    fn triangles(&mut self) -> Triangles {
        let corners = 3 + self.below(60);
        let mut surface = Triangles::default();
        for _ in 0..corners {
            surface.positions.push(self.point(4.0));
            surface.normals.push(self.point(1.0).normalize_or(Vec3::Z));
            surface.colors.push(self.color());
        }
        for _ in 0..self.below(80) {
            let triangle = std::array::from_fn(|_| self.below(corners));
            surface.indices.push(triangle);
        }
        surface
    }

    /// A closed surface of many small triangles, whose corners are shared.
    fn ball_of_triangles(&mut self) -> Triangles {
        let (color, radius) = (self.color(), 0.3 + self.point(1.0).abs().x);
        let mut surface = Triangles::default();
        let cells = 3 + self.below(8);
        for side in [-1.0, 1.0] {
            let first = surface.positions.len() as u32;
            for row in 0..=cells {
                for column in 0..=cells {
                    let [x, y] = [column, row].map(|i| 2.0 * i as f32 / cells as f32 - 1.0);
                    let height = side * (2.0 - x * x - y * y);
                    let normal = Vec3::new(x, y, height).normalize();
                    surface.positions.push(normal * radius);
                    surface.normals.push(normal);
                    surface.colors.push(color);
                }
            }
            for row in 0..cells {
                for column in 0..cells {
                    let a = first + row * (cells + 1) + column;
                    let (b, c) = (a + 1, a + cells + 1);
                    let d = c + 1;
                    let triangles = match side > 0.0 {
                        true => [[a, b, d], [a, d, c]],
                        false => [[a, d, b], [a, c, d]],
                    };
                    surface.indices.extend(triangles);
                }
            }
        }
        surface
    }
}
