//! Demonstrations: the objects, their motions, and the acts of the hands that a recording shows.

use std::collections::BTreeMap;

use bevy::math::Vec3;
use tabletop_core::{Hand, JointSpec, ObjectSpec, Pose, Rgb, Shape, SimTick, Table};
use tabletop_recorder::{Occurrence, RecordedSegment, RecorderError, RecordingReader};

use crate::{
    arrangement::Arrangement,
    operation::{Operation, OperationDeed},
    track::Track,
};

/// The part of a recording that a task is inferred from.
#[derive(Clone, Debug, Default)]
pub struct Demonstration {
    /// The table.
    pub table: Table,
    /// The objects, in the order of their creation.
    pub objects: Vec<ShownObject>,
    /// Joints between objects.
    pub joints: Vec<JointSpec>,
    /// Acts of the hands, in order.
    pub acts: Vec<HandAct>,
    /// Objects that were operated, pointed to, fastened and loosened, in order.
    pub operations: Vec<Operation>,
    /// The first tick.
    pub start: SimTick,
    /// The last tick.
    pub end: SimTick,
}

/// An object of a demonstration.
#[derive(Clone, Debug)]
pub struct ShownObject {
    /// Its description, with its first pose.
    pub spec: ObjectSpec,
    /// Its poses.
    pub track: Track,
    /// The tick in which it appeared.
    pub created: SimTick,
    /// The tick in which it disappeared, if it did.
    pub deleted: Option<SimTick>,
}

/// An act of a hand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HandAct {
    /// The tick.
    pub tick: SimTick,
    /// The hand.
    pub hand: Hand,
    /// The kind of act.
    pub deed: HandDeed,
}

/// A kind of act of a hand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum HandDeed {
    /// It grasps an object.
    Grasp(String),
    /// It releases the held object.
    Release,
    /// It removes the held object from the world.
    Destroy,
}

impl Demonstration {
    /// The demonstration of a recording.
    ///
    /// # Errors
    /// A file cannot be read, or has a line that no recorder writes; the error names the file.
    pub fn of(recording: &RecordingReader) -> Result<Self, RecorderError> {
        let scene = &recording.session().scene;
        let mut shown = Self {
            table: scene.table.unwrap_or_default(),
            joints: scene.joints.clone(),
            start: recording.first_tick(),
            end: recording.last_tick(),
            ..Self::default()
        };
        for object in &scene.objects {
            let mut spec = object.spec.clone();
            spec.pose = object.pose;
            shown.add(spec, recording.first_tick());
        }
        let rows = recording.states()?;
        shown.follow(
            &recording.segments()?,
            recording.header().ticks_per_frame,
            rows.is_empty(),
        );
        for row in rows {
            if let Some(object) = shown.named_mut(&row.id) {
                object.track.push(row.tick, row.pose);
            }
        }
        Ok(shown)
    }

    /// The object of this id.
    pub fn named(&self, id: &str) -> Option<&ShownObject> {
        self.objects.iter().find(|object| object.spec.id == id)
    }

    fn named_mut(&mut self, id: &str) -> Option<&mut ShownObject> {
        self.objects.iter_mut().find(|object| object.spec.id == id)
    }

    /// The arrangement of all present objects at the end of a tick.
    pub(crate) fn at(&self, tick: SimTick) -> Arrangement {
        let there = self.objects.iter().filter(|object| {
            object.created <= tick && object.deleted.is_none_or(|deleted| tick < deleted)
        });
        Arrangement::new(there.filter_map(|object| {
            let pose = object.track.at(tick)?;
            Some((object.spec.id.as_str(), &object.spec.shape, pose))
        }))
    }

    fn add(&mut self, spec: ObjectSpec, created: SimTick) {
        self.objects.push(ShownObject {
            track: Track::default(),
            created,
            deleted: None,
            spec,
        });
    }

