//! The simulator as a stage on which the robot imitates.

mod head_picture;
mod seeing;

pub use head_picture::{HeadCameraStage, HeadPicture};
pub use seeing::{SeeingStage, imitate_seeing};

use bevy::prelude::*;
use tabletop_camera::Camera;
use tabletop_controller::{Observer, SeenObject, Sight};
use tabletop_core::{
    JointKind, Random, RobotCommand, RobotLayout, SceneItem, SceneSpec, StepApp as _,
    WriteCommand as _,
};
use tabletop_geometry::{PlacedSolid, Pose};
use tabletop_planner::{
    LimbOrder, Piece, PlanningStage, RobotBody, Stopped, drives, is_feasible, scatter,
};
use tabletop_scene::{IdAllocator, assemble};
use tabletop_task::{Arrangement, Requirements, Task};

use crate::still_scene::StillScene;

/// An app whose robot is moved by commands, as scripts move it.
pub struct AppStage<'a> {
    app: &'a mut App,
    observer: Observer,
}

impl<'a> AppStage<'a> {
    /// The app, with the objects on its table.
    pub fn new(app: &'a mut App) -> Self {
        let mut observer = Observer::default();
        observer.look(app.world_mut());
        Self { app, observer }
    }
}

impl PlanningStage for AppStage<'_> {
    fn sight(&self) -> &Sight {
        self.observer.sight()
    }

    fn tick(&mut self, orders: &[LimbOrder]) -> Result<(), Stopped> {
        advance(self.app, orders);
        self.observer.look(self.app.world_mut());
        Ok(())
    }
}

impl HeadCameraStage for AppStage<'_> {
    fn head_picture(&mut self) -> Option<HeadPicture> {
        head_picture::head_picture(self.app)
    }
}

/// Gives the robot these orders for its limbs, and advances by a tick.
fn advance(app: &mut App, orders: &[LimbOrder]) {
    let drives = drives(app.world().resource::<RobotLayout>(), orders);
    if !drives.is_empty() {
        app.world_mut().write_command(RobotCommand::Drive(drives));
    }
    app.step(1);
}

/// Number of arrangements that are tried until one allows the task.
const DRAWS: u64 = 50;

/// A scene with everything at random places within reach of the robot, decided by the seed, in which the task is [feasible](is_feasible). A `camera`
/// sees all that the task moves, wherever its steps take and put it. `None` if there is no room.
pub fn scattered_for(
    task: &Task,
    requirements: &Requirements,
    scene: &SceneSpec,
    body: &RobotBody,
    camera: Option<Camera>,
    seed: u64,
) -> Option<SceneSpec> {
    let is_possible = |scene: &SceneSpec| {
        let objects = assemble(scene, &mut IdAllocator::default()).objects;
        // The binding of roles reports objects that do not fit.
        let Ok(binding) = task.bind(requirements, &objects) else {
            return true;
        };
        if let Some(camera) = camera {
            let scene = StillScene::new(camera, &scene.table, objects.clone());
            if !scene.keeps_in_view(task, &binding) {
                return false;
            }
        }
        let seen = objects.into_iter().map(|spec| {
            let is_fixed = spec.is_fixed();
            let (shape, pose) = (spec.shape, spec.pose);
            let seen = SeenObject {
                shape,
                pose,
                is_fixed,
            };
            (spec.id, seen)
        });
        let sight = Sight {
            table: scene.table,
            objects: seen.collect(),
            ..Sight::default()
        };
        is_feasible(task, &binding, &sight)
    };
    let seeds = std::iter::once(seed).chain((1..DRAWS).map(|draw| {
        let mixed = seed ^ draw.wrapping_mul(0xd6e8_feb8_6659_fd93);
        Random::new(mixed).bits()
    }));
    let mut scenes = seeds.map_while(|seed| scattered(scene, &[], Some(body), seed));
    scenes.find(is_possible)
}

