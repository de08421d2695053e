//! Variation from one demonstration to the next.

use std::f32::consts::TAU;

use bevy::math::{Quat, Vec3};
use tabletop_core::{
    HeadCamera, LIGHT, Light, ObjectSpec, Random, SceneItem, SceneSpec, Shape, Table,
};
use tabletop_geometry::{NAMED_COLORS, PlacedSolid, Pose, Rgb};
use tabletop_planner::RobotBody;
use tabletop_scene::{IdAllocator, assemble};
use tabletop_task::{PlaceRange, Reference, Relation, Requirements, Task};

use super::late::LateObjects;
use crate::imitation::scattered;

/// The variation besides the places of objects.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Variation {
    /// True if objects get other colours, as far as the requirements allow.
    pub colors: bool,
    /// By which part of it, at most, blocks and cylinders are narrower, as far as requirements allow; 0 for not at all. Heights stay, so that
    /// objects on them stand as high as in the demonstration.
    pub sizes: f32,
    /// Largest number of distractors: objects that have nothing to do with the task.
    pub distractors: u32,
    /// Largest displacement of the head camera, in units; it also turns by up to 2° per unit.
    pub camera: f32,
    /// By which part of it, at most, the brightness of the light in the pictures differs; also its direction and colour. 0 for not at all.
    pub light: f32,
    /// True if all that the task moves stays in the head camera's picture.
    pub in_view: bool,
}

/// Number of arrangements among which one with all goals on the table is searched for.
const DRAWS: u32 = 50;
/// Number of colours that are drawn.
const COLORS: u32 = 100;
/// Largest difference in lightness between a colour and its name.
const SHADE: f32 = 0.12;
/// The largest height of a unit vector that counts as level, in units.
const LEVEL: f32 = 0.02;
/// The extents of distractors, in units.
const DISTRACTOR: (f32, f32) = (0.6, 1.6);
/// Part by which red and blue of the light differ per part of its brightness.
const WARMTH: f32 = 0.5;
/// Angle by which the camera is turned per unit of its displacement, in rad.
const TURN: f32 = 0.035;

impl Variation {
    /// The pose of the head camera, if it is to be displaced.
    pub(super) fn mount(&self, table: &Table, random: &mut Random) -> Option<Pose> {
        let camera = HeadCamera::default();
        let mut any = |most: f32| random.between((-most, most));
        let by = Vec3::new(any(self.camera), any(self.camera), any(self.camera));
        let turns = [Vec3::X, Vec3::Y, Vec3::Z]
            .map(|axis| Quat::from_axis_angle(axis, any(self.camera * TURN)));
        if self.camera == 0.0 {
            return None;
        }
        let pose = camera.pose(table);
        let turn = turns[0] * turns[1] * turns[2];
        Some(Pose::new(
            pose.location + by,
            (turn * pose.rotation).normalize(),
        ))
    }

    /// The light in the pictures: brighter or darker, more from one side, warmer or colder.
    pub(super) fn light(&self, random: &mut Random) -> Light {
        let mut any = |most: f32| random.between((-most, most));
        let brightness = 1.0 + any(self.light);
        let from = Vec3::new(any(self.light), any(self.light), 0.0);
        let warmth = any(self.light * WARMTH);
        let at_most_all = |shares: Vec3| shares.min(Vec3::ONE);
        Light {
            along: at_most_all(LIGHT.along * (Vec3::ONE + from)),
            against: at_most_all(LIGHT.against * (Vec3::ONE - from)),
            color: LIGHT.color * brightness * Vec3::new(1.0 + warmth, 1.0, 1.0 - warmth),
        }
    }
}

/// A demonstration that is to be varied.
pub(super) struct Varying<'a> {
    pub task: &'a Task,
    pub late: &'a LateObjects,
    pub requirements: &'a Requirements,
    pub scene: &'a SceneSpec,
    /// The robot, if one has to reach everything.
    pub body: Option<&'a RobotBody>,
    pub variation: Variation,
}

