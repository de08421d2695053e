//! The pairs of solids that Rapier keeps.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod kit;

use bevy::prelude::*;
use bevy_rapier3d::prelude::RapierContextSimulation;
use tabletop_core::{Dynamics, prelude::*};
use tabletop_geometry::PAIR_GAP;

/// A world of cubes with this edge, at these places.
fn world(edge: f32, places: impl IntoIterator<Item = Vec3>, velocity: Vec3) -> App {
    let mut app = kit::app(default());
    let shape = kit::block(Vec3::splat(edge));
    for (index, place) in places.into_iter().enumerate() {
        let at = Pose::at(place);
        let mut cube = ObjectSpec::new(format!("cube {index}"), at, 1.0, shape.clone());
        cube.dynamics = Dynamics {
            velocity,
            ..cube.dynamics
        };
        app.world_mut().spawn((cube, Transform::from(at)));
    }
    app
}

fn pairs(app: &mut App) -> usize {
    let mut simulations = app.world_mut().query::<&RapierContextSimulation>();
    let simulation = simulations.single(app.world()).unwrap();
    simulation.narrow_phase.contact_pairs().count()
}

#[test]
fn bodies_nearer_than_the_gap_are_a_pair() {
    for (gap, expected) in [(PAIR_GAP - 0.001, 1), (PAIR_GAP + 0.001, 0)] {
        let mut app = world(1.0, [Vec3::ZERO, Vec3::X * (1.0 + gap)], Vec3::ZERO);
        // Once they have moved.
        app.step(2);
        assert_eq!(pairs(&mut app), expected, "{gap}");
    }
}

#[test]
fn many_fast_bodies_make_no_more_pairs_than_memory_is_for() {
    let side = 40_u16;
    let places = (0..side * side).map(|index| {
        let (x, y) = (index % side, index / side);
        Vec3::new(f32::from(x), f32::from(y), 0.0) * 0.3
    });
    // All of them would be pairs.
    let mut app = world(0.01, places, Vec3::Z * 200.0);
    for _ in 0..3 {
        app.step(1);
        let pairs = pairs(&mut app);
        assert!(pairs <= 200_000, "{pairs}");
    }
}
