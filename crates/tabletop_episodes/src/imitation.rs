//! The simulator as a stage on which the robot imitates.

use bevy::prelude::*;
use tabletop_core::{
    Drive, Joint, JointKind, JointSpec, ObjectIndex, ObjectSpec, Random, Robot, RobotCommand,
    RobotLayout, SceneItem, SceneSpec, StepApp as _, Table, WriteCommand as _,
};
use tabletop_geometry::Pose;
use tabletop_planner::{
    LimbOrder, LimbSight, Piece, PlanningStage, RobotBody, SeenObject, Sight, Stopped, angles,
    is_feasible, scatter,
};
use tabletop_scene::{IdAllocator, assemble};
use tabletop_task::{Arrangement, PlacedSolid, Requirements, Task};

/// The sight of a world, with the robot at the table.
pub fn sight(world: &mut World) -> Sight {
    let table = world.query::<&Table>().iter(world).next().copied();
    let joints: Vec<_> = world.query::<&Joint>().iter(world).copied().collect();
    let id = |entity: &Entity| Some(world.get::<ObjectSpec>(*entity)?.id.clone());
    let joints = joints.into_iter().filter_map(|joint| {
        let [first, second] = joint.objects.map(|entity| id(&entity));
        Some(JointSpec {
            objects: [first?, second?],
            frames: joint.frames,
            kind: joint.kind,
            collides: joint.collides,
        })
    });
    let objects = world.resource::<ObjectIndex>().iter().filter_map(|entity| {
        let spec = world.get::<ObjectSpec>(entity)?;
        let seen = SeenObject {
            shape: spec.shape.clone(),
            pose: Pose::from(world.get::<Transform>(entity)?),
            is_fixed: spec.is_fixed(),
        };
        Some((spec.id.clone(), seen))
    });
    Sight {
        table: table.unwrap_or_default(),
        objects: objects.collect(),
        joints: joints.collect(),
        limbs: limbs(world),
    }
}

fn limbs(world: &World) -> Vec<LimbSight> {
    let robot = world.resource::<Robot>();
    let id = |entity: &Entity| Some(world.get::<ObjectSpec>(*entity)?.id.clone());
    let layout = world.resource::<RobotLayout>();
    let limbs = layout.limbs.iter().zip(&robot.limbs);
    let limbs = limbs.map(|(limb, state)| LimbSight {
        angles: angles(robot.positions_of(&limb.joints)),
        opening: robot.joint(limb.gripper.joint).position,
        holds: state.holds.iter().filter_map(id).collect(),
        blocked_by: state.blocked_by.as_ref().map(ToString::to_string),
    });
    limbs.collect()
}

/// The command that carries out orders for the limbs; `None` if nothing is to move.
pub fn command(layout: &RobotLayout, orders: &[LimbOrder]) -> Option<RobotCommand> {
    let mut drives = Vec::new();
    for (limb, order) in layout.limbs.iter().zip(orders) {
        let joints = limb.joints.iter().copied().zip(order.joints);
        let all = joints.chain([(limb.gripper.joint, order.opening)]);
        let moving = all.filter(|(_, velocity)| *velocity != 0.0);
        drives.extend(
            moving.map(|(joint, velocity)| (layout.joint(joint).name, Drive::Velocity(velocity))),
        );
    }
    (!drives.is_empty()).then_some(RobotCommand::Drive(drives))
}

/// An app whose robot is moved by commands, as scripts move it.
pub struct AppStage<'a> {
    app: &'a mut App,
    sight: Sight,
    objects: Vec<Entity>,
}

impl<'a> AppStage<'a> {
    /// The app, with the objects on its table.
    pub fn new(app: &'a mut App) -> Self {
        let mut stage = Self {
            app,
            sight: Sight::default(),
            objects: Vec::new(),
        };
        stage.look();
        stage
    }

    /// Updates the sight. If the objects are the same, only their poses are read.
    fn look(&mut self) {
        let world = self.app.world();
        let index = world.resource::<ObjectIndex>();
        if !index.iter().eq(self.objects.iter().copied()) {
            self.objects = index.iter().collect();
            self.sight = sight(self.app.world_mut());
            return;
        }
        for &entity in &self.objects {
            if let (Some(spec), Some(transform)) = (
                world.get::<ObjectSpec>(entity),
                world.get::<Transform>(entity),
            ) && let Some(seen) = self.sight.objects.get_mut(&spec.id)
            {
                seen.pose = Pose::from(transform);
            }
        }
        self.sight.limbs = limbs(world);
    }
}

impl PlanningStage for AppStage<'_> {
    fn sight(&self) -> &Sight {
        &self.sight
    }

    fn tick(&mut self, orders: &[LimbOrder]) -> Result<(), Stopped> {
        let layout = self.app.world().resource::<RobotLayout>();
        if let Some(command) = command(layout, orders) {
            self.app.world_mut().write_command(command);
        }
        self.app.step(1);
        self.look();
        Ok(())
    }
}

/// Number of arrangements that are tried until one allows the task.
const DRAWS: u64 = 50;

/// A scene with everything at random places within reach of the robot, decided by the seed, in which the task is [feasible](is_feasible). `None` if
/// there is no room.
pub fn scattered_for(
    task: &Task,
    requirements: &Requirements,
    scene: &SceneSpec,
    body: &RobotBody,
    seed: u64,
) -> Option<SceneSpec> {
    let is_possible = |scene: &SceneSpec| {
        let objects = assemble(scene, &mut IdAllocator::default()).objects;
        // What does not take the roles is told by who binds them.
        let Ok(binding) = task.bind(requirements, &objects) else {
            return true;
        };
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
            // What slides is opened by one arm.
            let reached = parts.iter().map(|part| {
                let ways = opened.iter().filter(|(slid, _)| slid.id == part.id);
                let ends = ways.map(|(_, pose)| pose.location);
                std::iter::once(part.pose.location).chain(ends).collect()
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
    let is_reached = |points: &[Vec3]| body.is_none_or(|body| body.reaches(points));
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
