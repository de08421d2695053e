//! Carrying: the motion of held objects.

use std::cell::OnceCell;

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::bounding_volume::Aabb, plugin::RapierContextMut, prelude::*, rapier::prelude as rapier,
};
use tabletop_core::{Hand, Hands, Joint, Pose, TICK_SECONDS};
use tabletop_physics::{
    Carry, Convex, MovedBody, Nearby, Nearest, convex_parts, nearby, nearest, pull_velocity,
};

use crate::{
    grasp::CarryTarget,
    obstacles::{leave, slide},
    pile::{Pile, PiledObject, Resistance},
};

/// Greatest speeds of a hand: in units/s, and in rad/s for turning.
const FASTEST: (f32, f32) = (40.0, 10.0);

/// Greatest speed, in units/s, at which a hand pushes free objects.
const FASTEST_PUSH: f32 = 6.0;

/// Depth, in units, to which a free object may be squeezed against something before the hand yields.
const MOST_SQUEEZE: f32 = 0.002;

/// Gap, in units, to which a free object is reached before it is pushed.
const GAP: f32 = 0.01;

/// Depths, in units, of a free object in something: from the first on the hand slows, at the second it only yields.
const TOO_DEEP: (f32, f32) = (0.02, 0.05);

/// Number of tries to slide along obstacles and push no free object too much.
const MOST_SLIDES: usize = 4;

/// Number of parts of a turn that are tried, each half as large as the one before.
const TURNS: i32 = 5;

/// Largest difference of equal steps, in units.
const SAME_STEP: f32 = 1e-4;

/// Moves every held object towards its target for one tick, and keeps its surroundings awake: Rapier would let things fall into
/// sleeping objects for a tick.
pub(crate) fn carry(
    hands: Res<Hands>,
    mut rapier: WriteRapierContext,
    mut held: Query<(&Carry, &CarryTarget, MovedBody, Option<&mut Velocity>)>,
    mut sleeping: Query<&mut Sleeping>,
    joints: Query<&Joint>,
) {
    let Ok(mut rapier) = rapier.single_mut() else {
        return;
    };
    for object in Hand::ALL.into_iter().filter_map(|hand| hands.held_by(hand)) {
        let Ok((carry, target, mut body, velocity)) = held.get_mut(object) else {
            continue;
        };
        let here = body.pose();
        if let (Carry::AgainstJoints, Some(mut velocity)) = (carry, velocity) {
            *velocity = pull_velocity(here, target.0);
            continue;
        }
        let Some(collider) = collider_of(&rapier.colliders, object) else {
            continue;
        };
        let next = advanced(here, target.0);
        let is_jointed = |object| joints.iter().any(|joint| joint.objects.contains(&object));
        let shape = collider.shape();
        let near = Near::new(&rapier, object, shape, &is_jointed, here, next);
        let next = carried(collider, here, next, &near);
        for &neighbour in &near.sleeping {
            if let Ok(mut sleeping) = sleeping.get_mut(neighbour) {
                sleeping.sleeping = false;
            }
        }
        if next != here {
            body.send(&mut rapier.rigidbody_set, rounded(next));
        }
    }
}

/// A pose as it comes out of a global transform.
fn rounded(pose: Pose) -> Pose {
    let global = GlobalTransform::from(Transform::from(pose));
    Pose::from(&global.compute_transform())
}

fn collider_of(colliders: &RapierContextColliders, object: Entity) -> Option<&rapier::Collider> {
    let handle = colliders.entity2collider().get(&object)?;
    colliders.colliders.get(*handle)
}

/// The pose that a freely carried object reaches on its way from one pose to another.
fn carried(collider: &rapier::Collider, here: Pose, mut next: Pose, near: &Near) -> Pose {
    let held = convex_parts(Pose::IDENTITY, collider.shared_shape());
    if let Some(outside) = leave(&held, here, next, &near.immovable) {
        return outside;
    }
    next.rotation = turned(&held, here, next.rotation, near);
    let step = next.location - here.location;
    let pushes = near.pushes(&held, here, step.length());
    let mut step = pushed(step * slowness(&pushes), &pushes);
    for _ in 0..MOST_SLIDES {
        next.location = here.location + step;
        let there = slide(&held, here, next, &near.immovable);
        let slid = there.location - here.location;
        step = pushed(slid, &pushes);
        if step.distance(slid) < SAME_STEP {
            return there;
        }
    }
    here
}

/// The orientation that a held object reaches on its way to another: the farthest of a few at which it squeezes no free object.
fn turned(held: &[Convex], here: Pose, rotation: Quat, near: &Near) -> Quat {
    if rotation == here.rotation || near.free.is_empty() {
        return rotation;
    }
    let squeeze_here = near.squeeze(held, here);
    let parts = (0..TURNS).map(|halvings| 0.5f32.powi(halvings));
    let mut turns = parts.map(|part| here.rotation.slerp(rotation, part).normalize());
    let is_free = |turn: &Quat| {
        let squeeze = near.squeeze(held, Pose::new(here.location, *turn));
        squeeze <= squeeze_here.max(0.0)
    };
    turns.find(is_free).unwrap_or(here.rotation)
}

