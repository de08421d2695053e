//! Scenes in which objects are put from place to place, without physics: enough to know what the camera sees after each step of a task.

use std::collections::BTreeMap;

use bevy::math::{BVec3, Vec3};
use tabletop_camera::{Camera, DrawnSolid, Rasterizer, Scene};
use tabletop_core::{ObjectSpec, Picture, Shape, Table};
use tabletop_geometry::Pose;
use tabletop_task::{Binding, PlaceRange, Reference, Task, TaskStep};

/// Objects on a table before the head camera.
#[derive(Clone, Debug)]
pub struct StillScene {
    /// The head camera.
    pub camera: Camera,
    table: DrawnSolid,
    /// The objects, with their present poses.
    pub objects: Vec<ObjectSpec>,
    first: BTreeMap<String, Pose>,
}

impl StillScene {
    /// Objects on a table before a camera.
    pub fn new(camera: Camera, table: &Table, objects: Vec<ObjectSpec>) -> Self {
        let first = objects
            .iter()
            .map(|object| (object.id.clone(), object.pose));
        Self {
            camera,
            table: DrawnSolid::of_table(table, 1),
            first: first.collect(),
            objects,
        }
    }

    /// The head camera's picture.
    pub fn picture(&self, rasterizer: &mut Rasterizer) -> Picture {
        let mut scene = Scene::default();
        scene.solids.push(self.table.clone());
        for (number, object) in (2..).zip(&self.objects) {
            let solids = object.shape.drawn();
            let solids = solids.iter();
            let solids = solids.map(|solid| DrawnSolid::of(object.pose, solid, number));
            scene.solids.extend(solids);
        }
        let mut picture = Picture::default();
        rasterizer.draw(&scene, &self.camera, &mut picture);
        picture
    }

    /// True if an object would be wholly in the picture with this pose, were nothing before it.
    pub fn has_in_view(&self, id: &str, pose: Pose) -> bool {
        let object = self.object(id);
        object.is_some_and(|object| has_in_view(&self.camera, &object.shape, pose))
    }

    /// True if all that a task moves is in view, wherever its steps take and put it.
    pub fn keeps_in_view(&self, task: &Task, binding: &Binding) -> bool {
        let mut scene = self.clone();
        task.steps.iter().all(|step| {
            let Some(id) = binding.object(&step.object) else {
                return false;
            };
            // What is put aside gets its place later.
            let is_exact = |_: &Pose| {
                let goal = step.goal.as_ref();
                goal.is_some_and(|goal| goal.place == PlaceRange::Exact)
            };
            let goal = scene.goal(step, binding).filter(is_exact);
            let mut ends = scene.pose(id).into_iter().chain(goal);
            let is_seen = ends.all(|end| scene.has_in_view(id, end));
            if let Some(goal) = goal {
                scene.carry(step, binding, goal);
            }
            is_seen
        })
    }

    /// The pose of an object.
    pub fn pose(&self, id: &str) -> Option<Pose> {
        Some(self.object(id)?.pose)
    }

    fn object(&self, id: &str) -> Option<&ObjectSpec> {
        let mut objects = self.objects.iter();
        objects.find(|object| object.id == id)
    }

    /// Gives an object another pose.
    pub fn put(&mut self, id: &str, pose: Pose) {
        let mut objects = self.objects.iter_mut();
        if let Some(object) = objects.find(|object| object.id == id) {
            object.pose = pose;
        }
    }

    /// Gives the object of a step another pose, and moves along what goes along with it.
    pub fn carry(&mut self, step: &TaskStep, binding: &Binding, pose: Pose) {
        let Some(id) = binding.object(&step.object) else {
            return;
        };
        let from = self.pose(id).unwrap_or(pose);
        let motion = pose * from.inverse();
        let load = step.load.iter();
        for id in load.filter_map(|load| binding.object(&load.object)) {
            if let Some(now) = self.pose(id) {
                self.put(id, motion * now);
            }
        }
        self.put(id, pose);
    }

    /// The pose to which a step brings its object now. `None` if it has no goal, or its object or reference is missing.
    pub fn goal(&self, step: &TaskStep, binding: &Binding) -> Option<Pose> {
        Some(self.frame(step, binding)? * step.goal.as_ref()?.pose)
    }

    /// The pose of the reference of a step's goal.
    fn frame(&self, step: &TaskStep, binding: &Binding) -> Option<Pose> {
        match &step.goal.as_ref()?.reference {
            Reference::Table => Some(Pose::IDENTITY),
            Reference::Object { object } => self.pose(binding.object(object)?),
            Reference::PlaceOf { object } => self.first.get(binding.object(object)?).copied(),
            Reference::Itself => self.pose(binding.object(&step.object)?),
        }
    }

    /// True if every object is within `tolerance` units of where its last step puts it, in some orientation in which the reference looks the same.
    pub fn shows(&self, task: &Task, binding: &Binding, tolerance: f32) -> bool {
        let lasts = task.steps.iter().enumerate().filter(|(i, step)| {
            let mut later = task.steps[i + 1..].iter();
            later.all(|later| later.object != step.object)
        });
        let lasts: Vec<_> = lasts.map(|(_, step)| step).collect();
        let is_met = |step: &TaskStep, frame: Pose| {
            let now = binding.object(&step.object).and_then(|id| self.pose(id));
            let goal = step.goal.as_ref().map(|goal| frame * goal.pose.location);
            let pair = now.zip(goal);
            pair.is_some_and(|(now, goal)| now.location.distance(goal) <= tolerance)
        };
        lasts.iter().all(|step| {
            let Some(frame) = self.frame(step, binding) else {
                return false;
            };
            let Some(reference) = referred(step) else {
                return is_met(step, frame);
            };
            let role = task.role(reference);
            let frames = role.map_or_else(Vec::new, |role| role.symmetry.variants(frame));
            frames.into_iter().any(|frame| {
                let mut related = lasts
                    .iter()
                    .filter(|step| referred(step) == Some(reference));
                related.all(|step| is_met(step, frame))
            })
        })
    }
}

/// True if a camera sees all of a shape with this pose, were nothing before it.
pub fn has_in_view(camera: &Camera, shape: &Shape, pose: Pose) -> bool {
    let last = [camera.width, camera.height].map(|side| side as f32 - 1.0);
    let sees = |point: Vec3| {
        let pixel = camera.pixel_of(point);
        pixel.is_some_and(|at| (0.0..=last[0]).contains(&at.x) && (0.0..=last[1]).contains(&at.y))
    };
    let bounds = shape.bounds(Pose::IDENTITY);
    (0..8).all(|corner| {
        let is_high = BVec3::new(corner & 1 != 0, corner & 2 != 0, corner & 4 != 0);
        sees(pose * Vec3::select(is_high, bounds.high, bounds.low))
    })
}

/// The role to whose present pose the goal of a step is related.
fn referred(step: &TaskStep) -> Option<&str> {
    match &step.goal.as_ref()?.reference {
        Reference::Object { object } => Some(object),
        Reference::Table | Reference::PlaceOf { .. } | Reference::Itself => None,
    }
}
