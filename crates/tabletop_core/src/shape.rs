//! What an object looks like and collides as: the one description of geometry.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{
    BondEnd, BondPoint, Control, ControlKind, MOST_SIDES, MeshSpec, Polyhedron, Pose, Rgb,
    turn_about,
};

/// The shape of an object or of a part of one (report section 6.2). Sizes are full extents in units of 10 cm;
/// the shape's origin is its centre, for a composite its reference point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Reflect)]
#[reflect(opaque)]
pub enum Shape {
    /// A solid cuboid.
    Block {
        /// Extents along X, Y, Z.
        span: Vec3,
        /// Its colour.
        color: Rgb,
    },
    /// A solid circular cylinder along Y.
    Cylinder {
        /// Radius.
        radius: f32,
        /// Length.
        yspan: f32,
        /// Its colour.
        color: Rgb,
    },
    /// A solid ball.
    Sphere {
        /// Radius.
        radius: f32,
        /// Its colour.
        color: Rgb,
    },
    /// A cuboid container, open towards +Z.
    Box {
        /// Outer extents along X, Y, Z.
        span: Vec3,
        /// Thickness of floor and walls.
        thickness: f32,
        /// Its colour.
        color: Rgb,
    },
    /// A cylinder along Y with flat sides; its first corner is towards X.
    Prism {
        /// Radius of the corners.
        radius: f32,
        /// Length.
        yspan: f32,
        /// How many flat sides, 3 or more.
        sides: u32,
        /// Its colour.
        color: Rgb,
    },
    /// A prism, or a part of a pyramid, along Z; its first corner is towards X.
    Frustum {
        /// Radius of the corners of its end towards +Z.
        radius_top: f32,
        /// Radius of the corners of its end towards -Z.
        radius_bottom: f32,
        /// Length.
        zspan: f32,
        /// How many flat sides, 3 or more.
        sides: u32,
        /// Its colour.
        color: Rgb,
    },
    /// A ring about Z.
    Ring {
        /// Radius of its outer corners; the first one is towards X.
        radius_outer: f32,
        /// Radius of its hole.
        radius_inner: f32,
        /// Height.
        zspan: f32,
        /// How many flat sides, 3 or more.
        sides: u32,
        /// Its colour.
        color: Rgb,
    },
    /// What a file describes by triangles.
    Mesh {
        /// Its surface, and the solids that fill it.
        mesh: MeshSpec,
        /// Its colour.
        color: Rgb,
    },
    /// Several shapes as one rigid body.
    Composite {
        /// The shapes, which may overlap.
        parts: Vec<Part>,
    },
    /// A link of a chain: a block that is drawn longer than it collides, to cover the gaps at its joints.
    Link {
        /// Extents of the colliding block; Y is along the chain.
        span: Vec3,
        /// Length added to the drawn block at both ends along Y.
        padding: f32,
        /// Its colour.
        color: Rgb,
    },
    /// The lid of a lid box: a plate with a box as its handle on top.
    Lid {
        /// Extents of the plate, whose centre is the lid's origin.
        span: Vec3,
        /// Colour of the plate.
        color: Rgb,
        /// Outer extents of the handle.
        handle_span: Vec3,
        /// Thickness of the handle's walls.
        handle_thickness: f32,
        /// Colour of the handle.
        handle_color: Rgb,
    },
    /// A switch, lights, or shapes with states.
    Control(Box<Control>),
    /// A point at which a composite is fastened to another one. It has no extents.
    BondPoint(Box<BondPoint>),
}

/// A shape as a part of a composite.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// The part's id as the task file has it; empty if it has none. Need not be unique.
    pub id: String,
    /// Its pose in the frame of the composite that it is a direct part of.
    pub pose: Pose,
    /// Its shape.
    pub shape: Shape,
    /// Whether the demonstrator can point to it. Its id is then unique on the table.
    #[serde(default)]
    pub pointable: bool,
}

impl Part {
    /// A part that cannot be pointed to.
    pub fn new(id: impl Into<String>, pose: Pose, shape: Shape) -> Self {
        Self {
            id: id.into(),
            pose,
            shape,
            pointable: false,
        }
    }
}

