//! Objects in others of their colour.

use bevy::math::Vec3;
use tabletop_core::{Shape, Table};
use tabletop_geometry::{Pose, Rgb};
use tabletop_vision::{Eyes, KnownObject, KnownScenery};

use crate::guided::{camera, picture};

#[test]
fn blocks_in_a_bin_of_their_colour_stand_on_its_floor_and_not_in_it() {
    let color = Rgb::RED;
    let bin = Shape::Box {
        span: Vec3::new(4.0, 2.4, 0.8),
        thickness: 0.1,
        color,
    };
    let block = Shape::Block {
        span: Vec3::splat(0.8),
        color,
    };
    let shapes = [&bin, &block, &block, &block];
    let known = shapes.map(KnownObject::of);
    for shift in [0.0, 0.1, 0.2] {
        let at = |x: f32, y: f32, z: f32| Pose::at(Vec3::new(x + shift, y - 3.0, z));
        let inside = [at(-1.2, 0.1, 0.5), at(0.0, -0.1, 0.5), at(1.2, 0.0, 0.5)];
        let poses = [at(0.0, 0.0, 0.4), inside[0], inside[1], inside[2]];
        let scene: Vec<_> = shapes.into_iter().zip(poses).collect();
        let mut eyes = Eyes::new(known.to_vec(), camera(), Table::default());
        let seen = eyes.look(&picture(&scene), &KnownScenery::default());
        for (object, seen) in seen.objects.iter().enumerate().skip(1) {
            let height = seen.pose.map_or(0.5, |pose| pose.location.z);
            assert!(height > 0.47 || !seen.is_sure, "{shift} {object}: {height}");
        }
    }
}
