//! The properties of an object that a recording lists.

use tabletop_core::{AttributeValue, Decimal, Dynamics, ObjectSpec};

/// The keys that the program of 2014 knows, in its order.
const KEYS: [&str; 10] = [
    "xspan",
    "zspan",
    "yspan",
    "radius",
    "color",
    "thickness",
    "handleXspan",
    "handleZspan",
    "handleYspan",
    "handleThickness",
];

/// The properties as key and value: those that the task file describes, `shape` first; then those of its geometry that
/// are known and not described, by the keys and in the order of the program of 2014, and what else is known.
pub(crate) fn properties(spec: &ObjectSpec) -> Vec<(String, String)> {
    let owned = |(key, value): (&str, &str)| (key.to_owned(), value.to_owned());
    let mut all: Vec<_> = spec.all_descriptions().into_iter().map(owned).collect();
    for (key, value) in known(spec) {
        if !all.iter().any(|(described, _)| described == key) {
            all.push((key.to_owned(), value));
        }
    }
    all
}

fn known(spec: &ObjectSpec) -> Vec<(&'static str, String)> {
    let shape = spec.shape.as_drawn();
    let attributes = shape.attributes().into_iter();
    // No recording lists the colour of a handle.
    let attributes = attributes.filter(|(key, _)| *key != "handleColor");
    let mut known: Vec<_> = attributes.map(|(key, value)| (key, text(value))).collect();
    let place = |key: &str| KEYS.iter().position(|known| *known == key);
    known.sort_by_key(|(key, _)| place(key).unwrap_or(KEYS.len()));
    let Dynamics {
        friction,
        restitution,
        velocity: _,
    } = spec.dynamics;
    for (key, value) in [
        ("friction", friction),
        ("restitution", restitution),
        ("mass", Some(spec.mass)),
    ] {
        known.extend(value.map(|value| (key, Decimal(value).to_string())));
    }
    known
}

fn text(value: AttributeValue) -> String {
    match value {
        AttributeValue::Number(number) => Decimal(number).to_string(),
        AttributeValue::Count(count) => count.to_string(),
        AttributeValue::Text(text) => text.to_owned(),
        AttributeValue::Color(color) => color.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;
    use tabletop_core::Shape;
    use tabletop_geometry::{Pose, Rgb};

    use super::*;

    fn listed(shape: Shape, descriptions: &[(&str, &str)]) -> String {
        let spec = ObjectSpec {
            id: "it".into(),
            pose: Pose::IDENTITY,
            mass: 0.5,
            shape,
            dynamics: Dynamics {
                friction: Some(0.25),
                ..Dynamics::default()
            },
            descriptions: descriptions
                .iter()
                .map(|&(key, value)| (key.into(), value.into()))
                .collect(),
        };
        let pairs = properties(&spec).into_iter();
        let pairs: Vec<_> = pairs.map(|(key, value)| format!("{key}={value}")).collect();
        pairs.join(" ")
    }

    const RED: Rgb = Rgb::new(1.0, 0.0, 0.0);

    #[test]
    fn every_shape_lists_its_properties() {
        let span = Vec3::new(1.0, 2.0, 3.0);
        for (shape, expected) in [
            (
                Shape::Block { span, color: RED },
                "shape=block xspan=1.0 zspan=3.0 yspan=2.0 color=#ff0000 friction=0.25 mass=0.5",
            ),
            (
                Shape::Cylinder {
                    radius: 0.25,
                    yspan: 2.0,
                    color: RED,
                },
                "shape=cylinder yspan=2.0 radius=0.25 color=#ff0000 friction=0.25 mass=0.5",
            ),
            (
                Shape::Sphere {
                    radius: 0.25,
                    color: RED,
                },
                "shape=sphere radius=0.25 color=#ff0000 friction=0.25 mass=0.5",
            ),
            (
                Shape::Box {
                    span,
                    thickness: 0.1,
                    color: RED,
                },
                "shape=box xspan=1.0 zspan=3.0 yspan=2.0 color=#ff0000 thickness=0.1 friction=0.25 mass=0.5",
            ),
            (
                Shape::Link {
                    span,
                    padding: 0.25,
                    color: RED,
                },
                "shape=block xspan=1.0 zspan=3.0 yspan=2.5 color=#ff0000 friction=0.25 mass=0.5",
            ),
            (
                Shape::Lid {
                    span,
                    color: RED,
                    handle_span: Vec3::new(0.1, 0.2, 0.3),
                    handle_thickness: 0.05,
                    handle_color: Rgb::GRAY,
                },
                "shape=lid xspan=1.0 zspan=3.0 yspan=2.0 color=#ff0000 handleXspan=0.1 handleZspan=0.3 handleYspan=0.2 \
                 handleThickness=0.05 friction=0.25 mass=0.5",
            ),
            (
                Shape::Frustum {
                    radius_top: 0.5,
                    radius_bottom: 1.0,
                    zspan: 2.0,
                    sides: 6,
                    color: RED,
                },
                "shape=frustum zspan=2.0 color=#ff0000 radiusTop=0.5 radiusBottom=1.0 sides=6 friction=0.25 mass=0.5",
            ),
            (
                Shape::Ring {
                    radius_outer: 1.0,
                    radius_inner: 0.5,
                    zspan: 0.25,
                    sides: 32,
                    color: RED,
                },
                "shape=ring zspan=0.25 color=#ff0000 radiusOuter=1.0 radiusInner=0.5 sides=32 friction=0.25 mass=0.5",
            ),
            (
                Shape::Composite { parts: vec![] },
                "shape=composite friction=0.25 mass=0.5",
            ),
        ] {
            assert_eq!(listed(shape, &[]), expected);
        }
    }

    #[test]
    fn descriptions_of_the_file_come_first_and_are_not_repeated() {
        let ball = Shape::Sphere {
            radius: 1.0,
            color: RED,
        };
        assert_eq!(
            listed(
                ball,
                &[("use", "toy"), ("color", "scarlet"), ("shape", "globe")]
            ),
            "shape=globe use=toy color=scarlet radius=1.0 friction=0.25 mass=0.5"
        );
    }
}
