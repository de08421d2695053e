//! The files that a robot was read from.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize, Serializer};
use tabletop_core::Reach;

/// The files that a robot was read from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DescriptionSource {
    /// Path of the URDF, beside which its meshes are.
    #[serde(serialize_with = "as_text")]
    pub path: PathBuf,
    /// Content of the URDF.
    pub urdf: String,
    /// Content of the `robot.ron`. Without it, limbs and joints are those of Baxter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layout: Option<String>,
    /// Folders of its meshes, if it is a stranger's; those of the user's own are wherever it says.
    #[serde(skip)]
    pub reach: Option<Reach>,
}

impl DescriptionSource {
    /// The folder of its URDF.
    pub(crate) fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new(""))
    }

    /// True if its meshes may be there.
    pub(crate) fn reaches(&self, file: &Path) -> bool {
        self.reach.as_ref().is_none_or(|reach| reach.contains(file))
    }
}

/// Recordings are text: bytes of a path that are no Unicode are replaced there, and its meshes are not found in a replay.
fn as_text<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(&path.display())
}
