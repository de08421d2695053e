//! Beginnings that differ from those of a task in one thing.

use tabletop_camera::{Camera, Rasterizer};
use tabletop_core::{CameraCarrier, ObjectSpec, Random, SceneItem, SceneSpec};
use tabletop_episodes::{
    StillScene,
    imitation::scattered,
    multiplication::{Fingerprint, Variation, distractor, narrow, recolor},
};
use tabletop_geometry::PlacedSolid;
use tabletop_planner::RobotBody;
use tabletop_program::{ConcreteStep, ProgramRun, TableScene};

use super::{
    BENCHMARK_VERSION, Perturbation,
    beginning::{BeginningError, DRAWS, TaskBeginning, head_camera, possible_steps, table_of},
};

/// How light and cameras differ, at most: by half of its brightness, direction and colour, and by a unit along each axis.
const VARIATION: Variation = Variation {
    colors: false,
    sizes: 0.0,
    distractors: 0,
    camera: 1.0,
    light: 0.5,
    in_view: false,
};
/// Number of distractors.
const DISTRACTORS: u32 = 3;
/// Least distance of the middle of a distractor from all that the task takes and puts, in units: a hand has room between them.
const APART: f32 = 1.6;
/// By which part, at most, blocks are narrower.
const SIZES: f32 = 0.3;
/// The friction of objects, which is usually 0.5.
const FRICTIONS: (f32, f32) = (0.25, 0.75);

impl TaskBeginning {
    /// The same beginning with a perturbation. The task, the number, the robot and the perturbation alone decide it.
    ///
    /// # Errors
    /// The robot cannot do the task then.
    pub fn perturbed(
        &self,
        perturbation: Perturbation,
        body: &RobotBody,
        carrier: CameraCarrier,
    ) -> Result<Self, BeginningError> {
        let (task, episode) = (self.task.name, self.episode);
        let name = [
            BENCHMARK_VERSION,
            task,
            &episode.to_string(),
            perturbation.name(),
        ];
        let name = name.join(" ");
        let mut random = Random::new(Fingerprint::EMPTY.and(name.as_bytes()).number());
        let mut draws =
            (0..DRAWS).filter_map(|_| self.drawn(perturbation, body, carrier, &mut random));
        let first = draws.next();
        first.ok_or(BeginningError::Unperturbed(task, episode, perturbation))
    }

    /// The beginning with a perturbation at random, if the robot can do the task then, in the same steps.
    fn drawn(
        &self,
        perturbation: Perturbation,
        body: &RobotBody,
        carrier: CameraCarrier,
        random: &mut Random,
    ) -> Option<Self> {
        let mut drawn = Self {
            perturbation: Some(perturbation),
            ..self.clone()
        };
        match perturbation {
            Perturbation::Light => drawn.light = VARIATION.light(random),
            Perturbation::Camera => drawn.displacement = VARIATION.displacement(random),
            Perturbation::Words => {
                let others = self.task.other_words;
                let other = random.bits() % others.len() as u64;
                drawn.words = (*others.get(other as usize)?).to_owned();
            }
            Perturbation::Colors => drawn.scene = self.recolored(random),
            Perturbation::Sizes => {
                let items = &mut drawn.scene.items;
                items
                    .iter_mut()
                    .for_each(|item| narrow(item, SIZES, random, |_| true));
            }
            Perturbation::Friction => {
                for object in objects_in(&mut drawn.scene) {
                    object.dynamics.friction = Some(random.between(FRICTIONS));
                }
            }
            Perturbation::Distractors => {
                let camera = head_camera(carrier, None, &self.scene.table);
                drawn.scene = self.distracted(body, camera, random)?;
            }
        }
        drawn.table = table_of(&drawn.scene);
        let camera = head_camera(carrier, drawn.displacement, &drawn.scene.table);
        drawn.steps = possible_steps(&self.program, &drawn.table, body, camera)?;
        self.has_steps_like(&drawn.steps).then_some(drawn)
    }

    /// The scene in other colours, in which the sentences mean the same objects.
    fn recolored(&self, random: &mut Random) -> SceneSpec {
        let mut scene = self.scene.clone();
        for number in 0..scene.items.len() {
            let others = scene.clone();
            recolor(&mut scene.items[number], random, |object| {
                let mut painted = others.clone();
                painted.items[number] = SceneItem::Object(object.clone());
                self.means_the_same_in(&painted)
            });
        }
        scene
    }

