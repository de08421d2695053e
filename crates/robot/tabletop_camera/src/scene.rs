//! Scenes, at which cameras look.

mod facets;
mod shared_facets;

use std::sync::Arc;

use bevy::math::Vec3;
use tabletop_core::{Figure, Table};
use tabletop_geometry::{Pose, Primitive, Rgb, Solid};

pub use facets::Facets;
pub(crate) use facets::FourPlanes;
pub(crate) use shared_facets::facets_of;

/// A scene for a camera.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Solids.
    pub solids: Vec<DrawnSolid>,
    /// Surfaces of triangles.
    pub figures: Vec<DrawnFigure>,
    /// Middles of transparent balls ([`Markers`](tabletop_core::Markers)), in units. They change colours only.
    pub markers: Vec<Vec3>,
}

/// A figure in the picture.
#[derive(Clone, Debug)]
pub struct DrawnFigure {
    /// Pose in the world.
    pub pose: Pose,
    /// Its surface.
    pub facets: Arc<Facets>,
    /// The number of its pixels in [`Picture::objects`](tabletop_core::Picture::objects); above 0.
    pub object: u32,
}

/// A solid in the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnSolid {
    /// Pose of its centre in the world.
    pub pose: Pose,
    /// The solid.
    pub solid: Solid,
    /// Its colour.
    pub color: Rgb,
    /// The number of its pixels in [`Picture::objects`](tabletop_core::Picture::objects); above 0.
    pub object: u32,
}

/// The bits of a pose, which identify it.
fn bits_of(pose: Pose) -> [u32; 7] {
    let ([x, y, z], [a, b, c, d]) = (pose.location.to_array(), pose.rotation.to_array());
    [x, y, z, a, b, c, d].map(f32::to_bits)
}

impl DrawnFigure {
    /// A figure at a pose, as coarse as cameras see it. All that show the same surface share its facets.
    pub fn of(pose: Pose, figure: &Figure, object: u32) -> Self {
        Self {
            pose,
            facets: facets_of(&figure.coarse),
            object,
        }
    }

    /// The bits of its pose, which identify it.
    pub(crate) fn pose_bits(&self) -> [u32; 7] {
        bits_of(self.pose)
    }
}

impl DrawnSolid {
    /// The bits of its pose, which identify it.
    pub(crate) fn pose_bits(&self) -> [u32; 7] {
        bits_of(self.pose)
    }

    /// A solid of a body that stands at `pose`.
    pub fn of(body: Pose, primitive: &Primitive, object: u32) -> Self {
        Self {
            pose: body * primitive.pose,
            solid: primitive.solid.clone(),
            color: primitive.color,
            object,
        }
    }

    /// The slab of a table: white, its top at Z = 0.
    pub fn of_table(table: &Table, object: u32) -> Self {
        Self {
            pose: Pose::at(Vec3::NEG_Z * Table::THICKNESS / 2.0),
            solid: Solid::Cuboid(Vec3::new(table.xspan, table.yspan, Table::THICKNESS)),
            color: Rgb::WHITE,
            object,
        }
    }
}
