//! Scenes of task files, as the command line writes them.

mod mechanisms;
mod pose;

use std::io::Write;

use bevy::prelude::*;
use serde::Serialize;
use tabletop_core::{JointKind, ObjectSpec, Part, SceneSpec, Shape};
use tabletop_scene::{Assembly, IdAllocator, assemble};

use mechanisms::{BondDump, BondPointDump, ControlDump, bond_points, bonds, controls};
use pose::PoseDump;

/// Writes a scene as JSON: the table, every object with its parts, controls and bond points, the joints and bonds, with ids as they will be
/// on the table. Lengths in units, angles in degrees, colours as `#rrggbb`.
///
/// # Errors
///
/// An error of the writer.
pub fn write_dump(scene: &SceneSpec, mut out: impl Write) -> std::io::Result<()> {
    let assembly = assemble(scene, &mut IdAllocator::default());
    serde_json::to_writer_pretty(&mut out, &SceneDump::from(&assembly))?;
    writeln!(out)
}

#[derive(Serialize)]
struct SceneDump<'a> {
    table: TableDump,
    objects: Vec<ObjectDump<'a>>,
    joints: Vec<JointDump<'a>>,
    bonds: Vec<BondDump>,
}

#[derive(Serialize)]
struct TableDump {
    xspan: f32,
    yspan: f32,
}

#[derive(Serialize)]
struct ObjectDump<'a> {
    id: &'a str,
    #[serde(flatten)]
    pose: PoseDump,
    mass: f32,
    #[serde(skip_serializing_if = "Option::is_none")]
    friction: Option<f32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    restitution: Option<f32>,
    #[serde(rename = "linearVelocity", skip_serializing_if = "Option::is_none")]
    velocity: Option<[f32; 3]>,
    descriptions: Vec<DescriptionDump<'a>>,
    parts: Vec<PartDump>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    controls: Vec<ControlDump<'a>>,
    #[serde(rename = "bondPoints", skip_serializing_if = "Vec::is_empty")]
    bond_points: Vec<BondPointDump<'a>>,
}

#[derive(Serialize)]
struct DescriptionDump<'a> {
    name: &'a str,
    value: &'a str,
}

#[derive(Serialize)]
struct PartDump {
    id: String,
    #[serde(flatten)]
    shape: ShapeDump,
    color: String,
    #[serde(flatten)]
    pose: PoseDump,
}

#[derive(Serialize)]
#[serde(tag = "shape", rename_all = "lowercase")]
enum ShapeDump {
    Block {
        #[serde(flatten)]
        span: SpanDump,
    },
    Cylinder {
        radius: f32,
        yspan: f32,
        #[serde(skip_serializing_if = "Option::is_none")]
        sides: Option<u32>,
    },
    Sphere {
        radius: f32,
    },
    Frustum {
        #[serde(rename = "radiusTop")]
        radius_top: f32,
        #[serde(rename = "radiusBottom")]
        radius_bottom: f32,
        zspan: f32,
        sides: u32,
    },
    Ring {
        #[serde(rename = "radiusOuter")]
        radius_outer: f32,
        #[serde(rename = "radiusInner")]
        radius_inner: f32,
        zspan: f32,
        sides: u32,
    },
    Custom {
        file: String,
        scale: f32,
        triangles: usize,
        solids: usize,
    },
    Box {
        #[serde(flatten)]
        span: SpanDump,
        thickness: f32,
    },
}

#[derive(Serialize)]
struct SpanDump {
    xspan: f32,
    yspan: f32,
    zspan: f32,
}

#[derive(Serialize)]
struct JointDump<'a> {
    kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    limits: Option<[f32; 2]>,
    objects: &'a [String; 2],
    frames: [PoseDump; 2],
}

