//! Links and their shapes.

use glam::{DAffine3, DMat3, DVec3};

use crate::ModelJointId;

/// A rigid part of a robot.
#[derive(Clone, Debug)]
pub struct Link {
    /// Its name, unique among links.
    pub name: String,
    /// The line of the description in which it starts, from 1.
    pub line: usize,
    /// The joint that carries it; `None` for the root.
    pub joint: Option<ModelJointId>,
    /// Its mass and inertia.
    pub inertial: Inertial,
    /// Its visible shapes.
    pub visuals: Vec<LinkShape>,
    /// Its collision shapes.
    pub collisions: Vec<LinkShape>,
}

/// A mass and its distribution, in the frame of its link. A link that is a mere frame has no mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inertial {
    /// Mass in kg.
    pub mass: f64,
    /// Centre of mass in m.
    pub center: DVec3,
    /// Moments of inertia about the centre of mass, along the link's axes, in kg m².
    pub inertia: DMat3,
}

/// A body in the frame of its link.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkShape {
    /// From the body's own frame to the link's, in m.
    pub origin: DAffine3,
    /// The body's geometry.
    pub geometry: Geometry,
    /// Red, green, blue and opacity, 0 to 1; `None` where the description names no colour, as for collisions.
    pub color: Option<[f64; 4]>,
}

/// A body about the origin of its own frame. Lengths in m.
#[derive(Clone, Debug, PartialEq)]
pub enum Geometry {
    /// A box.
    Box {
        /// Its whole lengths along x, y and z.
        size: DVec3,
    },
    /// A cylinder along z.
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Its whole length.
        length: f64,
    },
    /// A ball.
    Sphere {
        /// Its radius.
        radius: f64,
    },
    /// A mesh in a file of its own.
    Mesh {
        /// The file, as the description names it: `package://tabletop/wrist.shape.json`.
        file: String,
        /// Factors along x, y and z.
        scale: DVec3,
    },
}
