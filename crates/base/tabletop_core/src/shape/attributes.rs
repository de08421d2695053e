//! The attributes by which task files and recordings describe shapes.

use bevy::prelude::*;
use tabletop_geometry::Rgb;

use crate::Shape;

/// The value of an attribute.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AttributeValue<'a> {
    /// A length in units, or a factor.
    Number(f32),
    /// A number of things.
    Count(u32),
    /// The name of a file.
    Text(&'a str),
    /// A colour.
    Color(Rgb),
}

impl Shape {
    /// Its lengths, with their names in task files; none of what consists of parts, states or a mesh.
    pub fn lengths_mut(&mut self) -> Vec<(&'static str, &mut f32)> {
        fn spans(span: &mut Vec3) -> [(&'static str, &mut f32); 3] {
            [
                ("xspan", &mut span.x),
                ("yspan", &mut span.y),
                ("zspan", &mut span.z),
            ]
        }
        match self {
            Self::Block { span, .. } | Self::Link { span, .. } => spans(span).into(),
            Self::Box {
                span, thickness, ..
            } => spans(span)
                .into_iter()
                .chain([("thickness", thickness)])
                .collect(),
            Self::Cylinder { radius, yspan, .. } | Self::Prism { radius, yspan, .. } => {
                vec![("radius", radius), ("yspan", yspan)]
            }
            Self::Sphere { radius, .. } => vec![("radius", radius)],
            Self::Frustum {
                radius_top,
                radius_bottom,
                zspan,
                ..
            } => vec![
                ("radiusTop", radius_top),
                ("radiusBottom", radius_bottom),
                ("zspan", zspan),
            ],
            Self::Ring {
                radius_outer,
                radius_inner,
                zspan,
                ..
            } => vec![
                ("radiusOuter", radius_outer),
                ("radiusInner", radius_inner),
                ("zspan", zspan),
            ],
            Self::Mesh { .. }
            | Self::Composite { .. }
            | Self::Lid { .. }
            | Self::Control(_)
            | Self::BondPoint(_) => Vec::new(),
        }
    }

    /// Its attributes besides parts and states: names and values, in the order of task files.
    pub fn attributes(&self) -> Vec<(&'static str, AttributeValue<'_>)> {
        use AttributeValue::{Color, Count, Number, Text};
        let spans = |names: [&'static str; 3], spans: Vec3| {
            let [x, y, z] = spans.to_array();
            names.into_iter().zip([x, y, z].map(Number))
        };
        let cuboid = |span| spans(["xspan", "yspan", "zspan"], span);
        match *self {
            Self::Block { span, color } | Self::Link { span, color, .. } => {
                cuboid(span).chain([("color", Color(color))]).collect()
            }
            Self::Cylinder {
                radius,
                yspan,
                color,
            } => vec![
                ("radius", Number(radius)),
                ("yspan", Number(yspan)),
                ("color", Color(color)),
            ],
            Self::Sphere { radius, color } => {
                vec![("radius", Number(radius)), ("color", Color(color))]
            }
            Self::Box {
                span,
                thickness,
                color,
            } => cuboid(span)
                .chain([("thickness", Number(thickness)), ("color", Color(color))])
                .collect(),
            Self::Prism {
                radius,
                yspan,
                sides,
                color,
            } => vec![
                ("radius", Number(radius)),
                ("yspan", Number(yspan)),
                ("sides", Count(sides)),
                ("color", Color(color)),
            ],
            Self::Frustum {
                radius_top,
                radius_bottom,
                zspan,
                sides,
                color,
            } => vec![
                ("radiusTop", Number(radius_top)),
                ("radiusBottom", Number(radius_bottom)),
                ("zspan", Number(zspan)),
                ("sides", Count(sides)),
                ("color", Color(color)),
            ],
            Self::Ring {
                radius_outer,
                radius_inner,
                zspan,
                sides,
                color,
            } => vec![
                ("radiusOuter", Number(radius_outer)),
                ("radiusInner", Number(radius_inner)),
                ("zspan", Number(zspan)),
                ("sides", Count(sides)),
                ("color", Color(color)),
            ],
            Self::Mesh { ref mesh, color } => vec![
                ("file", Text(mesh.file())),
                ("scale", Number(mesh.scale())),
                ("color", Color(color)),
            ],
            Self::Lid {
                span,
                color,
                handle_span,
                handle_thickness,
                handle_color,
            } => {
                let handle = spans(["handleXspan", "handleYspan", "handleZspan"], handle_span);
                cuboid(span)
                    .chain([("color", Color(color))])
                    .chain(handle)
                    .chain([
                        ("handleThickness", Number(handle_thickness)),
                        ("handleColor", Color(handle_color)),
                    ])
                    .collect()
            }
            Self::Composite { .. } | Self::Control(_) | Self::BondPoint(_) => Vec::new(),
        }
    }
}
