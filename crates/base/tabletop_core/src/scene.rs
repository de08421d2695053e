//! Scenes: the table and the objects on it, as a task file describes them.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};
use tabletop_geometry::{Bounds, Pose, Primitive, Rgb, Solid};

use crate::{JointedSpec, ObjectSpec, Rollback, Shape};

/// The content of a task file, in the file's order, before ids are made unique.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SceneSpec {
    /// The table.
    pub table: Table,
    /// The elements on it.
    pub items: Vec<SceneItem>,
}

/// The table: a white slab whose top lies in the XY plane, centred at the origin. As a component it marks the table's entity.
#[derive(Component, Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Reflect)]
#[component(immutable)]
#[require(Transform, Rollback)]
#[reflect(Component)]
pub struct Table {
    /// Extent along X in units.
    pub xspan: f32,
    /// Extent along Y in units.
    pub yspan: f32,
}

impl Table {
    /// Thickness of the slab below Z = 0, in units.
    pub const THICKNESS: f32 = 4.0;

    /// The slab, in the frame of the world.
    pub fn slab(&self) -> Primitive {
        Primitive {
            pose: Pose::at(Vec3::NEG_Z * Self::THICKNESS / 2.0),
            solid: Solid::Cuboid(Vec3::new(self.xspan, self.yspan, Self::THICKNESS)),
            color: Rgb::WHITE,
        }
    }
}

impl Default for Table {
    fn default() -> Self {
        Self {
            xspan: 20.0,
            yspan: 12.0,
        }
    }
}

/// One element of a task file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(
    clippy::large_enum_variant,
    reason = "a scene is read once and has few items; a box for each joint would only be in the way"
)]
pub enum SceneItem {
    /// A block, cylinder, sphere, box or composite.
    Object(ObjectSpec),
    /// A chain.
    Chain(ChainSpec),
    /// A box with a sliding lid.
    LidBox(LidBoxSpec),
    /// Two objects with a joint between them.
    Jointed(JointedSpec),
}

/// A string of links between two fixed ends (report section 6.2, `<chain>`). Lengths in units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Reflect)]
pub struct ChainSpec {
    /// Prefix of the ids of links and ends; empty for any.
    pub id: String,
    /// Its start.
    pub start: Vec3,
    /// Its end.
    pub end: Vec3,
    /// Extents of a link; Y is along the chain.
    pub link_span: Vec3,
    /// Number of links; 0 for as many as the distance needs.
    pub link_count: u32,
    /// Length added to each drawn link at both ends.
    pub link_padding: f32,
    /// Mass of a link in kg.
    pub link_mass: f32,
    /// Colour of the links.
    pub color: Rgb,
}

impl ChainSpec {
    /// Number of its links.
    pub fn links(&self) -> u32 {
        match self.link_count {
            0 => (self.start.distance(self.end) / self.link_span.y).ceil() as u32,
            count => count,
        }
    }

    /// The pose of a link's centre while the chain is straight.
    pub fn link_pose(&self, link: u32) -> Pose {
        let along = (self.end - self.start).normalize_or(Vec3::Y);
        let fraction = (link as f32 + 0.5) / self.links() as f32;
        Pose::new(
            self.start.lerp(self.end, fraction),
            Quat::from_rotation_arc(Vec3::Y, along),
        )
    }

    /// The least number of links that reach from start to end; together they may be half a link short.
    pub fn least_links(&self) -> u32 {
        (self.start.distance(self.end) / self.link_span.y - 0.5).ceil() as u32
    }
}

/// A box whose lid slides open towards its -X (report section 6.2, `<lidbox>`). Lengths in units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Reflect)]
pub struct LidBoxSpec {
    /// Prefix of the ids of box and lid; empty for any.
    pub id: String,
    /// Pose of the centre of the box; the lid lies on top of it.
    pub pose: Pose,
    /// Outer extents of the box without lid.
    pub span: Vec3,
    /// Thickness of floor, walls and lid.
    pub thickness: f32,
    /// Mass of the box in kg.
    pub box_mass: f32,
    /// Mass of the lid in kg.
    pub lid_mass: f32,
    /// Colour of box and lid.
    pub color: Rgb,
    /// Outer extents of the handle.
    pub handle_span: Vec3,
    /// Thickness of the handle's walls.
    pub handle_thickness: f32,
    /// Colour of the handle.
    pub handle_color: Rgb,
    /// Symbolic properties for recordings.
    pub descriptions: Vec<(String, String)>,
}

impl LidBoxSpec {
    /// The shape of the box, without its lid.
    pub const fn container(&self) -> Shape {
        Shape::Box {
            span: self.span,
            thickness: self.thickness,
            color: self.color,
        }
    }

    /// The shape of the lid.
    pub const fn lid(&self) -> Shape {
        Shape::Lid {
            span: Vec3::new(self.span.x, self.span.y, self.thickness),
            color: self.color,
            handle_span: self.handle_span,
            handle_thickness: self.handle_thickness,
            handle_color: self.handle_color,
        }
    }
}

impl SceneItem {
    /// Its bounds on the table; rough for a chain.
    pub fn bounds(&self) -> Bounds {
        match self {
            Self::Object(object) => object.shape.bounds(object.pose),
            Self::Chain(chain) => chain.bounds(),
            Self::LidBox(lidbox) => lidbox.bounds(),
            Self::Jointed(jointed) => {
                let [first, second] = jointed
                    .placed()
                    .map(|object| object.shape.bounds(object.pose));
                first.union(second)
            }
        }
    }
}

impl ChainSpec {
    fn bounds(&self) -> Bounds {
        let reach = self.link_span.max_element();
        Bounds::around(self.start, Vec3::splat(reach))
            .union(Bounds::around(self.end, Vec3::splat(reach)))
    }
}

impl LidBoxSpec {
    fn bounds(&self) -> Bounds {
        let top = self.thickness + self.handle_span.z;
        let center = self.pose * Pose::at(Vec3::Z * top / 2.0);
        Bounds::of_cuboid(self.span + Vec3::Z * top, center)
    }
}
