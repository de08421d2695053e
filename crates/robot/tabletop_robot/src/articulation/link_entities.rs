//! The robot's bodies in the world.

use bevy::{ecs::system::SystemState, prelude::*};
use bevy_rapier3d::{
    plugin::systems::{init_colliders, init_rigid_bodies},
    prelude::*,
};
use tabletop_core::{CarriesHeadCamera, Robot, Rollback, Table};
use tabletop_geometry::Pose;
use tabletop_physics::{MET_WHEN_THERE, MovedBody, set_enabled};

use crate::articulation::{
    passive_links::PassiveLinks,
    tree::{Articulation, Body, Positions, TreePosition},
};

/// A body of the robot: a link, or a finger of a gripper.
#[derive(Component, Clone, Debug, Reflect)]
#[require(Transform, Rollback)]
#[reflect(Component)]
pub struct RobotLink {
    /// Its name.
    pub name: String,
}

/// The robot's bodies, by their numbers; none before it is shown for the first time.
#[derive(Resource, Clone, Debug, Default)]
pub struct LinkEntities(pub Vec<Entity>);

/// Friction of the robot's surface. The friction of a contact is the product of both surfaces'.
pub const FRICTION: f32 = 1.0;

/// Makes the bodies, disabled.
pub fn spawn(world: &mut World) -> Result {
    let articulation = world.resource::<Articulation>().clone();
    let base = base(world);
    let posture = articulation.posture(&positions(world.resource::<Robot>()), base);
    let mut parts = Vec::new();
    for (body, &pose) in articulation.bodies.iter().zip(posture.bodies()) {
        let place = Transform::from(pose);
        let mut part = world.spawn((
            RobotLink {
                name: body.name.clone(),
            },
            place,
            GlobalTransform::from(place),
        ));
        if body.place == TreePosition::Head {
            part.insert(CarriesHeadCamera);
        }
        if let Some(collider) = collider(body) {
            part.insert((
                RigidBody::KinematicPositionBased,
                MET_WHEN_THERE,
                collider,
                Friction {
                    coefficient: FRICTION,
                    combine_rule: CoefficientCombineRule::Multiply,
                },
                RigidBodyDisabled,
            ));
        }
        parts.push(part.id());
        // One by one, before other pending bodies: the order of bodies decides the last bits of their motion, and Bevy's tables have an order
        // of their own.
        world.run_system_cached(init_rigid_bodies)?;
        world.run_system_cached(init_colliders)?;
    }
    world.insert_resource(LinkEntities(parts));
    Ok(())
}

/// Lets the bodies meet others, or not.
pub fn enable(world: &mut World, enabled: bool) -> Result {
    let links = world.resource::<LinkEntities>().clone();
    set_enabled(world, &links.0, enabled)
}

fn collider(body: &Body) -> Option<Collider> {
    let parts: Vec<_> = body
        .parts
        .iter()
        .map(|part| {
            (
                part.pose.location,
                part.pose.rotation,
                part.shape.clone().into(),
            )
        })
        .collect();
    (!parts.is_empty()).then(|| Collider::compound(parts))
}

/// The positions of the joints.
pub fn positions(robot: &Robot) -> Positions {
    robot.joints.iter().map(|joint| joint.position).collect()
}

/// Pose of the torso's frame in front of the present table.
pub fn base(world: &mut World) -> Pose {
    let mut tables = world.query::<&Table>();
    let table = tables.iter(world).next().copied();
    world
        .resource::<Articulation>()
        .layout
        .base
        .pose(&table.unwrap_or_default())
}

/// Lets these links push nothing, and all others push the objects that they meet.
pub fn make_passive(world: &mut World, passive: PassiveLinks) -> Result {
    let links = world.resource::<LinkEntities>().clone();
    world.resource_scope(|world, mut now: Mut<PassiveLinks>| {
        let mut contexts =
            world.query_filtered::<&mut RapierContextColliders, With<DefaultRapierContext>>();
        now.set(passive, &links.0, &mut *contexts.single_mut(world)?);
        Ok(())
    })
}

/// Puts the bodies where the posture has them, without pushing anything on the way.
pub fn teleport(world: &mut World) -> Result {
    let base = base(world);
    let posture = world
        .resource::<Articulation>()
        .posture(&positions(world.resource::<Robot>()), base);
    let parts = world.resource::<LinkEntities>().clone();
    let mut state: SystemState<(Query<MovedBody>, WriteRapierContext)> = SystemState::new(world);
    let (mut moved, mut rapier) = state.get_mut(world)?;
    let bodies = &mut rapier.single_mut()?.rigidbody_set;
    for (&part, &pose) in parts.0.iter().zip(posture.bodies()) {
        if let Ok(mut body) = moved.get_mut(part) {
            body.jump(bodies, pose);
        }
    }
    Ok(())
}
