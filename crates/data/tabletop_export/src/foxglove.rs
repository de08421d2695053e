//! MCAP: a file an episode, with Foxglove's messages in Protocol Buffers, which Rerun reads, too.

use std::{collections::BTreeMap, f32::consts::FRAC_PI_2, fmt::Display, io::Cursor};

use bevy::math::{Quat, Vec3};
use mcap::{McapError, WriteOptions, Writer, records::MessageHeader};
use tabletop_core::{SimTick, TICKS_PER_SECOND};
use tabletop_geometry::{self as geometry, Primitive, Solid};
use tabletop_training::{CameraTrack, FrameVectors, ObjectTrack, TrainingEpisode};

use crate::{
    episode_files::{EpisodeFile, EpisodeFiles},
    foxglove_messages::{
        Color, CompressedImage, CubePrimitive, CylinderPrimitive, FrameTransform, FrameTransforms,
        Log, LogInfo, MatchingId, Point3, Pose, Quaternion, RawImage, SceneEntity,
        SceneEntityDeletion, SceneUpdate, SpherePrimitive, Timestamp, TriangleListPrimitive,
        Vector3,
    },
    protobuf::{Bytes, Int32, Message, schema::SchemaSet},
    signal_message::SignalMessage,
};

/// Metres per unit.
const METERS: f32 = 0.1;

/// A folder with an MCAP file an episode, for Foxglove and Rerun: pictures, transforms, shapes, joints and sentences. Lengths in metres.
pub type Mcap = EpisodeFiles<McapFile>;

/// An MCAP file.
#[derive(Debug)]
pub struct McapFile;

impl EpisodeFile for McapFile {
    const ENDING: &'static str = ".mcap";

    fn content(episode: &TrainingEpisode) -> Result<Vec<u8>, impl Display> {
        file_of(episode)
    }
}

/// A topic with messages of one schema.
struct Topic {
    channel: u16,
    sequence: u32,
}

/// A file that is being written.
struct File(Writer<Cursor<Vec<u8>>>);

impl File {
    /// A topic with messages of a type.
    fn topic<M: Message>(&mut self, name: &str) -> Result<Topic, McapError> {
        let mut schemas = SchemaSet::default();
        M::add_schema(&mut schemas);
        self.topic_of(name, M::NAME, &schemas)
    }

    fn topic_of(
        &mut self,
        name: &str,
        schema: &str,
        schemas: &SchemaSet,
    ) -> Result<Topic, McapError> {
        let schema = self.0.add_schema(schema, "protobuf", &schemas.to_bytes())?;
        let channel = self
            .0
            .add_channel(schema, name, "protobuf", &BTreeMap::new())?;
        Ok(Topic {
            channel,
            sequence: 0,
        })
    }

    fn say(&mut self, topic: &mut Topic, tick: SimTick, message: &[u8]) -> Result<(), McapError> {
        let time = nanoseconds(tick);
        let header = MessageHeader {
            channel_id: topic.channel,
            sequence: topic.sequence,
            log_time: time,
            publish_time: time,
        };
        topic.sequence += 1;
        self.0.write_to_known_channel(&header, message)
    }
}

fn nanoseconds(tick: SimTick) -> u64 {
    tick.0 * 1_000_000_000 / u64::from(TICKS_PER_SECOND)
}

fn stamp(tick: SimTick) -> Timestamp {
    let time = nanoseconds(tick);
    Timestamp {
        seconds: time / 1_000_000_000,
        nanos: Int32((time % 1_000_000_000) as u32),
    }
}

