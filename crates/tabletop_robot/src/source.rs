//! The files that a robot was read from.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use tabletop_core::Reach;

/// The files that a robot was read from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DescriptionSource {
    /// Path of the URDF, beside which its meshes are.
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
