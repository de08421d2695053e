//! Writes the cup of `tablesetup/cup.stl`, an ASCII STL file whose Y is up: `cargo run --release --example stl_cup > tablesetup/cup.stl`.

use std::{
    f32::consts::TAU,
    io::{self, Write},
};

const SIDES: usize = 24;

/// Radius and height of the profile, from the middle of the bottom outside over the rim to the middle of the bottom inside.
const PROFILE: [[f32; 2]; 6] = [
    [0.0, -0.8],
    [0.8, -0.8],
    [1.0, 0.8],
    [0.8, 0.8],
    [0.62, -0.6],
    [0.0, -0.6],
];

fn main() -> io::Result<()> {
    let mut out = io::stdout().lock();
    writeln!(out, "solid cup")?;
    for side in 0..SIDES {
        for pair in PROFILE.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let [from, to] = [side, side + 1];
            let corners = [point(a, from), point(a, to), point(b, to), point(b, from)];
            for [i, j, k] in [[0, 1, 2], [0, 2, 3]] {
                facet(&mut out, [corners[i], corners[j], corners[k]])?;
            }
        }
    }
    writeln!(out, "endsolid cup")
}

fn point([radius, height]: [f32; 2], side: usize) -> [f32; 3] {
    let (sin, cos) = (TAU * (side % SIDES) as f32 / SIDES as f32).sin_cos();
    [radius * cos, height, -radius * sin]
}

/// Writes a triangle, if it is one.
fn facet(out: &mut impl Write, [a, b, c]: [[f32; 3]; 3]) -> io::Result<()> {
    let less = |p: [f32; 3], q: [f32; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let (u, v) = (less(b, a), less(c, a));
    let normal = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let length = normal.iter().map(|part| part * part).sum::<f32>().sqrt();
    if length < 1e-6 {
        return Ok(());
    }
    let [x, y, z] = normal.map(|part| part / length);
    writeln!(out, "facet normal {x} {y} {z}\n outer loop")?;
    for [x, y, z] in [a, b, c] {
        writeln!(out, "  vertex {x} {y} {z}")?;
    }
    writeln!(out, " endloop\nendfacet")
}
