//! Variation from one demonstration to the next.

use bevy::math::Vec3;
use tabletop_core::{LIGHT, Light, ObjectSpec, Random, SceneItem, SceneSpec};
use tabletop_geometry::{PlacedSolid, Pose};
use tabletop_planner::RobotBody;
use tabletop_scene::{IdAllocator, assemble};
use tabletop_task::{PlaceRange, Reference, Relation, Requirements, Task};

use super::{
    camera_displacement::CameraDisplacement,
    late::LateObjects,
    object_variation::{distractor, narrow, recolor},
};
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
/// Part by which red and blue of the light differ per part of its brightness.
const WARMTH: f32 = 0.5;

impl Variation {
    /// How the head camera is displaced, if it is to be.
    pub fn displacement(&self, random: &mut Random) -> Option<CameraDisplacement> {
        let displacement = CameraDisplacement::any(self.camera, random);
        (self.camera != 0.0).then_some(displacement)
    }

    /// The light in the pictures: brighter or darker, more from one side, warmer or colder.
    pub fn light(&self, random: &mut Random) -> Light {
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
                recolor(item, random, |spec| self.may_be(spec));
            }
        }
        if self.variation.sizes > 0.0 {
            for item in &mut scene.items {
                narrow(item, self.variation.sizes, random, |spec| self.may_be(spec));
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

    /// Whether an object still meets the requirements of the role that it takes by its id.
    fn may_be(&self, spec: &ObjectSpec) -> bool {
        let lacks = self.requirements.lacks(&spec.id, spec);
        lacks.is_none_or(|lacks| lacks.is_empty())
    }

    /// A distractor: an object that cannot take any role with requirements.
    fn distractor(&self, number: u32, random: &mut Random) -> Option<ObjectSpec> {
        distractor(number, random, |spec| {
            self.task.roles.iter().all(|role| {
                let lacks = self.requirements.lacks(&role.id, spec);
                lacks.is_none_or(|lacks| !lacks.is_empty())
            })
        })
    }
}
