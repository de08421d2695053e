//! The elements of objects: shapes, composites and their parts, descriptions.

use bevy::math::Vec3;
use tabletop_core::{ObjectSpec, Part, Shape, TightnessStep};

use crate::{
    document::tree::Element,
    elements::attributes::AttributeReader,
    elements::bond::{BOND_POINTS, bond_point},
    elements::control::{CONTROLS, ControlContent, control},
    elements::hollow::check_hollow,
    elements::mesh_files::MeshFiles,
    elements::value::{self, ValueError},
    elements::{DESCRIPTION, ElementReader},
};

pub(crate) const SHAPES: [&str; 8] = [
    "block",
    "cylinder",
    "frustum",
    "ring",
    "sphere",
    "box",
    "custom",
    "composite",
];
/// A cylinder of so many sides is round; so it is without any.
const ROUND: u32 = 32;
pub(crate) const SPANS: [&str; 3] = ["xspan", "yspan", "zspan"];

/// Where a shape stands.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum ObjectRole {
    /// It is an object of its own.
    Whole,
    /// It is a part of a composite.
    Part,
    /// It is a shape of a control's state, or a part of one.
    InState,
}

/// What stands in the element of a shape.
enum Content {
    Nothing,
    Parts(Vec<Part>),
    Control(ControlContent),
    Steps(Vec<TightnessStep>),
}

/// To which state triggering leads, for each of the simple parts of a shape.
pub(super) type NextStates = Vec<Option<u32>>;

impl ElementReader<'_, '_> {
    /// Reads an object.
    pub fn object(&mut self, element: &Element) -> Option<ObjectSpec> {
        let descriptions = self.descriptions(element);
        let (content, _) = self.content(element, ObjectRole::Whole);
        let mut attributes = AttributeReader::of(element, self.faults);
        let (id, pose) = (attributes.id(), attributes.pose());
        let mass = attributes.mass("mass", 1.0);
        attributes.ignore("pointable", false, value::boolean);
        let dynamics = attributes.dynamics();
        let shape =
            content.and_then(|content| shape(element, content, self.meshes, &mut attributes));
        attributes.finish(shape.map(|shape| ObjectSpec {
            id,
            pose,
            mass,
            shape,
            dynamics,
            descriptions,
        }))
    }

    /// Reads a part, and to which states triggering it leads.
    pub(super) fn part(
        &mut self,
        element: &Element,
        role: ObjectRole,
    ) -> Option<(Part, NextStates)> {
        let (content, of_parts) = self.content(element, role);
        let mut attributes = AttributeReader::of(element, self.faults);
        let id = attributes.id();
        let pose = match BOND_POINTS.contains(&element.name) {
            true => attributes.pose_or_origin(),
            false => attributes.pose(),
        };
        attributes.forbid(
            "mass",
            "a part has no mass of its own",
            "a mass of the outermost composite only",
        );
        for name in ["friction", "restitution", "linearVelocity"] {
            let problem = format!("a part has no {name} of its own");
            let expected = format!("{name} of the outermost composite only");
            attributes.forbid(name, &problem, &expected);
        }
        let pointable = attributes.read("pointable", false, value::boolean);
        let next = match role {
            ObjectRole::InState => {
                attributes.read("nextStateWhenTriggered", None, value::next_state)
            }
            ObjectRole::Whole | ObjectRole::Part => None,
        };
        let shape =
            content.and_then(|content| shape(element, content, self.meshes, &mut attributes));
        let part = attributes.finish(shape.map(|shape| Part {
            id,
            pose,
            shape,
            pointable,
        }))?;
        let next = match part.shape {
            Shape::Composite { .. } => of_parts.into_iter().map(|own| own.or(next)).collect(),
            Shape::Block { .. }
            | Shape::Cylinder { .. }
            | Shape::Sphere { .. }
            | Shape::Box { .. }
            | Shape::Prism { .. }
            | Shape::Frustum { .. }
            | Shape::Ring { .. }
            | Shape::Mesh { .. }
            | Shape::Link { .. }
            | Shape::Lid { .. }
            | Shape::Control(_)
            | Shape::BondPoint(_) => vec![next],
        };
        Some((part, next))
    }

