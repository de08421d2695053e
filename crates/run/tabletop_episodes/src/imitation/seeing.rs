//! The stage of a robot that is told no pose of an object: it sees them through its head camera.

use std::collections::BTreeMap;

use bevy::prelude::*;
use tabletop_camera::{Camera, DrawnSolid};
use tabletop_controller::{Observer, SeenObject, Sight};
use tabletop_core::{
    Drive, HeadCamera, ObjectSpec, Robot, RobotCommand, RobotLayout, StepApp as _, TICK_SECONDS,
    WriteCommand as _,
};
use tabletop_geometry::Pose;
use tabletop_planner::{
    Before, Doing, Imitation, LimbOrder, PlanningStage, RobotBody, Stopped, imitate, undone,
};
use tabletop_task::{Binding, Task};
use tabletop_vision::{Eyes, KnownObject, KnownScenery, ObjectPercept, Visibility, with_guides};

use super::{
    advance,
    head_picture::{HeadCameraStage, HeadPicture, head_picture},
};

/// Angle, in rad, by which the head turns for what is beside the picture.
const PAN: f64 = 0.5;

/// The most ticks for a turn of the head, and the angle, in rad, by which it may miss.
const NECK_TICKS: u32 = 240;
const NECK_EXACT: f64 = 1e-3;

/// An app whose robot is moved by commands and sees with its head camera. It knows the shapes and colours of the objects, the joints between
/// them, and the angles of its own joints, and feels what its grippers hold.
pub struct SeeingStage<'a> {
    app: &'a mut App,
    body: &'a RobotBody,
    observer: Observer,
    known: Vec<(String, KnownObject)>,
    /// The world as the robot believes it to be.
    belief: Sight,
    /// The object in each gripper, and its pose in the frame of the end effector.
    held: Vec<Option<(String, Pose)>>,
}

/// Does a task with the objects that the robot sees. It counts as done only if it is done in the world as it is.
pub fn imitate_seeing(
    app: &mut App,
    body: &RobotBody,
    task: &Task,
    binding: &Binding,
    objects: &[ObjectSpec],
    seed: u64,
    tell: impl FnMut(Doing),
) -> Imitation {
    let mut stage = SeeingStage::of_task(app, body, task, binding, objects);
    let before = Before::anything(&stage.truth());
    let mut imitation = imitate(&mut stage, body, task, binding, seed, tell);
    if imitation.failure.is_none() {
        imitation.failure = undone(task, binding, &stage.truth(), &before);
    }
    imitation
}

/// What eyes know of an object: it stands as in the scene, or on any side if the task tips it.
fn known_in(task: &Task, binding: &Binding, object: &ObjectSpec) -> KnownObject {
    let tips = task.steps.iter().any(|step| {
        step.tipping.is_some() && binding.object(&step.object) == Some(object.id.as_str())
    });
    let (known, own) = (KnownObject::described_by(object), object.pose.rotation);
    match tips {
        true => known.on_any_side(own),
        false => known.standing([own]),
    }
}

impl<'a> SeeingStage<'a> {
    /// The app, whose robot has looked at these objects, and knows which of them the task tips onto another side.
    pub fn of_task(
        app: &'a mut App,
        body: &'a RobotBody,
        task: &Task,
        binding: &Binding,
        objects: &[ObjectSpec],
    ) -> Self {
        Self::new(app, body, objects, |object| known_in(task, binding, object))
    }

    /// The app, whose robot has looked at these objects, and knows this of them.
    pub fn new(
        app: &'a mut App,
        body: &'a RobotBody,
        objects: &[ObjectSpec],
        known: impl Fn(&ObjectSpec) -> KnownObject,
    ) -> Self {
        let mut observer = Observer::default();
        let truth = observer.look(app.world_mut());
        let belief = Sight {
            objects: BTreeMap::new(),
            ..truth.clone()
        };
        let known = objects.iter().map(|spec| (spec.id.clone(), known(spec)));
        let mut stage = Self {
            known: known.collect(),
            held: vec![None; belief.limbs.len()],
            app,
            body,
            observer,
            belief,
        };
        stage.glance(None);
        stage
    }

    /// The world as it is.
    pub fn truth(&self) -> Sight {
        self.observer.sight().clone()
    }

