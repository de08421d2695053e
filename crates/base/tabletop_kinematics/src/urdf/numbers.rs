//! The numbers of an element.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::{Geometry, Inertial, LinkShape, ModelError, turn::from_roll_pitch_yaw};

/// The largest length, in m.
const LONGEST: f64 = 1000.0;

/// The largest scale of a mesh: from μm to m.
const LARGEST_SCALE: f64 = 1e6;

/// The largest mass, in kg.
const HEAVIEST: f64 = 1e6;

/// The mass, in kg, up to which an inertia that no body has is none: makers write anything for the links of sensors.
const LIGHTEST: f64 = 1e-3;

/// The largest moment of inertia, in kg m²; beyond, products of three are not finite.
const MOST_INERTIA: f64 = 1e12;

/// Reads the numbers of an element.
pub(super) struct Numbers {
    pub line: usize,
    pub element: String,
}

impl Numbers {
    pub fn fault(&self, fault: &'static str) -> ModelError {
        ModelError::Number {
            line: self.line,
            element: self.element.clone(),
            fault,
        }
    }

    pub fn vector(&self, numbers: [f64; 3], fault: &'static str) -> Result<DVec3, ModelError> {
        let vector = DVec3::from_array(numbers);
        match vector.is_finite() {
            true => Ok(vector),
            false => Err(self.fault(fault)),
        }
    }

    /// A place, in m.
    fn place(&self, numbers: [f64; 3]) -> Result<DVec3, ModelError> {
        let place = self.vector(numbers, "an xyz is not finite")?;
        match place.abs().max_element() <= LONGEST {
            true => Ok(place),
            false => Err(self.fault("an xyz is over 1000 m away")),
        }
    }

    /// A number from 0 to infinity.
    pub fn amount(&self, number: f64, fault: &'static str) -> Result<f64, ModelError> {
        match number >= 0.0 {
            true => Ok(number),
            false => Err(self.fault(fault)),
        }
    }

    /// A length from 0 up, in m.
    fn length(&self, number: f64) -> Result<f64, ModelError> {
        match number {
            0.0..=LONGEST => Ok(number.abs()),
            LONGEST.. => Err(self.fault("a length is over 1000 m")),
            _ => Err(self.fault("a length is negative or not finite")),
        }
    }

    fn scale(&self, numbers: [f64; 3]) -> Result<DVec3, ModelError> {
        let scale = self.vector(numbers, "a mesh's scale is not finite")?;
        match scale.abs().max_element() <= LARGEST_SCALE {
            true => Ok(scale),
            false => Err(self.fault("a mesh's scale is over 1,000,000")),
        }
    }

    fn rotation(&self, rpy: [f64; 3]) -> Result<DQuat, ModelError> {
        let DVec3 { x, y, z } = self.vector(rpy, "an rpy is not finite")?;
        Ok(from_roll_pitch_yaw(x, y, z))
    }

    pub fn pose(&self, pose: &urdf_rs::Pose) -> Result<DAffine3, ModelError> {
        Ok(DAffine3::from_rotation_translation(
            self.rotation(*pose.rpy)?,
            self.place(*pose.xyz)?,
        ))
    }

    pub fn inertial(&self, inertial: &urdf_rs::Inertial) -> Result<Inertial, ModelError> {
        let mass = inertial.mass.value;
        if !(mass >= 0.0 && mass.is_finite()) {
            return Err(self.fault("its mass is negative or not finite"));
        }
        if mass > HEAVIEST {
            return Err(self.fault("its mass is over 1,000,000 kg"));
        }
        let i = &inertial.inertia;
        let fault = "its inertia is negative or not finite; correct its <inertia>, or remove its <inertial>";
        let moments = self.vector([i.ixx, i.iyy, i.izz], fault)?;
        let products = self.vector([i.ixy, i.ixz, i.iyz], fault)?;
        if moments.min_element() < 0.0 {
            return Err(self.fault(fault));
        }
        let is_real = is_of_a_body(moments, products);
        if !is_real && mass > LIGHTEST {
            return Err(self.fault("no body has its inertia: a principal moment is negative; correct its <inertia>, or remove its <inertial>"));
        }
        let own = match is_real {
            true => DMat3::from_cols_array_2d(&[
                [i.ixx, i.ixy, i.ixz],
                [i.ixy, i.iyy, i.iyz],
                [i.ixz, i.iyz, i.izz],
            ]),
            false => DMat3::ZERO,
        };
        let origin = self.pose(&inertial.origin)?;
        Ok(Inertial {
            mass,
            center: origin.translation,
            inertia: origin.matrix3 * own * origin.matrix3.transpose(),
        })
    }

    /// The bodies of a shape: a capsule is a cylinder with a ball at each end.
    pub fn shapes(
        &self,
        origin: &urdf_rs::Pose,
        geometry: &urdf_rs::Geometry,
        color: Option<&urdf_rs::Color>,
    ) -> Result<Vec<LinkShape>, ModelError> {
        let origin = self.pose(origin)?;
        let at = |height: f64, geometry| LinkShape {
            origin: origin * DAffine3::from_translation(DVec3::Z * height),
            geometry,
            color: color.map(|color| *color.rgba),
        };
        let whole = |geometry| vec![at(0.0, geometry)];
        Ok(match geometry {
            urdf_rs::Geometry::Box { size } => whole(Geometry::Box {
                size: DVec3::new(
                    self.length(size[0])?,
                    self.length(size[1])?,
                    self.length(size[2])?,
                ),
            }),
            urdf_rs::Geometry::Cylinder { radius, length } => whole(Geometry::Cylinder {
                radius: self.length(*radius)?,
                length: self.length(*length)?,
            }),
            urdf_rs::Geometry::Sphere { radius } => whole(Geometry::Sphere {
                radius: self.length(*radius)?,
            }),
            urdf_rs::Geometry::Mesh { filename, scale } => whole(Geometry::Mesh {
                file: filename.clone(),
                scale: match scale {
                    Some(scale) => self.scale(**scale)?,
                    None => DVec3::ONE,
                },
            }),
            urdf_rs::Geometry::Capsule { radius, length } => {
                let (radius, length) = (self.length(*radius)?, self.length(*length)?);
                vec![
                    at(0.0, Geometry::Cylinder { radius, length }),
                    at(-length / 2.0, Geometry::Sphere { radius }),
                    at(length / 2.0, Geometry::Sphere { radius }),
                ]
            }
        })
    }
}

/// True if no principal moment is negative, apart from rounding errors.
fn is_of_a_body(moments: DVec3, products: DVec3) -> bool {
    let scale = moments.max_element();
    if scale > MOST_INERTIA {
        return false;
    }
    if scale == 0.0 {
        return products == DVec3::ZERO;
    }
    let (
        DVec3 {
            x: xx,
            y: yy,
            z: zz,
        },
        DVec3 {
            x: xy,
            y: xz,
            z: yz,
        },
    ) = (moments / scale, products / scale);
    let minors = [xx * yy - xy * xy, xx * zz - xz * xz, yy * zz - yz * yz];
    let determinant = xx * minors[2] - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    minors
        .iter()
        .chain([&determinant])
        .all(|&minor| minor >= -1e-9)
}
