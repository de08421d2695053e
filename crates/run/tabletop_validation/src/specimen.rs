//! Specimens: the objects of experiments.

use bevy::math::{DQuat, DVec3, Quat, Vec3};
use tabletop_core::{ObjectSpec, Shape};
use tabletop_geometry::{Pose, Rgb};

/// An object of an experiment, and its angular velocity at first, in rad/s.
#[derive(Clone)]
pub(crate) struct Specimen {
    pub spec: ObjectSpec,
    pub spin: Vec3,
}

/// Objects of 1 kg at rest at the origin, of the world's friction and restitution.
impl Specimen {
    pub fn new(id: impl Into<String>, shape: Shape) -> Self {
        Self {
            spec: ObjectSpec::new(id, Pose::IDENTITY, 1.0, shape),
            spin: Vec3::ZERO,
        }
    }

    pub fn block(id: impl Into<String>, span: impl Into<Vec3>) -> Self {
        Self::new(
            id,
            Shape::Block {
                span: span.into(),
                color: Rgb::GRAY,
            },
        )
    }

    /// A cube of 1 unit.
    pub fn cube(id: impl Into<String>) -> Self {
        Self::block(id, Vec3::ONE)
    }

    pub fn ball(id: impl Into<String>, radius: f32) -> Self {
        Self::new(
            id,
            Shape::Sphere {
                radius,
                color: Rgb::GRAY,
            },
        )
    }

    /// A cylinder that lies along Y.
    pub fn cylinder(id: impl Into<String>, radius: f32, yspan: f32) -> Self {
        Self::new(
            id,
            Shape::Cylinder {
                radius,
                yspan,
                color: Rgb::GRAY,
            },
        )
    }

    pub fn at(mut self, location: impl Into<Vec3>) -> Self {
        self.spec.pose.location = location.into();
        self
    }

    pub fn turned(mut self, rotation: Quat) -> Self {
        self.spec.pose.rotation = rotation;
        self
    }

    pub fn posed(mut self, pose: Pose) -> Self {
        self.spec.pose = pose;
        self
    }

    pub fn weighing(mut self, kilograms: f32) -> Self {
        self.spec.mass = kilograms;
        self
    }

    pub fn fixed(self) -> Self {
        self.weighing(0.0)
    }

    pub fn moving(mut self, velocity: impl Into<Vec3>) -> Self {
        self.spec.dynamics.velocity = velocity.into();
        self
    }

    pub fn spinning(mut self, spin: impl Into<Vec3>) -> Self {
        self.spin = spin.into();
        self
    }

    pub fn rough(mut self, friction: f32) -> Self {
        self.spec.dynamics.friction = Some(friction);
        self
    }

    pub fn elastic(mut self, restitution: f32) -> Self {
        self.spec.dynamics.restitution = Some(restitution);
        self
    }

    /// Its mass in kg.
    pub fn mass(&self) -> f64 {
        f64::from(self.spec.mass)
    }

    /// Its moments of inertia about its own axes, in kg units², by the textbook.
    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "only the energy of simple shapes is measured"
    )]
    pub fn inertia(&self) -> DVec3 {
        let per_kilogram = match self.spec.shape {
            Shape::Block { span, .. } => {
                let square = span.as_dvec3() * span.as_dvec3();
                (DVec3::splat(square.element_sum()) - square) / 12.0
            }
            Shape::Sphere { radius, .. } => DVec3::splat(0.4 * f64::from(radius).powi(2)),
            Shape::Cylinder { radius, yspan, .. } => {
                let [radius, length] = [radius, yspan].map(f64::from);
                let across = radius * radius / 4.0 + length * length / 12.0;
                DVec3::new(across, radius * radius / 2.0, across)
            }
            _ => DVec3::NAN,
        };
        per_kilogram * self.mass()
    }

    /// Its angular momentum when it is turned so and has this angular velocity.
    pub fn angular_momentum(&self, rotation: DQuat, spin: DVec3) -> DVec3 {
        rotation * (self.inertia() * (rotation.inverse() * spin))
    }
}