    /// Looks at the picture that the head camera shows now. Believes what it sees of these objects, or of all, and returns the names of those that it does not
    /// see well enough.
    fn glance(&mut self, sought: Option<&[String]>) -> Vec<String> {
        let Some(look) = self.head_picture() else {
            return Vec::new();
        };
        let (held, free): (Vec<_>, Vec<_>) = self
            .known
            .iter()
            .cloned()
            .partition(|(name, _)| self.is_held(name));
        let solids = held.iter().flat_map(|(name, _)| {
            let object = self.belief.objects.get(name);
            let solids = object.map_or(Vec::new(), |it| it.shape.drawn());
            let pose = object.map_or(Pose::IDENTITY, |it| it.pose);
            let solids = solids.into_iter();
            solids.map(move |solid| DrawnSolid::of(pose, &solid, 1))
        });
        let scenery = KnownScenery {
            figures: look.links,
            solids: solids.collect(),
        };
        let objects = with_guides(&free, &self.belief.joints);
        let mut eyes = Eyes::new(objects, look.camera, self.belief.table);
        eyes.remember(free.iter().map(|(name, _)| {
            let believed = self.belief.objects.get(name);
            believed.map(|it| it.pose)
        }));
        let mut percept = eyes.look(&look.picture, &scenery);
        // Which of several objects that look the same is which, no picture tells, unless it was seen before.
        let known = [&self.belief, self.observer.sight()];
        let place = |id: &String| known.iter().find_map(|sight| sight.objects.get(id));
        let places = free.iter().map(|(id, _)| Some(place(id)?.pose));
        eyes.name_by_place(&places.collect::<Vec<_>>(), &mut percept);
        let mut unseen = Vec::new();
        for ((name, known), seen) in free.iter().zip(percept.objects) {
            if sought.is_some_and(|sought| !sought.contains(name)) {
                continue;
            }
            match seen {
                ObjectPercept {
                    pose: Some(pose),
                    is_sure: true,
                    visibility: Visibility::Seen | Visibility::PartlyHidden,
                    ..
                } => self.believe(name, known, pose),
                // What is hidden has moved with what holds it.
                ObjectPercept {
                    pose: Some(pose),
                    is_explained: true,
                    visibility: Visibility::Hidden,
                    ..
                } => {
                    self.believe(name, known, pose);
                    unseen.push(name.clone());
                }
                ObjectPercept { .. } => unseen.push(name.clone()),
            }
        }
        unseen
    }

    /// True if an object was never seen, or a good part of its place is not in the picture of the head that looks straight ahead.
    fn is_beside_picture(&self, name: &str) -> bool {
        let head = HeadCamera {
            pan: 0.0,
            ..*self.app.world().resource::<HeadCamera>()
        };
        let camera = Camera::of_head(&head, &self.belief.table);
        let known = self.known.iter().find(|(own, _)| own == name);
        let seen = self.belief.objects.get(name);
        known
            .zip(seen)
            .is_none_or(|((_, known), seen)| known.is_cut_off(seen.pose, &camera))
    }

    /// Turns the neck to an angle, in rad. False if it has none, or does not get there.
    fn turn_head(&mut self, pan: f64) -> bool {
        let layout = self.app.world().resource::<RobotLayout>();
        let Some(neck) = layout.neck else {
            return false;
        };
        let name = layout.joint(neck).name;
        for _ in 0..NECK_TICKS {
            let left = pan - self.app.world().resource::<Robot>().joint(neck).position;
            if left.abs() < NECK_EXACT {
                return true;
            }
            let drive = Drive::Velocity(left / f64::from(TICK_SECONDS));
            let world = self.app.world_mut();
            world.write_command(RobotCommand::Drive(vec![(name, drive)]));
            self.app.step(1);
            self.observer.look(self.app.world_mut());
            self.feel();
        }
        false
    }

    /// Takes what it feels in its grippers, and moves what they hold with them.
    fn feel(&mut self) {
        let limbs = &self.observer.sight().limbs;
        self.belief.limbs.clone_from(limbs);
        for (number, limb) in limbs.iter().enumerate() {
            let end_effector = self.body.end_effector(number, &limb.angles);
            let Some(name) = limb.holds.first().cloned() else {
                self.held[number] = None;
                continue;
            };
            let Some(object) = self.belief.objects.get_mut(&name) else {
                continue;
            };
            match &self.held[number] {
                Some((held, pose)) if *held == name => object.pose = end_effector * *pose,
                Some(_) | None => {
                    self.held[number] = Some((name, end_effector.inverse() * object.pose));
                }
            }
        }
    }

    fn is_held(&self, name: &str) -> bool {
        let mut held = self.held.iter().flatten();
        held.any(|(held, _)| held == name)
    }

    /// Believes what was seen of an object.
    fn believe(&mut self, name: &str, known: &KnownObject, pose: Pose) {
        let pose = match self.belief.objects.get(name) {
            Some(before) => known.turned_least(pose, before.pose.rotation),
            None => pose,
        };
        let truth = self.observer.sight().objects.get(name);
        if let Some(object) = truth {
            let seen = SeenObject {
                pose,
                ..object.clone()
            };
            self.belief.objects.insert(name.to_owned(), seen);
        }
    }
}

impl HeadCameraStage for SeeingStage<'_> {
    fn head_picture(&mut self) -> Option<HeadPicture> {
        head_picture(self.app)
    }
}

impl PlanningStage for SeeingStage<'_> {
    fn sight(&self) -> &Sight {
        &self.belief
    }

    fn tick(&mut self, orders: &[LimbOrder]) -> Result<(), Stopped> {
        advance(self.app, orders);
        self.observer.look(self.app.world_mut());
        self.feel();
        Ok(())
    }

    /// Looks, and turns its head for what may be beside the picture.
    fn look(&mut self) -> Vec<String> {
        let mut unseen = self.glance(None);
        for pan in [PAN, -PAN] {
            if unseen.iter().any(|name| self.is_beside_picture(name)) && self.turn_head(pan) {
                unseen = self.glance(Some(&unseen));
            }
        }
        self.turn_head(0.0);
        unseen
    }
}