    /// The scene with other objects around that the sentences do not mean. The head sees them, and they hide nothing from it. `None` if there is no room.
    fn distracted(
        &self,
        body: &RobotBody,
        camera: Camera,
        random: &mut Random,
    ) -> Option<SceneSpec> {
        let mut scene = self.scene.clone();
        for number in 0..DISTRACTORS {
            let distractor = distractor(number, random, |object| {
                self.means_the_same_in(&with(&scene, object))
            })?;
            scene = (0..DRAWS).find_map(|_| {
                let placed = placed(&distractor, &scene, body, random)?;
                let still = StillScene::new(camera, &scene.table, vec![placed.clone()]);
                let is_seen = still.has_in_view(&placed.id, placed.pose);
                let more = with(&scene, &placed);
                (is_seen && self.is_apart_from(&placed) && hides_nothing(&scene, &more, camera))
                    .then_some(more)
            })?;
        }
        Some(scene)
    }

    /// True if an object is not near to anything that the task takes or puts.
    fn is_apart_from(&self, other: &ObjectSpec) -> bool {
        self.steps.iter().all(|step| {
            let taken = self.table.object(&step.object).map(|object| object.pose);
            let mut places = taken.into_iter().chain(step.pose);
            places.all(|place| {
                let way = place.location - other.pose.location;
                way.truncate().length() >= APART
            })
        })
    }

    fn means_the_same_in(&self, scene: &SceneSpec) -> bool {
        let (steps, _, failure) = ProgramRun::rehearsed(&self.program, &table_of(scene));
        failure.is_none() && self.has_steps_like(&steps)
    }

    /// True if these steps bring the same objects into the same relations.
    fn has_steps_like(&self, steps: &[ConcreteStep]) -> bool {
        let what = |step: &ConcreteStep| (step.object.clone(), step.relation.clone());
        self.steps.iter().map(what).eq(steps.iter().map(what))
    }
}

fn objects_in(scene: &mut SceneSpec) -> impl Iterator<Item = &mut ObjectSpec> {
    scene.items.iter_mut().filter_map(|item| match item {
        SceneItem::Object(object) => Some(object),
        SceneItem::LidBox(_) | SceneItem::Chain(_) | SceneItem::Jointed(_) => None,
    })
}

/// A scene with a further object.
fn with(scene: &SceneSpec, object: &ObjectSpec) -> SceneSpec {
    let mut more = scene.clone();
    more.items.push(SceneItem::Object(object.clone()));
    more
}

/// An object at a random place of a scene that the robot reaches.
fn placed(
    object: &ObjectSpec,
    scene: &SceneSpec,
    body: &RobotBody,
    random: &mut Random,
) -> Option<ObjectSpec> {
    let kept = table_of(scene).objects.into_iter().flat_map(|object| {
        let colliding = object.shape.colliding().into_iter();
        colliding.map(move |solid| PlacedSolid::of(&solid, object.pose))
    });
    let kept: Vec<_> = kept.collect();
    let alone = SceneSpec {
        table: scene.table,
        items: vec![SceneItem::Object(object.clone())],
    };
    let mut alone = scattered(&alone, &kept, Some(body), random.bits())?;
    objects_in(&mut alone).next().cloned()
}

/// True if the head sees as much of each object of a scene when there are more of them.
fn hides_nothing(scene: &SceneSpec, more: &SceneSpec, camera: Camera) -> bool {
    let [before, after] = [scene, more].map(|scene| seen_pixels(table_of(scene), camera));
    after.starts_with(&before)
}

/// The number of pixels in which the head sees each object.
fn seen_pixels(table: TableScene, camera: Camera) -> Vec<usize> {
    // The first number is the table's.
    let mut pixels = vec![0; table.objects.len()];
    let still = StillScene::new(camera, &table.table, table.objects);
    let picture = still.picture(&mut Rasterizer::alone());
    for number in picture.objects {
        let object = (number as usize).checked_sub(2);
        if let Some(pixels) = object.and_then(|object| pixels.get_mut(object)) {
            *pixels += 1;
        }
    }
    pixels
}
