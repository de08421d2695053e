//! Carrying: the motion of held objects.

use bevy::prelude::*;
use bevy_rapier3d::{parry::bounding_volume::Aabb, prelude::*, rapier::prelude as rapier};
use tabletop_core::{Hand, Hands, Pose, TICK_SECONDS};
use tabletop_physics::{Carry, Convex, convex_parts, nearby, nearest, pull_velocity};

use crate::{grasp::CarryTarget, obstacles::slide};

/// Greatest speeds of a hand: in units/s, and in rad/s for turning.
const FASTEST: (f32, f32) = (40.0, 10.0);

/// Greatest speed, in units/s, at which a hand pushes free objects.
const FASTEST_PUSH: f32 = 6.0;

/// Depth, in units, to which a free object may be squeezed against something before the hand yields.
const MOST_SQUEEZE: f32 = 0.002;

/// Moves every held object towards its target for one tick, and keeps its surroundings awake: Rapier would let things fall into
/// sleeping objects for a tick.
pub(crate) fn carry(
    hands: Res<Hands>,
    rapier: ReadRapierContext,
    mut held: Query<(&Carry, &CarryTarget, &mut Transform, Option<&mut Velocity>)>,
    mut sleeping: Query<&mut Sleeping>,
) {
    let Ok(rapier) = rapier.single() else {
        return;
    };
    for object in Hand::ALL.into_iter().filter_map(|hand| hands.held_by(hand)) {
        let Ok((carry, target, mut transform, velocity)) = held.get_mut(object) else {
            continue;
        };
        let here = Pose::from(&*transform);
        if let (Carry::AgainstJoints, Some(mut velocity)) = (carry, velocity) {
            *velocity = pull_velocity(here, target.0);
            continue;
        }
        let Some(collider) = collider_of(&rapier, object) else {
            continue;
        };
        let next = advanced(here, target.0);
        let near = Near::new(&rapier, collider, here, next);
        let next = carried(collider, here, next, &near);
        transform.set_if_neq(next.into());
        for neighbour in near.sleeping {
            if let Ok(mut sleeping) = sleeping.get_mut(neighbour) {
                sleeping.sleeping = false;
            }
        }
    }
}

fn collider_of<'a>(rapier: &'a RapierContext, object: Entity) -> Option<&'a rapier::Collider> {
    let handle = rapier.colliders.entity2collider().get(&object)?;
    rapier.colliders.colliders.get(*handle)
}

/// The pose that a freely carried object reaches on its way from one pose to another.
fn carried(collider: &rapier::Collider, here: Pose, mut next: Pose, near: &Near) -> Pose {
    let held = convex_parts(Pose::IDENTITY, collider.shared_shape());
    next.location = here.location + pushing(next.location - here.location, &held, here, &near.free);
    slide(&held, here, next, &near.immovable)
}

/// The part of a step that remains when free objects are reached in one tick and pushed from the next one on, no faster
/// than a hand pushes, and without being squeezed.
fn pushing(mut step: Vec3, held: &[Convex], here: Pose, free: &[Convex]) -> Vec3 {
    let reach = step.length() + MOST_SQUEEZE;
    for nearest in nearest(held, here, free, reach) {
        let squeeze = (-nearest.distance / MOST_SQUEEZE).max(0.0);
        let push = match squeeze < 1.0 {
            true => FASTEST_PUSH * TICK_SECONDS * (1.0 - squeeze),
            false => MOST_SQUEEZE * (1.0 - squeeze) / 2.0,
        };
        let approach = -step.dot(nearest.away);
        step += nearest.away * (approach - push.max(nearest.distance)).max(0.0);
    }
    step
}

/// A tick's part of the way to the target.
fn advanced(here: Pose, target: Pose) -> Pose {
    let way = target.location - here.location;
    let way = way.clamp_length_max(FASTEST.0 * TICK_SECONDS);
    let location = if way == target.location - here.location {
        target.location
    } else {
        here.location + way
    };
    let angle = here.rotation.angle_between(target.rotation);
    let most = FASTEST.1 * TICK_SECONDS;
    let rotation = if angle <= most {
        target.rotation
    } else {
        here.rotation
            .slerp(target.rotation, most / angle)
            .normalize()
    };
    Pose::new(location, rotation)
}

/// The neighbourhood of a carried object's way, as convex parts in the frame of the world.
struct Near {
    /// Obstacles: everything that does not move by itself.
    immovable: Vec<Convex>,
    /// Objects that it pushes.
    free: Vec<Convex>,
    /// The free objects that sleep.
    sleeping: Vec<Entity>,
}

impl Near {
    fn new(rapier: &RapierContext, carried: &rapier::Collider, here: Pose, next: Pose) -> Self {
        let bounds = carried.shape().compute_local_bounding_sphere();
        let reach = bounds.center().length() + bounds.radius() + 0.1;
        let way = Aabb::new(
            here.location.min(next.location) - reach,
            here.location.max(next.location) + reach,
        );
        let mut near = Self {
            immovable: Vec::new(),
            free: Vec::new(),
            sleeping: Vec::new(),
        };
        for other in nearby(rapier.colliders, rapier.rigidbody_set, way, |_| true) {
            if other.collider.parent() == carried.parent() {
                continue;
            }
            if !other.body.is_dynamic() {
                near.immovable.extend(other.parts());
                continue;
            }
            near.free.extend(other.parts());
            if other.body.is_sleeping() {
                near.sleeping.push(other.entity);
            }
        }
        near
    }
}
