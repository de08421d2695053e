//! MCAP: a file an episode, with messages of Foxglove's JSON schemas.

use std::{collections::BTreeMap, f32::consts::FRAC_PI_2, fmt::Display, io::Cursor};

use base64::{Engine as _, engine::general_purpose::STANDARD};
use bevy::math::Quat;
use mcap::{McapError, WriteOptions, Writer, records::MessageHeader};
use serde_json::{Value, json};
use tabletop_core::{SimTick, TICKS_PER_SECOND};
use tabletop_geometry::{Pose, Primitive, Solid};

use crate::{
    episode::{CameraTrack, ObjectTrack, TrainingEpisode},
    episode_files::{EpisodeFile, EpisodeFiles},
};

/// Metres per unit.
const METERS: f32 = 0.1;

/// A folder with an MCAP file an episode, for Foxglove and Rerun: pictures, transforms, shapes, joints and sentences. Lengths in metres.
pub type Mcap = EpisodeFiles<McapFile>;

/// An MCAP file.
#[derive(Debug)]
pub struct McapFile;

impl EpisodeFile for McapFile {
    const EXTENSION: &'static str = "mcap";

    fn content(episode: &TrainingEpisode) -> Result<Vec<u8>, impl Display> {
        file_of(episode)
    }
}

/// A topic whose messages are JSON.
struct Topic {
    channel: u16,
    sequence: u32,
}

/// A file that is being written.
struct File(Writer<Cursor<Vec<u8>>>);

impl File {
    fn topic(&mut self, name: &str, schema: &str) -> Result<Topic, McapError> {
        let text = json!({ "type": "object", "title": schema }).to_string();
        let schema = self.0.add_schema(schema, "jsonschema", text.as_bytes())?;
        let channel = self.0.add_channel(schema, name, "json", &BTreeMap::new())?;
        Ok(Topic {
            channel,
            sequence: 0,
        })
    }

    fn say(&mut self, topic: &mut Topic, tick: SimTick, message: &Value) -> Result<(), McapError> {
        let time = nanoseconds(tick);
        let header = MessageHeader {
            channel_id: topic.channel,
            sequence: topic.sequence,
            log_time: time,
            publish_time: time,
        };
        topic.sequence += 1;
        self.0
            .write_to_known_channel(&header, message.to_string().as_bytes())
    }
}

fn nanoseconds(tick: SimTick) -> u64 {
    tick.0 * 1_000_000_000 / u64::from(TICKS_PER_SECOND)
}

fn stamp(tick: SimTick) -> Value {
    let time = nanoseconds(tick);
    json!({ "sec": time / 1_000_000_000, "nsec": time % 1_000_000_000 })
}