/// A solid: what every shape is made of in the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solid {
    /// A cuboid of these full extents.
    Cuboid(Vec3),
    /// A cylinder along Y.
    Cylinder {
        /// Radius.
        radius: f32,
        /// Length.
        yspan: f32,
    },
    /// A ball of this radius.
    Ball(f32),
    /// A polyhedron, which is convex but for the surfaces of rings and meshes that [are drawn](Shape::drawn).
    Polyhedron(Polyhedron),
}

/// One solid of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primitive {
    /// Pose of its centre in the frame of the shape.
    pub pose: Pose,
    /// The solid.
    pub solid: Solid,
    /// Its colour.
    pub color: Rgb,
}

impl Shape {
    /// The element name of this shape in a task file, or the name that recordings give it.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Block { .. } | Self::Link { .. } => "block",
            Self::Cylinder { .. } | Self::Prism { .. } => "cylinder",
            Self::Sphere { .. } => "sphere",
            Self::Box { .. } => "box",
            Self::Frustum { .. } => "frustum",
            Self::Ring { .. } => "ring",
            Self::Mesh { .. } => "custom",
            Self::Composite { .. } => "composite",
            Self::Lid { .. } => "lid",
            Self::Control(control) => match control.kind {
                ControlKind::ToggleSwitch(_) => "toggleSwitch",
                ControlKind::IndicatorLights(_) => "indicatorLights",
                ControlKind::Custom(_) => "customControl",
            },
            Self::BondPoint(point) => match point.end {
                BondEnd::Guest(_) => "guestBondPoint",
                BondEnd::Host(_) => "hostBondPoint",
            },
        }
    }

    /// The simple shapes that are to be seen of it, in the order of the task file, each with its pose in the frame of this shape:
    /// all but composites and lids.
    pub fn simple_parts(&self) -> Vec<Part> {
        self.simple_parts_with(Control::seen)
    }

    /// The simple shapes that can be touched, of which some may not be seen.
    pub(crate) fn simple_touched(&self) -> Vec<Part> {
        self.simple_parts_with(Control::touched)
    }

    fn simple_parts_with(&self, of_control: fn(&Control) -> Vec<Part>) -> Vec<Part> {
        fn collect(
            id: &str,
            pose: Pose,
            shape: &Shape,
            of_control: fn(&Control) -> Vec<Part>,
            simple: &mut Vec<Part>,
        ) {
            let mut add = |pose, shape| simple.push(Part::new(id, pose, shape));
            match *shape {
                Shape::Composite { ref parts } => {
                    for part in parts {
                        let pose = pose * part.pose;
                        collect(&part.id, pose, &part.shape, of_control, simple);
                    }
                }
                Shape::Control(ref control) => {
                    for part in of_control(control) {
                        let pose = pose * part.pose;
                        collect(&part.id, pose, &part.shape, of_control, simple);
                    }
                }
                Shape::BondPoint(_) => {}
                Shape::Lid {
                    span,
                    color,
                    handle_span,
                    handle_thickness,
                    handle_color,
                } => {
                    let on_top = Pose::at(Vec3::Z * (span.z + handle_span.z) / 2.0);
                    let handle = Shape::Box {
                        span: handle_span,
                        thickness: handle_thickness,
                        color: handle_color,
                    };
                    add(pose, Shape::Block { span, color });
                    add(pose * on_top, handle);
                }
                Shape::Block { .. }
                | Shape::Cylinder { .. }
                | Shape::Sphere { .. }
                | Shape::Box { .. }
                | Shape::Prism { .. }
                | Shape::Frustum { .. }
                | Shape::Ring { .. }
                | Shape::Mesh { .. }
                | Shape::Link { .. } => add(pose, shape.clone()),
            }
        }
        let mut simple = Vec::new();
        collect("", Pose::IDENTITY, self, of_control, &mut simple);
        simple
    }

    /// Gives everything but controls this colour.
    pub fn paint(&mut self, new: Rgb) {
        match self {
            Self::Block { color, .. }
            | Self::Cylinder { color, .. }
            | Self::Sphere { color, .. }
            | Self::Box { color, .. }
            | Self::Prism { color, .. }
            | Self::Frustum { color, .. }
            | Self::Ring { color, .. }
            | Self::Mesh { color, .. }
            | Self::Link { color, .. } => *color = new,
            Self::Lid {
                color,
                handle_color,
                ..
            } => {
                *color = new;
                *handle_color = new;
            }
            Self::Composite { parts } => parts.iter_mut().for_each(|part| part.shape.paint(new)),
            Self::Control(_) | Self::BondPoint(_) => {}
        }
    }

    /// The solids to be drawn. Rings and meshes are polyhedra that are not convex.
    pub fn drawn(&self) -> Vec<Primitive> {
        primitives(self.simple_parts(), Purpose::Drawing)
    }

    /// Convex solids that fill what is drawn; a mesh nearly.
    pub fn filled(&self) -> Vec<Primitive> {
        primitives(self.simple_parts(), Purpose::Filling)
    }

    /// The convex solids that other bodies touch.
    pub fn colliding(&self) -> Vec<Primitive> {
        primitives(self.simple_touched(), Purpose::Colliding)
    }
}

