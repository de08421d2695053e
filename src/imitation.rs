//! The simulator as a stage on which the robot does what was shown.

use bevy::{
    math::{DAffine3, DMat3, DVec3},
    prelude::*,
};
use tabletop_core::{
    Drive, Joint, JointSpec, ObjectIndex, ObjectSpec, Pose, Random, Robot, RobotCommand,
    RobotLayout, SceneItem, SceneSpec, StepApp as _, Table, WriteCommand as _,
};
use tabletop_kinematics::{ModelError, baxter};
use tabletop_planner::{
    Angles, LimbOrder, LimbSight, LimbSource, Piece, RobotBody, SeenObject, Sight, Stage, scatter,
};
use tabletop_scene::{IdAllocator, assemble};
use tabletop_task::{Arrangement, Convex};

/// An app whose robot is moved by commands, as scripts move it.
pub struct AppStage<'a> {
    app: &'a mut App,
    table: Table,
    joints: Vec<JointSpec>,
}

impl<'a> AppStage<'a> {
    /// The app, with what is on its table.
    pub fn new(app: &'a mut App) -> Self {
        let world = app.world_mut();
        let table = world.query::<&Table>().iter(world).next().copied();
        let joints: Vec<_> = world.query::<&Joint>().iter(world).copied().collect();
        let id = |entity: Entity| Some(world.get::<ObjectSpec>(entity)?.id.clone());
        let joints = joints.into_iter().filter_map(|joint| {
            let [first, second] = joint.objects.map(id);
            Some(JointSpec {
                objects: [first?, second?],
                frames: joint.frames,
                kind: joint.kind,
                collides: joint.collides,
            })
        });
        Self {
            joints: joints.collect(),
            table: table.unwrap_or_default(),
            app,
        }
    }
}

impl Stage for AppStage<'_> {
    fn sight(&self) -> Sight {
        let world = self.app.world();
        let objects = world.resource::<ObjectIndex>().iter().filter_map(|entity| {
            let spec = world.get::<ObjectSpec>(entity)?;
            let seen = SeenObject {
                shape: spec.shape.clone(),
                pose: Pose::from(world.get::<Transform>(entity)?),
                is_fixed: spec.is_fixed(),
            };
            Some((spec.id.clone(), seen))
        });
        let robot = world.resource::<Robot>();
        let id = |entity: &Entity| Some(world.get::<ObjectSpec>(*entity)?.id.clone());
        let layout = world.resource::<RobotLayout>();
        let limbs = layout.limbs.iter().zip(&robot.limbs);
        let limbs = limbs.map(|(limb, state)| LimbSight {
            angles: padded(robot.positions_of(&limb.joints)),
            opening: robot.joint(limb.gripper.joint).position,
            holds: state.holds.iter().filter_map(id).collect(),
            blocked_by: state.blocked_by.clone(),
        });
        Sight {
            table: self.table,
            objects: objects.collect(),
            joints: self.joints.clone(),
            limbs: limbs.collect(),
        }
    }

    fn tick(&mut self, orders: &[LimbOrder]) {
        let layout = self.app.world().resource::<RobotLayout>();
        let mut drives = Vec::new();
        for (limb, order) in layout.limbs.iter().zip(orders) {
            let joints = limb.joints.iter().copied().zip(order.joints);
            let all = joints.chain([(limb.gripper.joint, order.opening)]);
            let moving = all.filter(|(_, velocity)| *velocity != 0.0);
            drives
                .extend(moving.map(|(joint, velocity)| {
                    (layout.joint(joint).name, Drive::Velocity(velocity))
                }));
        }
        if !drives.is_empty() {
            self.app
                .world_mut()
                .write_command(RobotCommand::Drive(drives));
        }
        self.app.step(1);
    }
}

/// The part of their motors' speed at which joints are turned.
const SHARE_OF_SPEED: f64 = 0.75;

fn padded(angles: impl IntoIterator<Item = f64>) -> Angles {
    let mut all = Angles::default();
    for (place, angle) in all.iter_mut().zip(angles) {
        *place = angle;
    }
    all
}

/// The Baxter of the report in front of a table, as planning needs it.
///
/// # Errors
/// Never: a test reads its description.
pub fn baxter_body(table: &Table) -> Result<RobotBody, ModelError> {
    let layout = RobotLayout::baxter();
    let model = baxter()?;
    let limbs = layout.limbs.iter().filter_map(|limb| {
        let frame = limb
            .end_effector
            .iter()
            .find(|frame| model.find_link(&frame.link).is_ok())?;
        let axes = frame.axes.map(DVec3::from_array);
        let joints: Vec<_> = limb
            .joints
            .iter()
            .map(|&joint| layout.joint(joint))
            .collect();
        Some(LimbSource {
            name: limb.name.to_string(),
            tip: frame.link.clone(),
            end_effector: DAffine3::from_mat3_translation(
                DMat3::from_cols(axes[0], axes[1], axes[2]),
                DVec3::from_array(frame.at),
            ),
            limits: joints.iter().map(|joint| joint.limits).collect(),
            speeds: padded(joints.iter().map(|joint| joint.speed * SHARE_OF_SPEED)),
            finger: limb.gripper.finger,
            widest: layout.joint(limb.gripper.joint).limits[1] as f32,
            home: padded(joints.iter().map(|joint| joint.home)),
        })
    });
    let limbs = limbs.collect();
    RobotBody::new(model, layout.base.pose(table), limbs)
}

/// A scene with everything at random places, decided by the seed, and within reach of the robot if there is one; what stands on, in or around
/// something stays with it, and nothing is put near what is `kept` free. None if there is no room.
pub fn scattered(
    scene: &SceneSpec,
    kept: &[Convex],
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
            let parts = assemble(&alone, &mut ids).objects;
            let solids = parts.iter().flat_map(|part| {
                let colliding = part.shape.colliding();
                let pose = part.pose;
                colliding
                    .into_iter()
                    .map(move |solid| Convex::of(&solid, pose))
            });
            let piece = Piece {
                solids: solids.collect(),
                ids: parts.iter().map(|part| part.id.clone()).collect(),
                centre: parts.first().map_or(Vec3::ZERO, |part| part.pose.location),
                reached: parts.iter().map(|part| part.pose.location).collect(),
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
    let seed = Random::new(seed).bits();
    let is_reached = |point| body.is_none_or(|body| body.reaches_from_above(point));
    let motions = scatter(&pieces, &arrangement, &scene.table, kept, is_reached, seed)?;
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