fn file_of(episode: &TrainingEpisode) -> Result<Vec<u8>, McapError> {
    // Pictures are compressed already.
    let options = WriteOptions::new().compression(None).library("tabletop");
    let mut file = File(options.create(Cursor::new(Vec::new()))?);
    let mut cameras = Vec::new();
    let mut raw = Vec::new();
    for camera in &episode.cameras {
        let name = format!("/camera/{}", camera.name);
        cameras.push((camera, file.topic::<CompressedImage>(&name)?));
        for channel in [RawChannel::Depth, RawChannel::Ids] {
            if channel.is_in(camera) {
                let topic = file.topic::<RawImage>(&format!("{name}/{}", channel.name()))?;
                raw.push((camera, channel, topic));
            }
        }
    }
    let mut transforms = file.topic::<FrameTransforms>("/tf")?;
    let mut scene = file.topic::<SceneUpdate>("/scene")?;
    let mut log = file.topic::<Log>("/log")?;
    let state = episode.whole_state();
    let mut signals = Vec::new();
    for (topic, name, signal) in [
        ("/state", "tabletop.State", &state),
        ("/action", "tabletop.Action", &episode.action),
    ] {
        let message = SignalMessage::new(name, signal);
        let topic = file.topic_of(topic, name, &message.schemas())?;
        signals.push((signal, message, topic));
    }
    let mut parts = episode.subtasks.iter().peekable();
    for (frame, &tick) in episode.ticks.iter().enumerate() {
        for (camera, topic) in &mut cameras {
            file.say(topic, tick, &picture(camera, frame, tick).to_bytes())?;
        }
        for (camera, channel, topic) in &mut raw {
            file.say(topic, tick, &channel.image(camera, frame, tick).to_bytes())?;
        }
        let placed = episode.objects.iter();
        let placed = placed.filter_map(|object| transform(object, frame, tick));
        let message = FrameTransforms {
            transforms: placed.collect(),
        };
        file.say(&mut transforms, tick, &message.to_bytes())?;
        if let Some(update) = scene_update(&episode.objects, frame, tick) {
            file.say(&mut scene, tick, &update.to_bytes())?;
        }
        while let Some(part) = parts.next_if(|part| part.frame <= frame) {
            let line = Log {
                timestamp: stamp(tick),
                level: LogInfo,
                message: part.sentence.clone(),
                name: "task".into(),
                ..Log::default()
            };
            file.say(&mut log, tick, &line.to_bytes())?;
        }
        for (signal, message, topic) in &mut signals {
            file.say(topic, tick, &message.of(numbers_at(signal, frame)))?;
        }
    }
    file.0.finish()?;
    Ok(file.0.into_inner().into_inner())
}

/// The numbers of a frame.
fn numbers_at(signal: &FrameVectors, frame: usize) -> &[f32] {
    let width = signal.names.len();
    &signal.values[frame * width..][..width]
}

fn picture(camera: &CameraTrack, frame: usize, tick: SimTick) -> CompressedImage {
    CompressedImage {
        timestamp: stamp(tick),
        frame_id: camera.name.clone(),
        data: Bytes(camera.images[frame].png.clone()),
        format: "png".into(),
    }
}

/// Values of pixels beside a picture, in 16 bits.
#[derive(Clone, Copy)]
enum RawChannel {
    /// Distances, in mm.
    Depth,
    /// The numbers of things.
    Ids,
}

impl RawChannel {
    const fn name(self) -> &'static str {
        match self {
            Self::Depth => "depth",
            Self::Ids => "ids",
        }
    }

    const fn is_in(self, camera: &CameraTrack) -> bool {
        match self {
            Self::Depth => !camera.depths.is_empty(),
            Self::Ids => !camera.ids.is_empty(),
        }
    }

    fn image(self, camera: &CameraTrack, frame: usize, tick: SimTick) -> RawImage {
        let image = &camera.images[frame];
        RawImage {
            timestamp: stamp(tick),
            frame_id: camera.name.clone(),
            width: image.width,
            height: image.height,
            encoding: "16UC1".into(),
            step: image.width * 2,
            data: Bytes(self.bytes(camera, frame)),
        }
    }

    /// The values of a frame's pixels, the lower byte first.
    fn bytes(self, camera: &CameraTrack, frame: usize) -> Vec<u8> {
        match self {
            Self::Depth => {
                let depths = camera.depths[frame].iter();
                let millimeters = depths.map(|depth| (depth * 1000.0).round() as u16);
                millimeters.flat_map(u16::to_le_bytes).collect()
            }
            Self::Ids => camera.ids[frame]
                .iter()
                .copied()
                .flat_map(u16::to_le_bytes)
                .collect(),
        }
    }
}