impl<'a> From<&'a Assembly> for SceneDump<'a> {
    fn from(assembly: &'a Assembly) -> Self {
        Self {
            table: TableDump {
                xspan: assembly.table.xspan,
                yspan: assembly.table.yspan,
            },
            objects: assembly.objects.iter().map(ObjectDump::from).collect(),
            joints: assembly
                .joints
                .iter()
                .map(|joint| {
                    let (kind, limits) = match joint.kind {
                        JointKind::Ball => ("ball", None),
                        JointKind::Fixed => ("fixed", None),
                        JointKind::Slider { min, max, .. } => ("slider", Some([min, max])),
                        JointKind::PushButton { travel, .. } => ("pushButton", Some([0.0, travel])),
                        JointKind::Shears { min, max } => {
                            ("shears", Some([min.to_degrees(), max.to_degrees()]))
                        }
                        JointKind::Hinge { min, max, .. } => {
                            ("hinge", Some([min.to_degrees(), max.to_degrees()]))
                        }
                    };
                    JointDump {
                        kind,
                        limits,
                        objects: &joint.objects,
                        frames: joint.frames.map(PoseDump::from),
                    }
                })
                .collect(),
            bonds: bonds(&assembly.objects),
        }
    }
}

impl<'a> From<&'a ObjectSpec> for ObjectDump<'a> {
    fn from(spec: &'a ObjectSpec) -> Self {
        Self {
            id: &spec.id,
            pose: spec.pose.into(),
            mass: spec.mass,
            descriptions: spec
                .all_descriptions()
                .into_iter()
                .map(|(name, value)| DescriptionDump { name, value })
                .collect(),
            friction: spec.dynamics.friction,
            restitution: spec.dynamics.restitution,
            velocity: (spec.dynamics.velocity != Vec3::ZERO)
                .then(|| spec.dynamics.velocity.to_array()),
            parts: spec
                .shape
                .simple_parts()
                .into_iter()
                .filter_map(dump_part)
                .collect(),
            controls: controls(spec),
            bond_points: bond_points(spec),
        }
    }
}

fn dump_part(part: Part) -> Option<PartDump> {
    let (shape, color) = match part.shape {
        Shape::Block { span, color } => (ShapeDump::Block { span: span.into() }, color),
        // As it is drawn.
        Shape::Link {
            span,
            padding,
            color,
        } => {
            let drawn = span + Vec3::Y * 2.0 * padding;
            (ShapeDump::Block { span: drawn.into() }, color)
        }
        Shape::Cylinder {
            radius,
            yspan,
            color,
        } => {
            let sides = None;
            (
                ShapeDump::Cylinder {
                    radius,
                    yspan,
                    sides,
                },
                color,
            )
        }
        Shape::Prism {
            radius,
            yspan,
            sides,
            color,
        } => {
            let sides = Some(sides);
            (
                ShapeDump::Cylinder {
                    radius,
                    yspan,
                    sides,
                },
                color,
            )
        }
        Shape::Sphere { radius, color } => (ShapeDump::Sphere { radius }, color),
        Shape::Frustum {
            radius_top,
            radius_bottom,
            zspan,
            sides,
            color,
        } => (
            ShapeDump::Frustum {
                radius_top,
                radius_bottom,
                zspan,
                sides,
            },
            color,
        ),
        Shape::Ring {
            radius_outer,
            radius_inner,
            zspan,
            sides,
            color,
        } => (
            ShapeDump::Ring {
                radius_outer,
                radius_inner,
                zspan,
                sides,
            },
            color,
        ),
        Shape::Mesh { mesh, color } => (
            ShapeDump::Custom {
                file: mesh.file().to_owned(),
                scale: mesh.scale(),
                triangles: mesh.surface().triangles().len(),
                solids: mesh.solids().len(),
            },
            color,
        ),
        Shape::Box {
            span,
            thickness,
            color,
        } => (
            ShapeDump::Box {
                span: span.into(),
                thickness,
            },
            color,
        ),
        Shape::Composite { .. } | Shape::Lid { .. } | Shape::Control(_) | Shape::BondPoint(_) => {
            return None;
        }
    };
    Some(PartDump {
        id: part.id,
        shape,
        color: color.to_string(),
        pose: part.pose.into(),
    })
}

impl From<Vec3> for SpanDump {
    fn from(span: Vec3) -> Self {
        Self {
            xspan: span.x,
            yspan: span.y,
            zspan: span.z,
        }
    }
}
