//! The elements of simple shapes.

use bevy::math::Vec3;
use tabletop_core::Shape;

use crate::{
    document::tree::Element,
    elements::{
        attributes::AttributeReader, hollow::check_hollow, mesh_files::MeshFiles, value::ValueError,
    },
};

/// The attributes of a cuboid's extents.
pub(crate) const SPANS: [&str; 3] = ["xspan", "yspan", "zspan"];

/// Number of sides from which a cylinder is round, as it is by default.
const ROUND: u32 = 32;

/// The shape of an element of [`SHAPES`](super::names::SHAPES) other than a composite.
pub(super) fn simple_shape(
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
    use tabletop_core::{Dynamics, ObjectSpec};
    use tabletop_geometry::{Pose, Rgb};

    use super::*;
    use crate::test_support::{lines_of, only_object};

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
}