fn file_of(episode: &TrainingEpisode) -> Result<Vec<u8>, McapError> {
    // Pictures are compressed already.
    let options = WriteOptions::new().compression(None).library("tabletop");
    let mut file = File(options.create(Cursor::new(Vec::new()))?);
    let mut cameras = Vec::new();
    let mut raw = Vec::new();
    for camera in &episode.cameras {
        let name = format!("/camera/{}", camera.name);
        cameras.push((camera, file.topic(&name, "foxglove.CompressedImage")?));
        for channel in [RawChannel::Depth, RawChannel::Ids] {
            if channel.is_in(camera) {
                let topic =
                    file.topic(&format!("{name}/{}", channel.name()), "foxglove.RawImage")?;
                raw.push((camera, channel, topic));
            }
        }
    }
    let mut transforms = file.topic("/tf", "foxglove.FrameTransforms")?;
    let mut scene = file.topic("/scene", "foxglove.SceneUpdate")?;
    let mut log = file.topic("/log", "foxglove.Log")?;
    let mut states = file.topic("/state", "tabletop.Signal")?;
    let mut actions = file.topic("/action", "tabletop.Signal")?;
    let mut parts = episode.subtasks.iter().peekable();
    for (frame, &tick) in episode.ticks.iter().enumerate() {
        for (camera, topic) in &mut cameras {
            let data = STANDARD.encode(&camera.images[frame].png);
            let picture = json!({
                "timestamp": stamp(tick), "frame_id": camera.name, "format": "png", "data": data,
            });
            file.say(topic, tick, &picture)?;
        }
        for (camera, channel, topic) in &mut raw {
            let image = &camera.images[frame];
            let data = STANDARD.encode(channel.bytes(camera, frame));
            let picture = json!({
                "timestamp": stamp(tick), "frame_id": camera.name, "width": image.width,
                "height": image.height, "encoding": "16UC1", "step": image.width * 2, "data": data,
            });
            file.say(topic, tick, &picture)?;
        }
        let moved: Vec<_> = episode
            .objects
            .iter()
            .filter_map(|object| {
                let Pose { location, rotation } = object.poses[frame]?;
                Some(json!({
                    "timestamp": stamp(tick), "parent_frame_id": "table",
                    "child_frame_id": object.spec.id,
                    "translation": vector((location * METERS).to_array()),
                    "rotation": quaternion(rotation.to_array()),
                }))
            })
            .collect();
        file.say(&mut transforms, tick, &json!({ "transforms": moved }))?;
        let appear = |object: &&ObjectTrack| {
            object.poses[frame].is_some() && (frame == 0 || object.poses[frame - 1].is_none())
        };
        let gone = |object: &&ObjectTrack| {
            object.poses[frame].is_none() && frame > 0 && object.poses[frame - 1].is_some()
        };
        let entities: Vec<_> = episode
            .objects
            .iter()
            .filter(appear)
            .map(|object| entity(object, tick))
            .collect();
        let deletions: Vec<_> = episode
            .objects
            .iter()
            .filter(gone)
            .map(|object| json!({ "timestamp": stamp(tick), "type": 0, "id": object.spec.id }))
            .collect();
        if !entities.is_empty() || !deletions.is_empty() {
            let update = json!({ "entities": entities, "deletions": deletions });
            file.say(&mut scene, tick, &update)?;
        }
        while let Some(part) = parts.next_if(|part| part.frame <= frame) {
            let line = json!({
                "timestamp": stamp(tick), "level": 2, "message": part.sentence,
                "name": "task", "file": "", "line": 0,
            });
            file.say(&mut log, tick, &line)?;
        }
        for (signal, topic) in [
            (&episode.state, &mut states),
            (&episode.action, &mut actions),
        ] {
            let width = signal.names.len();
            let numbers = &signal.values[frame * width..][..width];
            let numbers: serde_json::Map<_, _> = signal
                .names
                .iter()
                .zip(numbers)
                .map(|(name, number)| (name.clone(), json!(number)))
                .collect();
            file.say(topic, tick, &Value::Object(numbers))?;
        }
    }
    file.0.finish()?;
    Ok(file.0.into_inner().into_inner())
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

/// An object that is drawn in its own frame from now on.
fn entity(object: &ObjectTrack, tick: SimTick) -> Value {
    let (mut cubes, mut spheres, mut cylinders, mut triangles) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for Primitive { pose, solid, color } in object.spec.shape.drawn() {
        let [r, g, b] = color.to_bytes().map(|value| f32::from(value) / 255.0);
        let color = json!({ "r": r, "g": g, "b": b, "a": 1.0 });
        let placed = |Pose { location, rotation }: Pose| {
            json!({
                "position": vector((location * METERS).to_array()),
                "orientation": quaternion(rotation.to_array()),
            })
        };
        match solid {
            Solid::Cuboid(span) => cubes.push(json!({
                "pose": placed(pose), "size": vector((span * METERS).to_array()), "color": color,
            })),
            Solid::Ball(radius) => {
                let size = vector([2.0 * radius * METERS; 3]);
                spheres.push(json!({ "pose": placed(pose), "size": size, "color": color }));
            }
            Solid::Cylinder { radius, yspan } => {
                // Theirs stand along Z, ours along Y.
                let upright = Quat::from_rotation_x(FRAC_PI_2);
                let turned = Pose::new(pose.location, pose.rotation * upright);
                let size = vector([2.0 * radius * METERS, 2.0 * radius * METERS, yspan * METERS]);
                cylinders.push(json!({
                    "pose": placed(turned), "size": size, "bottom_scale": 1.0, "top_scale": 1.0,
                    "color": color,
                }));
            }
            Solid::Polyhedron(polyhedron) => {
                let points: Vec<_> = polyhedron
                    .corners()
                    .iter()
                    .map(|corner| vector((*corner * METERS).to_array()))
                    .collect();
                let indices: Vec<_> = polyhedron.triangles().iter().flatten().collect();
                triangles.push(json!({
                    "pose": placed(pose), "points": points, "color": color, "colors": [],
                    "indices": indices,
                }));
            }
        }
    }
    json!({
        "timestamp": stamp(tick), "frame_id": object.spec.id, "id": object.spec.id,
        "lifetime": { "sec": 0, "nsec": 0 }, "frame_locked": true, "metadata": [],
        "arrows": [], "cubes": cubes, "spheres": spheres, "cylinders": cylinders, "lines": [],
        "triangles": triangles, "texts": [], "models": [],
    })
}

fn vector([x, y, z]: [f32; 3]) -> Value {
    json!({ "x": x, "y": y, "z": z })
}

fn quaternion([x, y, z, w]: [f32; 4]) -> Value {
    json!({ "x": x, "y": y, "z": z, "w": w })
}