    /// What stands in the element of a shape; nothing if that is faulty as a whole. Of the parts of a composite, also to which states
    /// triggering them leads.
    fn content(&mut self, element: &Element, role: ObjectRole) -> (Option<Content>, NextStates) {
        if CONTROLS.contains(&element.name) {
            let content = self.control_content(element, role);
            return (content.map(Content::Control), Vec::new());
        }
        if BOND_POINTS.contains(&element.name) {
            let steps = self.tightness_steps(element);
            return (steps.map(Content::Steps), Vec::new());
        }
        let (parts, next) = self.parts(element, role);
        let content = match element.name {
            "composite" => Content::Parts(parts),
            _ => Content::Nothing,
        };
        (Some(content), next)
    }

    /// The parts of a composite; none for a simple shape, whose content is checked.
    fn parts(&mut self, element: &Element, role: ObjectRole) -> (Vec<Part>, NextStates) {
        let is_composite = element.name == "composite";
        let mut allowed = Vec::new();
        if is_composite {
            allowed.extend(SHAPES);
            if role != ObjectRole::InState {
                allowed.extend(CONTROLS);
                allowed.extend(BOND_POINTS);
            }
        }
        if role == ObjectRole::Whole {
            allowed.push(DESCRIPTION);
        }
        let role_of_parts = match role {
            ObjectRole::Whole | ObjectRole::Part => ObjectRole::Part,
            ObjectRole::InState => ObjectRole::InState,
        };
        let (mut parts, mut states) = (Vec::new(), Vec::new());
        let mut is_empty = true;
        for child in &element.children {
            let is_description = child.name == DESCRIPTION;
            is_empty &= is_description;
            if self.is_allowed(child, element.name, &allowed)
                && !is_description
                && let Some((part, next)) = self.part(child, role_of_parts)
            {
                parts.push(part);
                states.extend(next);
            }
        }
        if is_composite && is_empty && !element.is_broken {
            let expected = format_args!("at least one of {}", SHAPES.join(", "));
            self.faults
                .report(element.place(), "it has no parts", expected);
        }
        (parts, states)
    }

    /// Reads what describes an object.
    pub fn descriptions(&mut self, element: &Element) -> Vec<(String, String)> {
        let mut descriptions = Vec::new();
        for child in &element.children {
            if child.name == DESCRIPTION && child.is_of_the_language() {
                self.forbid_children(child);
                let mut attributes = AttributeReader::of(child, self.faults);
                let description = (
                    attributes.require("name", String::new(), "name", value::name),
                    attributes.require("value", String::new(), "text", |text| Ok(text.to_owned())),
                );
                descriptions.extend(attributes.finish(Some(description)));
            }
        }
        descriptions
    }
}

/// The shape of an element; absent for a composite of no parts, and for a mesh that cannot be read.
fn shape(
    element: &Element,
    content: Content,
    meshes: &mut MeshFiles,
    attributes: &mut AttributeReader,
) -> Option<Shape> {
    match content {
        Content::Nothing => simple_shape(element, meshes, attributes),
        Content::Parts(parts) if parts.is_empty() => None,
        Content::Parts(parts) => Some(Shape::Composite { parts }),
        Content::Control(content) => Some(control(element, content, attributes)),
        Content::Steps(steps) => Some(bond_point(element, steps, attributes)),
    }
}

