//! Objects as the events of a recording describe them.

use std::collections::BTreeMap;

use bevy::math::Vec3;
use tabletop_core::{ObjectSpec, Shape};
use tabletop_geometry::{Pose, Rgb};

/// The object that the properties of a recording describe, and whether its size is among them.
pub(crate) fn described(id: &str, properties: &[(String, String)]) -> (ObjectSpec, bool) {
    let known: BTreeMap<&str, &str> = properties
        .iter()
        .map(|(name, value)| (name.as_str(), value.as_str()))
        .collect();
    let number = |name: &str| known.get(name).and_then(|value| value.parse::<f32>().ok());
    let length = |name: &str| number(name).unwrap_or(1.0);
    let span = Vec3::new(length("xspan"), length("yspan"), length("zspan"));
    let color = known.get("color").and_then(|color| color_of(color));
    let color = color.unwrap_or(Rgb::GRAY);
    let thickness = number("thickness").unwrap_or(0.05);
    let radius = number("radius").unwrap_or(0.5);
    // The original calls a ball a cylinder, and a cylinder's length `zspan`.
    let yspan = number("yspan").or(number("zspan"));
    let sides = known.get("sides").and_then(|sides| sides.parse().ok());
    let sides = sides.unwrap_or(32);
    let name = known.get("shape").copied().unwrap_or_default();
    let shape = match (name, yspan) {
        ("block", _) => Shape::Block { span, color },
        ("box", _) => Shape::Box {
            span,
            thickness,
            color,
        },
        ("cylinder", Some(yspan)) if known.contains_key("sides") => Shape::Prism {
            radius,
            yspan,
            sides,
            color,
        },
        ("frustum", _) => Shape::Frustum {
            radius_top: length("radiusTop"),
            radius_bottom: length("radiusBottom"),
            zspan: span.z,
            sides,
            color,
        },
        ("ring", _) => Shape::Ring {
            radius_outer: length("radiusOuter"),
            radius_inner: number("radiusInner").unwrap_or(0.5),
            zspan: span.z,
            sides,
            color,
        },
        ("cylinder", Some(yspan)) => Shape::Cylinder {
            radius,
            yspan,
            color,
        },
        ("cylinder", None) if known.contains_key("radius") => Shape::Sphere { radius, color },
        ("cylinder", None) => Shape::Cylinder {
            radius,
            yspan: 1.0,
            color,
        },
        ("sphere", _) => Shape::Sphere { radius, color },
        ("lid", _) => {
            let plate = number("thickness").or(number("zspan")).unwrap_or(thickness);
            Shape::Lid {
                span: span.with_z(plate),
                color,
                handle_span: Vec3::new(
                    length("handleXspan"),
                    length("handleYspan"),
                    length("handleZspan"),
                ),
                handle_thickness: number("handleThickness").unwrap_or(thickness),
                handle_color: color,
            }
        }
        _ => Shape::Composite { parts: Vec::new() },
    };
    let sized = ["xspan", "zspan", "radius", "radiusOuter", "radiusTop"];
    let tells_size = sized.into_iter().any(|key| known.contains_key(key));
    let mass = number("mass").unwrap_or(1.0);
    let mut spec = ObjectSpec::new(id, Pose::IDENTITY, mass, shape);
    spec.dynamics.friction = number("friction");
    spec.dynamics.restitution = number("restitution");
    spec.descriptions = properties
        .iter()
        .filter(|(name, _)| !GEOMETRY.contains(&name.as_str()))
        .cloned()
        .collect();
    if matches!(spec.shape, Shape::Sphere { .. }) {
        let kind = spec
            .descriptions
            .iter_mut()
            .find(|(name, _)| name == "shape");
        kind.into_iter()
            .for_each(|(_, kind)| *kind = "sphere".to_owned());
    }
    (spec, tells_size)
}

/// Properties that are no descriptions.
const GEOMETRY: [&str; 20] = [
    "xspan",
    "yspan",
    "zspan",
    "radius",
    "radiusTop",
    "radiusBottom",
    "radiusOuter",
    "radiusInner",
    "sides",
    "file",
    "scale",
    "color",
    "thickness",
    "handleXspan",
    "handleYspan",
    "handleZspan",
    "handleThickness",
    "friction",
    "restitution",
    "mass",
];

/// A colour. The original writes two digits more before those of bright red: `#ffff0000`.
fn color_of(text: &str) -> Option<Rgb> {
    match text.strip_prefix('#') {
        Some(digits) if digits.len() == 8 && digits.is_ascii() => {
            format!("#{}", &digits[2..]).parse().ok()
        }
        _ => text.parse().ok(),
    }
}