    /// Follows the events; their moves only if `moves` is true, for want of anything better.
    pub(crate) fn follow(
        &mut self,
        segments: &[RecordedSegment],
        ticks_per_frame: u64,
        moves: bool,
    ) {
        for segment in segments {
            // An act shows in the first frame after it. For the first frame, the tick of the act itself is known.
            let mut begun = segment.act.is_some();
            for event in &segment.events {
                let shown = SimTick(self.start.0 + event.frame * ticks_per_frame);
                let does = !matches!(
                    event.what,
                    Occurrence::Create { .. }
                        | Occurrence::Delete { .. }
                        | Occurrence::Move { .. }
                        | Occurrence::InitializeControl { .. }
                        | Occurrence::ChangeControlState { .. }
                );
                let tick = match does && std::mem::take(&mut begun) {
                    true => segment.start,
                    false => shown,
                };
                let mut act = |hand, deed| self.acts.push(HandAct { tick, hand, deed });
                let mut operate = |deed| {
                    let states = Vec::new();
                    self.operations.push(Operation { tick, deed, states });
                };
                match &event.what {
                    Occurrence::Create { id, properties } => match self.named_mut(id) {
                        Some(known) => known.deleted = None,
                        None => self.add(spec_of(id, properties), shown),
                    },
                    Occurrence::Delete { id } => {
                        if let Some(object) = self.named_mut(id) {
                            object.deleted = Some(
                                segment
                                    .start
                                    .max(SimTick(shown.0.saturating_sub(ticks_per_frame))),
                            );
                        }
                    }
                    Occurrence::Move {
                        id,
                        location,
                        degrees,
                    } if moves => {
                        if let Some(object) = self.named_mut(id) {
                            let pose = Pose::from_degrees(*location, *degrees);
                            object.track.push(shown, pose);
                        }
                    }
                    Occurrence::Move { .. } => {}
                    Occurrence::Grasp { hand, id } => act(*hand, HandDeed::Grasp(id.clone())),
                    Occurrence::Release { hand } => act(*hand, HandDeed::Release),
                    Occurrence::Destroy { hand } => act(*hand, HandDeed::Destroy),
                    Occurrence::ChangeControlState { control, state } => {
                        if let Some(operation) = self.operations.last_mut() {
                            operation.states.push((control.clone(), state.clone()));
                        }
                    }
                    Occurrence::Trigger { control, .. } => {
                        let control = control.clone();
                        operate(OperationDeed::Trigger { control });
                    }
                    Occurrence::PointTo { part, .. } => {
                        let part = part.clone();
                        operate(OperationDeed::PointTo { part });
                    }
                    Occurrence::Fasten { bond, .. } => {
                        operate(OperationDeed::Fasten(bond.clone()));
                    }
                    Occurrence::Loosen { bond, .. } => {
                        operate(OperationDeed::Loosen(bond.clone()));
                    }
                    Occurrence::Cut { link, .. } => {
                        let link = link.clone();
                        operate(OperationDeed::Cut { link });
                    }
                    Occurrence::InitializeControl { .. } => {}
                }
            }
        }
    }
}

/// The object that the properties of a recording describe.
fn spec_of(id: &str, properties: &[(String, String)]) -> ObjectSpec {
    let known: BTreeMap<&str, &str> = properties
        .iter()
        .map(|(name, value)| (name.as_str(), value.as_str()))
        .collect();
    let number = |name: &str| known.get(name).and_then(|value| value.parse::<f32>().ok());
    let length = |name: &str| number(name).unwrap_or(1.0);
    let span = Vec3::new(length("xspan"), length("yspan"), length("zspan"));
    let color = known.get("color").and_then(|color| {
        // The original writes some colours with eight digits.
        color.get(..7).unwrap_or(color).parse().ok()
    });
    let color = color.unwrap_or(Rgb::GRAY);
    let thickness = number("thickness").unwrap_or(0.05);
    let radius = number("radius").unwrap_or(0.5);
    // The original calls a ball a cylinder, and a cylinder's length `zspan`.
    let yspan = number("yspan").or(number("zspan"));
    let sides = known.get("sides").and_then(|sides| sides.parse().ok());
    let sides = sides.unwrap_or(32);
    let shape = match (known.get("shape").copied().unwrap_or_default(), yspan) {
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
        ("sphere" | "cylinder", _) => Shape::Sphere { radius, color },
        ("lid", _) => Shape::Lid {
            span: span.with_z(thickness),
            color,
            handle_span: Vec3::new(
                length("handleXspan"),
                length("handleYspan"),
                length("handleZspan"),
            ),
            handle_thickness: number("handleThickness").unwrap_or(thickness),
            handle_color: color,
        },
        _ => Shape::Composite { parts: Vec::new() },
    };
    let mass = number("mass").unwrap_or(1.0);
    let mut spec = ObjectSpec::new(id, Pose::IDENTITY, mass, shape);
    spec.dynamics.friction = number("friction");
    spec.dynamics.restitution = number("restitution");
    let geometry = [
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
    spec.descriptions = properties
        .iter()
        .filter(|(name, _)| !geometry.contains(&name.as_str()))
        .cloned()
        .collect();
    spec
}
