//! The elements of objects: shapes, composites and their parts, descriptions.

use tabletop_core::{Composition, ObjectSpec, Part, Shape, TightnessStep};

use crate::{
    document::tree::Element,
    elements::{
        ElementReader,
        attributes::AttributeReader,
        bond::bond_point,
        control::{ControlContent, control},
        mesh_files::MeshFiles,
        names::{BOND_POINTS, CONTROLS, DESCRIPTION, SHAPES},
        role::ObjectRole,
        simple_shape::simple_shape,
        value,
    },
};

/// The content of a shape's element, and whether it has no fault for which the element is left out.
struct Inside {
    content: ShapeContent,
    is_sound: bool,
    /// Of the parts of a composite, to which states triggering them leads.
    next: NextStates,
}

/// The content of a shape's element.
enum ShapeContent {
    Nothing,
    Parts(Vec<Part>),
    Control(ControlContent),
    Steps(Vec<TightnessStep>),
}

/// For each simple part of a shape, the state to which triggering it leads.
pub(super) type NextStates = Vec<Option<u32>>;

impl ElementReader<'_, '_> {
    /// Reads an object.
    pub fn object(&mut self, element: &Element) -> Option<ObjectSpec> {
        let descriptions = self.descriptions(element);
        let inside = self.inside(element, ObjectRole::Whole);
        let mut attributes = AttributeReader::of(element, self.faults);
        let (id, pose) = (attributes.id(), attributes.pose());
        let mass = attributes.mass("mass", 1.0);
        attributes.ignore("pointable", false, value::boolean);
        let dynamics = attributes.dynamics();
        let shape = shape(element, inside.content, self.meshes, &mut attributes);
        let shape = shape.filter(|_| inside.is_sound);
        attributes.finish(shape.map(|shape| ObjectSpec {
            id,
            pose,
            mass,
            shape,
            dynamics,
            descriptions,
        }))
    }

    /// Reads a part, and the states to which triggering it leads.
    pub(super) fn part(
        &mut self,
        element: &Element,
        role: ObjectRole,
    ) -> Option<(Part, NextStates)> {
        let inside = self.inside(element, role);
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
        let shape = shape(element, inside.content, self.meshes, &mut attributes);
        let shape = shape.filter(|_| inside.is_sound);
        let part = attributes.finish(shape.map(|shape| Part {
            id,
            pose,
            shape,
            pointable,
        }))?;
        let next = match part.shape.composition() {
            Composition::Parts(_) => inside.next.into_iter().map(|own| own.or(next)).collect(),
            Composition::Simple
            | Composition::Lid(_)
            | Composition::Control(_)
            | Composition::BondPoint(_) => vec![next],
        };
        Some((part, next))
    }

    fn inside(&mut self, element: &Element, role: ObjectRole) -> Inside {
        let (mut is_sound, mut next) = (true, Vec::new());
        let content = if CONTROLS.contains(&element.name) {
            let content;
            (content, is_sound) = self.control_content(element, role);
            ShapeContent::Control(content)
        } else if BOND_POINTS.contains(&element.name) {
            let steps;
            (steps, is_sound) = self.tightness_steps(element);
            ShapeContent::Steps(steps)
        } else {
            let parts;
            (parts, next) = self.parts(element, role);
            match element.name {
                "composite" => ShapeContent::Parts(parts),
                _ => ShapeContent::Nothing,
            }
        };
        Inside {
            content,
            is_sound,
            next,
        }
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

    /// Reads the descriptions of an object.
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

/// The shape of an element; `None` for a composite without parts, and for a mesh that cannot be read.
fn shape(
    element: &Element,
    content: ShapeContent,
    meshes: &mut MeshFiles,
    attributes: &mut AttributeReader,
) -> Option<Shape> {
    match content {
        ShapeContent::Nothing => simple_shape(element, meshes, attributes),
        ShapeContent::Parts(parts) if parts.is_empty() => None,
        ShapeContent::Parts(parts) => Some(Shape::Composite { parts }),
        ShapeContent::Control(content) => Some(control(element, content, attributes)),
        ShapeContent::Steps(steps) => Some(bond_point(element, steps, attributes)),
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;
    use tabletop_core::{Dynamics, SceneItem};

    use super::*;
    use crate::test_support::{lines_of, only_object, scene_of};

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
