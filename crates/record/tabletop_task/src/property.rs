//! Properties of objects.

use bevy::math::Vec3;
use tabletop_core::{ObjectSpec, Shape};
use tabletop_geometry::Rgb;

/// The lengths that define shapes.
pub(crate) const LENGTHS: [&str; 8] = [
    "xspan",
    "yspan",
    "zspan",
    "radius",
    "radiusTop",
    "radiusBottom",
    "radiusOuter",
    "radiusInner",
];

/// The kind of values that a property has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PropertyKind {
    Id,
    Shape,
    Color,
    /// All lengths of a shape.
    Size,
    Length,
    Mass,
    /// A description of the task file.
    Description,
}

impl PropertyKind {
    pub fn of(name: &str) -> Self {
        match name {
            "id" => Self::Id,
            "shape" => Self::Shape,
            "color" => Self::Color,
            "size" => Self::Size,
            "mass" => Self::Mass,
            name if LENGTHS.contains(&name) => Self::Length,
            _ => Self::Description,
        }
    }
}

/// The properties of an object as names and values: `id`, `shape`, `color` if it has just one, `size`, the lengths of its shape
/// (`xspan`, `radius`, ...), `mass`, then its descriptions.
pub fn properties(spec: &ObjectSpec) -> Vec<(String, String)> {
    let mut all = vec![("id".to_owned(), spec.id.clone())];
    let mut add = |name: &str, value: String| all.push((name.to_owned(), value));
    let mut descriptions = spec.all_descriptions().into_iter();
    if let Some((_, shape)) = descriptions.next() {
        add("shape", shape.to_owned());
    }
    if let Some(color) = only_color(&spec.shape) {
        add("color", color.to_string());
    }
    let lengths = lengths(&spec.shape);
    let size: Vec<_> = lengths
        .iter()
        .map(|(_, length)| length.to_string())
        .collect();
    add("size", size.join("x"));
    for (name, length) in lengths {
        add(name, length.to_string());
    }
    add("mass", spec.mass.to_string());
    for (name, value) in descriptions {
        add(name, value.to_owned());
    }
    all
}

/// A property of an object.
pub fn property(spec: &ObjectSpec, name: &str) -> Option<String> {
    let all = properties(spec).into_iter();
    all.rev()
        .find(|(known, _)| known == name)
        .map(|(_, value)| value)
}

fn only_color(shape: &Shape) -> Option<Rgb> {
    let solids = shape.drawn();
    let first = solids.first()?.color;
    solids
        .iter()
        .all(|solid| solid.color == first)
        .then_some(first)
}

/// The lengths that define a shape, in units; for a composite, those of the cuboid around it.
fn lengths(shape: &Shape) -> Vec<(&'static str, f32)> {
    let spans = |span: Vec3| vec![("xspan", span.x), ("yspan", span.y), ("zspan", span.z)];
    match shape {
        Shape::Block { span, .. }
        | Shape::Box { span, .. }
        | Shape::Link { span, .. }
        | Shape::Lid { span, .. } => spans(*span),
        Shape::Cylinder { radius, yspan, .. } => vec![("radius", *radius), ("yspan", *yspan)],
        Shape::Sphere { radius, .. } => vec![("radius", *radius)],
        Shape::Prism { radius, yspan, .. } => vec![("radius", *radius), ("yspan", *yspan)],
        Shape::Frustum {
            radius_top,
            radius_bottom,
            zspan,
            ..
        } => vec![
            ("radiusTop", *radius_top),
            ("radiusBottom", *radius_bottom),
            ("zspan", *zspan),
        ],
        Shape::Ring {
            radius_outer,
            radius_inner,
            zspan,
            ..
        } => vec![
            ("radiusOuter", *radius_outer),
            ("radiusInner", *radius_inner),
            ("zspan", *zspan),
        ],
        Shape::Composite { .. } | Shape::Mesh { .. } | Shape::Control(_) | Shape::BondPoint(_) => {
            spans(around(shape))
        }
    }
}

/// Extents of the cuboid around a shape, along the axes of its frame, to a hundredth of a unit.
fn around(shape: &Shape) -> Vec3 {
    let solids: Vec<_> = shape
        .colliding()
        .iter()
        .map(|solid| tabletop_geometry::PlacedSolid::of(solid, tabletop_geometry::Pose::IDENTITY))
        .collect();
    let reach = |way: Vec3| {
        let all = solids.iter().map(|solid| solid.farthest(way).dot(way));
        all.reduce(f32::max).unwrap_or(0.0)
    };
    let extents = Vec3::AXES.map(|axis| reach(axis) + reach(-axis));
    (Vec3::from(extents) * 100.0).round() / 100.0
}

