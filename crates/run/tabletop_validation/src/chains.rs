//! Hanging chains.
//!
//! Rigid links that joints connect hang like a catenary of straight pieces: the horizontal force is the same in every joint, and the
//! vertical one changes by a link's weight, so the tangents of the links' angles are evenly spaced.

use bevy::math::Vec3;
use tabletop_core::{ChainSpec, SceneItem};
use tabletop_geometry::Rgb;

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{SHIPPED, SmallWorld},
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("chain-hangs", || hang(16)),
    Experiment::new("chain-hangs-tight", || hang(13)),
];

/// The distance of a chain's first joint from its end, in units.
const END: f64 = 0.1;

/// A chain of links of 1 unit between two ends 12 units apart, after 30 s.
fn hang(links: u32) -> Vec<Measurement> {
    const SPAN: f32 = 12.0;
    const HEIGHT: f32 = 20.0;
    let chain = ChainSpec {
        id: "chain".into(),
        start: Vec3::new(-SPAN / 2.0, 0.0, HEIGHT),
        end: Vec3::new(SPAN / 2.0, 0.0, HEIGHT),
        link_span: Vec3::new(0.1, 1.0, 0.1),
        link_count: links,
        link_padding: 0.05,
        link_mass: 0.1,
        color: Rgb::GRAY,
    };
    let mut world = SmallWorld::with_items(SHIPPED, vec![SceneItem::Chain(chain)]);
    world.seconds(30.0);
    let ends: Vec<_> = (0..links)
        .map(|link| {
            let pose = world.pose(&format!("chain-link{link}"));
            [-0.5, 0.5].map(|y| (pose * (Vec3::Y * y)).as_dvec3())
        })
        .collect();
    let lowest = ends
        .iter()
        .flatten()
        .map(|end| end.z)
        .fold(f64::INFINITY, f64::min);
    let gap = ends
        .windows(2)
        .map(|pair| pair[0][1].distance(pair[1][0]))
        .fold(0.0, f64::max);
    let expected = sag(links, f64::from(SPAN) - 2.0 * END);
    vec![
        Measurement::close(
            "sag",
            "Σ sin φᵢ, tan φᵢ = i w/H",
            expected,
            f64::from(HEIGHT) - lowest,
            0.01,
        ),
        Measurement::none("gap", gap, 0.01),
    ]
}

/// How far links of length 1 hang down between joints at one height, this far from each other.
fn sag(links: u32, distance: f64) -> f64 {
    let angles = |step: f64| {
        (0..links).map(move |link| {
            let place = f64::from(link) - f64::from(links - 1) / 2.0;
            (step * place).atan()
        })
    };
    // The steeper, the nearer the ends.
    let (mut flat, mut steep) = (0.0, 1e6);
    for _ in 0..200 {
        let step = (flat + steep) / 2.0;
        match angles(step).map(f64::cos).sum::<f64>() > distance {
            true => flat = step,
            false => steep = step,
        }
    }
    angles(flat)
        .filter(|angle| *angle > 0.0)
        .map(f64::sin)
        .sum()
}