/// What solids of a shape are for.
#[derive(Clone, Copy)]
enum Purpose {
    Drawing,
    Filling,
    Colliding,
}

fn primitives(simple_parts: Vec<Part>, purpose: Purpose) -> Vec<Primitive> {
    let mut primitives = Vec::new();
    for part in simple_parts {
        let mut add = |pose: Pose, solid, color| {
            primitives.push(Primitive {
                pose: part.pose * pose,
                solid,
                color,
            });
        };
        let center = Pose::IDENTITY;
        match part.shape {
            Shape::Block { span, color } => add(center, Solid::Cuboid(span), color),
            Shape::Cylinder {
                radius,
                yspan,
                color,
            } => add(center, Solid::Cylinder { radius, yspan }, color),
            Shape::Sphere { radius, color } => add(center, Solid::Ball(radius), color),
            Shape::Box {
                span,
                thickness,
                color,
            } => {
                for (center, span) in box_plates(span, thickness) {
                    add(Pose::at(center), Solid::Cuboid(span), color);
                }
            }
            Shape::Prism {
                radius,
                yspan,
                sides,
                color,
            } => {
                let prism = Polyhedron::prism(radius, yspan, sides);
                add(center, Solid::Polyhedron(prism), color);
            }
            Shape::Frustum {
                radius_top,
                radius_bottom,
                zspan,
                sides,
                color,
            } => {
                let frustum = Polyhedron::frustum(radius_top, radius_bottom, zspan, sides);
                add(center, Solid::Polyhedron(frustum), color);
            }
            Shape::Ring {
                radius_outer,
                radius_inner,
                zspan,
                sides,
                color,
            } => match purpose {
                Purpose::Drawing => {
                    let ring = Polyhedron::ring(radius_outer, radius_inner, zspan, sides);
                    add(center, Solid::Polyhedron(ring), color);
                }
                Purpose::Filling | Purpose::Colliding => {
                    let sides = sides.clamp(3, MOST_SIDES);
                    let wedge = Polyhedron::wedge(radius_outer, radius_inner, zspan, sides);
                    for side in 0..sides {
                        let angle = std::f32::consts::TAU * side as f32 / sides as f32;
                        let pose = Pose::new(Vec3::ZERO, turn_about(Vec3::Z, angle));
                        add(pose, Solid::Polyhedron(wedge), color);
                    }
                }
            },
            Shape::Mesh { ref mesh, color } => match purpose {
                Purpose::Drawing => add(center, Solid::Polyhedron(mesh.surface()), color),
                Purpose::Filling | Purpose::Colliding => {
                    for &solid in mesh.solids() {
                        add(center, Solid::Polyhedron(solid), color);
                    }
                }
            },
            Shape::Link {
                span,
                padding,
                color,
            } => {
                let ends = match purpose {
                    Purpose::Drawing | Purpose::Filling => Vec3::Y * 2.0 * padding,
                    Purpose::Colliding => Vec3::ZERO,
                };
                add(center, Solid::Cuboid(span + ends), color);
            }
            Shape::Composite { .. }
            | Shape::Lid { .. }
            | Shape::Control(_)
            | Shape::BondPoint(_) => {}
        }
    }
    primitives
}
impl Solid {
    /// Volume in cubic units.
    pub fn volume(self) -> f32 {
        use std::f32::consts::PI;
        match self {
            Self::Cuboid(span) => span.element_product(),
            Self::Cylinder { radius, yspan } => PI * radius * radius * yspan,
            Self::Ball(radius) => 4.0 / 3.0 * PI * radius * radius * radius,
            Self::Polyhedron(polyhedron) => polyhedron.volume(),
        }
    }
}

