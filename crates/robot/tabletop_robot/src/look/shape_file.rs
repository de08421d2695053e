//! The program's own shape files (`assets/baxter/*.shape.json`): links made of a few exact solids, which can be divided into any
//! number of triangles.

use bevy::math::Vec3;
use serde::Deserialize;
use tabletop_core::Figure;
use tabletop_geometry::Triangles;

use super::{
    boxes::Cuboid, detail::Detail, extrusion::Extrusion, hull::Hull, lathe::Lathe, loft::Loft,
    palette::Paint, tube::Tube,
};

/// The shape of a link. Lengths in m, in the frame that `about` names.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ShapeFile {
    /// Its description, for readers of the file.
    #[serde(rename = "about")]
    _about: String,
    parts: Vec<ShapePart>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ShapePart {
    color: Paint,
    /// True if the plane y = 0 mirrors it.
    #[serde(default)]
    mirrored: bool,
    solid: ShapeForm,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum ShapeForm {
    Lathe(Lathe),
    Loft(Loft),
    Extrusion(Extrusion),
    Tube(Tube),
    Box(Cuboid),
}

impl ShapeForm {
    fn hull(&self, detail: Detail) -> Hull {
        match self {
            Self::Lathe(lathe) => lathe.hull(detail),
            Self::Loft(loft) => loft.hull(detail),
            Self::Extrusion(extrusion) => extrusion.hull(detail),
            Self::Tube(tube) => tube.hull(detail),
            Self::Box(cuboid) => cuboid.hull(),
        }
    }
}

impl ShapeFile {
    /// Reads a shape from the text of a file.
    pub fn read(text: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(text)
    }

    /// The surface of each solid that is large enough for this detail, with its colour.
    fn hulls(&self, detail: Detail) -> impl Iterator<Item = (Hull, Paint)> {
        self.parts.iter().flat_map(move |part| {
            let hull = part.solid.hull(detail);
            let [least, most] = hull.bounds();
            let hull = (most - least)
                .cmpge(Vec3::splat(detail.least_extent()))
                .any()
                .then_some(hull);
            let mirrored = hull.clone().filter(|_| part.mirrored).map(|hull| {
                hull.mapped(|point| Vec3::new(point.x, -point.y, point.z))
                    .oriented()
            });
            hull.into_iter()
                .chain(mirrored)
                .map(|hull| (hull, part.color))
        })
    }

    fn surface(&self, detail: Detail) -> Triangles {
        let mut surface = Triangles::default();
        for (hull, paint) in self.hulls(detail) {
            surface.append(&hull.shaded(paint.rgb()));
        }
        surface
    }

    /// Its figure, in units.
    pub fn figure(&self) -> Figure {
        Figure {
            fine: self.surface(Detail::Fine).into(),
            coarse: self.surface(Detail::Coarse).into(),
        }
    }
}

/// The figure of a shape file's text, in units.
///
/// # Errors
/// The mistake and its place.
pub fn read_shape(text: &str) -> Result<Figure, serde_json::Error> {
    Ok(ShapeFile::read(text)?.figure())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::look::shipped::PARTS;

    /// Bounds of the links of the real robot, in mm, in the frames of the files.
    const BOUNDS: [(&str, [i32; 3], [i32; 3]); 12] = [
        ("torso", [-219, -336, -62], [200, 336, 875]),
        ("pedestal", [-499, -411, -924], [415, 411, -58]),
        ("head", [-75, -75, -66], [76, 75, 38]),
        ("screen", [-57, -134, -96], [3, 134, 96]),
        ("upper_shoulder", [-88, -141, 31], [135, 141, 369]),
        ("lower_shoulder", [-73, -76, -98], [121, 76, 98]),
        ("upper_elbow", [-92, -79, 12], [133, 79, 326]),
        ("lower_elbow", [-69, -70, -95], [92, 70, 95]),
        ("upper_forearm", [-86, -74, -18], [72, 74, 324]),
        ("lower_forearm", [-59, -59, -86], [168, 62, 83]),
        ("wrist", [-57, -56, 54], [56, 57, 139]),
        ("finger", [-20, -15, -75], [20, 15, 75]),
    ];

    fn shape(name: &str) -> ShapeFile {
        let file = format!("{name}.shape.json");
        let (_, text) = PARTS.iter().find(|(known, _)| **known == *file).unwrap();
        ShapeFile::read(text).unwrap()
    }

    #[test]
    fn every_solid_is_closed_and_has_its_outside_outside() {
        for (name, text) in PARTS {
            for detail in Detail::BOTH {
                for (i, (hull, _)) in ShapeFile::read(text).unwrap().hulls(detail).enumerate() {
                    assert!(hull.volume() > 0.0, "{name}: solid {i}, {detail:?}");
                    assert!(hull.is_closed(), "{name}: solid {i}, {detail:?}");
                }
            }
        }
    }

    #[test]
    fn triangles_and_normals_agree() {
        for (name, text) in PARTS {
            let figure = ShapeFile::read(text).unwrap().figure();
            for surface in [&figure.fine, &figure.coarse] {
                assert_eq!(surface.positions.len(), surface.normals.len());
                assert_eq!(surface.positions.len(), surface.colors.len());
                for normal in &surface.normals {
                    assert!((normal.length() - 1.0).abs() < 1e-4, "{name}: {normal}");
                }
                for &triangle in &surface.indices {
                    let [a, b, c] = triangle.map(|i| surface.positions[i as usize]);
                    let face = (b - a).cross(c - a).normalize();
                    for i in triangle {
                        let normal = surface.normals[i as usize];
                        assert!(face.dot(normal) > 0.3, "{name}: {normal} at {a}");
                    }
                }
            }
        }
    }

    #[test]
    fn links_are_as_large_as_those_of_the_real_robot() {
        for (name, least, most) in BOUNDS {
            let figure = shape(name).figure();
            for (surface, tolerance) in [(&figure.fine, 10.0), (&figure.coarse, 25.0)] {
                for (corner, expected) in [
                    (Vec3::min as fn(Vec3, Vec3) -> Vec3, least),
                    (Vec3::max, most),
                ] {
                    let own = surface.positions.iter().copied().reduce(corner).unwrap() * 100.0;
                    let missed = own - Vec3::from(expected.map(|mm| mm as f32));
                    assert!(
                        missed.abs().max_element() < tolerance,
                        "{name}: {own} mm for {expected:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_robot_has_no_more_triangles_than_can_be_drawn() {
        let (mut fine, mut coarse) = (0, 0);
        for (name, text) in PARTS {
            let figure = ShapeFile::read(text).unwrap().figure();
            let times = match name.trim_end_matches(".shape.json") {
                "torso" | "pedestal" | "head" | "screen" => 1,
                "finger" => 4,
                _ => 2,
            };
            fine += times * figure.fine.indices.len();
            coarse += times * figure.coarse.indices.len();
        }
        assert!(fine < 40_000 && coarse < 5_500, "{fine} and {coarse}");
    }

    #[test]
    fn mistakes_are_named() {
        for (text, expected) in [
            ("{}", "missing field `about`"),
            (
                r#"{"about": "", "parts": [{"color": "pink"}]}"#,
                "unknown variant `pink`",
            ),
            (
                r#"{"about": "", "parts": [{"color": "red", "solid": {"box": {"center": [0, 0, 0], "scale": 1}}}]}"#,
                "unknown field `scale`",
            ),
        ] {
            let message = ShapeFile::read(text).unwrap_err().to_string();
            assert!(message.starts_with(expected), "{message}");
        }
    }

    #[test]
    fn senseless_numbers_do_no_harm() {
        for solid in [
            r#"{"lathe": {"origin": [0, 0, 0], "axis": "z", "profile": []}}"#,
            r#"{"lathe": {"origin": [0, 0, 0], "axis": "z", "profile": [[1e30, 1e30], [1e38, -1]]}}"#,
            r#"{"loft": {"axis": "x", "sections": []}}"#,
            r#"{"loft": {"axis": "x", "sections": [{"at": 0, "u": [1, 0], "v": [1e38, -1e38], "exponent": 0}]}}"#,
            r#"{"tube": {"radius": 1, "path": []}}"#,
            r#"{"tube": {"radius": -1, "path": [[0, 0, 0], [0, 0, 0], [0, 0, 1], [0, 0, 0]]}}"#,
            r#"{"extrusion": {"axis": "y", "from": 0, "to": 0, "outline": [[0, 0], [1, 1]]}}"#,
        ] {
            let text =
                format!(r#"{{"about": "", "parts": [{{"color": "red", "solid": {solid}}}]}}"#);
            ShapeFile::read(&text).unwrap().figure();
        }
    }
}
