//! Meshes: shapes made of the triangles of a file.

use std::sync::Arc;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use tabletop_geometry::{Polyhedron, PolyhedronError};

/// A mesh, already scaled: a surface of triangles and the convex solids that fill it. Lengths in units, in the shape's frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Reflect)]
#[reflect(opaque)]
#[serde(try_from = "MeshRecord", into = "MeshRecord")]
pub struct MeshSpec(Arc<MeshContent>);

#[derive(Debug, PartialEq)]
struct MeshContent {
    file: String,
    scale: f32,
    surface: Polyhedron,
    solids: Vec<Polyhedron>,
}

/// A mesh as it is serialised.
#[derive(Serialize, Deserialize)]
struct MeshRecord {
    file: String,
    scale: f32,
    surface: PolyhedronRecord,
    solids: Vec<PolyhedronRecord>,
}

#[derive(Serialize, Deserialize)]
struct PolyhedronRecord {
    corners: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

/// The error of data that is no mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MeshError {
    /// Its surface or one of its solids is no polyhedron.
    #[error(transparent)]
    Polyhedron(#[from] PolyhedronError),
    /// It has more triangles than [`MeshSpec::MOST_TRIANGLES`].
    #[error("it has more than {} triangles", MeshSpec::MOST_TRIANGLES)]
    TooManyTriangles,
    /// It has no solids, or more than [`MeshSpec::MOST_SOLIDS`].
    #[error("it does not have 1 to {} solids", MeshSpec::MOST_SOLIDS)]
    Solids,
    /// One of its solids encloses nothing.
    #[error("one of its solids has no volume")]
    NoVolume,
}

impl MeshSpec {
    /// Largest number of triangles of a surface.
    pub const MOST_TRIANGLES: usize = 100_000;

    /// Largest number of solids of a mesh.
    pub const MOST_SOLIDS: usize = 1_000;

    /// A mesh read from a file. `file` is the name in the task file; lengths of the file are multiplied by `scale`.
    ///
    /// # Errors
    /// There are too many triangles or solids, none, or solids without volume.
    pub fn new(
        file: String,
        scale: f32,
        surface: Polyhedron,
        solids: Vec<Polyhedron>,
    ) -> Result<Self, MeshError> {
        let triangles = |polyhedron: &Polyhedron| polyhedron.triangles().len();
        if triangles(&surface) > Self::MOST_TRIANGLES
            || solids.iter().map(triangles).sum::<usize>() > Self::MOST_TRIANGLES
        {
            return Err(MeshError::TooManyTriangles);
        }
        if !(1..=Self::MOST_SOLIDS).contains(&solids.len()) {
            return Err(MeshError::Solids);
        }
        if solids.iter().any(|solid| solid.volume() <= 0.0) {
            return Err(MeshError::NoVolume);
        }
        Ok(Self(Arc::new(MeshContent {
            file,
            scale,
            surface,
            solids,
        })))
    }

    /// The name of its file, as in the task file.
    pub fn file(&self) -> &str {
        &self.0.file
    }

    /// The factor on the lengths of its file.
    pub fn scale(&self) -> f32 {
        self.0.scale
    }

    /// Its surface.
    pub fn surface(&self) -> &Polyhedron {
        &self.0.surface
    }

    /// The convex solids that fill it.
    pub fn solids(&self) -> &[Polyhedron] {
        &self.0.solids
    }

    /// Its name in recordings: that of its file up to the first dot, without folders.
    pub fn name(&self) -> &str {
        let file = self.0.file.rsplit(['/', '\\']).next().unwrap_or_default();
        file.split('.').next().unwrap_or_default()
    }
}

impl TryFrom<MeshRecord> for MeshSpec {
    type Error = MeshError;

    fn try_from(record: MeshRecord) -> Result<Self, MeshError> {
        let polyhedron =
            |record: PolyhedronRecord| Polyhedron::new(record.corners, record.triangles);
        let solids: Result<_, _> = record.solids.into_iter().map(polyhedron).collect();
        Self::new(
            record.file,
            record.scale,
            polyhedron(record.surface)?,
            solids?,
        )
    }
}

impl From<MeshSpec> for MeshRecord {
    fn from(mesh: MeshSpec) -> Self {
        let record = |polyhedron: &Polyhedron| PolyhedronRecord {
            corners: polyhedron.corners().to_vec(),
            triangles: polyhedron.triangles().to_vec(),
        };
        Self {
            file: mesh.0.file.clone(),
            scale: mesh.0.scale,
            surface: record(&mesh.0.surface),
            solids: mesh.0.solids.iter().map(record).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh() -> MeshSpec {
        let cube = Polyhedron::frustum(1.0, 1.0, 1.0, 4);
        let cube = Polyhedron::new(cube.corners().to_vec(), cube.triangles().to_vec());
        let cube = cube.unwrap_or_else(|error| panic!("{error}"));
        MeshSpec::new("stl/my cup.v2.stl".into(), 0.1, cube.clone(), vec![cube])
            .unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn a_mesh_is_read_back_as_it_was_written() -> Result<(), serde_json::Error> {
        let text = serde_json::to_string(&mesh())?;
        assert_eq!(serde_json::from_str::<MeshSpec>(&text)?, mesh());
        for (sound, broken) in [
            ("[0,1,5]", "[0,1,9]"),
            ("\"solids\":[{", "\"solids\":[],\"more\":[{"),
        ] {
            let broken = text.replace(sound, broken);
            assert_ne!(broken, text);
            assert!(
                serde_json::from_str::<MeshSpec>(&broken).is_err(),
                "{broken}"
            );
        }
        Ok(())
    }

    #[test]
    fn its_name_is_that_of_its_file_up_to_a_dot() {
        assert_eq!(mesh().name(), "my cup");
    }
}
