//! The parts of objects that do something or can be spoken of: controls, bond points, and what can be pointed to.

use crate::{BondEnd, BondPoint, Control, GuestPoint, HostPoint, ObjectSpec, Part, Pose, Shape};

/// A part of an object with an id of its own, or the whole object.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a, T> {
    /// Its id.
    pub id: &'a str,
    /// Its pose in the frame of the object.
    pub pose: Pose,
    /// What it is.
    pub what: &'a T,
}

impl ObjectSpec {
    /// The object's controls: itself, or parts of it.
    pub fn controls(&self) -> Vec<Placed<'_, Control>> {
        let mut controls = Vec::new();
        self.visit(&mut |id, pose, shape| {
            if let Shape::Control(control) = shape {
                controls.push(Placed {
                    id,
                    pose,
                    what: &**control,
                });
            }
        });
        controls
    }

    /// The control of an id.
    pub fn control(&self, id: &str) -> Option<&Control> {
        let mut controls = self.controls().into_iter();
        controls
            .find(|control| control.id == id)
            .map(|control| control.what)
    }

    /// The control of an id, to be changed.
    pub fn control_mut(&mut self, id: &str) -> Option<&mut Control> {
        match &mut self.shape {
            Shape::Control(control) if self.id == id => Some(control),
            Shape::Composite { parts } => control_among(parts, id),
            Shape::Control(_)
            | Shape::Block { .. }
            | Shape::Cylinder { .. }
            | Shape::Sphere { .. }
            | Shape::Box { .. }
            | Shape::Link { .. }
            | Shape::Lid { .. }
            | Shape::BondPoint(_) => None,
        }
    }

    /// The points at which it is fastened to others.
    pub fn guest_points(&self) -> Vec<(Placed<'_, BondPoint>, &GuestPoint)> {
        let points = self.bond_points().into_iter();
        points
            .filter_map(|point| match &point.what.end {
                BondEnd::Guest(guest) => Some((point, guest)),
                BondEnd::Host(_) => None,
            })
            .collect()
    }

    /// The points at which others are fastened to it.
    pub fn host_points(&self) -> Vec<(Placed<'_, BondPoint>, &HostPoint)> {
        let points = self.bond_points().into_iter();
        points
            .filter_map(|point| match &point.what.end {
                BondEnd::Host(host) => Some((point, host)),
                BondEnd::Guest(_) => None,
            })
            .collect()
    }

    /// All its bond points.
    pub fn bond_points(&self) -> Vec<Placed<'_, BondPoint>> {
        let mut points = Vec::new();
        self.visit(&mut |id, pose, shape| {
            if let Shape::BondPoint(point) = shape {
                points.push(Placed {
                    id,
                    pose,
                    what: &**point,
                });
            }
        });
        points
    }

    /// Whether a part of it that can be pointed to has this id.
    pub fn has_pointable(&self, id: &str) -> bool {
        fn among(parts: &[Part], id: &str) -> bool {
            parts.iter().any(|part| {
                part.pointable && part.id == id
                    || matches!(&part.shape, Shape::Composite { parts } if among(parts, id))
            })
        }
        matches!(&self.shape, Shape::Composite { parts } if among(parts, id))
    }

    /// The object itself and all parts of composites, with the ids and the poses in the frame of the object.
    fn visit<'a>(&'a self, see: &mut impl FnMut(&'a str, Pose, &'a Shape)) {
        fn visit<'a>(
            id: &'a str,
            pose: Pose,
            shape: &'a Shape,
            see: &mut impl FnMut(&'a str, Pose, &'a Shape),
        ) {
            see(id, pose, shape);
            if let Shape::Composite { parts } = shape {
                for part in parts {
                    visit(&part.id, pose * part.pose, &part.shape, see);
                }
            }
        }
        visit(&self.id, Pose::IDENTITY, &self.shape, see);
    }
}

fn control_among<'a>(parts: &'a mut [Part], id: &str) -> Option<&'a mut Control> {
    parts.iter_mut().find_map(|part| match &mut part.shape {
        Shape::Control(control) => (part.id == id).then_some(&mut **control),
        Shape::Composite { parts } => control_among(parts, id),
        Shape::Block { .. }
        | Shape::Cylinder { .. }
        | Shape::Sphere { .. }
        | Shape::Box { .. }
        | Shape::Link { .. }
        | Shape::Lid { .. }
        | Shape::BondPoint(_) => None,
    })
}
