//! Errors of mesh files.

use tabletop_core::MeshError;
use tabletop_geometry::PolyhedronError;

/// The error of a file that is no mesh.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFileError {
    /// It has more than [`MAX_STL_BYTES`](crate::MAX_STL_BYTES).
    #[error("it is larger than {} bytes", crate::MAX_STL_BYTES)]
    TooLarge,
    /// It is not written as STL.
    #[error("it is no STL file: {0}")]
    Stl(String),
    /// It is not written as OBJ.
    #[error("it is no OBJ file: {0}")]
    Obj(String),
    /// It is not written as COLLADA.
    #[error("it is no COLLADA file: {0}")]
    Collada(String),
    /// It has more triangles than this limit.
    #[error("it has more than {0} triangles")]
    TooManyTriangles(usize),
    /// Its content is no surface.
    #[error(transparent)]
    Surface(#[from] PolyhedronError),
    /// Its content is too large, or no solid.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}
