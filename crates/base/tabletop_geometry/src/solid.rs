//! Solids, of which every shape consists.

use bevy::prelude::*;

use crate::{Bounds, Polyhedron, Pose, Rgb};

/// A solid: every shape consists of these in the end.
#[derive(Clone, Debug, PartialEq)]
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
    /// A polyhedron. It is convex, except where only its look counts, as that of a ring's or mesh's surface.
    Polyhedron(Polyhedron),
}

/// One solid of a shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Primitive {
    /// Pose of its centre in the frame of the shape.
    pub pose: Pose,
    /// The solid.
    pub solid: Solid,
    /// Its colour.
    pub color: Rgb,
}

impl Solid {
    /// Volume in cubic units.
    pub fn volume(&self) -> f32 {
        use std::f32::consts::PI;
        match *self {
            Self::Cuboid(span) => span.element_product(),
            Self::Cylinder { radius, yspan } => PI * radius * radius * yspan,
            Self::Ball(radius) => 4.0 / 3.0 * PI * radius * radius * radius,
            Self::Polyhedron(ref polyhedron) => polyhedron.volume(),
        }
    }
}

impl Bounds {
    /// The bounds of a solid; the origin of its shape is at the given pose.
    pub fn of_primitive(part: &Primitive, at: Pose) -> Self {
        let at = at * part.pose;
        match part.solid {
            Solid::Cuboid(span) => Self::of_cuboid(span, at),
            Solid::Ball(radius) => Self::around(at.location, Vec3::splat(radius)),
            Solid::Cylinder { radius, yspan } => {
                let axis = at.rotation * Vec3::Y;
                let across = (Vec3::ONE - axis * axis).max(Vec3::ZERO).map(f32::sqrt);
                Self::around(at.location, axis.abs() * yspan / 2.0 + across * radius)
            }
            Solid::Polyhedron(ref polyhedron) => Self::of_polyhedron(polyhedron, at),
        }
    }

    /// The bounds of a cuboid of these full extents at a pose.
    pub fn of_cuboid(span: Vec3, at: Pose) -> Self {
        let half = span / 2.0;
        let reach = Mat3::from_quat(at.rotation).abs() * half;
        Self::around(at.location, reach)
    }
}