impl Varying<'_> {
    /// The varied scene. `None` if there is no room for it.
    pub(super) fn varied(&self, random: &mut Random) -> Option<SceneSpec> {
        let mut scene = self.scene.clone();
        let distractors = match self.variation.distractors {
            0 => 0,
            most => (random.bits() % (u64::from(most) + 1)) as u32,
        };
        if self.variation.colors {
            for item in &mut scene.items {
                self.recolor(item, random);
            }
        }
        if self.variation.sizes > 0.0 {
            for item in &mut scene.items {
                self.narrow(item, random);
            }
        }
        for i in 0..distractors {
            let distractor = self.distractor(i, random)?;
            scene.items.push(SceneItem::Object(distractor));
        }
        let kept = self.kept();
        (0..DRAWS).find_map(|_| {
            let scene = scattered(&scene, &kept, self.body, random.bits())?;
            self.is_on_table(&scene).then_some(scene)
        })
    }

    /// Solids at the places of the table where objects are put.
    fn kept(&self) -> Vec<PlacedSolid> {
        let goals = self.task.steps.iter().filter_map(|step| {
            let goal = step.goal.as_ref()?;
            let is_place = goal.reference == Reference::Table && goal.place == PlaceRange::Exact;
            let role = self.task.role(&step.object)?;
            is_place.then_some((&role.shown.shape, goal.pose))
        });
        let solids = goals.flat_map(|(shape, pose)| {
            let colliding = shape.colliding();
            colliding
                .into_iter()
                .map(move |solid| PlacedSolid::of(&solid, pose))
        });
        solids.collect()
    }

    /// True if all goals of the task are on the table when objects are where this scene puts them.
    fn is_on_table(&self, scene: &SceneSpec) -> bool {
        let objects = assemble(scene, &mut IdAllocator::default()).objects;
        let Ok(binding) = self.late.bind(self.task, self.requirements, &objects) else {
            return false;
        };
        let half = Vec3::new(scene.table.xspan, scene.table.yspan, 0.0) / 2.0;
        let beginning = |role: &str| {
            let id = binding.object(role)?;
            let object = objects.iter().find(|object| object.id == id)?;
            Some((&object.shape, object.pose))
        };
        let mut now = std::collections::BTreeMap::new();
        self.task.steps.iter().all(|step| {
            let Some((shape, start)) = beginning(&step.object) else {
                return self.late.contains(&step.object);
            };
            let Some(goal) = &step.goal else {
                return true;
            };
            let from = now.get(step.object.as_str()).copied().unwrap_or(start);
            let frame = match &goal.reference {
                Reference::Table => Some(Pose::IDENTITY),
                Reference::Itself => Some(from),
                Reference::Object { object } => now
                    .get(object.as_str())
                    .copied()
                    .or_else(|| Some(beginning(object)?.1)),
                Reference::PlaceOf { object } => beginning(object).map(|(_, pose)| pose),
            };
            let Some(frame) = frame else {
                let other = step.relations.first().and_then(Relation::object);
                return other.is_some_and(|other| self.late.contains(other));
            };
            let pose = frame * goal.pose;
            let motion = pose * from.inverse();
            for load in &step.load {
                let known = now.get(load.object.as_str()).copied();
                let known = known.or_else(|| Some(beginning(&load.object)?.1));
                now.extend(known.map(|known| (load.object.as_str(), motion * known)));
            }
            now.insert(step.object.as_str(), pose);
            goal.place == PlaceRange::Anywhere
                || shape.colliding().iter().all(|solid| {
                    let solid = PlacedSolid::of(solid, pose);
                    [Vec3::X, Vec3::Y].into_iter().all(|way| {
                        let reach = |way: Vec3| solid.farthest(way).dot(way);
                        reach(way).max(reach(-way)) < half.dot(way)
                    })
                })
        })
    }

    fn recolor(&self, item: &mut SceneItem, random: &mut Random) {
        for _ in 0..COLORS {
            let color = any_color(random);
            let mut varied = item.clone();
            match &mut varied {
                SceneItem::Object(spec) => {
                    paint(&mut spec.shape, color);
                    if !self.may_be(spec) {
                        continue;
                    }
                }
                SceneItem::LidBox(spec) => spec.color = color,
                SceneItem::Chain(spec) => spec.color = color,
                SceneItem::Jointed(_) => {}
            }
            *item = varied;
            return;
        }
    }

    fn narrow(&self, item: &mut SceneItem, random: &mut Random) {
        let SceneItem::Object(spec) = item else {
            return;
        };
        let [first, second] = [(); 2].map(|()| 1.0 - random.between((0.0, self.variation.sizes)));
        let mut varied = spec.clone();
        let rotation = spec.pose.rotation;
        let is_level = |axis: Vec3| (rotation * axis).z.abs() < LEVEL;
        match &mut varied.shape {
            Shape::Block { span, .. } => {
                let axes = [Vec3::X, Vec3::Y, Vec3::Z].into_iter();
                let level: Vec<_> = axes.filter(|axis| is_level(*axis)).collect();
                // A leaning object keeps its size, or it would stand otherwise.
                let [one, other] = level[..] else {
                    return;
                };
                *span *= Vec3::ONE - one * (1.0 - first) - other * (1.0 - second);
            }
            Shape::Cylinder { radius, .. } if (rotation * Vec3::Y).z.abs() > 1.0 - LEVEL => {
                *radius *= first;
            }
            Shape::Cylinder { .. }
            | Shape::Sphere { .. }
            | Shape::Box { .. }
            | Shape::Prism { .. }
            | Shape::Frustum { .. }
            | Shape::Ring { .. }
            | Shape::Mesh { .. }
            | Shape::Link { .. }
            | Shape::Lid { .. }
            | Shape::Composite { .. }
            | Shape::Control(_)
            | Shape::BondPoint(_) => return,
        }
        if !spec.is_fixed() && self.may_be(&varied) {
            *spec = varied;
        }
    }

    /// Whether an object still meets the requirements of the role that it takes by its id.
    fn may_be(&self, spec: &ObjectSpec) -> bool {
        let lacks = self.requirements.lacks(&spec.id, spec);
        lacks.is_none_or(|lacks| lacks.is_empty())
    }

    /// A distractor: an object that cannot take any role with requirements.
    fn distractor(&self, number: u32, random: &mut Random) -> Option<ObjectSpec> {
        (0..COLORS).find_map(|_| {
            let color = any_color(random);
            let [x, y, z] = [(); 3].map(|()| random.between(DISTRACTOR));
            let (shape, rotation, height) = match random.bits() % 2 {
                0 => {
                    let span = Vec3::new(x, y, z);
                    (Shape::Block { span, color }, Quat::IDENTITY, z)
                }
                _ => {
                    let shape = Shape::Cylinder {
                        radius: x / 2.0,
                        yspan: z,
                        color,
                    };
                    (shape, Quat::from_rotation_x(TAU / 4.0), z)
                }
            };
            // Apart from everything, so that it is moved by itself.
            let at = Vec3::new(1000.0 + 10.0 * number as f32, 0.0, height / 2.0);
            let id = format!("Distractor{}", number + 1);
            let spec = ObjectSpec::new(&id, Pose::new(at, rotation), 1.0, shape);
            let is_other = |requirements: &Requirements, task: &Task| {
                task.roles.iter().all(|role| {
                    let lacks = requirements.lacks(&role.id, &spec);
                    lacks.is_none_or(|lacks| !lacks.is_empty())
                })
            };
            is_other(self.requirements, self.task).then_some(spec)
        })
    }
}

