//! Meshes: triangles and surfaces from STL, OBJ and COLLADA files, and the convex solids that fill them.
//!
//! [`read_stl`], [`read_obj`] and [`read_collada`] read triangles; [`surface()`] makes a surface of those of an STL file, [`convex_solids`] decomposes one, once
//! for each content, and [`mesh`] does both.
//!
//! ```
//! let cup = std::fs::read("../../../tablesetup/cup.stl")?;
//! let mesh = tabletop_mesh::mesh("cup.stl", &cup, 1.0)?;
//! assert!(mesh.solids().len() > 1, "a cup is hollow");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod collada;
mod convex;
mod error;
mod limits;
mod obj;
mod stl;
mod surface;
mod text;

pub use collada::{ColoredTriangles, read_collada};
pub use convex::convex_solids;
pub use error::MeshFileError;
pub use limits::MAX_STL_BYTES;
pub use obj::read_obj;
pub use stl::read_stl;
pub use surface::surface;

use bevy::math::Vec3;
use tabletop_core::MeshSpec;

/// The corners of a triangle, in the units of its file.
pub type Triangle = [Vec3; 3];

/// The mesh of an STL file, with its lengths multiplied by a scale above 0. `file` is its name in the task file.
///
/// # Errors
/// The bytes are not an STL file, or describe something too large or without volume.
pub fn mesh(file: &str, bytes: &[u8], scale: f32) -> Result<MeshSpec, MeshFileError> {
    let surface = surface(bytes)?;
    let by = Vec3::splat(scale);
    let solids = convex_solids(&surface);
    let solids = solids.iter().map(|solid| solid.scaled(by)).collect();
    Ok(MeshSpec::new(
        file.to_owned(),
        scale,
        surface.scaled(by),
        solids,
    )?)
}
