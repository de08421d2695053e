//! The observer of a world.

use bevy::{ecs::change_detection::Tick, prelude::*};
use tabletop_core::{Joint, ObjectIndex, ObjectSpec, Robot, RobotLayout, Table};
use tabletop_geometry::Pose;

use crate::sight::{LimbSight, SeenObject, Sight, angles};

/// The observer of a world: keeps its sight, and updates only the poses while objects and joints are the same.
#[derive(Default)]
pub struct Observer {
    sight: Sight,
    objects: Vec<Entity>,
    joints: Vec<Joint>,
    all_joints: Option<QueryState<&'static Joint>>,
    /// The time of the last look.
    looked: Tick,
}

impl Observer {
    /// The sight of the last look.
    pub fn sight(&self) -> &Sight {
        &self.sight
    }

    /// The sight of the world as it is now.
    pub fn look(&mut self, world: &mut World) -> &Sight {
        if self.is_outdated(world) {
            self.sight = sight(world, &self.joints);
        } else {
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
        self.looked = world.increment_change_tick();
        &self.sight
    }

    /// Updates the lists of objects and joints. True if they, or the objects' properties, are others than at the last look.
    fn is_outdated(&mut self, world: &mut World) -> bool {
        let all_joints = self.all_joints.get_or_insert_with(|| world.query());
        let joints: Vec<_> = all_joints.iter(world).copied().collect();
        let objects: Vec<_> = world.resource::<ObjectIndex>().iter().collect();
        let now = world.change_tick();
        let is_changed = |object: &Entity| {
            let ticks = world.entity(*object).get_change_ticks::<ObjectSpec>();
            ticks.is_none_or(|ticks| ticks.is_changed(self.looked, now))
        };
        let is_outdated =
            objects != self.objects || joints != self.joints || objects.iter().any(is_changed);
        (self.objects, self.joints) = (objects, joints);
        is_outdated
    }
}

impl Sight {
    /// The sight of the world as it is now.
    pub fn of(world: &mut World) -> Self {
        let mut observer = Observer::default();
        observer.look(world);
        observer.sight
    }
}

fn sight(world: &mut World, joints: &[Joint]) -> Sight {
    let table = world.query::<&Table>().iter(world).next().copied();
    let id = |entity| Some(world.get::<ObjectSpec>(entity)?.id.clone());
    let joints = joints.iter().filter_map(|joint| joint.spec(id));
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
        says_it_grips: state.says_it_grips,
        blocked_by: state.blocked_by.as_ref().map(ToString::to_string),
    });
    limbs.collect()
}
