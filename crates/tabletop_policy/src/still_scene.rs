//! Scenes in which objects are put from place to place, without physics: enough to know what the camera sees after each step of a task.

use std::collections::BTreeMap;

use bevy::math::{Quat, Vec3};
use tabletop_camera::{Camera, DrawnSolid, Rasterizer, Scene};
use tabletop_core::{HeadCamera, ObjectSpec, Picture};
use tabletop_episodes::multiplication::VariedBeginning;
use tabletop_geometry::Pose;
use tabletop_task::{Binding, Reference, Symmetry, Task, TaskStep, Turns};

use crate::label::Heading;

/// Objects on a table before the head camera.
#[derive(Clone, Debug)]
pub(crate) struct StillScene {
    pub camera: Camera,
    table: DrawnSolid,
    /// The objects, with their present poses.
    pub objects: Vec<ObjectSpec>,
    first: BTreeMap<String, Pose>,
}

/// The largest part across of the axis of a turn that is about the vertical.
const UPRIGHT: f32 = 0.02;

impl StillScene {
    pub fn of(beginning: &VariedBeginning) -> Self {
        let table = &beginning.scene.table;
        let head = HeadCamera {
            mount: beginning.mount,
            light: beginning.light,
            ..HeadCamera::default()
        };
        let objects = beginning.objects.clone();
        let first = objects
            .iter()
            .map(|object| (object.id.clone(), object.pose));
        Self {
            camera: Camera::of_head(&head, table),
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

    /// True if the camera sees this point, were nothing before it.
    pub fn sees(&self, point: Vec3) -> bool {
        let last = [self.camera.width, self.camera.height].map(|side| side as f32 - 1.0);
        let pixel = self.camera.pixel_of(point);
        pixel.is_some_and(|at| (0.0..=last[0]).contains(&at.x) && (0.0..=last[1]).contains(&at.y))
    }

    pub fn pose(&self, id: &str) -> Option<Pose> {
        let mut objects = self.objects.iter();
        Some(objects.find(|object| object.id == id)?.pose)
    }

    pub fn put(&mut self, id: &str, pose: Pose) {
        let mut objects = self.objects.iter_mut();
        if let Some(object) = objects.find(|object| object.id == id) {
            object.pose = pose;
        }
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

/// The role to whose present pose the goal of a step is related.
fn referred(step: &TaskStep) -> Option<&str> {
    match &step.goal.as_ref()?.reference {
        Reference::Object { object } => Some(object),
        Reference::Table | Reference::PlaceOf { .. } | Reference::Itself => None,
    }
}

/// The heading of an object with this symmetry.
pub(crate) fn heading(symmetry: &Symmetry, pose: Pose) -> Heading {
    let yaw_of = |rotation: Quat| 2.0 * libm::atan2f(rotation.z, rotation.w);
    let yaws: Vec<f32> = match &symmetry.turns {
        Turns::Finite(turns) => {
            let alike = turns.iter().map(|turn| pose.rotation * *turn);
            let is_upright = |rotation: &Quat| {
                let turn = *rotation * pose.rotation.inverse();
                turn.x.abs().max(turn.y.abs()) < UPRIGHT
            };
            alike.filter(is_upright).map(yaw_of).collect()
        }
        Turns::About { axis, ends_alike } => {
            let axis = pose.rotation * *axis;
            let is_upright = axis.truncate().length() < UPRIGHT;
            let ends = [axis, -axis];
            let ends = match (is_upright, ends_alike) {
                (true, _) => &ends[..0],
                (false, false) => &ends[..1],
                (false, true) => &ends[..],
            };
            ends.iter().map(|end| libm::atan2f(end.y, end.x)).collect()
        }
        Turns::Any => Vec::new(),
    };
    Heading::of(&yaws)
}

#[cfg(test)]
mod tests {
    use tabletop_core::Shape;
    use tabletop_geometry::Rgb;

    use super::*;
    use crate::label::Yaw;

    fn yaw(span: Vec3, degrees: Vec3) -> Option<Yaw> {
        let color = Rgb::RED;
        let symmetry = Symmetry::of(&Shape::Block { span, color });
        heading(&symmetry, Pose::from_degrees(Vec3::ZERO, degrees)).yaw()
    }

    #[test]
    fn a_heading_has_the_fold_of_the_object_as_it_stands() {
        let brick = Vec3::new(2.0, 1.0, 1.0);
        for (span, turn, fold) in [
            (Vec3::ONE, Vec3::ZERO, 4),
            (Vec3::ONE, Vec3::X * 90.0, 4),
            (brick, Vec3::ZERO, 2),
            (brick, Vec3::Y * 90.0, 4),
        ] {
            let found = yaw(span, turn + Vec3::Z * 20.0).unwrap();
            assert_eq!(found.fold, fold, "{span} {turn}");
            let period = std::f32::consts::TAU / fold as f32;
            let rest = (found.angle - 20_f32.to_radians()).rem_euclid(period / 2.0);
            assert!(
                rest.min(period / 2.0 - rest) < 1e-3,
                "{span} {turn}: {found:?}"
            );
        }
        let color = Rgb::RED;
        let ball = Symmetry::of(&Shape::Sphere { radius: 1.0, color });
        assert_eq!(heading(&ball, Pose::IDENTITY).yaw(), None);
    }
}
