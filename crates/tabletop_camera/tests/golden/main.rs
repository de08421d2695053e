//! Pictures of many random scenes are the same bytes as they were when their hashes were written down.
//!
//! A change that makes them differ changes what scripts see and what recordings hold: it is made on purpose or not at all.

mod random_scene;

use tabletop_camera::Rasterizer;
use tabletop_core::Picture;

use random_scene::{hash_of, random_scene};

const SCENES: u64 = 300;

#[test]
fn plain_pictures_are_the_bytes_they_were() {
    assert_eq!(hash_of_pictures(false), 0xa577_883b_2c45_b35e);
}

#[test]
fn smooth_pictures_are_the_bytes_they_were() {
    assert_eq!(hash_of_pictures(true), 0x7033_0b48_74c1_6a15);
}

fn hash_of_pictures(antialiasing: bool) -> u64 {
    let (mut rasterizer, mut picture) = (Rasterizer::default(), Picture::default());
    (0..SCENES).fold(0xcbf2_9ce4_8422_2325, |hash, seed| {
        let (scene, camera) = random_scene(seed, antialiasing);
        rasterizer.draw(&scene, &camera, &mut picture);
        (hash ^ hash_of(&picture)).wrapping_mul(0x0100_0000_01b3)
    })
}