/// A scene with everything at random places, decided by the seed, and within reach of the robot if there is one. Objects that stand on, in or
/// around others stay with them, and nothing is put near the solids `kept` free. `None` if there is no room.
pub fn scattered(
    scene: &SceneSpec,
    kept: &[PlacedSolid],
    body: Option<&RobotBody>,
    seed: u64,
) -> Option<SceneSpec> {
    let mut ids = IdAllocator::default();
    let mut objects = Vec::new();
    let pieces: Vec<_> = scene
        .items
        .iter()
        .map(|item| {
            let alone = SceneSpec {
                table: scene.table,
                items: vec![item.clone()],
            };
            let assembly = assemble(&alone, &mut ids);
            let parts = assembly.objects;
            // A sliding object is somewhere else when it is open.
            let opened = assembly.joints.iter().filter_map(|joint| {
                let JointKind::Slider { max, .. } = joint.kind else {
                    return None;
                };
                let part = |id: &str| parts.iter().find(|part| part.id == id);
                let [holder, slid] = joint.objects.each_ref().map(|id| part(id));
                let way = holder?.pose.rotation * joint.frames[0].rotation * Vec3::NEG_X;
                let slid = slid?;
                Some((
                    slid,
                    Pose::new(slid.pose.location + way * max, slid.pose.rotation),
                ))
            });
            let opened: Vec<_> = opened.collect();
            let places = parts.iter().map(|part| (part, part.pose));
            let places: Vec<_> = places.chain(opened.iter().copied()).collect();
            let solids = places.iter().flat_map(|(part, pose)| {
                let colliding = part.shape.colliding();
                colliding
                    .into_iter()
                    .map(move |solid| PlacedSolid::of(&solid, *pose))
            });
            // A sliding part is opened by one arm, where that takes it.
            let reached = parts.iter().map(|part| {
                let ways = opened.iter().filter(|(slid, _)| slid.id == part.id);
                let mut ends: Vec<_> = ways.map(|(_, pose)| *pose).collect();
                let own = match ends.is_empty() {
                    true => Vec3::ZERO,
                    false => body.map_or(Vec3::ZERO, |body| body.hold(&part.shape, part.pose)),
                };
                ends.push(part.pose);
                ends.into_iter().map(|end| end * own).collect()
            });
            let reached = reached.collect();
            let piece = Piece {
                solids: solids.collect(),
                ids: parts.iter().map(|part| part.id.clone()).collect(),
                centre: parts.first().map_or(Vec3::ZERO, |part| part.pose.location),
                reached,
            };
            objects.extend(parts);
            piece
        })
        .collect();
    let arrangement = Arrangement::new(
        objects
            .iter()
            .map(|object| (object.id.as_str(), &object.shape, object.pose)),
    );
    let tops = pieces.iter().flat_map(|piece| &piece.solids);
    let highest = tops.map(|solid| solid.heights()[1]).fold(0.0, f32::max);
    // Nothing is put where the arms begin.
    let arms = body.map(RobotBody::at_home).unwrap_or_default();
    let low = |solid: &PlacedSolid| solid.heights()[0] < highest + 0.3;
    let kept: Vec<_> = kept
        .iter()
        .cloned()
        .chain(arms.into_iter().filter(low))
        .collect();
    let seed = Random::new(seed).bits();
    let room = body.map_or(0.0, |body| body.carrying_room(&pieces));
    // What stands on others is in that room already.
    let is_reached = |points: &[Vec3], foot: f32| {
        body.is_none_or(|body| body.reaches(points, (room - foot).max(0.0)))
    };
    let motions = scatter(&pieces, &arrangement, &scene.table, &kept, is_reached, seed)?;
    let items = scene.items.iter().zip(motions);
    let items = items.map(|(item, motion)| moved(item, motion));
    Some(SceneSpec {
        table: scene.table,
        items: items.collect(),
    })
}

/// An item of a scene, moved.
pub(crate) fn moved(item: &SceneItem, motion: Pose) -> SceneItem {
    let mut item = item.clone();
    match &mut item {
        SceneItem::Object(spec) => spec.pose = motion * spec.pose,
        SceneItem::LidBox(spec) => spec.pose = motion * spec.pose,
        SceneItem::Chain(spec) => {
            (spec.start, spec.end) = (motion * spec.start, motion * spec.end);
        }
        SceneItem::Jointed(spec) => spec.pose = motion * spec.pose,
    }
    item
}