/// A free object that a held one reaches.
struct Push {
    nearest: Nearest,
    resistance: Resistance,
}

impl Push {
    /// The way, in units, by which it gives way in a tick.
    fn way(&self) -> f32 {
        let give = self.resistance.give(TOO_DEEP.0);
        give.min(FASTEST_PUSH * TICK_SECONDS)
    }
}

/// The part of a step at which a hand slows, so that nothing is squeezed ever more.
fn slowness(pushes: &[Push]) -> f32 {
    let depths = pushes
        .iter()
        .map(|push| push.resistance.depth.max(-push.nearest.distance));
    let room = TOO_DEEP.1 - depths.fold(0.0, f32::max);
    (room / (TOO_DEEP.1 - TOO_DEEP.0)).clamp(0.0, 1.0)
}

/// The part of a step that remains when free objects are reached in one tick and pushed from the next one on, no faster
/// than a hand pushes, and without being squeezed.
fn pushed(mut step: Vec3, pushes: &[Push]) -> Vec3 {
    for push in pushes {
        let nearest = &push.nearest;
        let squeeze = (-nearest.distance / MOST_SQUEEZE).max(0.0);
        let way = match squeeze < 1.0 {
            true => push.way() * (1.0 - squeeze),
            false => MOST_SQUEEZE * (1.0 - squeeze) / 2.0,
        };
        let approach = -step.dot(nearest.away);
        step += nearest.away * (approach - way.max(nearest.distance - GAP)).max(0.0);
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
struct Near<'a> {
    /// Obstacles: everything that does not move by itself.
    immovable: Vec<Convex>,
    /// Objects that it pushes.
    free: Vec<PiledObject>,
    /// The free objects that sleep.
    sleeping: Vec<Entity>,
    /// The pile of these objects, if they were reached.
    pile: OnceCell<Pile>,
    colliders: &'a RapierContextColliders,
    bodies: &'a RapierRigidBodySet,
    carried: Entity,
    is_jointed: &'a dyn Fn(Entity) -> bool,
}

impl<'a> Near<'a> {
    fn new(
        rapier: &'a RapierContextMut,
        carried: Entity,
        shape: &dyn rapier::Shape,
        is_jointed: &'a dyn Fn(Entity) -> bool,
        here: Pose,
        next: Pose,
    ) -> Self {
        let bounds = shape.compute_local_bounding_sphere();
        let radius = bounds.center().length() + bounds.radius();
        // It is pushed out of what it would be turned into.
        let turning = here.rotation.angle_between(next.rotation) * radius;
        // What it slides along may turn it anywhere.
        let reach = radius + turning + here.location.distance(next.location) + 0.1;
        let way = Aabb::new(here.location - reach, here.location + reach);
        let mut near = Self {
            immovable: Vec::new(),
            free: Vec::new(),
            sleeping: Vec::new(),
            pile: OnceCell::new(),
            colliders: &rapier.colliders,
            bodies: &rapier.rigidbody_set,
            carried,
            is_jointed,
        };
        for other in near.others(way) {
            if !other.body.is_dynamic() {
                near.immovable.extend(other.parts());
                continue;
            }
            near.free.push(PiledObject::new(&other, is_jointed));
            if other.body.is_sleeping() {
                near.sleeping.push(other.entity);
            }
        }
        near
    }

    /// The other bodies in a box.
    fn others(&self, room: Aabb) -> impl Iterator<Item = Nearby<'a>> + use<'a> {
        let carried = self.carried;
        let is_other = move |entity| entity != carried;
        nearby(self.colliders, self.bodies, room, is_other)
    }

    /// How much farther, in units, a held one at a pose is in free objects than they give way in a tick.
    fn squeeze(&self, held: &[Convex], at: Pose) -> f32 {
        let pushes = self.pushes(held, at, 0.0).into_iter();
        let squeezes = pushes.map(|push| -push.nearest.distance - push.way());
        squeezes.fold(f32::NEG_INFINITY, f32::max)
    }

    /// The free objects that a held one at a pose reaches within a step's length, in units.
    fn pushes(&self, held: &[Convex], here: Pose, step: f32) -> Vec<Push> {
        let of_object = |object: &PiledObject| {
            let entity = object.entity;
            let reached = nearest(held, here, &object.parts, step + MOST_SQUEEZE);
            let push = |nearest: Nearest| Push {
                resistance: self.pile().resistance(entity, -nearest.away),
                nearest,
            };
            reached.map(push).collect::<Vec<_>>()
        };
        self.free.iter().flat_map(of_object).collect()
    }

    fn pile(&self) -> &Pile {
        self.pile.get_or_init(|| {
            let everywhere = Aabb::new(Vec3::MIN, Vec3::MAX);
            Pile::of(&self.free, self.others(everywhere), self.is_jointed)
        })
    }
}
