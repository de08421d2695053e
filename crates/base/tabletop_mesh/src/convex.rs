//! Decomposition of surfaces into the convex solids that fill them.

use std::{
    collections::BTreeMap,
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{Mutex, PoisonError},
};

use bevy::math::Vec3;
use parry3d::transformation::{
    try_convex_hull,
    vhacd::{VHACD, VHACDParameters},
};
use tabletop_core::MeshSpec;
use tabletop_geometry::Polyhedron;

/// Largest distance of a surface from the faces of a convex one, as a share of its length.
const FLATNESS: f32 = 1e-4;

/// Number of cells along the longest side of a surface that is not convex.
const CELLS: u32 = 64;

/// Largest concavity that a solid may fill up, as a share of the whole.
const CONCAVITY: f32 = 0.002;

/// Largest number of solids of a surface.
const MOST_SOLIDS: u32 = 128;

/// Largest number of decompositions that are remembered, and of the triangles in them.
const MOST_KNOWN: usize = 256;
const MOST_KNOWN_TRIANGLES: usize = 1_000_000;

/// A surface and the convex solids that fill it.
struct Decomposition {
    /// It is held, so that the same content is the same surface for as long as this is remembered.
    surface: Polyhedron,
    solids: Vec<Polyhedron>,
}

/// The latest decompositions, by the numbers of their surfaces.
static KNOWN: Mutex<BTreeMap<usize, Decomposition>> = Mutex::new(BTreeMap::new());

/// Convex solids that fill a surface; for one that is not convex approximately: up to a sixtieth of its length is filled up or left out. Empty if
/// it encloses nothing. The latest surfaces are decomposed only once.
pub fn convex_solids(surface: &Polyhedron) -> Vec<Polyhedron> {
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let found = known
        .entry(surface.number())
        .or_insert_with(|| Decomposition {
            surface: surface.clone(),
            solids: solids_of(surface),
        });
    let solids = found.solids.clone();
    while known.len() > MOST_KNOWN || triangles_in(&known) > MOST_KNOWN_TRIANGLES {
        known.pop_first();
    }
    solids
}

fn triangles_in(known: &BTreeMap<usize, Decomposition>) -> usize {
    let polyhedra = known
        .values()
        .flat_map(|known| known.solids.iter().chain([&known.surface]));
    polyhedra.map(|known| known.triangles().len()).sum()
}

fn solids_of(surface: &Polyhedron) -> Vec<Polyhedron> {
    if let Some(hull) = hull(surface.corners().to_vec())
        && is_filled(surface, &hull)
    {
        return vec![hull];
    }
    // A surface that is degenerate in a way that Parry has not foreseen is taken as a whole.
    let parts = catch_unwind(AssertUnwindSafe(|| decompose(surface))).unwrap_or_default();
    match parts.is_empty() || parts.len() > MeshSpec::MOST_SOLIDS {
        true => hull(surface.corners().to_vec()).into_iter().collect(),
        false => parts,
    }
}

fn decompose(surface: &Polyhedron) -> Vec<Polyhedron> {
    let parameters = VHACDParameters {
        resolution: CELLS,
        concavity: CONCAVITY,
        max_convex_hulls: MOST_SOLIDS,
        ..VHACDParameters::default()
    };
    let (corners, triangles) = (surface.corners(), surface.triangles());
    let parts = VHACD::decompose(&parameters, corners, triangles, true);
    parts
        .compute_exact_convex_hulls(corners, triangles)
        .into_iter()
        .filter_map(|(corners, _)| hull(corners))
        .collect()
}

/// The convex hull of some corners, if it has a volume.
fn hull(corners: Vec<Vec3>) -> Option<Polyhedron> {
    let (corners, triangles) = try_convex_hull(&corners).ok()?;
    let hull = Polyhedron::new(corners, triangles).ok()?;
    let span = hull.bounds().high - hull.bounds().low;
    (hull.volume() > 1e-6 * span.max_element().powi(3)).then_some(hull)
}

/// True if a surface is that of its hull.
fn is_filled(surface: &Polyhedron, hull: &Polyhedron) -> bool {
    let span = hull.bounds().high - hull.bounds().low;
    let tolerance = FLATNESS * span.max_element();
    let is_convex = surface.faces().all(|[a, b, c]| {
        let Some(normal) = (b - a).cross(c - a).try_normalize() else {
            return true;
        };
        let height = |corner: &Vec3| normal.dot(*corner - a);
        hull.corners()
            .iter()
            .all(|corner| height(corner) <= tolerance)
    });
    is_convex && (surface.volume() / hull.volume() - 1.0).abs() < 1e-2
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume(solids: &[Polyhedron]) -> f32 {
        solids.iter().map(|solid| solid.volume()).sum()
    }

    #[test]
    fn a_convex_mesh_is_one_solid() {
        for sides in [3, 6, 32] {
            let frustum = Polyhedron::frustum(0.5, 1.0, 2.0, sides);
            let solids = convex_solids(&frustum);
            assert_eq!(solids.len(), 1);
            assert!((volume(&solids) / frustum.volume() - 1.0).abs() < 1e-3);
        }
    }

    #[test]
    fn a_ring_stays_open() {
        let ring = Polyhedron::ring(1.0, 0.6, 0.5, 32);
        let solids = convex_solids(&ring);
        assert!(solids.len() > 4, "{solids:?}");
        let inside = |x, y| {
            let point = Vec3::new(x, y, 0.0);
            solids.iter().any(|solid| solid.contains(point))
        };
        for angle in 0..16 {
            let (sin, cos) = (angle as f32 / 16.0 * std::f32::consts::TAU).sin_cos();
            assert!(!inside(0.5 * cos, 0.5 * sin), "the hole at {angle}");
            assert!(inside(0.8 * cos, 0.8 * sin), "the ring at {angle}");
        }
        assert!((volume(&solids) / ring.volume() - 1.0).abs() < 0.15);
        assert_eq!(convex_solids(&ring), solids);
    }

    #[test]
    fn a_flat_mesh_has_no_solids() {
        let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        let sheet = Polyhedron::new(corners, vec![[0, 1, 2]]);
        let sheet = sheet.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(convex_solids(&sheet), []);
    }

    #[test]
    fn only_the_latest_decompositions_are_remembered() {
        for i in 0..20_000_u16 {
            let frustum = Polyhedron::frustum(0.5, 1.0, 2.0 + f32::from(i) / 4096.0, 4);
            assert_eq!(convex_solids(&frustum).len(), 1);
        }
        let known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        assert!(known.len() <= MOST_KNOWN, "{}", known.len());
    }
}
