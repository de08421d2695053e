//! Other knowledge of the objects of a recording whose events do not tell all.

use bevy::math::Vec3;
use tabletop_core::{JointKind, JointSpec, ObjectSpec, Shape};
use tabletop_geometry::{PlacedSolid, Pose, Rgb};

use crate::demonstration::{Demonstration, ShownObject};

/// Other knowledge of the objects of a recording: the task file that was on the table.
#[derive(Clone, Debug, Default)]
pub struct Furniture {
    /// The objects.
    pub objects: Vec<ObjectSpec>,
    /// Joints between them.
    pub joints: Vec<JointSpec>,
}

impl Demonstration {
    /// Completes properties that the events do not tell from the furniture, and guesses the rest.
    pub(crate) fn furnish(&mut self, furniture: &Furniture) {
        for object in self.objects.iter_mut().filter(|object| object.is_guessed) {
            let mut like = furniture.objects.iter();
            if let Some(like) = like.find(|like| like.id == object.spec.id) {
                object.spec.shape = like.shape.clone();
                object.spec.mass = like.mass;
                object.is_guessed = false;
            }
        }
        self.guess_sizes();
        let is_there = |joint: &&JointSpec| joint.objects.iter().all(|id| self.named(id).is_some());
        self.joints = furniture.joints.iter().filter(is_there).cloned().collect();
        if self.joints.is_empty() {
            self.joints = self.lids();
        }
    }

    /// Guesses that an object of unknown size is as wide as it is high above the table, or above the known object below it.
    fn guess_sizes(&mut self) {
        let first = |object: &ShownObject| object.track.at(self.start);
        let mut guessed: Vec<_> = (0..self.objects.len())
            .filter(|&i| self.objects[i].is_guessed)
            .filter_map(|i| Some((i, first(&self.objects[i])?)))
            .collect();
        guessed.sort_by(|a, b| a.1.location.z.total_cmp(&b.1.location.z));
        for (i, pose) in guessed {
            let foot = pose.location;
            let below = self.objects.iter().enumerate().filter_map(|(j, other)| {
                let at = other.track.at(self.start)?;
                let is_known = !other.is_guessed && j != i && at.location.z < foot.z;
                let tops = other.spec.shape.colliding();
                let solids = tops.iter().map(|solid| PlacedSolid::of(solid, at));
                let under = solids.filter(|solid| {
                    let way = (foot - solid.pose.location).truncate();
                    way.length() < solid.radius()
                });
                is_known.then(|| under.map(|solid| solid.heights()[1]).fold(0.0, f32::max))
            });
            let support = below.filter(|top| *top < foot.z).fold(0.0, f32::max);
            let edge = (2.0 * (foot.z - support)).max(0.1);
            let object = &mut self.objects[i];
            object.spec.shape = sized(&object.spec, edge);
            object.is_guessed = false;
        }
    }

    /// The joints of boxes and lids whose ids tell that they belong together.
    fn lids(&self) -> Vec<JointSpec> {
        let lids = self.objects.iter().filter_map(|lid| {
            let Shape::Lid { span, .. } = &lid.spec.shape else {
                return None;
            };
            let id = lid.spec.id.strip_suffix("-lid")?;
            let container = self.named(&format!("{id}-box"))?;
            let Shape::Box { span: outer, .. } = &container.spec.shape else {
                return None;
            };
            Some(JointSpec {
                objects: [container.spec.id.clone(), lid.spec.id.clone()],
                frames: [
                    Pose::at(Vec3::Z * outer.z / 2.0),
                    Pose::at(Vec3::NEG_Z * span.z / 2.0),
                ],
                kind: JointKind::Slider {
                    min: 0.0,
                    max: span.x,
                    friction: 0.0,
                    damping: 0.0,
                },
                collides: false,
            })
        });
        lids.collect()
    }
}

/// The shape of an object whose extents are all of this length; if it is unknown, a block.
fn sized(spec: &ObjectSpec, edge: f32) -> Shape {
    let kind = spec.descriptions.iter().find(|(name, _)| name == "shape");
    let color = spec.shape.drawn().first().map(|solid| solid.color);
    let color = color.unwrap_or(Rgb::GRAY);
    let span = Vec3::splat(edge);
    match kind.map(|(_, value)| value.as_str()) {
        Some("sphere") => Shape::Sphere {
            radius: edge / 2.0,
            color,
        },
        Some("cylinder") => Shape::Cylinder {
            radius: edge / 2.0,
            yspan: edge,
            color,
        },
        Some("box") => Shape::Box {
            span,
            thickness: 0.05,
            color,
        },
        Some(_) | None => Shape::Block { span, color },
    }
}
