//! The solids of which a shape consists.

use bevy::prelude::*;
use tabletop_geometry::{Bounds, MOST_SIDES, Polyhedron, Pose, Primitive, Solid, turn_about};

use crate::{Part, Shape};

impl Shape {
    /// The solids to draw. Those of rings and meshes are polyhedra that are not convex.
    pub fn drawn(&self) -> Vec<Primitive> {
        primitives(self.simple_parts(), SolidPurpose::Drawing)
    }

    /// Convex solids that fill the drawn shape, for a mesh approximately.
    pub fn filled(&self) -> Vec<Primitive> {
        primitives(self.simple_parts(), SolidPurpose::Filling)
    }

    /// The convex solids that other bodies touch.
    pub fn colliding(&self) -> Vec<Primitive> {
        primitives(self.simple_touched(), SolidPurpose::Colliding)
    }

    /// The bounds of the solids that other bodies touch, if the shape's origin is at this pose.
    pub fn bounds(&self, at: Pose) -> Bounds {
        self.colliding()
            .iter()
            .map(|part| Bounds::of_primitive(part, at))
            .reduce(Bounds::union)
            .unwrap_or(Bounds::around(at.location, Vec3::ZERO))
    }
}

/// The purpose of a shape's solids.
#[derive(Clone, Copy)]
enum SolidPurpose {
    Drawing,
    Filling,
    Colliding,
}

fn primitives(simple_parts: Vec<Part>, purpose: SolidPurpose) -> Vec<Primitive> {
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
                SolidPurpose::Drawing => {
                    let ring = Polyhedron::ring(radius_outer, radius_inner, zspan, sides);
                    add(center, Solid::Polyhedron(ring), color);
                }
                SolidPurpose::Filling | SolidPurpose::Colliding => {
                    let sides = sides.clamp(3, MOST_SIDES);
                    let wedge = Polyhedron::wedge(radius_outer, radius_inner, zspan, sides);
                    for side in 0..sides {
                        let angle = std::f32::consts::TAU * side as f32 / sides as f32;
                        let pose = Pose::new(Vec3::ZERO, turn_about(Vec3::Z, angle));
                        add(pose, Solid::Polyhedron(wedge.clone()), color);
                    }
                }
            },
            Shape::Mesh { ref mesh, color } => match purpose {
                SolidPurpose::Drawing => {
                    add(center, Solid::Polyhedron(mesh.surface().clone()), color);
                }
                SolidPurpose::Filling | SolidPurpose::Colliding => {
                    for solid in mesh.solids() {
                        add(center, Solid::Polyhedron(solid.clone()), color);
                    }
                }
            },
            Shape::Link {
                span,
                padding,
                color,
            } => {
                let ends = match purpose {
                    SolidPurpose::Drawing | SolidPurpose::Filling => Vec3::Y * 2.0 * padding,
                    SolidPurpose::Colliding => Vec3::ZERO,
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
    use std::f32::consts::SQRT_2;

    use super::*;
    use tabletop_geometry::Rgb;

    #[test]
    fn turned_solids_reach_as_far_as_they_do() {
        let turned = Pose::from_degrees(Vec3::X, Vec3::new(0.0, 0.0, 45.0));
        let color = Rgb::GRAY;
        let block = Shape::Block {
            span: Vec3::new(1.0, 1.0, 2.0),
            color,
        };
        let cylinder = Shape::Cylinder {
            radius: 1.0,
            yspan: 2.0,
            color,
        };
        let ball = Shape::Sphere { radius: 0.5, color };
        for (shape, reach) in [
            (block, Vec3::new(SQRT_2 / 2.0, SQRT_2 / 2.0, 1.0)),
            (cylinder, Vec3::new(SQRT_2, SQRT_2, 1.0)),
            (ball, Vec3::splat(0.5)),
        ] {
            let bounds = shape.bounds(turned);
            assert!(
                (bounds.low - (Vec3::X - reach)).length() < 1e-5,
                "{bounds:?}"
            );
            assert!(
                (bounds.high - (Vec3::X + reach)).length() < 1e-5,
                "{bounds:?}"
            );
        }
    }

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
