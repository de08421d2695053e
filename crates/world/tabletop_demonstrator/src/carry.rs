//! Carrying: the motion of held objects.

use std::cell::OnceCell;

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::bounding_volume::{Aabb, BoundingVolume as _},
    plugin::RapierContextMut,
    prelude::*,
    rapier::prelude as rapier,
};
use tabletop_core::{Hand, Hands, Joint, TICK_SECONDS};
use tabletop_geometry::Pose;
use tabletop_physics::{
    Approach, Carry, Convex, Environment, MovedBody, Nearest, Pushed, SweptSolid, convex_parts,
    limits::{FASTEST, FASTEST_PUSH, LEAVING, MOST_SLIDES, PRESSED, REACH, SAME_LENGTH, TOUCHING},
    nearest, pull_velocity,
};

use crate::{
    grasp::CarryTarget,
    obstacles::{leave, slide},
};

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
        let held = convex_parts(Pose::IDENTITY, collider.shared_shape());
        let (next, neighbours) = {
            let near = Near::new(&rapier, object, collider.shape(), &joints, here, next);
            (carried(&held, here, next, &near), near.things.free)
        };
        for neighbour in neighbours.iter().filter(|it| it.is_sleeping) {
            if let Ok(mut sleeping) = sleeping.get_mut(neighbour.object) {
                sleeping.sleeping = false;
            }
        }
        body.send(&mut rapier.rigidbody_set, next);
    }
}

fn collider_of(colliders: &RapierContextColliders, object: Entity) -> Option<&rapier::Collider> {
    let handle = colliders.entity2collider().get(&object)?;
    colliders.colliders.get(*handle)
}

/// The pose that a freely carried object reaches on its way from one pose to another.
fn carried(held: &[Convex], here: Pose, mut next: Pose, near: &Near) -> Pose {
    if let Some(outside) = leave(held, here, next, &near.immovable) {
        return outside;
    }
    next.rotation = near.turned(held, here, next.rotation);
    let step = next.location - here.location;
    let pushes = near.pushes(held, here, step.length());
    let mut step = pushed(step, &pushes);
    for _ in 0..MOST_SLIDES {
        next.location = here.location + step;
        let there = slide(held, here, next, &near.immovable);
        let slid = there.location - here.location;
        step = pushed(slid, &pushes);
        if step.distance(slid) < SAME_LENGTH {
            return there;
        }
    }
    here
}

/// A free object that a held one reaches, and where.
type Push<'a> = (Pushed<'a>, Vec<Nearest>);

/// The part of a step that remains when free objects are reached in one tick and pushed from the next one on, no faster
/// than a hand pushes. A hand leaves an object that it is too deep in; an arm, which goes along a path, only stops.
fn pushed(mut step: Vec3, pushes: &[Push]) -> Vec3 {
    let places = pushes
        .iter()
        .flat_map(|(object, places)| places.iter().map(move |place| (object, place)));
    for (object, place) in places {
        let way = -step.dot(place.away);
        let depth = -place.distance;
        let room = match depth > PRESSED {
            true => (PRESSED - depth) / 2.0,
            false => room(object, place, way),
        };
        step += place.away * (way - room).max(0.0);
    }
    step
}

/// The part of a way, in units, that a hand can go towards a place of a free object.
fn room(object: &Pushed, place: &Nearest, way: f32) -> f32 {
    let mut approach = Approach {
        gap: place.distance,
        way,
        direction: -place.away,
        retreat: object.retreat(-place.away),
    };
    if approach.is_push() {
        approach.way = way.min(FASTEST_PUSH * TICK_SECONDS);
    }
    match way > 0.0 {
        true => approach.way * object.part(approach),
        false => way,
    }
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

/// The neighbourhood of a carried object's way.
struct Near<'a> {
    /// The solids that the object may come near.
    things: Environment,
    /// Obstacles: everything that does not move by itself, in the table's frame.
    immovable: Vec<Convex>,
    /// A wider environment, with the objects that are pushed in turn; looked at only if any is.
    pile: OnceCell<Environment>,
    look: Box<dyn Fn(Aabb) -> Environment + 'a>,
    room: Aabb,
}

impl<'a> Near<'a> {
    fn new(
        rapier: &'a RapierContextMut,
        carried: Entity,
        shape: &dyn rapier::Shape,
        joints: &'a Query<&Joint>,
        here: Pose,
        next: Pose,
    ) -> Self {
        let bounds = shape.compute_local_bounding_sphere();
        let radius = bounds.center().length() + bounds.radius();
        // It is pushed out of obstacles that it would be turned into.
        let turning = here.rotation.angle_between(next.rotation) * radius;
        // Obstacles along which it slides may turn it anywhere.
        let reach = radius + turning + here.location.distance(next.location) + LEAVING;
        let room = Aabb::new(here.location - reach, here.location + reach);
        let look = move |room| {
            let is_met = |entity| entity != carried;
            let (colliders, bodies) = (&rapier.colliders, &rapier.rigidbody_set);
            Environment::new(colliders, bodies, room, is_met, joints.iter())
        };
        let things = look(room);
        Self {
            immovable: things.immovable.iter().map(SweptSolid::part).collect(),
            things,
            pile: OnceCell::new(),
            look: Box::new(look),
            room,
        }
    }

    /// The orientation that a held object reaches on its way to another, with the free objects that it pushes.
    fn turned(&self, held: &[Convex], here: Pose, rotation: Quat) -> Quat {
        if rotation == here.rotation || self.things.free.is_empty() {
            return rotation;
        }
        let there = Pose::new(here.location, rotation);
        let solids: Vec<_> = SweptSolid::moving(held, (), here, there).collect();
        match self.pile().part(&solids) {
            (part, _) if part < 1.0 => here.rotation.slerp(rotation, part).normalize(),
            _ => rotation,
        }
    }

    /// The free objects that a held one at a pose reaches within a way, in units.
    fn pushes(&self, held: &[Convex], here: Pose, way: f32) -> Vec<Push<'_>> {
        let reached = self.things.free.iter().filter_map(|object| {
            let parts: Vec<_> = object.solids.iter().map(SweptSolid::part).collect();
            let places: Vec<_> = nearest(held, here, &parts, way + TOUCHING).collect();
            (!places.is_empty()).then_some(())?;
            Some((self.pile().pushed(object.object)?, places))
        });
        reached.collect()
    }

    fn pile(&self) -> &Environment {
        self.pile
            .get_or_init(|| (self.look)(self.room.loosened(REACH)))
    }
}