/// The shape of an element that is one of [`SHAPES`] but no composite.
fn simple_shape(
    element: &Element,
    meshes: &mut MeshFiles,
    attributes: &mut AttributeReader,
) -> Option<Shape> {
    Some(match element.name {
        "block" => Shape::Block {
            span: attributes.spans(SPANS, Vec3::ONE),
            color: attributes.color("color"),
        },
        "cylinder" => {
            let sides = attributes.sides(ROUND);
            let radius = attributes.span("radius", 0.5);
            let yspan = attributes.span("yspan", 1.0);
            let color = attributes.color("color");
            match sides < ROUND {
                true => Shape::Prism {
                    radius,
                    yspan,
                    sides,
                    color,
                },
                false => Shape::Cylinder {
                    radius,
                    yspan,
                    color,
                },
            }
        }
        "frustum" => Shape::Frustum {
            radius_top: attributes.span("radiusTop", 0.5),
            radius_bottom: attributes.span("radiusBottom", 0.5),
            zspan: attributes.span("zspan", 1.0),
            sides: attributes.sides(3),
            color: attributes.color("color"),
        },
        "ring" => {
            let radius_outer = attributes.span("radiusOuter", 1.0);
            let radius_inner = attributes.span("radiusInner", 0.5);
            if attributes.is_sound() && radius_inner >= radius_outer {
                let problem = format_args!("a hole of {radius_inner} leaves no ring");
                let expected = format_args!("less than {radius_outer}");
                attributes.fault("radiusInner", problem, expected);
            }
            Shape::Ring {
                radius_outer,
                radius_inner,
                zspan: attributes.span("zspan", 1.0),
                sides: attributes.sides(32),
                color: attributes.color("color"),
            }
        }
        "custom" => {
            let file =
                attributes.require("file", String::new(), "path", |text| Ok(text.to_owned()));
            let scale = attributes.span("scale", 1.0);
            let color = attributes.color("color");
            if !attributes.is_sound() {
                return None;
            }
            match meshes.mesh(element.origin.source, &file, scale) {
                Ok(mesh) => Shape::Mesh { mesh, color },
                Err(ValueError { problem, expected }) => {
                    attributes.fault("file", problem, expected);
                    return None;
                }
            }
        }
        "sphere" => Shape::Sphere {
            radius: attributes.span("radius", 0.5),
            color: attributes.color("color"),
        },
        _ => {
            let span = attributes.spans(SPANS, Vec3::ONE);
            let thickness = attributes.span("thickness", 0.05);
            check_hollow("thickness", span, thickness, attributes);
            Shape::Box {
                span,
                thickness,
                color: attributes.color("color"),
            }
        }
    })
}

#[cfg(test)]
mod tests {
    use tabletop_core::{Dynamics, Pose, Rgb, SceneItem};

    use super::*;
    use crate::test_support::{items_of, lines_of, scene_of};

