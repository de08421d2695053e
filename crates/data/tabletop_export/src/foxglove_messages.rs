//! Foxglove's messages, with the names and numbers of its schemas (github.com/foxglove/foxglove-sdk, `schemas/proto`), and Google's that they use.

use crate::protobuf::{
    Bytes, FieldValue, Int32, Message, message,
    schema::{EnumSchema, FieldSchema, ProtoKind, SchemaSet},
    wire::whole,
};

message! {
    Timestamp = "google.protobuf.Timestamp" {
        1 seconds: u64,
        2 nanos: Int32,
    }
}

message! {
    Duration = "google.protobuf.Duration" {
        1 seconds: u64,
        2 nanos: Int32,
    }
}

message! {
    CompressedImage = "foxglove.CompressedImage" {
        1 timestamp: Timestamp,
        4 frame_id: String,
        2 data: Bytes,
        3 format: String,
    }
}

message! {
    RawImage = "foxglove.RawImage" {
        1 timestamp: Timestamp,
        7 frame_id: String,
        2 width: u32,
        3 height: u32,
        4 encoding: String,
        5 step: u32,
        6 data: Bytes,
    }
}

message! {
    Vector3 = "foxglove.Vector3" {
        1 x: f64,
        2 y: f64,
        3 z: f64,
    }
}

message! {
    Point3 = "foxglove.Point3" {
        1 x: f64,
        2 y: f64,
        3 z: f64,
    }
}

message! {
    Quaternion = "foxglove.Quaternion" {
        1 x: f64,
        2 y: f64,
        3 z: f64,
        4 w: f64,
    }
}

message! {
    Pose = "foxglove.Pose" {
        1 position: Vector3,
        2 orientation: Quaternion,
    }
}

message! {
    Color = "foxglove.Color" {
        1 r: f64,
        2 g: f64,
        3 b: f64,
        4 a: f64,
    }
}

message! {
    FrameTransform = "foxglove.FrameTransform" {
        1 timestamp: Timestamp,
        2 parent_frame_id: String,
        3 child_frame_id: String,
        4 translation: Vector3,
        5 rotation: Quaternion,
    }
}

message! {
    FrameTransforms = "foxglove.FrameTransforms" {
        1 transforms: Vec<FrameTransform>,
    }
}

/// The kind of deletion: of the entity with the id.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MatchingId;

impl FieldValue for MatchingId {
    const KIND: ProtoKind = ProtoKind::Enum("foxglove.SceneEntityDeletion.Type");

    fn write(&self, number: u32, to: &mut Vec<u8>) {
        whole(to, number, 0);
    }
}

message! {
    SceneEntityDeletion = "foxglove.SceneEntityDeletion" {
        1 timestamp: Timestamp,
        2 r#type: MatchingId,
        3 id: String,
    }
    &[("Type", &[("MATCHING_ID", 0), ("ALL", 1)])]
}

message! {
    KeyValuePair = "foxglove.KeyValuePair" {
        1 key: String,
        2 value: String,
    }
}

message! {
    ArrowPrimitive = "foxglove.ArrowPrimitive" {
        1 pose: Pose,
        2 shaft_length: f64,
        3 shaft_diameter: f64,
        4 head_length: f64,
        5 head_diameter: f64,
        6 color: Color,
    }
}

message! {
    CubePrimitive = "foxglove.CubePrimitive" {
        1 pose: Pose,
        2 size: Vector3,
        3 color: Color,
    }
}

message! {
    SpherePrimitive = "foxglove.SpherePrimitive" {
        1 pose: Pose,
        2 size: Vector3,
        3 color: Color,
    }
}

message! {
    CylinderPrimitive = "foxglove.CylinderPrimitive" {
        1 pose: Pose,
        2 size: Vector3,
        3 bottom_scale: f64,
        4 top_scale: f64,
        5 color: Color,
    }
}

/// The kind of line: a strip.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LineStrip;

impl FieldValue for LineStrip {
    const KIND: ProtoKind = ProtoKind::Enum("foxglove.LinePrimitive.Type");

    fn write(&self, number: u32, to: &mut Vec<u8>) {
        whole(to, number, 0);
    }
}

message! {
    LinePrimitive = "foxglove.LinePrimitive" {
        1 r#type: LineStrip,
        2 pose: Pose,
        3 thickness: f64,
        4 scale_invariant: bool,
        5 points: Vec<Point3>,
        6 color: Color,
        7 colors: Vec<Color>,
        8 indices: Vec<u32>,
    }
    &[("Type", &[("LINE_STRIP", 0), ("LINE_LOOP", 1), ("LINE_LIST", 2)])]
}

message! {
    TextPrimitive = "foxglove.TextPrimitive" {
        1 pose: Pose,
        2 billboard: bool,
        3 font_size: f64,
        4 scale_invariant: bool,
        5 color: Color,
        6 text: String,
    }
}

message! {
    ModelPrimitive = "foxglove.ModelPrimitive" {
        1 pose: Pose,
        2 scale: Vector3,
        3 color: Color,
        4 override_color: bool,
        5 url: String,
        6 media_type: String,
        7 data: Bytes,
    }
}

message! {
    TriangleListPrimitive = "foxglove.TriangleListPrimitive" {
        1 pose: Pose,
        2 points: Vec<Point3>,
        3 color: Color,
        4 colors: Vec<Color>,
        5 indices: Vec<u32>,
    }
}

message! {
    SceneEntity = "foxglove.SceneEntity" {
        1 timestamp: Timestamp,
        2 frame_id: String,
        3 id: String,
        4 lifetime: Duration,
        5 frame_locked: bool,
        6 metadata: Vec<KeyValuePair>,
        7 arrows: Vec<ArrowPrimitive>,
        8 cubes: Vec<CubePrimitive>,
        9 spheres: Vec<SpherePrimitive>,
        10 cylinders: Vec<CylinderPrimitive>,
        11 lines: Vec<LinePrimitive>,
        12 triangles: Vec<TriangleListPrimitive>,
        13 texts: Vec<TextPrimitive>,
        14 models: Vec<ModelPrimitive>,
    }
}

message! {
    SceneUpdate = "foxglove.SceneUpdate" {
        1 deletions: Vec<SceneEntityDeletion>,
        2 entities: Vec<SceneEntity>,
    }
}

/// The level of a line that only informs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LogInfo;

impl FieldValue for LogInfo {
    const KIND: ProtoKind = ProtoKind::Enum("foxglove.Log.Level");

    fn write(&self, number: u32, to: &mut Vec<u8>) {
        whole(to, number, 2);
    }
}

message! {
    Log = "foxglove.Log" {
        1 timestamp: Timestamp,
        2 level: LogInfo,
        3 message: String,
        4 name: String,
        5 file: String,
        6 line: u32,
    }
    &[(
        "Level",
        &[("UNKNOWN", 0), ("DEBUG", 1), ("INFO", 2), ("WARNING", 3), ("ERROR", 4), ("FATAL", 5)],
    )]
}
