//! Golden test: pictures of many random scenes keep the bytes whose hashes were recorded.
//!
//! A change that makes them differ changes what scripts see and what recordings hold. Make it on purpose or not at all.

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

#[test]
fn a_figure_is_drawn_where_it_is_now() {
    let (mut scene, camera) = (0..)
        .map(|seed| random_scene(seed, true))
        .find(|(scene, _)| scene.figures.len() > 3)
        .expect("a scene has figures");
    let (mut rasterizer, mut picture) = (Rasterizer::default(), Picture::default());
    for _ in 0..3 {
        for i in 0..scene.figures.len() {
            scene.figures[i].pose.location.x += 0.1;
            scene.solids.truncate(i + 2);
            rasterizer.draw(&scene, &camera, &mut picture);
            let mut anew = Picture::default();
            Rasterizer::default().draw(&scene, &camera, &mut anew);
            assert_eq!(hash_of(&picture), hash_of(&anew), "figure {i}");
        }
        scene.figures.swap(1, 2);
        scene.figures.pop();
    }
}

#[test]
fn an_incremental_picture_equals_a_fresh_one() {
    for seed in 0..60 {
        let (mut scene, camera) = random_scene(seed, seed % 2 == 0);
        let (mut rasterizer, mut picture) = (Rasterizer::default(), Picture::default());
        for number in 0..24_usize {
            // Twice as it was, then with something in another place, colour or number, or without it.
            let (solids, figures) = (scene.solids.len(), scene.figures.len());
            match number % 6 {
                2 => scene.solids[number % solids].pose.location.z += 0.2,
                3 => scene.solids[number % solids].color.red = 0.5,
                4 if figures > 0 => scene.figures[number % figures].pose.location.x -= 0.3,
                5 if number == 11 => scene.markers.clear(),
                5 if number == 17 && solids > 1 => scene.solids.truncate(solids - 1),
                5 => scene.solids[number % solids].object += 1,
                _ => {}
            }
            rasterizer.draw(&scene, &camera, &mut picture);
            let mut anew = Picture::default();
            Rasterizer::default().draw(&scene, &camera, &mut anew);
            assert_eq!(
                hash_of(&picture),
                hash_of(&anew),
                "scene {seed}, picture {number}"
            );
        }
    }
}

fn hash_of_pictures(antialiasing: bool) -> u64 {
    let (mut rasterizer, mut picture) = (Rasterizer::default(), Picture::default());
    (0..SCENES).fold(0xcbf2_9ce4_8422_2325, |hash, seed| {
        let (scene, camera) = random_scene(seed, antialiasing);
        // Results that are kept from picture to picture must not show.
        rasterizer.draw(&scene, &camera, &mut picture);
        let before = hash_of(&picture);
        rasterizer.draw(&scene, &camera, &mut picture);
        assert_eq!(hash_of(&picture), before, "scene {seed}");
        (hash ^ hash_of(&picture)).wrapping_mul(0x0100_0000_01b3)
    })
}