    fn only_object(content: &str) -> ObjectSpec {
        match items_of(content).as_slice() {
            [SceneItem::Object(object)] => object.clone(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn simple_shapes_have_the_defaults_of_the_report() {
        for (name, shape) in [
            (
                "block",
                Shape::Block {
                    span: Vec3::ONE,
                    color: Rgb::GRAY,
                },
            ),
            (
                "cylinder",
                Shape::Cylinder {
                    radius: 0.5,
                    yspan: 1.0,
                    color: Rgb::GRAY,
                },
            ),
            (
                "sphere",
                Shape::Sphere {
                    radius: 0.5,
                    color: Rgb::GRAY,
                },
            ),
            (
                "box",
                Shape::Box {
                    span: Vec3::ONE,
                    thickness: 0.05,
                    color: Rgb::GRAY,
                },
            ),
        ] {
            let expected = ObjectSpec {
                id: String::new(),
                pose: Pose::at(Vec3::new(1.0, 2.0, 3.0)),
                mass: 1.0,
                shape,
                dynamics: Dynamics::default(),
                descriptions: vec![],
            };
            assert_eq!(
                only_object(&format!("<{name} location='(1,2,3)'/>")),
                expected
            );
        }
    }

    #[test]
    fn simple_shapes_have_the_attributes_of_the_report() {
        let object = only_object(
            "<block id='b_1' location='(-2,0,1)' rotation='(0,0,45)' mass='0' color='#00A57F' \
             xspan='2' yspan='3' zspan='4' pointable='true'>\
             <description name='use' value='a &amp; b'/><description name='shape' value=''/></block>",
        );
        assert_eq!(object.id, "b_1");
        let pose = Pose::from_degrees(Vec3::new(-2.0, 0.0, 1.0), Vec3::new(0.0, 0.0, 45.0));
        assert_eq!(object.pose, pose);
        assert!(object.is_fixed());
        let color = "#00a57f".parse().unwrap();
        assert_eq!(
            object.shape,
            Shape::Block {
                span: Vec3::new(2.0, 3.0, 4.0),
                color
            }
        );
        let descriptions = [("use", "a & b"), ("shape", "")].map(|(n, v)| (n.into(), v.into()));
        assert_eq!(object.descriptions, descriptions);
        let shape =
            only_object("<cylinder location='(0,0,2)' yspan='7' radius='2' sides='32'/>").shape;
        assert_eq!(
            shape,
            Shape::Cylinder {
                radius: 2.0,
                yspan: 7.0,
                color: Rgb::GRAY
            }
        );
        let shape = only_object("<box location='(0,0,2)' thickness='.2'/>").shape;
        assert_eq!(
            shape,
            Shape::Box {
                span: Vec3::ONE,
                thickness: 0.2,
                color: Rgb::GRAY
            }
        );
    }

    #[test]
    fn objects_have_physical_attributes_and_parts_have_none() {
        let object = only_object(
            "<sphere location='(0,0,1)' friction='.25' restitution='1' linearVelocity='(1,-2,0)'/>",
        );
        let expected = Dynamics {
            friction: Some(0.25),
            restitution: Some(1.0),
            velocity: Vec3::new(1.0, -2.0, 0.0),
        };
        assert_eq!(object.dynamics, expected);
        let plain =
            only_object("<composite location='(0,0,1)'><block location='(0,0,0)'/></composite>");
        assert!(plain.dynamics.is_default());
        for (name, value) in [
            ("friction", "-1"),
            ("restitution", "1.1"),
            ("linearVelocity", "(1,2)"),
        ] {
            let attributes = format!("{name}='{value}'");
            let faults = lines_of(&format!("<block location='(0,0,1)' {attributes}/>"));
            assert_eq!(faults.len(), 1);
            assert!(
                faults[0].starts_with(&format!("block, {name}: `{value}` is ")),
                "{faults:?}"
            );
            let part = format!(
                "<composite location='(0,0,1)'><block location='(0,0,0)' {attributes}/></composite>"
            );
            assert!(lines_of(&part)[0].contains(&format!("a part has no {name} of its own")));
        }
    }

    #[test]
    fn shapes_of_the_later_program_have_its_defaults() {
        for (element, shape) in [
            (
                "frustum",
                Shape::Frustum {
                    radius_top: 0.5,
                    radius_bottom: 0.5,
                    zspan: 1.0,
                    sides: 3,
                    color: Rgb::GRAY,
                },
            ),
            (
                "ring",
                Shape::Ring {
                    radius_outer: 1.0,
                    radius_inner: 0.5,
                    zspan: 1.0,
                    sides: 32,
                    color: Rgb::GRAY,
                },
            ),
            (
                "frustum radiusTop='.1' radiusBottom='2' zspan='3' sides='6' color='red'",
                Shape::Frustum {
                    radius_top: 0.1,
                    radius_bottom: 2.0,
                    zspan: 3.0,
                    sides: 6,
                    color: Rgb::RED,
                },
            ),
            (
                "ring radiusOuter='3' radiusInner='2' zspan='.5' sides='8' color='red'",
                Shape::Ring {
                    radius_outer: 3.0,
                    radius_inner: 2.0,
                    zspan: 0.5,
                    sides: 8,
                    color: Rgb::RED,
                },
            ),
            (
                "cylinder sides='6'",
                Shape::Prism {
                    radius: 0.5,
                    yspan: 1.0,
                    sides: 6,
                    color: Rgb::GRAY,
                },
            ),
            (
                "cylinder sides='32'",
                Shape::Cylinder {
                    radius: 0.5,
                    yspan: 1.0,
                    color: Rgb::GRAY,
                },
            ),
        ] {
            let content = format!("<{element} location='(0,0,1)'/>");
            assert_eq!(only_object(&content).shape, shape);
            let part = format!("<composite location='(0,0,1)'>{content}</composite>");
            assert_eq!(only_object(&part).shape.simple_parts()[0].shape, shape);
        }
    }

    #[test]
    fn shapes_of_the_later_program_are_checked() {
        for (content, fault) in [
            (
                "<ring location='(0,0,1)' radiusOuter='.5'/>",
                "ring, radiusInner: a hole of 0.5 leaves no ring, expected less than 0.5",
            ),
            (
                "<frustum location='(0,0,1)' sides='2'/>",
                "frustum, sides: `2` is out of range, expected a whole number from 3 to 1000000",
            ),
            (
                "<custom location='(0,0,1)'/>",
                "custom, file: it is missing, expected file=\"path\"",
            ),
            (
                "<custom location='(0,0,1)' file='cup.stl'/>",
                "custom, file: `cup.stl` cannot be read by a text without a folder, expected a task file on the disk",
            ),
        ] {
            assert_eq!(lines_of(content), [fault], "{content}");
        }
    }

    #[test]
    fn composites_nest() {
        let object = only_object(
            "<composite location='(0,0,1)' mass='10'><composite id='head' location='(-1,0,0)'>\
             <block id='x' location='(0,0,0)'/><block id='x' location='(0,1,0)'/></composite>\
             <sphere location='(2.8,0,0)'/></composite>",
        );
        assert_eq!(object.mass, 10.0);
        let parts = object.shape.simple_parts();
        let places: Vec<_> = parts
            .iter()
            .map(|part| (part.id.as_str(), part.pose.location.x))
            .collect();
        assert_eq!(places, [("x", -1.0), ("x", -1.0), ("", 2.8)]);
    }

    #[test]
    fn only_the_faulty_part_is_skipped() {
        let content = "<composite location='(0,0,1)'><block location='(0,0,0)' mass='1'/>\
                       <sphere location='(0,0,0)'/></composite>";
        let shape = only_object_in_spite_of_faults(content).shape;
        assert_eq!(shape.simple_parts().len(), 1);
        assert_eq!(
            lines_of(content),
            [
                "block, mass: a part has no mass of its own, expected a mass of the outermost composite only"
            ]
        );
    }

    fn only_object_in_spite_of_faults(content: &str) -> ObjectSpec {
        match scene_of("", content).items.as_slice() {
            [SceneItem::Object(object)] => object.clone(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_composite_needs_parts() {
        for content in [
            "<composite location='(0,0,1)'/>",
            "<composite location='(0,0,1)'><description name='a' value='b'/></composite>",
        ] {
            assert_eq!(
                lines_of(content),
                [
                    "composite: it has no parts, expected at least one of block, cylinder, frustum, ring, sphere, box, custom, composite"
                ]
            );
            assert!(scene_of("", content).items.is_empty());
        }
        let content = "<composite location='(0,0,1)'><block/></composite>";
        assert_eq!(lines_of(content).len(), 1);
        assert!(scene_of("", content).items.is_empty());
    }

    #[test]
    fn a_faulty_description_leaves_its_object() {
        let content = "<block location='(0,0,1)'><description name='a b' value=''/>\
                       <description name='c'/><description name='d' value=' e '/></block>";
        let object = only_object_in_spite_of_faults(content);
        assert_eq!(object.descriptions, [("d".to_owned(), " e ".to_owned())]);
        assert_eq!(lines_of(content).len(), 2);
    }
}
