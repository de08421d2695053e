//! Parts of objects with an id or a function: controls, bond points, and parts that can be pointed to.

use bevy::prelude::*;
use tabletop_geometry::Pose;

use crate::{BondEnd, BondPoint, Control, GuestPoint, HostPoint, ObjectSpec, Part, Shape};

/// An object, or a part of one with an id of its own.
#[derive(Clone, Copy, Debug)]
pub struct PlacedPart<'a, T> {
    /// Its id.
    pub id: &'a str,
    /// Its pose in the frame of the object.
    pub pose: Pose,
    /// The part.
    pub what: &'a T,
}

/// A touched surface of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct TouchedSurface<'a> {
    /// The simple shape, in the frame of the object.
    pub part: Part,
    /// Id of the control that the surface belongs to, and the number of the control's simple part.
    pub control: Option<(&'a str, u32)>,
    /// Id of the innermost pointable part around it, or of the object.
    pub pointable: &'a str,
}

impl ObjectSpec {
    /// All surfaces of the object that can be touched.
    pub fn surfaces(&self) -> Vec<TouchedSurface<'_>> {
        fn collect<'a>(
            (id, pose, shape): (&'a str, Pose, &'a Shape),
            pointable: &'a str,
            surfaces: &mut Vec<TouchedSurface<'a>>,
        ) {
            if let Shape::Composite { parts } = shape {
                for part in parts {
                    let pointable = if part.pointable { &part.id } else { pointable };
                    let part = (&*part.id, pose * part.pose, &part.shape);
                    collect(part, pointable, surfaces);
                }
                return;
            }
            let is_control = matches!(shape, Shape::Control(_));
            for (number, part) in (0..).zip(shape.simple_touched()) {
                let part = Part {
                    pose: pose * part.pose,
                    ..part
                };
                surfaces.push(TouchedSurface {
                    part,
                    control: is_control.then_some((id, number)),
                    pointable,
                });
            }
        }
        let mut surfaces = Vec::new();
        collect(
            (&self.id, Pose::IDENTITY, &self.shape),
            &self.id,
            &mut surfaces,
        );
        surfaces
    }

    /// The first surface of the object that a ray touches, with its distance. The ray is in the table's frame, the object at `pose`.
    pub fn touched_along(&self, ray: Ray3d, pose: Pose) -> Option<(TouchedSurface<'_>, f32)> {
        let distance = |surface: &TouchedSurface| {
            let solids = surface.part.shape.colliding();
            let at = pose * surface.part.pose;
            let distances = solids
                .iter()
                .filter_map(|solid| solid.distance_along(ray, at));
            distances.min_by(f32::total_cmp)
        };
        let touched = self.surfaces().into_iter();
        touched
            .filter_map(|surface| Some((distance(&surface)?, surface)))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(distance, surface)| (surface, distance))
    }

    /// The object's controls: the object itself, or parts of it.
    pub fn controls(&self) -> Vec<PlacedPart<'_, Control>> {
        let mut controls = Vec::new();
        self.visit(&mut |id, pose, shape| {
            if let Shape::Control(control) = shape {
                controls.push(PlacedPart {
                    id,
                    pose,
                    what: control,
                });
            }
        });
        controls
    }

    /// The control with this id.
    pub fn control(&self, id: &str) -> Option<&Control> {
        let mut controls = self.controls().into_iter();
        controls
            .find(|control| control.id == id)
            .map(|control| control.what)
    }

    /// The control with this id, for changing it.
    pub fn control_mut(&mut self, id: &str) -> Option<&mut Control> {
        control_of(&mut self.shape, &self.id, id)
    }

    /// Its guest points, by which it is fastened to others.
    pub fn guest_points(&self) -> Vec<(PlacedPart<'_, BondPoint>, &GuestPoint)> {
        let points = self.bond_points().into_iter();
        points
            .filter_map(|point| match &point.what.end {
                BondEnd::Guest(guest) => Some((point, guest)),
                BondEnd::Host(_) => None,
            })
            .collect()
    }

    /// Its host points, to which others are fastened.
    pub fn host_points(&self) -> Vec<(PlacedPart<'_, BondPoint>, &HostPoint)> {
        let points = self.bond_points().into_iter();
        points
            .filter_map(|point| match &point.what.end {
                BondEnd::Host(host) => Some((point, host)),
                BondEnd::Guest(_) => None,
            })
            .collect()
    }

    /// All its bond points.
    pub fn bond_points(&self) -> Vec<PlacedPart<'_, BondPoint>> {
        let mut points = Vec::new();
        self.visit(&mut |id, pose, shape| {
            if let Shape::BondPoint(point) = shape {
                points.push(PlacedPart {
                    id,
                    pose,
                    what: point,
                });
            }
        });
        points
    }

    /// True if it has a pointable part with this id.
    pub fn has_pointable(&self, id: &str) -> bool {
        fn among(parts: &[Part], id: &str) -> bool {
            parts.iter().any(|part| {
                part.pointable && part.id == id
                    || matches!(&part.shape, Shape::Composite { parts } if among(parts, id))
            })
        }
        matches!(&self.shape, Shape::Composite { parts } if among(parts, id))
    }

    /// Visits the object and all parts of composites, with their ids and their poses in the object's frame.
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

/// The control with this id in a shape whose own id is `own`.
fn control_of<'a>(shape: &'a mut Shape, own: &str, id: &str) -> Option<&'a mut Control> {
    if let Shape::Control(control) = shape {
        return (own == id).then_some(control);
    }
    let Shape::Composite { parts } = shape else {
        return None;
    };
    parts
        .iter_mut()
        .find_map(|part| control_of(&mut part.shape, &part.id, id))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ControlKind, Side, ToggleSwitch};
    use tabletop_geometry::Rgb;

    #[test]
    fn a_ray_touches_the_side_of_a_switch_and_the_pointable_part() {
        let switch = Control::new(ControlKind::ToggleSwitch(ToggleSwitch {
            span: Vec3::new(1.0, 0.5, 0.1),
            angle: 10.0,
            color: Rgb::GRAY,
            pressed: Side::Left,
            states: 2,
        }));
        let color = Rgb::GRAY;
        let block = Shape::Block {
            span: Vec3::new(4.0, 4.0, 1.0),
            color,
        };
        let parts = vec![
            Part {
                pointable: true,
                ..Part::new("board", Pose::at(Vec3::NEG_Z * 0.5), block)
            },
            Part::new("power", Pose::IDENTITY, Shape::Control(switch)),
        ];
        let spec = ObjectSpec::new("panel", Pose::IDENTITY, 0.0, Shape::Composite { parts });
        let pose = Pose::from_degrees(Vec3::new(5.0, 0.0, 1.0), Vec3::Z * 180.0);
        let touched = |x: f32| {
            let ray = Ray3d::new(pose * Vec3::new(x, 0.0, 9.0), Dir3::NEG_Z);
            let (surface, _) = spec.touched_along(ray, pose)?;
            Some((surface.control, surface.pointable))
        };
        assert_eq!(touched(-0.2), Some((Some(("power", 0)), "panel")));
        assert_eq!(touched(0.2), Some((Some(("power", 1)), "panel")));
        assert_eq!(touched(1.0), Some((None, "board")));
        assert_eq!(touched(9.0), None);
    }
}