/// The place of an object, while it is there.
fn transform(object: &ObjectTrack, frame: usize, tick: SimTick) -> Option<FrameTransform> {
    let geometry::Pose { location, rotation } = object.poses[frame]?;
    Some(FrameTransform {
        timestamp: stamp(tick),
        parent_frame_id: "table".into(),
        child_frame_id: object.spec.id.clone(),
        translation: vector(location * METERS),
        rotation: quaternion(rotation),
    })
}

/// The objects that have come and gone since the frame before, if there are any.
fn scene_update(objects: &[ObjectTrack], frame: usize, tick: SimTick) -> Option<SceneUpdate> {
    let was_there = |object: &ObjectTrack| frame > 0 && object.poses[frame - 1].is_some();
    let is_there = |object: &ObjectTrack| object.poses[frame].is_some();
    let appear = objects.iter().filter(|it| is_there(it) && !was_there(it));
    let gone = objects.iter().filter(|it| !is_there(it) && was_there(it));
    let update = SceneUpdate {
        entities: appear.map(|object| entity(object, tick)).collect(),
        deletions: gone.map(|object| deletion(object, tick)).collect(),
    };
    (!update.entities.is_empty() || !update.deletions.is_empty()).then_some(update)
}

fn deletion(object: &ObjectTrack, tick: SimTick) -> SceneEntityDeletion {
    SceneEntityDeletion {
        timestamp: stamp(tick),
        r#type: MatchingId,
        id: object.spec.id.clone(),
    }
}

/// An object that is drawn in its own frame from now on.
fn entity(object: &ObjectTrack, tick: SimTick) -> SceneEntity {
    let mut entity = SceneEntity {
        timestamp: stamp(tick),
        frame_id: object.spec.id.clone(),
        id: object.spec.id.clone(),
        frame_locked: true,
        ..SceneEntity::default()
    };
    for Primitive { pose, solid, color } in object.spec.shape.drawn() {
        let [r, g, b] = color.to_bytes().map(|value| f64::from(value) / 255.0);
        let color = Color { r, g, b, a: 1.0 };
        match solid {
            Solid::Cuboid(span) => entity.cubes.push(CubePrimitive {
                pose: placed(pose),
                size: vector(span * METERS),
                color,
            }),
            Solid::Ball(radius) => entity.spheres.push(SpherePrimitive {
                pose: placed(pose),
                size: vector(Vec3::splat(2.0 * radius * METERS)),
                color,
            }),
            Solid::Cylinder { radius, yspan } => {
                // Theirs stand along Z, ours along Y.
                let upright = Quat::from_rotation_x(FRAC_PI_2);
                let turned = geometry::Pose::new(pose.location, pose.rotation * upright);
                let size = Vec3::new(2.0 * radius, 2.0 * radius, yspan) * METERS;
                entity.cylinders.push(CylinderPrimitive {
                    pose: placed(turned),
                    size: vector(size),
                    bottom_scale: 1.0,
                    top_scale: 1.0,
                    color,
                });
            }
            Solid::Polyhedron(polyhedron) => {
                let point = |corner: &Vec3| {
                    let Vector3 { x, y, z } = vector(*corner * METERS);
                    Point3 { x, y, z }
                };
                entity.triangles.push(TriangleListPrimitive {
                    pose: placed(pose),
                    points: polyhedron.corners().iter().map(point).collect(),
                    color,
                    colors: Vec::new(),
                    indices: polyhedron.triangles().iter().flatten().copied().collect(),
                });
            }
        }
    }
    entity
}

fn placed(pose: geometry::Pose) -> Pose {
    Pose {
        position: vector(pose.location * METERS),
        orientation: quaternion(pose.rotation),
    }
}

fn vector(vector: Vec3) -> Vector3 {
    let [x, y, z] = vector.to_array().map(f64::from);
    Vector3 { x, y, z }
}

fn quaternion(rotation: Quat) -> Quaternion {
    let [x, y, z, w] = rotation.to_array().map(f64::from);
    Quaternion { x, y, z, w }
}