/// Floor and four walls of an open box, as centre and extents.
fn box_plates(span: Vec3, thickness: f32) -> [(Vec3, Vec3); 5] {
    let t = thickness;
    let wall_height = span.z - t;
    let wall_z = t / 2.0;
    let side = Vec3::new(t, span.y - 2.0 * t, wall_height);
    let side_x = (span.x - t) / 2.0;
    let end = Vec3::new(span.x, t, wall_height);
    let end_y = (span.y - t) / 2.0;
    [
        (
            Vec3::new(0.0, 0.0, (t - span.z) / 2.0),
            Vec3::new(span.x, span.y, t),
        ),
        (Vec3::new(-side_x, 0.0, wall_z), side),
        (Vec3::new(side_x, 0.0, wall_z), side),
        (Vec3::new(0.0, -end_y, wall_z), end),
        (Vec3::new(0.0, end_y, wall_z), end),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plates_of_a_box_fill_its_walls_exactly() {
        let (span, thickness) = (Vec3::new(5.0, 4.0, 3.0), 0.2);
        let volume: f32 = Shape::Box {
            span,
            thickness,
            color: Rgb::GRAY,
        }
        .colliding()
        .iter()
        .map(|plate| plate.solid.volume())
        .sum();
        let hollow = (span.x - 0.4) * (span.y - 0.4) * (span.z - 0.2);
        assert!((volume - (span.element_product() - hollow)).abs() < 1e-4);
    }

    #[test]
    fn poses_of_nested_parts_compose() {
        let block = Shape::Block {
            span: Vec3::ONE,
            color: Rgb::GRAY,
        };
        let inner = Shape::Composite {
            parts: vec![Part {
                pointable: false,
                id: "inner".into(),
                pose: Pose::at(Vec3::X),
                shape: block,
            }],
        };
        let shape = Shape::Composite {
            parts: vec![Part {
                id: String::new(),
                pose: Pose::from_degrees(Vec3::Z, Vec3::new(0.0, 0.0, 90.0)),
                shape: inner,
                pointable: false,
            }],
        };
        let [part] = &shape.simple_parts()[..] else {
            panic!("{:?}", shape.simple_parts());
        };
        assert_eq!(part.id, "inner");
        assert!((part.pose.location - Vec3::new(0.0, 1.0, 1.0)).length() < 1e-6);
    }

    #[test]
    fn a_ring_is_drawn_as_one_and_collides_as_convex_wedges() {
        let ring = Shape::Ring {
            radius_outer: 1.0,
            radius_inner: 0.5,
            zspan: 0.4,
            sides: 16,
            color: Rgb::GRAY,
        };
        assert_eq!(ring.drawn().len(), 1);
        assert_eq!(ring.filled(), ring.colliding());
        let wedges = ring.colliding();
        assert_eq!(wedges.len(), 16);
        let volume: f32 = wedges.iter().map(|wedge| wedge.solid.volume()).sum();
        assert!((volume / ring.drawn()[0].solid.volume() - 1.0).abs() < 1e-4);
        let axis = Ray3d::new(Vec3::Z * 5.0, Dir3::NEG_Z);
        assert!(
            ring.drawn()
                .iter()
                .all(|solid| solid.distance_along(axis, Pose::IDENTITY).is_none())
        );
    }

    #[test]
    fn a_link_is_drawn_longer_than_it_collides() {
        let link = Shape::Link {
            span: Vec3::new(0.1, 1.0, 0.1),
            padding: 0.05,
            color: Rgb::GRAY,
        };
        assert_eq!(
            link.drawn()[0].solid,
            Solid::Cuboid(Vec3::new(0.1, 1.1, 0.1))
        );
        assert_eq!(
            link.colliding()[0].solid,
            Solid::Cuboid(Vec3::new(0.1, 1.0, 0.1))
        );
    }
}
