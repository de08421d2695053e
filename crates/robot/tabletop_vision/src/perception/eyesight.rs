//! Looking at a picture.

use crate::{Eyes, KnownObject, KnownScenery, with_guides};
use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_camera::{Camera, FiguresSeen, Scene, VisibleWorld};
use tabletop_core::{HeadCamera, Joint, JointSpec, ObjectIndex, ObjectSpec, SensorImage};

use super::belief::{PerceivedObject, Perception, PerceptionDemand};

/// The eyes, and what they know.
#[derive(Resource, Default)]
pub(crate) struct Eyesight {
    eyes: Option<Eyes>,
    known: KnownThings,
    scene: Scene,
}

/// Objects, the joints between them, and the camera.
#[derive(Clone, Debug, Default, PartialEq)]
struct KnownThings {
    objects: Vec<(Entity, ObjectSpec)>,
    joints: Vec<JointSpec>,
    camera: Option<Camera>,
}

/// What the robot knows without looking.
#[derive(SystemParam)]
pub(crate) struct Knowledge<'w, 's> {
    head: Res<'w, HeadCamera>,
    index: Res<'w, ObjectIndex>,
    specs: Query<'w, 's, &'static ObjectSpec>,
    joints: Query<'w, 's, &'static Joint>,
}

pub(crate) fn perceive(
    mut demand: ResMut<PerceptionDemand>,
    image: Res<SensorImage>,
    world: VisibleWorld,
    knowledge: Knowledge,
    mut eyesight: ResMut<Eyesight>,
    mut perception: ResMut<Perception>,
) {
    demand.clear();
    if image.picture.rgb.is_empty() {
        // A real camera has nothing to show.
        *perception = Perception::default();
        return;
    }
    let known = knowledge.of(&world);
    if known != eyesight.known || image.tick < perception.tick || eyesight.eyes.is_none() {
        // Where objects were is no longer true if time has gone back.
        eyesight.know(known, &world, image.tick >= perception.tick);
    }
    let Eyesight { eyes, known, scene } = &mut *eyesight;
    let Some(eyes) = eyes else {
        return;
    };
    world.draw(FiguresSeen::FromHead, scene, &mut Vec::new());
    let scenery = KnownScenery {
        figures: scene.figures.clone(),
        solids: Vec::new(),
    };
    let percept = eyes.look(&image.picture, &scenery);
    let objects = known.objects.iter().zip(percept.objects);
    let objects = objects.map(|((object, spec), seen)| PerceivedObject {
        id: spec.id.clone(),
        object: *object,
        seen,
    });
    *perception = Perception {
        tick: image.tick,
        objects: objects.collect(),
    };
}

impl Knowledge<'_, '_> {
    fn of(&self, world: &VisibleWorld) -> KnownThings {
        let objects = self.index.iter();
        let objects =
            objects.filter_map(|object| Some((object, self.specs.get(object).ok()?.clone())));
        let id = |object: Entity| self.specs.get(object).ok().map(|spec| spec.id.clone());
        let joints = self.joints.iter().filter_map(|joint| joint.spec(id));
        KnownThings {
            objects: objects.collect(),
            joints: joints.collect(),
            camera: Some(Camera::of_head(&self.head, &world.table())),
        }
    }
}

impl Eyesight {
    fn know(&mut self, known: KnownThings, world: &VisibleWorld, is_remembering: bool) {
        let objects = known.objects.iter().map(|(_, spec)| {
            let object = KnownObject::described_by(spec).on_any_side(spec.pose.rotation);
            (spec.id.clone(), object)
        });
        let objects = with_guides(&objects.collect::<Vec<_>>(), &known.joints);
        let Some(camera) = known.camera else {
            return;
        };
        let mut eyes = Eyes::new(objects, camera, world.table());
        if let (Some(before), true) = (&self.eyes, is_remembering) {
            let remembered: Vec<_> = before.remembered().collect();
            let place = |object: Entity| {
                let mut before = self.known.objects.iter();
                let number = before.position(|(own, _)| *own == object);
                number.and_then(|number| remembered[number])
            };
            eyes.remember(known.objects.iter().map(|(object, _)| place(*object)));
        }
        self.known = known;
        self.eyes = Some(eyes);
    }
}
