//! The properties of an object that a recording lists.

use bevy::math::Vec3;
use tabletop_core::{Decimal, Dynamics, ObjectSpec, Rgb, Shape};

/// The properties as key and value: those that the task file describes, `shape` first; then those of its geometry that
/// are known and not described, by the keys and in the order of the program of 2014.
pub(crate) fn properties(spec: &ObjectSpec) -> Vec<(String, String)> {
    let owned = |(key, value): (&str, &str)| (key.to_owned(), value.to_owned());
    let mut all: Vec<_> = spec.all_descriptions().into_iter().map(owned).collect();
    for (key, value) in Known::of(spec).by_key() {
        if let Some(value) = value
            && !all.iter().any(|(described, _)| described == key)
        {
            all.push((key.to_owned(), value));
        }
    }
    all
}

#[derive(Default)]
struct Known {
    span: [Option<f32>; 3],
    radius: Option<f32>,
    color: Option<Rgb>,
    thickness: Option<f32>,
    handle_span: Option<Vec3>,
    handle_thickness: Option<f32>,
    /// What the program of 2014 does not know.
    further: Vec<(&'static str, String)>,
    mass: f32,
}

impl Known {
    fn of(spec: &ObjectSpec) -> Self {
        let extents = |span: Vec3| span.to_array().map(Some);
        let lengths = |lengths: &[(&'static str, f32)]| {
            let text = |&(key, length): &(&'static str, f32)| (key, Decimal(length).to_string());
            lengths.iter().map(text).collect()
        };
        let with_sides = |mut further: Vec<(&'static str, String)>, sides: u32| {
            further.push(("sides", sides.to_string()));
            further
        };
        let known = match spec.shape {
            Shape::Block { span, color } => Self {
                span: extents(span),
                color: Some(color),
                ..Self::default()
            },
            Shape::Cylinder {
                radius,
                yspan,
                color,
            } => Self {
                span: [None, Some(yspan), None],
                radius: Some(radius),
                color: Some(color),
                ..Self::default()
            },
            Shape::Sphere { radius, color } => Self {
                radius: Some(radius),
                color: Some(color),
                ..Self::default()
            },
            Shape::Prism {
                radius,
                yspan,
                sides,
                color,
            } => Self {
                span: [None, Some(yspan), None],
                radius: Some(radius),
                color: Some(color),
                further: with_sides(Vec::new(), sides),
                ..Self::default()
            },
            Shape::Frustum {
                radius_top,
                radius_bottom,
                zspan,
                sides,
                color,
            } => Self {
                span: [None, None, Some(zspan)],
                color: Some(color),
                further: with_sides(
                    lengths(&[("radiusTop", radius_top), ("radiusBottom", radius_bottom)]),
                    sides,
                ),
                ..Self::default()
            },
            Shape::Ring {
                radius_outer,
                radius_inner,
                zspan,
                sides,
                color,
            } => Self {
                span: [None, None, Some(zspan)],
                color: Some(color),
                further: with_sides(
                    lengths(&[("radiusOuter", radius_outer), ("radiusInner", radius_inner)]),
                    sides,
                ),
                ..Self::default()
            },
            Shape::Mesh { ref mesh, color } => Self {
                color: Some(color),
                further: vec![
                    ("file", mesh.file().to_owned()),
                    ("scale", Decimal(mesh.scale()).to_string()),
                ],
                ..Self::default()
            },
            Shape::Box {
                span,
                thickness,
                color,
            } => Self {
                span: extents(span),
                color: Some(color),
                thickness: Some(thickness),
                ..Self::default()
            },
            Shape::Link {
                span,
                padding,
                color,
            } => Self {
                span: extents(span + Vec3::Y * 2.0 * padding),
                color: Some(color),
                ..Self::default()
            },
            Shape::Lid {
                span,
                color,
                handle_span,
                handle_thickness,
                ..
            } => Self {
                span: extents(span),
                color: Some(color),
                handle_span: Some(handle_span),
                handle_thickness: Some(handle_thickness),
                ..Self::default()
            },
            Shape::Composite { .. } | Shape::Control(_) | Shape::BondPoint(_) => Self::default(),
        };
        let mut further = known.further;
        let Dynamics {
            friction,
            restitution,
            velocity: _,
        } = spec.dynamics;
        for (key, value) in [("friction", friction), ("restitution", restitution)] {
            further.extend(value.map(|value| (key, Decimal(value).to_string())));
        }
        Self {
            mass: spec.mass,
            further,
            ..known
        }
    }

    fn by_key(self) -> impl Iterator<Item = (&'static str, Option<String>)> {
        let number = |value: Option<f32>| value.map(|value| Decimal(value).to_string());
        let [xspan, yspan, zspan] = self.span.map(number);
        let handle = |axis: fn(Vec3) -> f32| number(self.handle_span.map(axis));
        let known = [
            ("xspan", xspan),
            ("zspan", zspan),
            ("yspan", yspan),
            ("radius", number(self.radius)),
            ("color", self.color.map(|color| color.to_string())),
            ("thickness", number(self.thickness)),
            ("handleXspan", handle(|span| span.x)),
            ("handleZspan", handle(|span| span.z)),
            ("handleYspan", handle(|span| span.y)),
            ("handleThickness", number(self.handle_thickness)),
        ];
        let mass = [("mass", number(Some(self.mass)))];
        let further = self.further.into_iter();
        let further = further.map(|(key, value)| (key, Some(value)));
        known.into_iter().chain(further).chain(mass)
    }
}

#[cfg(test)]
mod tests {
    use tabletop_core::Pose;

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
    fn every_shape_lists_what_is_known_of_it() {
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
    fn what_the_file_describes_comes_first_and_is_not_repeated() {
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
