//! Looks of robots: Baxter's own shapes, faces on its screen, and the meshes of other robots.
//!
//! [`figure_of`] makes the figure of a visual of a robot's description; a link with several visuals has them [`merged`].
//! Where that fails, [`stand_in`] shows the link's collision shapes. Descriptions are in metres, figures in units.

mod axis;
mod boxes;
mod detail;
pub(crate) mod error;
mod extrusion;
mod faces;
pub(crate) mod figure;
mod hull;
mod lathe;
pub(crate) mod link_figures;
mod loft;
mod mesh_path;
pub(crate) mod meshes;
mod palette;
mod shape_file;
pub(crate) mod shared_figures;
mod shipped;
mod solids;
mod tube;

pub use error::LookError;
pub use faces::face;
pub use figure::{figure_of, merged, screen_with, stand_in};
pub use shape_file::read_shape;