/// A scene whose objects have exchanged their colours, as this seed decides.
pub fn with_colors_exchanged(mut scene: SceneSpec, seed: u64) -> SceneSpec {
    let mut random = Random::new(seed);
    let mut shapes: Vec<_> = scene
        .items
        .iter_mut()
        .filter_map(|item| match item {
            SceneItem::Object(spec) => Some(&mut spec.shape),
            SceneItem::LidBox(_) | SceneItem::Chain(_) | SceneItem::Jointed(_) => None,
        })
        .collect();
    let mut colors: Vec<_> = shapes
        .iter()
        .filter_map(|shape| Some(shape.drawn().first()?.color))
        .collect();
    for shape in &mut shapes {
        if !colors.is_empty() {
            let drawn = random.bits() % colors.len() as u64;
            paint(shape, colors.swap_remove(drawn as usize));
        }
    }
    scene
}

/// A colour with a name, or one near it.
fn any_color(random: &mut Random) -> Rgb {
    let (_, named) = NAMED_COLORS[(random.bits() % NAMED_COLORS.len() as u64) as usize];
    let shade = random.between((-SHADE, SHADE));
    let part = |part: f32| (part + shade).clamp(0.0, 1.0);
    Rgb::new(part(named.red), part(named.green), part(named.blue))
}

/// Paints a shape; of a composite, only the parts with the colour of the first.
fn paint(shape: &mut Shape, color: Rgb) {
    let Some(old) = shape.drawn().first().map(|solid| solid.color) else {
        return;
    };
    for own in shape.colors_mut() {
        if *own == old {
            *own = color;
        }
    }
}
