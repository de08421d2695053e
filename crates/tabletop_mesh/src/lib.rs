//! Meshes: surfaces from STL files, and the convex solids that fill them.
//!
//! [`read_stl`] reads a file, [`convex_solids`] decomposes its surface, once for each content, and [`mesh`] does both.
//!
//! ```
//! let cup = std::fs::read("../../tablesetup/cup.stl")?;
//! let mesh = tabletop_mesh::mesh("cup.stl", &cup, 1.0)?;
//! assert!(mesh.solids().len() > 1, "a cup is hollow");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod convex;
mod stl;

pub use convex::convex_solids;
pub use stl::{MAX_STL_BYTES, StlError, read_stl};

use bevy::math::Vec3;
use tabletop_core::MeshSpec;

/// The mesh of an STL file, with its lengths multiplied by a scale above 0. `file` is its name in the task file.
///
/// # Errors
/// The bytes are not an STL file, or describe something too large or without volume.
pub fn mesh(file: &str, bytes: &[u8], scale: f32) -> Result<MeshSpec, StlError> {
    let surface = read_stl(bytes)?;
    let by = Vec3::splat(scale);
    let solids = convex_solids(surface);
    let solids = solids.iter().map(|solid| solid.scaled(by)).collect();
    Ok(MeshSpec::new(
        file.to_owned(),
        scale,
        surface.scaled(by),
        solids,
    )?)
}