/// True if a property has the wanted value: a colour by its name or `#rrggbb`, a number within 1 %, a range `1..2`, lengths
/// with `x` between them, or else a text, in upper or lower case.
pub fn has_value(name: &str, value: &str, wanted: &str) -> bool {
    match PropertyKind::of(name) {
        PropertyKind::Color => has_color(value, wanted),
        PropertyKind::Id | PropertyKind::Shape => is_same_text(value, wanted),
        PropertyKind::Size
        | PropertyKind::Length
        | PropertyKind::Mass
        | PropertyKind::Description => has_numbers(value, wanted),
    }
}

fn has_color(value: &str, wanted: &str) -> bool {
    let [Ok(value), Ok(color)] = [value, wanted].map(str::parse::<Rgb>) else {
        // A description may have this name.
        return is_same_text(value, wanted);
    };
    let is_named = !wanted.trim().starts_with('#');
    value.to_bytes() == color.to_bytes()
        || (is_named && crate::noun::color_name(value) == crate::noun::color_name(color))
}

fn has_numbers(value: &str, wanted: &str) -> bool {
    if let (Some((least, most)), Ok(value)) = (range(wanted), value.parse::<f32>()) {
        return (least..=most).contains(&value);
    }
    match (numbers(value), numbers(wanted)) {
        (Some(a), Some(b)) => {
            let is_near = |(a, b): (&f32, &f32)| (a - b).abs() <= 0.01 * b.abs().max(1e-3);
            a.len() == b.len() && a.iter().zip(&b).all(is_near)
        }
        _ => is_same_text(value, wanted),
    }
}

/// True if two texts are the same in upper or lower case.
pub(crate) fn is_same_text(a: &str, b: &str) -> bool {
    a.trim().eq_ignore_ascii_case(b.trim())
}

/// The numbers of a text with `x` between them.
pub(crate) fn numbers(text: &str) -> Option<Vec<f32>> {
    text.split('x').map(number).collect()
}

/// The bounds of a range `1..2`, which may be open.
pub(crate) fn range(text: &str) -> Option<(f32, f32)> {
    let (least, most) = text.split_once("..")?;
    let bound = |text: &str, open: f32| match text.trim() {
        "" => Some(open),
        text => number(text),
    };
    Some((
        bound(least, f32::NEG_INFINITY)?,
        bound(most, f32::INFINITY)?,
    ))
}

fn number(text: &str) -> Option<f32> {
    text.trim()
        .parse()
        .ok()
        .filter(|number: &f32| number.is_finite())
}

#[cfg(test)]
mod tests {
    use tabletop_geometry::Pose;

    use super::*;

    #[test]
    fn colours_numbers_and_ranges_are_compared_by_value() {
        for (name, value, wanted, expected) in [
            ("color", "#ff0000", "red", true),
            ("color", "#e01010", "red", true),
            ("color", "#e01010", "#ff0000", false),
            ("color", "#00ff00", "red", false),
            ("color", "#00ff00", "vermilion", false),
            ("color", "reddish", "Reddish", true),
            ("xspan", "2", "2.0", true),
            ("xspan", "2", "1..3", true),
            ("xspan", "2", "..1.5", false),
            ("xspan", "2", "1.5..", true),
            ("size", "2x2x1", "2.0x2.0x1.0", true),
            ("size", "2x2x1", "2x2", false),
            ("use", "Tool", "tool", true),
            ("use", " tool ", "tool", true),
            ("weight", "2", "1..3", true),
            ("id", "100", "101", false),
            ("id", "2", "1..3", false),
            ("id", "Red", "red", true),
        ] {
            assert_eq!(
                has_value(name, value, wanted),
                expected,
                "{name}: {value}, {wanted}"
            );
        }
    }

    #[test]
    fn an_object_tells_its_properties() {
        let mut spec = ObjectSpec::new(
            "a",
            Pose::IDENTITY,
            1.0,
            Shape::Cylinder {
                radius: 0.5,
                yspan: 3.0,
                color: Rgb::RED,
            },
        );
        spec.descriptions.push(("use".into(), "log".into()));
        let reported: Vec<_> = properties(&spec)
            .into_iter()
            .map(|(name, value)| format!("{name}={value}"))
            .collect();
        assert_eq!(
            reported.join(" "),
            "id=a shape=cylinder color=#ff0000 size=0.5x3 radius=0.5 yspan=3 mass=1 use=log"
        );
        assert_eq!(property(&spec, "use").as_deref(), Some("log"));
        assert_eq!(property(&spec, "xspan"), None);
    }
}
